//! Random designs of cooled blades, in the ranges a designer would draw them in.
//!
//! A design is drawn as people draw one: first the blade; then its sections on paper ([`Drawing`]); then shell and
//! chambers where the sections have room for them; then holes where a chamber lies behind the surface. The paper is
//! only as good as rules of thumb (inscribed circles through a few hundred points, five sections), so some designs
//! ask for what cannot be built.

mod blades;
mod bores;
mod check;
mod confirm;
#[path = "../../../core/cooling/tests/mutations/draw.rs"]
mod draw;
mod drawing;
mod interior;
#[path = "../../../core/cooling/tests/mutations/sound.rs"]
mod sound;

pub use check::{Outcome, outcome};
pub use confirm::{Confirmation, confirm};
pub use drawing::Drawing;

use draw::Draw;
use serde_json::{Value, json};

/// The design of a seed: the same on every machine.
pub fn design(seed: u64) -> Value {
    let mut draw = Draw::new(seed);
    let (space, blade) = blades::blade(&mut draw);
    let mut design = json!({ "format": "coolinggen/1", "name": format!("random{seed:04}"), "space": space, "blade": blade });
    // A blade that cannot be drawn cannot be cooled: it is left solid, and the build says what is wrong with it.
    if let Some(drawing) = Drawing::of(&design) {
        design["cooling"] = interior::cooling(&mut draw, &drawing);
    }
    design
}
