//! The mesh files of every sample, as the command line writes them, in other people's readers: closed, outward, of the
//! volume and size that the report tells, with regions called like the faces.

#[path = "../../../exporters/tests/support/closed.rs"]
#[allow(unreachable_pub)]
mod closed;
#[path = "../../../exporters/tests/support/stl.rs"]
#[allow(unreachable_pub)]
mod stl;

use glam::DVec3;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Greatest distance between mesh and surface, mm: asked of the program, and what volumes and boxes may be off for it.
const CHORD: f64 = 0.02;
/// Greatest angle between a triangle's normal and the surface's at its corners, degrees: the program's default.
const ANGLE: f64 = 15.0;
/// Rounding of coordinates in float32 at the samples' radii, mm.
const ROUNDING: f64 = 3e-5;

/// The triangles of one face in mm, z along the span.
struct Region {
    name: String,
    corners: Vec<[DVec3; 3]>,
    /// Normals at the corners, if the file has them.
    normals: Vec<[DVec3; 3]>,
}

/// What one file, or one node of it, holds: the solids' names and their regions.
struct Body {
    what: String,
    solids: Vec<String>,
    regions: Vec<Region>,
    /// Whether the reader has rounded positions so far that neighbours may be one point.
    rounded: bool,
}

fn samples() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples");
    let entries = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let mut designs: Vec<PathBuf> = entries.filter(|p| p.extension().is_some_and(|e| e == "json")).collect();
    designs.sort();
    designs
}

fn read_glb(path: &Path) -> Vec<Body> {
    let gltf = gltf::Gltf::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let blob = gltf.blob.clone().unwrap();
    // Metres with y up: (x, y, z) there is (x, -z, y) of the blade.
    let turned = |p: DVec3| DVec3::new(p.x, -p.z, p.y);
    let nodes = gltf.scenes().next().unwrap().nodes();
    nodes
        .map(|node| {
            let name = node.name().unwrap().to_owned();
            let (translation, rotation, scale) = node.transform().decomposed();
            assert_eq!((rotation, scale), ([0.0, 0.0, 0.0, 1.0], [1.0; 3]));
            let origin = DVec3::from(translation.map(f64::from));
            let regions = node.mesh().unwrap().primitives().map(|primitive| {
                let extras: Value = serde_json::from_str(primitive.extras().as_ref().unwrap().get()).unwrap();
                let reader = primitive.reader(|_| Some(&blob));
                let vectors = |v: [f32; 3]| DVec3::from(v.map(f64::from));
                let points: Vec<DVec3> = (reader.read_positions().unwrap())
                    .map(|p| turned(vectors(p) + origin) * 1000.0)
                    .collect();
                let normals: Vec<DVec3> =
                    reader.read_normals().unwrap().map(|n| turned(vectors(n))).collect();
                let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
                let triples =
                    |of: &[DVec3]| indices.chunks(3).map(|t| [0, 1, 2].map(|k| of[t[k] as usize])).collect();
                Region {
                    name: extras["name"].as_str().unwrap().to_owned(),
                    corners: triples(&points),
                    normals: triples(&normals),
                }
            });
            let what = format!("{} {name}", path.display());
            Body { what, regions: regions.collect(), solids: vec![name], rounded: false }
        })
        .collect()
}

fn read_obj(path: &Path, solids: Vec<String>) -> Body {
    let (models, materials) = tobj::load_obj(path, &tobj::LoadOptions::default()).unwrap();
    let materials = materials.unwrap();
    let regions = models.into_iter().map(|model| {
        let mesh = &model.mesh;
        assert!(mesh.material_id.is_some_and(|id| id < materials.len()), "{} has no material", model.name);
        let triples = |of: &[f32], indices: &[u32]| {
            let at = |i: u32| DVec3::from([0, 1, 2].map(|k| f64::from(of[3 * i as usize + k])));
            indices.chunks(3).map(|t| [at(t[0]), at(t[1]), at(t[2])]).collect()
        };
        Region {
            corners: triples(&mesh.positions, &mesh.indices),
            normals: triples(&mesh.normals, &mesh.normal_indices),
            name: model.name,
        }
    });
    // The reader keeps single precision, about no local origin.
    Body { what: path.display().to_string(), regions: regions.collect(), solids, rounded: true }
}

fn read_stl(path: &Path, solids: Vec<String>) -> Body {
    let regions = stl::read_stl(&std::fs::read_to_string(path).unwrap());
    let regions = regions.into_iter().map(|(name, corners)| Region { name, corners, normals: Vec::new() });
    Body { what: path.display().to_string(), regions: regions.collect(), solids, rounded: false }
}

/// Sides that do not occur as often in one direction as in the other. Where a reader rounds positions, neighbours become
/// one point: triangles shrink to sides, and sides come to lie on each other, but a closed mesh stays closed.
fn unbalanced_sides(triangles: &[[u32; 3]]) -> usize {
    let mut balance: BTreeMap<(u32, u32), i64> = BTreeMap::new();
    for t in triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            *balance.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
    }
    balance.iter().filter(|&(&(a, b), &n)| a != b && n != 0).count()
}

fn check(body: &Body, report: &Value) {
    let what = &body.what;
    let corners: Vec<DVec3> = body.regions.iter().flat_map(|r| r.corners.iter().flatten().copied()).collect();
    let (index, points) = closed::welded(&corners);
    let triangles: Vec<[u32; 3]> = index.chunks(3).map(|t| [t[0], t[1], t[2]]).collect();
    let open = if body.rounded { unbalanced_sides(&triangles) } else { closed::open_sides(&triangles) };
    assert_eq!(open, 0, "{what} is open");

    // Closed, and of the volume that it must enclose: so the triangles turn outward, round voids, too.
    let total =
        |key: &str| body.solids.iter().map(|s| report["solids"][s][key].as_f64().unwrap()).sum::<f64>();
    let volume = closed::volume(&triangles, &points);
    let allowed = CHORD * total("area_mm2");
    assert!((volume - total("volume_mm3")).abs() <= allowed, "{what}: {volume} mm3");

    // No refinement brings triangles at the point of such a tip near to the surface's normal, which has no limit there.
    let pointed = report["name"] == "medial-propeller";
    for region in body.regions.iter().filter(|r| !r.normals.is_empty()) {
        for ([a, b, c], normals) in region.corners.iter().zip(&region.normals) {
            let across = (*b - *a).cross(*c - *a);
            // Rounding may turn a triangle that is not higher than it.
            let longest = a.distance(*b).max(b.distance(*c)).max(c.distance(*a));
            if body.rounded && across.length() <= 2.0 * ROUNDING * longest {
                continue;
            }
            // Tiny triangles may tilt, and single precision tilts those that are not high.
            let tiny = longest < CHORD || across.length() < 1e-4 * longest;
            let free = pointed || body.rounded || tiny;
            let least = if free { 0.0 } else { (ANGLE + 0.5).to_radians().cos() };
            for normal in normals {
                assert!((normal.length() - 1.0).abs() < 1e-5, "{what} {}: {normal}", region.name);
                let cosine = normal.dot(across) / across.length();
                assert!(cosine > least, "{what} {}: a normal is {cosine} of its triangle's", region.name);
            }
        }
    }

    let named: Vec<&str> = body.regions.iter().map(|r| r.name.as_str()).collect();
    let faces = report["faces"].as_array().unwrap().iter();
    let expected: BTreeSet<&str> = faces
        .filter(|f| body.solids.iter().any(|s| f["solids"].as_array().unwrap().iter().any(|of| of == s)))
        .map(|f| f["name"].as_str().unwrap())
        .collect();
    assert_eq!(named.iter().copied().collect::<BTreeSet<_>>(), expected, "{what}");
    assert_eq!(named.len(), expected.len(), "{what}: a region in several pieces");

    let low = points.iter().fold(DVec3::INFINITY, |m, p| m.min(*p));
    let high = points.iter().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
    let corner = |solid: &str, which: &str| -> DVec3 {
        let corner = &report["solids"][solid]["bounding_box_mm"][which];
        DVec3::from([0, 1, 2].map(|k| corner[k].as_f64().unwrap()))
    };
    let least = body.solids.iter().fold(DVec3::INFINITY, |m, s| m.min(corner(s, "min")));
    let greatest = body.solids.iter().fold(DVec3::NEG_INFINITY, |m, s| m.max(corner(s, "max")));
    let off = (low - least).abs().max((high - greatest).abs()).max_element();
    assert!(off <= CHORD + ROUNDING, "{what}: the box is {off} mm off");
}

fn check_files(design: &Path) {
    let name = design.file_stem().unwrap().to_str().unwrap().to_owned();
    let folder = tempfile::tempdir().unwrap();
    let done = Command::new(env!("CARGO_BIN_EXE_coolinggen"))
        .args(["generate", "--format", "glb,obj,stl", "--json", "--chord", &CHORD.to_string(), "--out"])
        .args([folder.path(), design])
        .output()
        .unwrap();
    assert!(done.status.success(), "{name}: {}", String::from_utf8_lossy(&done.stdout));
    let report: Value = serde_json::from_slice(&done.stdout).unwrap();
    let solids: Vec<String> = report["solids"].as_object().unwrap().keys().cloned().collect();
    let mut parts: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for solid in &solids {
        let part = solid.split_once('/').map_or(solid.as_str(), |(part, _)| part);
        parts.entry(part).or_default().push(solid.clone());
    }
    let design: Value = serde_json::from_str(&std::fs::read_to_string(design).unwrap()).unwrap();
    let cooling = |field: &str| design.pointer(&format!("/cooling{field}")).is_some();
    let expected = 1 + usize::from(cooling("")) + usize::from(cooling("/inserts"));
    assert_eq!(parts.len(), expected, "{name} has metal, coolant if it is cooled, and its inserts");
    let path = |part: &str, extension: &str| folder.path().join(format!("{name}.{part}.{extension}"));
    for (part, held) in &parts {
        check(&read_obj(&path(part, "obj"), held.clone()), &report);
        check(&read_stl(&path(part, "stl"), held.clone()), &report);
    }
    parts.insert("assembly", solids.clone());
    for (part, mut held) in parts {
        let bodies = read_glb(&path(part, "glb"));
        bodies.iter().for_each(|body| check(body, &report));
        let mut nodes: Vec<String> = bodies.into_iter().flat_map(|b| b.solids).collect();
        nodes.sort();
        held.sort();
        assert_eq!(nodes, held, "{name}: a node a solid");
    }
}

#[test]
fn mesh_files_of_every_sample_are_sound() {
    samples().iter().for_each(|design| check_files(design));
}

/// The serpentine's slots in a width at which they run within micrometres of their chamber's borders, whose chords would
/// cross theirs.
fn check_slots(width: f64) {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/rotor-serpentine.json");
    let mut design: Value = serde_json::from_str(&std::fs::read_to_string(sample).unwrap()).unwrap();
    design["cooling"]["slot_rows"][0]["width"] = width.into();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rotor-serpentine.json");
    std::fs::write(&path, design.to_string()).unwrap();
    check_files(&path);
}

#[test]
fn slots_beside_their_chambers_borders() {
    check_slots(0.45);
}

#[test]
#[ignore = "a sweep: minutes"]
fn slots_of_any_width() {
    (35..=55).for_each(|percent| check_slots(f64::from(percent) / 100.0));
}
