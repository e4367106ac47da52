//! What would fit: the limit that a refusal says.

/// The greatest value below `refused` that fits, to a thousandth of it; none if hardly any does.
pub(super) fn greatest(refused: f64, fits: impl Fn(f64) -> bool) -> Option<f64> {
    nearest(0.01 * refused, refused, fits)
}

/// The value between `from`, which fits, and `refused`, which does not, that is nearest to `refused` and fits; none if
/// `from` does not fit.
pub(super) fn nearest(from: f64, refused: f64, fits: impl Fn(f64) -> bool) -> Option<f64> {
    const STEPS: u32 = 12;
    if !fits(from) {
        return None;
    }
    let (mut good, mut bad) = (from, refused);
    for _ in 0..STEPS {
        let middle = 0.5 * (good + bad);
        *(if fits(middle) { &mut good } else { &mut bad }) = middle;
    }
    Some(good)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_found_from_both_sides() {
        let most = greatest(2.0, |d| d < 1.3).unwrap();
        assert!(most < 1.3 && most > 1.299, "{most}");
        let least = nearest(0.9, 0.1, |x| x > 0.4).unwrap();
        assert!(least > 0.4 && least < 0.401, "{least}");
        assert_eq!(greatest(2.0, |_| false), None);
    }
}
