//! Strings, lists and references as ISO 10303-21 writes them.

use std::fmt;

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
    fn strings_are_escaped() {
        assert_eq!(
            Text("a'b\\c\n\u{e9}\u{1f600}").to_string(),
            "'a''b\\\\c\\X2\\000A\\X0\\\\X2\\00E9\\X0\\\\X4\\0001F600\\X0\\'"
        );
        assert_eq!(List([Ref(1), Ref(2)].iter().map(|r| Ref(r.0))).to_string(), "(#1,#2)");
    }
}
