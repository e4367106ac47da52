//! What tests of built designs share.

use coolinggen_cooling::Generated;
use serde_json::Value;
use std::collections::HashSet;
use std::path::Path;

/// A design of the samples.
pub(crate) fn sample(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Watertight, of the genus implied, with nothing lost between metal and coolant, names used once.
pub(crate) fn check(generated: &Generated) {
    let report = &generated.report;
    assert!(report.watertight);
    assert!(report.max_edge_deviation_mm < 3e-8, "{}", report.max_edge_deviation_mm);
    for (solid, genus) in &report.genus {
        assert_eq!(genus.found, Some(genus.expected), "{solid}");
    }
    let sum: f64 = report.solids.values().map(|s| s.volume_mm3).sum();
    assert!((sum / report.blank.volume_mm3 - 1.0).abs() < 1e-9, "{sum}");
    let names: HashSet<&str> = generated.blade.model.faces.iter().map(|f| f.name.as_str()).collect();
    assert_eq!(names.len(), generated.blade.model.faces.len());
}
