//! A conversation with one client: its messages in order, its requests side by side.

use super::lines::{Line, Outbox, next_line, outbox};
use super::methods::{Context, METHODS, Method};
use super::models::{Models, lock};
use super::rpc::{self, Call, RpcError};
use super::task::Task;
use serde_json::Value;
use std::collections::HashMap;
use std::io::{BufRead, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// Longest message, bytes: designs are at most a few megabytes.
const LONGEST: usize = 64 << 20;

type Job = Box<dyn FnOnce() + Send>;

/// What all clients share.
pub(super) struct Server {
    pub(super) models: Models,
    jobs: Sender<Job>,
    clients: AtomicU64,
}

impl Server {
    /// A server with as many workers as there are processors, but two at least: a long request must not hold up a
    /// short one.
    pub(super) fn new() -> Arc<Self> {
        let (jobs, queue): (_, Receiver<Job>) = channel();
        let queue = Arc::new(Mutex::new(queue));
        for _ in 0..thread::available_parallelism().map_or(2, |n| n.get().max(2)) {
            let queue = Arc::clone(&queue);
            thread::spawn(move || {
                loop {
                    let job = lock(&queue).recv();
                    match job {
                        Ok(job) => job(),
                        Err(_) => break,
                    }
                }
            });
        }
        Arc::new(Self { models: Models::default(), jobs, clients: AtomicU64::new(1) })
    }
}

/// How a conversation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ended {
    /// The client has gone.
    Left,
    /// The client asked the server to end.
    Shutdown,
}

/// Requests under way, by their ids.
type Running = Arc<Mutex<HashMap<String, Arc<Task>>>>;

struct Session {
    server: Arc<Server>,
    client: u64,
    outbox: Outbox,
    running: Running,
    initialized: bool,
}

/// Talks to a client until one of both ends it. When the client has gone its requests are cancelled and waited for, but
/// no longer than `patience`.
pub(super) fn talk(
    server: &Arc<Server>,
    mut reader: impl BufRead,
    out: impl Write + Send + 'static,
    patience: Duration,
) -> Ended {
    let (outbox, writer) = outbox(out);
    let client = server.clients.fetch_add(1, Ordering::Relaxed);
    let running = Running::default();
    let mut session = Session {
        server: Arc::clone(server),
        client,
        outbox,
        running: Arc::clone(&running),
        initialized: false,
    };
    let ended = loop {
        match next_line(&mut reader, LONGEST) {
            Ok(Some(Line::Whole(line))) => {
                if session.message(&line) {
                    break Ended::Shutdown;
                }
            }
            Ok(Some(Line::TooLong)) => {
                let error = RpcError::invalid_request(format!("a message has at most {LONGEST} bytes"));
                session.outbox.send(&rpc::reply(&Value::Null, Err(error)));
            }
            Ok(None) | Err(_) => break Ended::Left,
        }
    };
    drop(session);
    lock(&running).values().for_each(|task| task.cancel());
    let deadline = Instant::now().checked_add(patience);
    let in_time = || deadline.is_none_or(|deadline| Instant::now() < deadline);
    while in_time() && !(lock(&running).is_empty() && writer.is_finished()) {
        thread::sleep(Duration::from_millis(2));
    }
    server.models.leave(client);
    ended
}

impl Session {
    /// Answers a message, or sets about it; whether it was the last.
    fn message(&mut self, line: &[u8]) -> bool {
        let call = match rpc::read(line) {
            Ok(call) => call,
            Err((id, error)) => {
                self.outbox.send(&rpc::reply(&id, Err(error)));
                return false;
            }
        };
        let Some(id) = call.id.clone() else {
            self.notified(&call);
            return false;
        };
        if lock(&self.running).contains_key(&id.to_string()) {
            let error = RpcError::invalid_request(format!("a request with the id {id} is under way"));
            self.outbox.send(&rpc::reply(&id, Err(error)));
            return false;
        }
        if call.method == "shutdown" {
            self.outbox.send(&rpc::reply(&id, Ok(Value::Null)));
            return true;
        }
        match METHODS.iter().find(|m| m.name == call.method) {
            None => {
                let error = RpcError::unknown_method(&call.method, "");
                self.outbox.send(&rpc::reply(&id, Err(error)));
            }
            Some(_) if !self.initialized && call.method != "initialize" => {
                self.outbox.send(&rpc::reply(&id, Err(RpcError::not_initialized())));
            }
            Some(method) => self.start(method, id, call.params),
        }
        false
    }

    /// Notifications: only cancelling is one; others are nobody's business.
    fn notified(&self, call: &Call) {
        if call.method == "$/cancelRequest"
            && let Some(id) = call.params.get("id")
        {
            let mut running = lock(&self.running);
            let Some(task) = running.get(&id.to_string()).cloned() else { return };
            task.cancel();
            // One that still waits for a worker need not wait for it any longer.
            if task.take() {
                running.remove(&id.to_string());
                drop(running);
                self.outbox.send(&rpc::reply(id, Err(RpcError::cancelled())));
            }
        }
    }

    /// Runs a method: quick ones here, so that they keep their order, others on a worker.
    fn start(&mut self, method: &'static Method, id: Value, params: Value) {
        let task = Arc::new(Task::new(id, self.outbox.clone()));
        if method.quick {
            let result = run(&self.server, self.client, &task, method, params);
            self.initialized |= method.name == "initialize" && result.is_ok();
            self.outbox.send(&rpc::reply(task.id(), result));
            return;
        }
        lock(&self.running).insert(task.id().to_string(), Arc::clone(&task));
        let (server, client, outbox) = (Arc::clone(&self.server), self.client, self.outbox.clone());
        let running = Arc::clone(&self.running);
        let job = move || {
            if !task.take() {
                return;
            }
            let result = run(&server, client, &task, method, params);
            // The id is free before the client can know.
            lock(&running).remove(&task.id().to_string());
            outbox.send(&rpc::reply(task.id(), result));
        };
        if self.server.jobs.send(Box::new(job)).is_err() {
            eprintln!("coolinggen serve: no worker is left");
        }
    }
}

/// Runs a method; a panic in it is an error like any other.
fn run(server: &Server, client: u64, task: &Task, method: &Method, params: Value) -> Result<Value, RpcError> {
    task.go_on()?;
    let context = Context { models: &server.models, client, task };
    contained(|| method.call(&context, params))
}

fn contained(work: impl FnOnce() -> Result<Value, RpcError>) -> Result<Value, RpcError> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let said = panic.downcast_ref::<&str>().copied().map(str::to_owned);
        let said = said.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
        Err(RpcError::internal(format!("a defect of coolinggen, please report it: {said}")))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_error_reply() {
        let error = contained(|| panic!("lost {}", 7)).unwrap_err();
        assert_eq!(error.code, -32603);
        assert!(error.message.contains("lost 7"), "{error:?}");
        assert_eq!(contained(|| Ok(Value::Null)), Ok(Value::Null));
    }
}
