//! Blades read from STEP files: their B-spline surfaces, not their topology.

mod chain;
mod part21;
mod read;

use super::closed::{self, EdgesSpec};
use crate::blade::Blade;
use crate::fault::{Fault, Pointer};
use crate::stream::StreamSpace;
use crate::surface::BladeSurface;
use coolinggen_nurbs::{NurbsError, RationalSurface};
use part21::{Broken, Exchange};
use read::{Patch, ReadError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The blade in a STEP file: one B-spline surface closed around it, or several that join. Other faces (hub, tip,
/// fillets) are left out. Lengths are converted to mm; the machine axis is x.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StepSource {
    /// Path of the file, relative to the design.
    pub file: String,
    /// Names of the faces to use; all B-spline surfaces of the file if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faces: Option<Vec<String>>,
    /// How far apart borders of neighbouring surfaces may lie, mm.
    #[serde(default = "default_tolerance")]
    #[schemars(extend("unit" = "mm"))]
    pub tolerance: f64,
    /// Where the edges are in the parameter around the blade of a single surface; found if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edges: Option<EdgesSpec>,
}

fn default_tolerance() -> f64 {
    1e-3
}

/// What to do about files that draw parts of a blade as cylinders, extrusions and the like.
const AS_NURBS: &str =
    "all faces around the blade must be B-spline surfaces: convert the shape to NURBS before the export";

const MOST_BYTES: u64 = 500_000_000;

impl StepSource {
    /// Reads the file and makes the blade.
    pub(super) fn blade(&self, space: &StreamSpace, folder: &Path) -> Result<Blade, Vec<Fault>> {
        if !(self.tolerance > 0.0 && self.tolerance <= 0.1) {
            let message = format!("the tolerance {} mm is outside 0 to 0.1 mm", self.tolerance);
            let fault = Fault::new("/tolerance", "out_of_range", message);
            return Err(vec![fault.value(self.tolerance).min(0.0).max(0.1).unit("mm")]);
        }
        let text = self.text(folder)?;
        let (surface, notes) = self.surface(&text)?;
        let mut blade =
            closed::blade(&surface, self.edges.as_ref(), self.tolerance, space, &Pointer::root())?;
        blade.fit.notes.splice(0..0, notes);
        Ok(blade)
    }

    fn text(&self, folder: &Path) -> Result<String, Vec<Fault>> {
        let path = folder.join(&self.file);
        let refuse = |code: &'static str, message: String| {
            vec![Fault::new("/file", code, message).value(self.file.clone())]
        };
        let size = std::fs::metadata(&path)
            .map_err(|e| refuse("cannot_read", format!("{} cannot be read: {e}", path.display())))?
            .len();
        if size > MOST_BYTES {
            return Err(refuse("too_large", format!("{} has {size} bytes", path.display())));
        }
        let bytes = std::fs::read(&path)
            .map_err(|e| refuse("cannot_read", format!("{} cannot be read: {e}", path.display())))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// The closed surface, with what was done to get it.
    fn surface(&self, text: &str) -> Result<(BladeSurface, Vec<String>), Vec<Fault>> {
        let fault = |code: &'static str, message: String| {
            vec![Fault::new("/file", code, message).value(self.file.clone())]
        };
        let failed = |e: NurbsError| fault("no_surface", format!("the surfaces cannot be joined: {e}"));
        let file = Exchange::new(text).map_err(|b| fault("bad_step", broken(&b)))?;
        let mut patches = read::patches(&file).map_err(|e| match e {
            ReadError::Broken(b) => fault("bad_step", broken(&b)),
            ReadError::Surface { id, error } => {
                fault("bad_step", format!("surface #{id} is not valid: {error}"))
            }
        })?;
        if patches.is_empty() {
            let kinds: Vec<String> = file.surface_kinds().iter().map(|(k, n)| format!("{n} {k}")).collect();
            let instead = if kinds.is_empty() { "no surface at all".to_owned() } else { kinds.join(", ") };
            let faults = fault("no_surface", format!("the file has no B-spline surface; it has {instead}"));
            return Err(faults.into_iter().map(|f| f.hint(AS_NURBS)).collect());
        }
        if let Some(names) = &self.faces {
            self.pick(names, &mut patches)?;
        }
        let ring = chain::ring(&patches, self.tolerance).ok_or_else(|| {
            let message = format!(
                "none of the {} B-spline surfaces is closed, and no ring of them joins within {} mm",
                patches.len(),
                self.tolerance
            );
            fault("not_closed", message).into_iter().map(|f| f.hint(AS_NURBS)).collect::<Vec<_>>()
        })?;
        let members = ring.members();
        let (net, gap) = chain::joined(&ring, &patches).map_err(failed)?;
        if gap > 1.01 * self.tolerance {
            let message =
                format!("the surfaces join within {gap:.3e} mm only after their knots are made equal");
            return Err(fault("not_closed", message));
        }
        let mut notes = Vec::new();
        let ids: Vec<String> = members.iter().map(|&i| format!("#{}", patches[i].id)).collect();
        notes.push(format!("the blade is made of the file's surfaces {}", ids.join(", ")));
        if gap > 1e-9 {
            notes.push(format!("borders were moved by up to {gap:.2e} mm to join the surfaces"));
        }
        let surface = if members.iter().any(|&i| patches[i].rational) {
            BladeSurface::Rational(RationalSurface::from_homogeneous(net).map_err(failed)?)
        } else {
            BladeSurface::BSpline(net.map(|p| p.weighted))
        };
        Ok((surface, notes))
    }

    fn pick(&self, names: &[String], patches: &mut Vec<Patch>) -> Result<(), Vec<Fault>> {
        let mut faults = Vec::new();
        for (i, name) in names.iter().enumerate() {
            if !patches.iter().any(|p| p.names.contains(name)) {
                let message = format!("no face named {name:?} lies on a B-spline surface");
                let pointer = Pointer::root().at("faces").at(i);
                faults.push(Fault::new(pointer, "not_found", message).value(name.clone()));
            }
        }
        patches.retain(|p| p.names.iter().any(|n| names.contains(n)));
        if faults.is_empty() { Ok(()) } else { Err(faults) }
    }
}

fn broken(broken: &Broken) -> String {
    match broken {
        Broken::Empty => "the file is empty".to_owned(),
        Broken::NotStep => "the file is not a STEP file (it does not begin with ISO-10303-21)".to_owned(),
        Broken::CutShort => "the file is cut short: its end, END-ISO-10303-21, is missing".to_owned(),
        Broken::Malformed { id } => format!("instance #{id} of the file cannot be understood"),
        Broken::Dangling { id } => format!("the file refers to #{id}, which it does not have"),
    }
}
