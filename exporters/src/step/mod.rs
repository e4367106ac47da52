//! STEP, AP214 or AP242, through truck's writer.
//!
//! truck writes the topology; our geometry prints itself (`geometry`), and a pass over the lines (`rewrite`) puts in
//! what truck leaves out: names, parameter curves (`pcurves`), products, colours, layers and a header that readers accept.

mod convert;
mod geometry;
mod pcurves;
mod product;
mod rewrite;
mod text;

use crate::ExportError;
use crate::select::select;
use coolinggen_brep::Model;
use product::Described;
use rewrite::{Additions, Rewriter};
use std::fmt::Write as _;
use std::io::{self, Write};
use truck_stepio::out::StepModels;

/// The application protocol of a STEP file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StepSchema {
    /// AP214, automotive design: what every CAD program reads. Faces have names of their own.
    #[default]
    Ap214,
    /// AP242, managed model-based 3D engineering: faces are named by shape aspects, too, which is where its readers look
    /// for what product data say of a face.
    Ap242,
}

/// What the header of a STEP file says. Nothing is taken from the clock or the machine.
#[derive(Clone, Debug, PartialEq)]
pub struct StepOptions {
    /// File name in the header.
    pub name: String,
    /// The application protocol.
    pub schema: StepSchema,
    /// Time stamp, ISO 8601.
    pub time_stamp: String,
    /// Author.
    pub author: String,
    /// Organisation.
    pub organisation: String,
    /// Distance below which a reader may take points for the same, mm.
    pub uncertainty_mm: f64,
    /// Whether edges carry their curves in the parameters of their surfaces. Readers then need not project them, which
    /// is faster and closer.
    pub pcurves: bool,
}

impl Default for StepOptions {
    fn default() -> Self {
        Self {
            name: String::new(),
            schema: StepSchema::default(),
            time_stamp: "1970-01-01T00:00:00".to_owned(),
            author: String::new(),
            organisation: String::new(),
            uncertainty_mm: 1e-7,
            pcurves: true,
        }
    }
}

/// Writes the solids of these names (all for an empty list) as one file in millimetres: a product a solid,
/// each with its own copies of shared faces; face names, colours, and layers by [`coolinggen_brep::Style::layer`].
/// A solid with voids becomes a `BREP_WITH_VOIDS`.
///
/// # Errors
/// [`ExportError::UnknownSolid`], [`ExportError::NoSolid`], [`ExportError::BadTopology`],
/// [`ExportError::BadOption`], [`ExportError::Io`].
pub fn write_step(
    model: &Model,
    solids: &[&str],
    options: &StepOptions,
    out: &mut impl Write,
) -> Result<(), ExportError> {
    if !(options.uncertainty_mm > 0.0 && options.uncertainty_mm.is_finite()) {
        return Err(ExportError::BadOption { name: "uncertainty_mm", value: options.uncertainty_mm });
    }
    let chosen = select(model, solids)?;
    let names: Vec<&str> = chosen.iter().map(|s| s.name.as_str()).collect();
    let faces = || chosen.iter().flat_map(|s| s.faces()).map(|used| model.face(used.face));
    let face_names: Vec<&str> = faces().map(|f| f.name.as_str()).collect();
    let solid_of = chosen.iter().enumerate().flat_map(|(number, solid)| solid.faces().map(move |_| number));
    let described: Vec<Described<'_>> =
        faces().zip(solid_of).map(|(f, solid)| Described { name: &f.name, style: &f.style, solid }).collect();

    product::preamble(options, out)?;
    let converted: Vec<convert::StepSolid<'_>> = chosen.iter().map(|s| convert::solid(model, s)).collect();
    let models: StepModels<'_, _, _, _> = converted.iter().collect();
    let pcurves = if options.pcurves { pcurves::of_all(model, &chosen, &converted) } else { Vec::new() };
    let next = rewrite::FIRST_ENTITY + converted.iter().map(convert::entities).sum::<usize>();
    let additions = Additions { solids: &names, faces: &face_names, pcurves: &pcurves, next };
    let mut rewriter = Rewriter::new(out, additions);
    if write!(rewriter, "{models}").is_err() {
        let error = rewriter.error.take();
        return Err(error.unwrap_or_else(|| io::Error::other("the STEP writer failed")).into());
    }
    let written = rewriter.written;
    product::closing(&names, &described, &written, options.schema, out)?;
    Ok(())
}
