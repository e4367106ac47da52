//! A client of the sidecar, for tests.
#![allow(dead_code)] // No test uses all of it.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

pub(crate) const BINARY: &str = env!("CARGO_BIN_EXE_coolinggen");
/// A reply that takes longer than this will not come.
pub(crate) const LONG: Duration = Duration::from_secs(120);

pub(crate) fn sample(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// One end of a conversation.
pub(crate) struct Client<W: Write> {
    pub(crate) out: W,
    lines: Receiver<String>,
}

impl<W: Write> Client<W> {
    pub(crate) fn new(out: W, input: impl Read + Send + 'static) -> Self {
        let (sender, lines) = channel();
        thread::spawn(move || {
            for line in BufReader::new(input).lines() {
                if line.is_err() || sender.send(line.unwrap()).is_err() {
                    break;
                }
            }
        });
        Self { out, lines }
    }

    pub(crate) fn raw(&mut self, text: &[u8]) {
        self.out.write_all(text).unwrap();
        self.out.flush().unwrap();
    }

    pub(crate) fn send(&mut self, id: impl Into<Value>, method: &str, params: &Value) {
        let message = json!({ "jsonrpc": "2.0", "id": id.into(), "method": method, "params": params });
        self.raw(format!("{message}\n").as_bytes());
    }

    pub(crate) fn cancel(&mut self, id: impl Into<Value>) {
        let params = json!({ "id": id.into() });
        let message = json!({ "jsonrpc": "2.0", "method": "$/cancelRequest", "params": params });
        self.raw(format!("{message}\n").as_bytes());
    }

    pub(crate) fn next(&self) -> Value {
        let line = self.lines.recv_timeout(LONG).expect("a message");
        serde_json::from_str(&line).expect("a line of JSON")
    }

    /// The next reply; progress is passed over.
    pub(crate) fn reply(&self) -> Value {
        loop {
            let message = self.next();
            if message.get("id").is_some() {
                return message;
            }
        }
    }

    pub(crate) fn ask(&mut self, method: &str, params: &Value) -> Value {
        self.send("ask", method, params);
        let reply = self.reply();
        assert_eq!(reply["id"], "ask", "{reply}");
        reply
    }

    pub(crate) fn result(&mut self, method: &str, params: &Value) -> Value {
        let mut reply = self.ask(method, params);
        assert!(reply.get("error").is_none(), "{method}: {}", reply["error"]);
        reply["result"].take()
    }

    pub(crate) fn error(&mut self, method: &str, params: &Value) -> Value {
        let mut reply = self.ask(method, params);
        reply["error"].take()
    }
}

pub(crate) struct Server {
    pub(crate) process: Child,
    pub(crate) client: Client<ChildStdin>,
}

impl Server {
    pub(crate) fn with(arguments: &[&str]) -> Self {
        Self::started(Command::new(BINARY).arg("serve").args(arguments))
    }

    /// The server that a command starts.
    pub(crate) fn started(command: &mut Command) -> Self {
        let mut process = command
            // glibc keeps an arena a thread, which fill up one after the other: one alone shows what is in use.
            .env("MALLOC_ARENA_MAX", "1")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let client = Client::new(process.stdin.take().unwrap(), process.stdout.take().unwrap());
        Self { process, client }
    }

    /// A server after `initialize`.
    pub(crate) fn ready() -> Self {
        let mut server = Self::with(&[]);
        server.client.result("initialize", &json!({ "protocol_version": 1 }));
        server
    }

    /// Closes the server's standard input; how long it took to end, and its exit code.
    pub(crate) fn leave(self) -> (Duration, Option<i32>) {
        let Self { mut process, client } = self;
        let started = Instant::now();
        drop(client.out);
        let status = process.wait().unwrap();
        (started.elapsed(), status.code())
    }
}

/// Resident memory of a process in kB, where the system tells.
pub(crate) fn resident(process: &Child) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{}/status", process.id())).ok()?;
    let line = status.lines().find(|l| l.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

fn bytes(base64: &Value) -> Vec<u8> {
    // A decoder of the test's own: four characters are three bytes.
    let value = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let text = base64.as_str().unwrap().as_bytes();
    let padding = text.iter().filter(|&&c| c == b'=').count();
    let mut out: Vec<u8> = text
        .chunks_exact(4)
        .flat_map(|c| {
            let bits =
                c.iter().fold(0u32, |bits, &c| bits << 6 | u32::from(if c == b'=' { 0 } else { value(c) }));
            bits.to_be_bytes()[1..].to_vec()
        })
        .collect();
    out.truncate(out.len() - padding);
    out
}

/// Numbers in base64.
pub(crate) fn floats(base64: &Value) -> Vec<f32> {
    bytes(base64).chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect()
}

/// Indices in base64.
pub(crate) fn indices(base64: &Value) -> Vec<u32> {
    bytes(base64).chunks_exact(4).map(|b| u32::from_le_bytes(b.try_into().unwrap())).collect()
}
