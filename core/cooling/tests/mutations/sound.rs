//! What must hold of every design that was built.

use coolinggen_cooling::report::Report;

/// Greatest relative difference between metal with coolant and the uncooled blade.
const VOLUME: f64 = 1e-7;

/// The error says what is wrong with the solids.
pub(crate) fn check_report(report: &Report) -> Result<(), String> {
    let name = &report.name;
    if !report.watertight {
        return Err(format!("{name} is not watertight"));
    }
    if let Some((solid, genus)) = report.genus.iter().find(|(_, g)| g.found != Some(g.expected)) {
        return Err(format!("{solid} has the wrong genus: {genus:?}"));
    }
    if let Some((solid, r)) = report.solids.iter().find(|(_, r)| !(r.volume_mm3 > 0.0)) {
        return Err(format!("{solid} has the volume {}", r.volume_mm3));
    }
    if !(report.max_edge_deviation_mm <= 3e-8) {
        return Err(format!("edges lie {} mm off their faces", report.max_edge_deviation_mm));
    }
    if let Some(wall) = report.wall_thickness_mm.as_ref().filter(|w| !(w.min > 0.0)) {
        return Err(format!("{} leaves the blade: {wall:?}", wall.face));
    }
    let sum: f64 = report.solids.values().map(|s| s.volume_mm3).sum();
    let blank = report.blank.volume_mm3;
    let off = (sum - blank).abs() / blank;
    if off <= VOLUME { Ok(()) } else { Err(format!("metal and coolant differ from the blank by {off:.1e}")) }
}
