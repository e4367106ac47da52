//! IGES 5.3, for meshers such as CENTAUR and for CAD programs that read nothing newer.
//!
//! Two variants: trimmed surfaces (entities 144 and 142), which every reader knows, and manifold solids (186) whose faces
//! share edges and vertices, which keeps panels connected. Either way a face stands on a B-spline surface (128) in the
//! model's own parameters (`patch`), each edge has its curve in space and in these parameters, and a face's label and level
//! say what it is. `lines` knows the sections of the file, `entities` the geometry.

mod circle;
mod entities;
mod lines;
mod patch;
mod solids;
mod trimmed;

use crate::ExportError;
use crate::select::{each_face_once, select};
use coolinggen_brep::{FaceId, Grouping, Model, Solid};
use entities::Colors;
use lines::{Directory, File, Pointer};
use patch::Patch;
use std::io::Write;

/// What the faces of an IGES file are made into.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IgesForm {
    /// A trimmed surface a face, entity 144: nothing says which faces are neighbours.
    TrimmedSurfaces,
    /// A manifold solid B-rep object a solid, entity 186: faces share edges, edges share vertices, and solids share the
    /// faces between them.
    #[default]
    Solids,
}

/// What an IGES file is, and what its global section says. Nothing is taken from the clock or the machine.
#[derive(Clone, Debug, PartialEq)]
pub struct IgesOptions {
    /// Identification of the product.
    pub name: String,
    /// Name of the file.
    pub file_name: String,
    /// What the faces are made into.
    pub form: IgesForm,
    /// Time stamp, `YYYYMMDD.HHNNSS`.
    pub time_stamp: String,
    /// Author.
    pub author: String,
    /// Organisation.
    pub organisation: String,
    /// Distance below which a reader may take points for the same, mm.
    pub resolution_mm: f64,
}

impl Default for IgesOptions {
    fn default() -> Self {
        Self {
            name: String::new(),
            file_name: String::new(),
            form: IgesForm::default(),
            time_stamp: "19700101.000000".to_owned(),
            author: String::new(),
            organisation: String::new(),
            resolution_mm: 1e-6,
        }
    }
}

/// Writes the solids of these names (all for an empty list) as one IGES file in millimetres. The label of a face is its
/// alias, its level the index of its group plus one, its colour the face's own. A face between two of the solids is written
/// once.
///
/// # Errors
/// [`ExportError::UnknownSolid`], [`ExportError::NoSolid`], [`ExportError::BadTopology`], [`ExportError::BadOption`],
/// [`ExportError::TooLarge`] beyond 9,999,999 lines, [`ExportError::Io`].
pub fn write_iges(
    model: &Model,
    solids: &[&str],
    grouping: &Grouping,
    options: &IgesOptions,
    out: &mut impl Write,
) -> Result<(), ExportError> {
    if !(options.resolution_mm > 0.0 && options.resolution_mm.is_finite()) {
        return Err(ExportError::BadOption { name: "resolution_mm", value: options.resolution_mm });
    }
    let chosen = select(model, solids)?;
    let mut faces = Faces { model, grouping, colors: Colors::default() };
    let mut file = File::default();
    match options.form {
        IgesForm::TrimmedSurfaces => trimmed::write(&mut file, &mut faces, &chosen)?,
        IgesForm::Solids => solids::write(&mut file, &mut faces, &chosen)?,
    }
    file.write(options, out)
}

/// What both variants say of faces.
struct Faces<'a> {
    model: &'a Model,
    grouping: &'a Grouping,
    colors: Colors,
}

impl<'a> Faces<'a> {
    /// The faces of these solids, each once, in the order in which the solids meet them.
    fn of(&self, solids: &[&Solid]) -> Vec<FaceId> {
        each_face_once(self.model, solids).iter().map(|met| met.used.face).collect()
    }

    /// Label, level and colour of what a face is made into.
    fn directory(&mut self, file: &mut File, face: FaceId, entry: Directory<'static>) -> Directory<'a> {
        Directory {
            label: self.grouping.alias(face),
            level: self.grouping.index_of(face) + 1,
            color: Some(self.colors.of(file, self.model.face(face).style.color)),
            ..entry
        }
    }

    /// The surface of a face: label and level are the face's, since some readers show those of surfaces.
    fn surface(&self, file: &mut File, face: FaceId, patch: &Patch<'_>) -> Pointer {
        let (label, level) = (self.grouping.alias(face), self.grouping.index_of(face) + 1);
        entities::surface(file, patch, label, level)
    }
}
