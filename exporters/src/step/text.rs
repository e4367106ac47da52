//! Numbers and strings as ISO 10303-21 writes them.

use std::fmt::{self, Write};

/// A real: shortest decimal that reads back as the same double, with the decimal point the format asks for.
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

/// A parenthesised list.
pub(crate) struct List<I>(pub(crate) I);

impl<T: fmt::Display, I: Clone + IntoIterator<Item = T>> fmt::Display for List<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("(")?;
        for (i, item) in self.0.clone().into_iter().enumerate() {
            if i > 0 {
                f.write_str(",")?;
            }
            item.fmt(f)?;
        }
        f.write_str(")")
    }
}

/// A reference to an entity.
pub(crate) struct Ref(pub(crate) usize);

impl fmt::Display for Ref {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}", self.0)
    }
}

/// A quoted string: quotes and backslashes doubled, everything outside printable ASCII as `\X2\` or `\X4\` codes.
pub(crate) struct Text<'a>(pub(crate) &'a str);

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("'")?;
        for c in self.0.chars() {
            match c {
                '\'' => f.write_str("''")?,
                '\\' => f.write_str("\\\\")?,
                ' '..='~' => write!(f, "{c}")?,
                c if u32::from(c) < 0x1_0000 => write!(f, "\\X2\\{:04X}\\X0\\", u32::from(c))?,
                c => write!(f, "\\X4\\{:08X}\\X0\\", u32::from(c))?,
            }
        }
        f.write_str("'")
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

    #[test]
    fn strings_are_escaped() {
        assert_eq!(
            Text("a'b\\c\n\u{e9}\u{1f600}").to_string(),
            "'a''b\\\\c\\X2\\000A\\X0\\\\X2\\00E9\\X0\\\\X4\\0001F600\\X0\\'"
        );
        assert_eq!(List([Ref(1), Ref(2)].iter().map(|r| Ref(r.0))).to_string(), "(#1,#2)");
    }
}
