//! A request that is being worked on: how far it is, and whether its client still wants it.

use super::lines::Outbox;
use super::models::lock;
use super::rpc::{RpcError, notification};
use coolinggen_cooling::{Stage, Watch};
use serde_json::{Value, json};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Least time between two progress messages of a request.
const PACE: Duration = Duration::from_millis(100);

/// A request under way.
pub(super) struct Task {
    id: Value,
    outbox: Outbox,
    cancelled: AtomicBool,
    /// Taken by the worker that does it, or by who cancels it before: the reply is for that one to send.
    taken: AtomicBool,
    told: Mutex<Option<Instant>>,
}

impl Task {
    pub(super) fn new(id: Value, outbox: Outbox) -> Self {
        Self {
            id,
            outbox,
            cancelled: AtomicBool::new(false),
            taken: AtomicBool::new(false),
            told: Mutex::new(None),
        }
    }

    pub(super) fn id(&self) -> &Value {
        &self.id
    }

    /// Asks it to stop.
    pub(super) fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Takes it; whether nobody has before.
    pub(super) fn take(&self) -> bool {
        !self.taken.swap(true, Ordering::Relaxed)
    }

    /// An error once it has been asked to stop.
    pub(super) fn go_on(&self) -> Result<(), RpcError> {
        if self.cancelled() { Err(RpcError::cancelled()) } else { Ok(()) }
    }

    /// Tells the client how far it is, unless it was told a moment ago.
    pub(super) fn progress(&self, stage: &str, fraction: f64) {
        let now = Instant::now();
        let mut told = lock(&self.told);
        if told.is_none_or(|before| now - before >= PACE) {
            *told = Some(now);
            let params = json!({ "id": self.id, "stage": stage, "fraction": fraction });
            self.outbox.send(&notification("$/progress", &params));
        }
    }
}

impl Watch for Task {
    fn begins(&self, stage: Stage) {
        self.progress(stage.name(), stage.begins_at());
    }

    fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}
