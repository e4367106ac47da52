//! Banded linear systems: what B-spline interpolation leads to.

use crate::error::NurbsError;
use crate::vector::VectorSpace;

/// LU factors of a square matrix whose entries vanish outside `|row - column| <= width`.
///
/// No pivoting: B-spline collocation matrices are totally positive, for which elimination without pivoting is
/// backward stable (de Boor and Pinkus 1977).
#[derive(Clone, Debug)]
pub struct BandedLu {
    size: usize,
    width: usize,
    /// Row `i`, column `i - width + k` at `i * (2 * width + 1) + k`.
    entries: Vec<f64>,
}

impl BandedLu {
    /// Factors the matrix whose row `i` is `first(i)` (column of the first entry) and the entries from there.
    ///
    /// # Errors
    /// [`NurbsError::BadParameters`] at the first row without pivot: the data miss a basis function.
    pub fn factor(
        size: usize,
        width: usize,
        mut row: impl FnMut(usize, &mut [f64]) -> usize,
    ) -> Result<Self, NurbsError> {
        let stride = 2 * width + 1;
        let mut entries = vec![0.0; size * stride];
        let mut buffer = vec![0.0; stride];
        for i in 0..size {
            buffer.fill(0.0);
            let first = row(i, &mut buffer);
            for (k, &value) in buffer.iter().enumerate() {
                let column = first + k;
                if value != 0.0 && column < size {
                    let offset = (column + width).checked_sub(i).filter(|&o| o < stride);
                    let Some(offset) = offset else { return Err(NurbsError::BadParameters { index: i }) };
                    entries[i * stride + offset] = value;
                }
            }
        }
        match width {
            // The usual width has loops of known length.
            3 => eliminate::<3>(&mut entries, size, 3)?,
            _ => eliminate::<0>(&mut entries, size, width)?,
        }
        Ok(Self { size, width, entries })
    }

    /// Solves in place; `right` has one entry a row.
    pub fn solve<V: VectorSpace>(&self, right: &mut [V]) {
        let stride = 2 * self.width + 1;
        for i in 0..self.size {
            let mut value = right[i];
            for j in i.saturating_sub(self.width)..i {
                value = value - right[j] * self.entries[i * stride + j + self.width - i];
            }
            right[i] = value;
        }
        for i in (0..self.size).rev() {
            let mut value = right[i];
            for j in i + 1..(i + self.width + 1).min(self.size) {
                value = value - right[j] * self.entries[i * stride + j + self.width - i];
            }
            right[i] = value * (1.0 / self.entries[i * stride + self.width]);
        }
    }
}

/// Gaussian elimination in place; `W` is the width, or 0 for any.
#[inline(always)]
fn eliminate<const W: usize>(entries: &mut [f64], size: usize, width: usize) -> Result<(), NurbsError> {
    let width = if W > 0 { W } else { width };
    let stride = 2 * width + 1;
    for i in 0..size {
        let (done, rest) = entries.split_at_mut((i + 1) * stride);
        let row = &done[i * stride + width..];
        let pivot = row[0];
        if !(pivot.abs() > 1e-14) {
            return Err(NurbsError::BadParameters { index: i });
        }
        for (k, below) in rest.chunks_exact_mut(stride).take(width).enumerate() {
            // Beyond the last column there is nothing but zeros.
            let below = &mut below[width - 1 - k..2 * width - k];
            if below[0] != 0.0 {
                below[0] /= pivot;
                for j in 1..=width {
                    below[j] -= below[0] * row[j];
                }
            }
        }
    }
    Ok(())
}
