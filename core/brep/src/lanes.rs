//! Four numbers at a time: arithmetic that the compiler turns into vector instructions.

use std::ops::{Add, Mul, Sub};

/// What basis functions are computed in: a number, or four of them.
pub(crate) trait Real:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
}

impl Real for f64 {}

/// Four numbers, or `N`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lanes<const N: usize = 4>(pub(crate) [f64; N]);

impl<const N: usize> Real for Lanes<N> {}

impl<const N: usize> From<f64> for Lanes<N> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self([value; N])
    }
}

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        // A loop: closures of `array::map` are not always inlined.
        let mut out = self.0;
        for i in 0..N {
            out[i] = f(out[i], other.0[i]);
        }
        Self(out)
    }

    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        let mut out = self.0;
        for x in &mut out {
            *x = x.sqrt();
        }
        Self(out)
    }

    #[inline(always)]
    pub(crate) fn sum(self) -> f64 {
        self.0.iter().sum()
    }
}

impl Lanes {
    /// The greatest of the four; not a number if one of them is none.
    #[inline(always)]
    pub(crate) fn max(self) -> f64 {
        let greater = |a: f64, b: f64| if b <= a { a } else { b };
        greater(greater(self.0[0], self.0[1]), greater(self.0[2], self.0[3]))
    }

    /// Sines and cosines, by rotation from the first angle: fast where the four are neighbours.
    #[inline]
    pub(crate) fn sin_cos(self) -> (Self, Self) {
        let base = self.0[1];
        let d = self - Self::from(base);
        let square = d * d;
        if !(square.max() < 1e-3) {
            let both = self.0.map(f64::sin_cos);
            return (Self(both.map(|b| b.0)), Self(both.map(|b| b.1)));
        }
        // Taylor series; the first term left out is below 1e-19.
        let series = |c: [f64; 4]| {
            let [a, b, c, e] = c.map(Self::from);
            Self::from(1.0) + square * (a + square * (b + square * (c + square * e)))
        };
        let sin_d = d * series([-1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0]);
        let cos_d = series([-0.5, 1.0 / 24.0, -1.0 / 720.0, 1.0 / 40_320.0]);
        let (sin, cos) = base.sin_cos();
        let (sin, cos) = (Self::from(sin), Self::from(cos));
        (sin * cos_d + cos * sin_d, cos * cos_d - sin * sin_d)
    }
}

impl<const N: usize> Add for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<const N: usize> Sub for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<const N: usize> Mul for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn neighbouring_angles_have_the_right_sines(
            base in -10.0f64..10.0,
            near in proptest::array::uniform4(-0.03f64..0.03),
        ) {
            let (sin, cos) = Lanes(near.map(|d| base + d)).sin_cos();
            for lane in 0..4 {
                prop_assert!((sin.0[lane] - (base + near[lane]).sin()).abs() < 4e-16);
                prop_assert!((cos.0[lane] - (base + near[lane]).cos()).abs() < 4e-16);
            }
        }
    }
}
