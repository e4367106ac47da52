//! Writers of models: STEP and BREP for CAD, IGES for meshers, glTF, OBJ and STL for everything that takes meshes.
//!
//! Output depends on the model and the options alone: no clock, no thread count, no hash order. Every writer takes
//! the names of the solids to write, all for an empty list.

mod boundary;
mod brep;
mod error;
mod file;
mod forms;
mod glb;
mod gmsh;
mod iges;
mod manifest;
mod materials;
mod nastran;
mod number;
mod obj;
mod openfoam;
mod panels;
mod select;
mod step;
mod stl;
mod tessellate;

pub use brep::write_brep;
pub use error::ExportError;
pub use file::{remove_unfinished, write_atomically};
pub use glb::write_glb;
pub use gmsh::write_gmsh_script;
pub use iges::{IgesForm, IgesOptions, write_iges};
pub use manifest::{FacePlace, Listed, MANIFEST_FORMAT, manifest};
pub use nastran::write_nastran;
pub use obj::{write_mtl, write_obj};
pub use openfoam::{CaseFile, CaseOptions, openfoam_case};
pub use panels::write_panels;
pub use step::{StepOptions, StepSchema, write_step};
pub use stl::write_stl;
pub use tessellate::{FaceMesh, KeptMeshes, Tessellation, TessellationOptions, tessellate, tessellate_again};
