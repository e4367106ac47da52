//! Numbers as text.

use std::fmt::{self, Write};

/// A real: the shortest decimal that reads back as the same double, with the decimal point that STEP and IGES ask for.
pub(crate) struct Real(pub(crate) f64);

impl fmt::Display for Real {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Debug prints a point or an exponent, the exponent possibly without point.
        let mut text = Short::default();
        write!(text, "{:?}", self.0 + 0.0)?;
        let text = text.as_str()?;
        match text.split_once('e') {
            Some((mantissa, exponent)) if mantissa.contains('.') => write!(f, "{mantissa}E{exponent}"),
            Some((mantissa, exponent)) => write!(f, "{mantissa}.E{exponent}"),
            None => f.write_str(text),
        }
    }
}

/// The text of a number, without an allocation: most of a file are numbers.
#[derive(Default)]
struct Short {
    bytes: [u8; 32],
    length: usize,
}

impl Short {
    fn as_str(&self) -> Result<&str, fmt::Error> {
        std::str::from_utf8(&self.bytes[..self.length]).map_err(|_| fmt::Error)
    }
}

impl fmt::Write for Short {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let end = self.length + text.len();
        self.bytes.get_mut(self.length..end).ok_or(fmt::Error)?.copy_from_slice(text.as_bytes());
        self.length = end;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reals_have_a_point_and_read_back() {
        for (x, text) in [(1.0, "1.0"), (1e-7, "1.E-7"), (-2.5e-9, "-2.5E-9"), (1e20, "1.E20"), (-0.0, "0.0")]
        {
            assert_eq!(Real(x).to_string(), text);
        }
        let x = 0.1 + 0.2;
        assert_eq!(Real(x).to_string().parse::<f64>().unwrap(), x);
    }
}
