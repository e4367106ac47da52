//! Layers and colours: which faces belong together and how they look.

use coolinggen_brep::Style;

fn style(layer: impl Into<String>, color: [f64; 3]) -> Style {
    Style { layer: layer.into(), color }
}

/// The outer surface.
pub(super) fn blade() -> Style {
    style("blade", [0.62, 0.64, 0.67])
}

/// Hub and tip faces of the metal.
pub(super) fn end() -> Style {
    style("blade/ends", [0.48, 0.50, 0.54])
}

/// Faces between metal and the coolant of a chamber.
pub(super) fn chamber(name: &str) -> Style {
    style(format!("chamber/{name}"), [0.85, 0.45, 0.25])
}

/// Faces between metal and the coolant of a turn.
pub(super) fn turn(name: &str) -> Style {
    style(format!("turn/{name}"), [0.72, 0.40, 0.62])
}

/// Sheets of inserts.
pub(super) fn insert() -> Style {
    style("insert", [0.36, 0.62, 0.52])
}

/// Walls of jets.
pub(super) fn jet() -> Style {
    style("insert/jet", [0.20, 0.45, 0.38])
}

/// Faces between metal and the coolant of a radial hole.
pub(super) fn radial_hole() -> Style {
    style("radial_hole", [0.90, 0.62, 0.20])
}

/// Walls of film holes.
pub(super) fn film() -> Style {
    style("film", [0.80, 0.30, 0.30])
}

/// Walls of slots.
pub(super) fn slot() -> Style {
    style("slot", [0.55, 0.35, 0.75])
}

/// Walls of crossover holes.
pub(super) fn crossover() -> Style {
    style("crossover", [0.30, 0.65, 0.45])
}

/// Pins.
pub(super) fn pin() -> Style {
    style("pin", [0.80, 0.70, 0.30])
}

/// Walls of dust holes.
pub(super) fn dust_hole() -> Style {
    style("dust_hole", [0.60, 0.45, 0.35])
}

/// Hub and shroud as solids of their own.
pub(super) fn annulus() -> Style {
    style("annulus", [0.36, 0.42, 0.50])
}

/// Where coolant enters.
pub(super) fn inlet() -> Style {
    style("coolant/inlet", [0.16, 0.45, 0.85])
}

/// Where coolant leaves.
pub(super) fn outlet() -> Style {
    style("coolant/outlet", [0.45, 0.70, 0.95])
}
