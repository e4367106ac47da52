//! The local socket, for several clients of one server.

use super::session::{Ended, Server, talk};
use interprocess::local_socket::{GenericFilePath, ListenerOptions, Stream, prelude::*};
use std::io::{self, BufReader, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

/// A socket that clients may connect to; its file goes with it.
pub(super) struct Listener {
    path: PathBuf,
    listener: interprocess::local_socket::Listener,
}

/// Listens on the socket of this name. A socket file whose server is dead is replaced, one that is served is not.
///
/// # Errors
/// A sentence with the path and what is wrong.
pub(super) fn listen(name: &str) -> Result<Listener, String> {
    let path = path_of(name)?;
    let failed = |error: io::Error| format!("cannot listen on {}: {error}", path.display());
    let create = || {
        let name = path.as_path().to_fs_name::<GenericFilePath>()?;
        ListenerOptions::new().name(name).create_sync()
    };
    let listener = match create() {
        Err(error) if error.kind() == io::ErrorKind::AddrInUse => {
            let name = path.as_path().to_fs_name::<GenericFilePath>().map_err(failed)?;
            if Stream::connect(name).is_ok() {
                return Err(format!("another server listens on {}", path.display()));
            }
            std::fs::remove_file(&path).map_err(failed)?;
            create().map_err(failed)?
        }
        other => other.map_err(failed)?,
    };
    Ok(Listener { path, listener })
}

/// The writing half of a connection.
struct Writer(Arc<Stream>);

impl Write for Writer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        (&*self.0).write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        (&*self.0).flush()
    }
}

/// Where a socket is: a path as it stands, a bare name in a folder that is the user's alone.
#[cfg(unix)]
fn path_of(name: &str) -> Result<PathBuf, String> {
    use std::os::unix::fs::{DirBuilderExt, MetadataExt};
    if name.contains('/') {
        return Ok(PathBuf::from(name));
    }
    if let Some(folder) = std::env::var_os("XDG_RUNTIME_DIR").filter(|f| Path::new(f).is_dir()) {
        return Ok(Path::new(&folder).join(format!("coolinggen-{name}.sock")));
    }
    let home = std::env::var_os("HOME").ok_or("HOME is not set: give the socket's path")?;
    let folder = Path::new(&home).join(".cache/coolinggen");
    let made = std::fs::DirBuilder::new().recursive(true).mode(0o700).create(&folder);
    made.map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
    let mode = std::fs::metadata(&folder).map_or(0, |data| data.mode());
    if mode & 0o022 != 0 {
        return Err(format!("{} may be written by others: give the socket's path", folder.display()));
    }
    Ok(folder.join(format!("{name}.sock")))
}

#[cfg(not(unix))]
fn path_of(name: &str) -> Result<PathBuf, String> {
    let pipe = name.starts_with(r"\\.\pipe\");
    Ok(if pipe { PathBuf::from(name) } else { PathBuf::from(format!(r"\\.\pipe\coolinggen-{name}")) })
}

impl Listener {
    /// Where clients find it.
    pub(super) fn address(&self) -> std::path::Display<'_> {
        self.path.display()
    }

    /// Serves all who come, until one of them asks for the end.
    pub(super) fn serve(self, server: &Arc<Server>) {
        // A listener waits without end: it has a thread of its own, which the process does not wait for.
        let (ask, asked) = channel();
        let (path, server) = (self.path.clone(), Arc::clone(server));
        thread::spawn(move || {
            for stream in self.listener.incoming() {
                let Ok(stream) = stream else { continue };
                let (server, ask) = (Arc::clone(&server), ask.clone());
                thread::spawn(move || {
                    let stream = Arc::new(stream);
                    let (reader, writer) = (BufReader::new(&*stream), Writer(Arc::clone(&stream)));
                    if talk(&server, reader, writer, Duration::MAX) == Ended::Shutdown {
                        // Nobody listens any more if another client was faster.
                        let _ = ask.send(());
                    }
                });
            }
        });
        // An error means that the listener has failed.
        let _ = asked.recv();
        let _ = std::fs::remove_file(path);
    }
}
