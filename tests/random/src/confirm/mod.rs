//! Confirms refusals: whether what a fault says is impossible is impossible, found without the code that refused. The
//! blade's surface and the stream surfaces are the build's; everything inside is found anew from the document, by
//! polygons, sampled points and brute force (`slice`, `interior`).

mod film;
mod interior;
mod radial;
mod sections;
mod slice;

use coolinggen_blade::{Fault, build};
use coolinggen_cooling::design::Design;
use interior::Interior;
use serde_json::Value;
use slice::Slices;
use std::path::Path;

/// What a check says of a fault, with its numbers.
#[derive(Clone, Debug)]
pub enum Confirmation {
    /// The geometry is impossible.
    Confirmed(String),
    /// The check finds nothing impossible.
    Contradicted(String),
    /// There is no check of this kind of refusal.
    Unchecked,
}

/// Blade and interior of a refused design.
struct Confirmer {
    slices: Slices,
    interior: Interior,
    cooling: Value,
}

/// Checks the first fault of a refused design.
pub fn confirm(document: &Value, fault: &Fault) -> Confirmation {
    match confirmer(document).and_then(|c| c.check(fault)) {
        Some(Ok(what)) => Confirmation::Confirmed(what),
        Some(Err(what)) => Confirmation::Contradicted(what),
        None => Confirmation::Unchecked,
    }
}

fn confirmer(document: &Value) -> Option<Confirmer> {
    let design = Design::from_json(&document.to_string()).ok()?;
    let (space, blade) = build(&design.space, &design.blade, Path::new(".")).ok()?;
    let cooling = document["cooling"].clone();
    let interior = Interior::of(&cooling).unwrap_or_else(Interior::none);
    Some(Confirmer { slices: Slices::new(space, blade), interior, cooling })
}

/// The number behind a word of a message.
fn number_after(text: &str, word: &str) -> Option<f64> {
    let rest = &text[text.find(word)? + word.len()..];
    let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-')).unwrap_or(rest.len());
    rest[..end].trim_end_matches('.').parse().ok()
}

impl Confirmer {
    fn check(&self, fault: &Fault) -> Option<Result<String, String>> {
        let parts: Vec<&str> = fault.pointer.split('/').skip(1).collect();
        let text = fault.message.as_str();
        let v = number_after(text, "span fraction ");
        let index = |k: usize| parts.get(k).and_then(|p| p.parse::<usize>().ok());
        let hole = || number_after(text, "hole ").map(|n| n as usize);
        match (parts.as_slice(), fault.code) {
            (["blade", ..], "geometry") if text.contains("no one camber line") => self.hump(v?),
            (["cooling", "film_rows", ..], "ligament") => {
                let gap = self.nearest_hole(index(2)?, hole()?)?;
                let what = format!("{gap:.3} mm between it and the nearest hole");
                Some(if gap < 0.05 { Ok(what) } else { Err(what) })
            }
            (["cooling", "film_rows", ..], "wall_too_thin") => {
                self.too_short(&self.cooling["film_rows"][index(2)?], hole()?)
            }
            (["cooling", "film_rows", ..], _) => {
                self.hole_meets_wall(&self.cooling["film_rows"][index(2)?], hole()?)
            }
            (["cooling", "slot_rows", ..], "side_wall") => {
                let number = number_after(text, "slot ")? as usize;
                self.beside_slot(&self.cooling["slot_rows"][index(2)?], number)
            }
            (["cooling", "chambers" | "walls", ..], "geometry")
                if text.contains("fillets of radius") || text.contains("cross in the chamber") =>
            {
                let chamber = index(2)?;
                let radius = self.interior.chambers.get(chamber)?.2.at(v?);
                self.fillets_overlap(v?, chamber, radius)
            }
            // A nose that is too sharp leaves room for the chamber farther back, if there is room at all.
            (["cooling", "chambers", ..], "geometry") if text.contains("sharpness of the nose") => {
                self.no_room(v?, self.interior.chambers.first()?.2.at(v?))
            }
            (["cooling", "shell" | "chambers", ..], "geometry") if text.contains("leaves") => {
                let end =
                    number_after(text, "end of radius ").or_else(|| number_after(text, "end needs "))?;
                self.no_room(v?, end)
            }
            (["cooling", "radial_holes", ..], "leaves_blade" | "holes_meet") => self.radial_hole(index(2)?),
            _ => None,
        }
    }
}
