//! The sidecar: JSON-RPC 2.0, one message a line, for programs that keep a model warm (docs/protocol.md).

mod lines;
mod mesh;
mod methods;
mod models;
mod page;
mod rpc;
mod session;
mod socket;
mod task;

use crate::arguments::ServeOptions;
use crate::commands::print;
use crate::outcome::Failure;
use coolinggen_exporters::remove_unfinished;
use session::{Server, talk};
use std::io;
use std::thread;
use std::time::Duration;

/// How long requests of a client that has gone may take to notice.
const PATIENCE: Duration = Duration::from_millis(500);

/// Serves until the client on standard input leaves, a client asks to end, or the parent process dies.
pub(crate) fn serve(options: &ServeOptions) -> Result<(), Failure> {
    if options.describe {
        return print(&page::page());
    }
    let server = Server::new();
    let listener = match &options.socket {
        Some(name) => {
            let listener = socket::listen(name).map_err(|e| Failure::other(e, false))?;
            eprintln!("coolinggen serve: listening on {}", listener.address());
            Some(listener)
        }
        None => None,
    };
    match (listener, options.detached) {
        (Some(listener), true) => listener.serve(&server),
        (listener, _) => {
            if let Some(listener) = listener {
                let server = server.clone();
                thread::spawn(move || {
                    listener.serve(&server);
                    // A client on the socket asked for the end.
                    end()
                });
            }
            watch_parent();
            talk(&server, io::stdin().lock(), io::stdout(), PATIENCE);
        }
    }
    end()
}

/// Ends the process. Whatever still runs has had its time: a computation that hangs does not keep it.
fn end() -> ! {
    remove_unfinished();
    std::process::exit(0)
}

/// Ends the process when its parent dies, for the parent's death need not close standard input.
#[cfg(unix)]
fn watch_parent() {
    use std::os::unix::process::parent_id;
    const PERIOD: Duration = Duration::from_millis(200);
    let parent = parent_id();
    thread::spawn(move || {
        while parent_id() == parent {
            thread::sleep(PERIOD);
        }
        end()
    });
}

#[cfg(not(unix))]
fn watch_parent() {}
