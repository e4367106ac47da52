//! Files that are either complete or not there.

use crate::ExportError;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Distinguishes the temporary files of one process.
static COUNTER: AtomicU64 = AtomicU64::new(0);

/// Removes the temporary file unless it was renamed.
struct Temporary(Option<PathBuf>);

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(path) = self.0.take() {
            // Nothing more can be done about a file that cannot be removed.
            let _ = fs::remove_file(path);
        }
    }
}

/// Writes `path` through `write`: into a temporary file of the same folder, which takes the name only when all
/// is written. On an error, or a panic in `write`, whatever was at `path` before stays as it was.
///
/// # Errors
/// Those of `write`; [`ExportError::Io`] from the file system.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), ExportError>,
) -> Result<(), ExportError> {
    let Some(name) = path.file_name() else {
        let kind = std::io::ErrorKind::InvalidInput;
        return Err(std::io::Error::new(kind, format!("`{}` names no file", path.display())).into());
    };
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}-{}.tmp", std::process::id(), COUNTER.fetch_add(1, Ordering::Relaxed)));
    let temporary = path.with_file_name(hidden);
    let file = File::options().write(true).create_new(true).open(&temporary)?;
    let mut guard = Temporary(Some(temporary.clone()));
    let mut writer = BufWriter::with_capacity(1 << 18, file);
    write(&mut writer)?;
    writer.flush()?;
    // Windows refuses to rename an open file.
    drop(writer);
    fs::rename(&temporary, path)?;
    guard.0 = None;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = std::env::temp_dir().join(format!("coolinggen-file-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("a.txt");
        write_atomically(&path, |w| Ok(w.write_all(b"old")?)).unwrap();
        let failed = write_atomically(&path, |w| {
            w.write_all(b"new")?;
            Err(ExportError::NoSolid)
        });
        assert!(matches!(failed, Err(ExportError::NoSolid)));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        fs::remove_dir_all(&folder).unwrap();
    }
}
