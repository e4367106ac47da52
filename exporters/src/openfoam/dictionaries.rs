//! The dictionaries of a case.

use super::{CaseFile, Patch, Region, SCALE};
use crate::Tessellation;
use crate::boundary::Boundary;
use glam::DVec3;
use std::fmt::Write as _;

/// Cells along the diagonal of the box, before any refinement.
const CELLS_ALONG: f64 = 40.0;
/// Cells across the smallest thing at a patch.
const CELLS_ACROSS: f64 = 2.0;
/// Halvings of a cell at most.
const MOST_LEVELS: f64 = 6.0;

/// Header of a file.
pub(super) fn head(class: &str, location: &str, object: &str) -> String {
    format!(
        "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {class};\n    location    \
         \"{location}\";\n    object      {object};\n}}\n\n"
    )
}

/// All dictionaries and the script that runs the meshers.
pub(super) fn all(mesh: &Tessellation, regions: &[Region], patches: &[Patch]) -> Vec<CaseFile> {
    let (low, high) = bounds(mesh);
    let cell = (high - low).length() / CELLS_ALONG;
    let dictionary = |folder: &str, name: &str, body: &str| CaseFile {
        path: format!("{folder}/{name}"),
        content: (head("dictionary", folder, name) + body).into_bytes(),
    };
    vec![
        CaseFile { path: "Allmesh".to_owned(), content: include_bytes!("Allmesh").to_vec() },
        dictionary("system", "controlDict", include_str!("controlDict")),
        dictionary("system", "fvSchemes", include_str!("fvSchemes")),
        dictionary("system", "fvSolution", ""),
        dictionary("system", "blockMeshDict", &block(low, high, cell)),
        dictionary("system", "snappyHexMeshDict", &snappy(regions, patches, cell)),
        dictionary("constant", "regionProperties", &region_properties(regions)),
    ]
}

/// The box of all points, m.
fn bounds(mesh: &Tessellation) -> (DVec3, DVec3) {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = mesh.points.iter().fold(start, |(low, high), p| (low.min(*p), high.max(*p)));
    (low * SCALE, high * SCALE)
}

/// One block of cubes around everything, half a cell wider.
fn block(low: DVec3, high: DVec3, cell: f64) -> String {
    let (low, size) = (low - 0.5 * cell, high - low + cell);
    let counts = (size / cell).ceil();
    let high = low + counts * cell;
    let mut text = String::from("vertices\n(\n");
    for z in [low.z, high.z] {
        for (x, y) in [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y)] {
            let _ = writeln!(text, "    ({x:?} {y:?} {z:?})");
        }
    }
    let DVec3 { x, y, z } = counts;
    let _ = write!(
        text,
        ");\n\nblocks\n(\n    hex (0 1 2 3 4 5 6 7) ({x} {y} {z}) simpleGrading (1 1 1)\n);\n\nboundary\n(\n    background\n    \
         {{\n        type patch;\n        faces ((0 3 2 1) (4 5 6 7) (0 1 5 4) (1 2 6 5) (2 3 7 6) (3 0 4 7));\n    \
         }}\n);\n"
    );
    text
}

/// Halvings after which cells of `cell` metres resolve a thing.
fn level(feature_mm: Option<f64>, cell: f64) -> u32 {
    let Some(feature) = feature_mm else { return 1 };
    (cell * CELLS_ACROSS / (feature * SCALE)).log2().ceil().clamp(1.0, MOST_LEVELS) as u32
}

fn snappy(regions: &[Region], patches: &[Patch], cell: f64) -> String {
    let mut names = String::new();
    let mut levels = String::new();
    for Patch { name, boundary, feature_mm } in patches {
        let level = level(*feature_mm, cell);
        let kind = if *boundary == Boundary::Wall { "wall" } else { "patch" };
        let _ = writeln!(names, "            {name} {{ name {name}; }}");
        let _ = writeln!(
            levels,
            "                {name} {{ level ({level} {level}); patchInfo {{ type {kind}; }} }}"
        );
    }
    let mut inside = String::new();
    for Region { name, inside: [x, y, z], .. } in regions {
        let _ = writeln!(inside, "        (({x:?} {y:?} {z:?}) {name})");
    }
    include_str!("snappyHexMeshDict")
        .replace("@NAMES@", &names)
        .replace("@LEVELS@", &levels)
        .replace("@INSIDE@", &inside)
}

fn region_properties(regions: &[Region]) -> String {
    let of = |fluid: bool| {
        let names: Vec<&str> = regions.iter().filter(|r| r.fluid == fluid).map(|r| r.name.as_str()).collect();
        names.join(" ")
    };
    format!("regions\n(\n    fluid ({})\n    solid ({})\n);\n", of(true), of(false))
}
