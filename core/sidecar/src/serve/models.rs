//! Warm models: what was generated last under each name, shared by all clients.

use coolinggen_cooling::{Generated, Warm};
use coolinggen_exporters::KeptMeshes;
use std::collections::{BTreeSet, HashMap};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Models by name.
#[derive(Default)]
pub(super) struct Models {
    all: Mutex<HashMap<String, Entry>>,
}

#[derive(Default)]
struct Entry {
    /// What the next generation may reuse; locked while one runs.
    warm: Arc<Mutex<Warm>>,
    /// What the next tessellation may reuse.
    meshes: Arc<Mutex<KeptMeshes>>,
    /// The last generation, to be had while the next runs.
    last: Option<Arc<Generated>>,
    /// Clients that use it: it goes with the last of them.
    clients: BTreeSet<u64>,
}

/// Locks also what a panic left: every holder leaves it whole or empty.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Models {
    /// What generations of the model of this name share; the model is made if it is not there.
    pub(super) fn warm(&self, name: &str, client: u64) -> Arc<Mutex<Warm>> {
        let mut all = lock(&self.all);
        let entry = all.entry(name.to_owned()).or_default();
        entry.clients.insert(client);
        Arc::clone(&entry.warm)
    }

    /// Makes a generation the last of its model, unless that has been closed in the meantime.
    pub(super) fn settle(&self, name: &str, generated: &Arc<Generated>) {
        if let Some(entry) = lock(&self.all).get_mut(name) {
            entry.last = Some(Arc::clone(generated));
        }
    }

    /// The last generation of a model.
    pub(super) fn last(&self, name: &str, client: u64) -> Option<Arc<Generated>> {
        let mut all = lock(&self.all);
        let entry = all.get_mut(name)?;
        let last = entry.last.clone()?;
        entry.clients.insert(client);
        Some(last)
    }

    /// What tessellations of a model share; nothing of one that is not there.
    pub(super) fn meshes(&self, name: &str) -> Arc<Mutex<KeptMeshes>> {
        lock(&self.all).get(name).map(|entry| Arc::clone(&entry.meshes)).unwrap_or_default()
    }

    /// Ends a client's use of a model; whether it used it.
    pub(super) fn close(&self, name: &str, client: u64) -> bool {
        let mut all = lock(&self.all);
        let Some(entry) = all.get_mut(name) else { return false };
        let used = entry.clients.remove(&client);
        if entry.clients.is_empty() {
            all.remove(name);
        }
        used
    }

    /// Ends a client's use of all its models.
    pub(super) fn leave(&self, client: u64) {
        lock(&self.all).retain(|_, entry| {
            entry.clients.remove(&client);
            !entry.clients.is_empty()
        });
    }

    /// Names of all models, in order.
    pub(super) fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = lock(&self.all).keys().cloned().collect();
        names.sort();
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_goes_with_its_last_client() {
        let models = Models::default();
        let warm = models.warm("a", 1);
        assert!(Arc::ptr_eq(&warm, &models.warm("a", 2)));
        models.warm("b", 1);
        models.leave(1);
        assert_eq!(models.names(), ["a"]);
        assert!(!models.close("a", 1));
        assert!(models.close("a", 2));
        assert_eq!(models.names(), Vec::<String>::new());
        assert!(models.last("a", 1).is_none());
    }
}
