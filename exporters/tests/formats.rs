//! OBJ, GLB and STL, read back by other people's readers.

mod support;

use coolinggen_brep::{Model, Solid};
use coolinggen_exporters::{
    ExportError, Tessellation, TessellationOptions, tessellate, write_glb, write_mtl, write_obj, write_stl,
};
use glam::DVec3;
use support::closed::{self, welded};
use support::mesh;
use support::stl::read_stl;

fn mesh_of(model: &Model) -> Tessellation {
    tessellate(model, &TessellationOptions::default()).unwrap()
}

fn face_names(model: &Model, solid: &Solid) -> Vec<String> {
    solid.faces().map(|f| model.face(f.face).name.replace(' ', "_")).collect()
}

#[test]
fn obj_keeps_groups_materials_and_closes() {
    for (name, model) in support::all() {
        let t = mesh_of(&model);
        for solid in &model.solids {
            let names = [solid.name.as_str()];
            let (mut obj, mut mtl) = (Vec::new(), Vec::new());
            write_obj(&model, &names, &t, "x.mtl", &mut obj).unwrap();
            write_mtl(&model, &names, &mut mtl).unwrap();
            let (models, materials) =
                tobj::load_obj_buf(&mut obj.as_slice(), &tobj::LoadOptions::default(), |_| {
                    tobj::load_mtl_buf(&mut mtl.as_slice())
                })
                .unwrap();
            let materials = materials.unwrap();
            assert_eq!(models.iter().map(|m| m.name.clone()).collect::<Vec<_>>(), face_names(&model, solid));
            let mut triangles = Vec::new();
            let mut points = Vec::new();
            for (m, used) in models.iter().zip(solid.faces()) {
                let style = &model.face(used.face).style;
                let material = &materials[m.mesh.material_id.unwrap()];
                assert_eq!(material.name, style.layer.replace(' ', "_"));
                assert_eq!(material.diffuse.unwrap(), style.color.map(|c| c as f32));
                // The reader splits the vertices by model: weld them again.
                let first = points.len() as u32;
                points.extend(
                    m.mesh.positions.chunks(3).map(|p| DVec3::new(p[0].into(), p[1].into(), p[2].into())),
                );
                triangles
                    .extend(m.mesh.indices.chunks(3).map(|t| [first + t[0], first + t[1], first + t[2]]));
                for (t, n) in m.mesh.indices.chunks(3).zip(m.mesh.normal_indices.chunks(3)) {
                    let at = |i: u32| points[(first + i) as usize];
                    let cross = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
                    for &k in n {
                        let n = &m.mesh.normals[3 * k as usize..];
                        let n = DVec3::new(n[0].into(), n[1].into(), n[2].into());
                        assert!((n.length() - 1.0).abs() < 1e-6 && n.dot(cross) > 0.0, "{name}");
                    }
                }
            }
            let (index, points) = welded(&points);
            let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|i| index[i as usize])).collect();
            assert_eq!(closed::open_sides(&triangles), 0, "{name}");
            assert!(closed::volume(&triangles, &points) > 0.0, "{name}");
        }
    }
}

#[test]
fn obj_shares_vertices_within_a_solid() {
    let model = support::blocks::cuboid();
    let mut obj = Vec::new();
    write_obj(&model, &[], &mesh_of(&model), "x.mtl", &mut obj).unwrap();
    let text = String::from_utf8(obj).unwrap();
    assert_eq!(text.lines().filter(|l| l.starts_with("v ")).count(), 8);
    assert!(text.contains("g bl\u{f6}ck_a's/top"));
}

#[test]
fn glb_has_nodes_primitives_names_and_closes() {
    for (name, model) in support::all() {
        let t = mesh_of(&model);
        let mut bytes = Vec::new();
        write_glb(&model, &[], &t, &mut bytes).unwrap();
        assert_eq!(bytes.len() % 4, 0);
        let gltf = gltf::Gltf::from_slice(&bytes).unwrap();
        let blob = gltf.blob.clone().unwrap();
        let nodes: Vec<_> = gltf.scenes().next().unwrap().nodes().collect();
        assert_eq!(nodes.len(), model.solids.len());
        for (node, solid) in nodes.iter().zip(&model.solids) {
            assert_eq!(node.name(), Some(solid.name.as_str()));
            let origin = DVec3::from(node.transform().decomposed().0.map(f64::from));
            let mesh = node.mesh().unwrap();
            let listed: serde_json::Value =
                serde_json::from_str(mesh.extras().as_ref().unwrap().get()).unwrap();
            let (mut points, mut triangles) = (Vec::new(), Vec::new());
            assert_eq!(mesh.primitives().len(), solid.faces().count());
            for (i, (p, used)) in mesh.primitives().zip(solid.faces()).enumerate() {
                let face = model.face(used.face);
                let extras: serde_json::Value =
                    serde_json::from_str(p.extras().as_ref().unwrap().get()).unwrap();
                assert_eq!(extras["name"], face.name.as_str());
                assert_eq!(listed["faces"][i], face.name.as_str());
                assert_eq!(p.material().name(), Some(face.style.layer.as_str()));
                let reader = p.reader(|_| Some(&blob));
                let first = points.len() as u32;
                let at: Vec<DVec3> =
                    reader.read_positions().unwrap().map(|p| DVec3::from(p.map(f64::from))).collect();
                let bounds = p.bounding_box();
                let low = at.iter().fold(DVec3::INFINITY, |m, p| m.min(*p));
                assert_eq!(low, DVec3::from(bounds.min.map(f64::from)));
                let normals: Vec<DVec3> =
                    reader.read_normals().unwrap().map(|n| DVec3::from(n.map(f64::from))).collect();
                let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
                for t in indices.chunks(3) {
                    let [a, b, c] = [t[0], t[1], t[2]].map(|i| at[i as usize]);
                    let cross = (b - a).cross(c - a);
                    assert!(t.iter().all(|&i| normals[i as usize].dot(cross) > 0.0), "{name} {}", face.name);
                    triangles.push([t[0] + first, t[1] + first, t[2] + first]);
                }
                points.extend(at);
            }
            let (index, points) = welded(&points);
            let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|i| index[i as usize])).collect();
            assert_eq!(closed::open_sides(&triangles), 0, "{name}");
            let exact = closed::volume(&mesh::solid_triangles(&t, solid), &t.points);
            let found = closed::volume(&triangles, &points) * 1e9;
            assert!((found - exact).abs() < 1e-5 * exact, "{name}: {found} {exact}");
            // Machine (x, y, z) mm is glTF (x, z, -y) m.
            let p = t.points[solid.faces().next().map(|f| t.faces[f.face.0].points[0]).unwrap() as usize];
            let there = points[0] + origin;
            assert!((there - DVec3::new(p.x, p.z, -p.y) * 1e-3).length() < 1e-8, "{name}");
        }
    }
}

#[test]
fn stl_has_named_regions_and_closes() {
    for (name, model) in support::all() {
        let t = mesh_of(&model);
        for solid in &model.solids {
            let mut bytes = Vec::new();
            write_stl(&model, &[&solid.name], &t, &mut bytes).unwrap();
            let regions = read_stl(std::str::from_utf8(&bytes).unwrap());
            let names: Vec<String> = regions.iter().map(|r| r.0.clone()).collect();
            assert_eq!(names, face_names(&model, solid));
            let corners: Vec<DVec3> = regions.iter().flat_map(|r| r.1.iter().flatten().copied()).collect();
            let (index, points) = welded(&corners);
            let triangles: Vec<[u32; 3]> = index.chunks(3).map(|t| [t[0], t[1], t[2]]).collect();
            assert_eq!(closed::open_sides(&triangles), 0, "{name}");
            let exact = closed::volume(&mesh::solid_triangles(&t, solid), &t.points);
            assert_eq!(closed::volume(&triangles, &points) as f32, exact as f32, "{name}");
        }
    }
}

#[test]
fn output_is_the_same_every_time() {
    let run = || {
        let model = support::airfoil::hollow(support::airfoil::Walls::Cone, 0.1, false);
        let t = mesh_of(&model);
        let (mut glb, mut obj, mut stl) = (Vec::new(), Vec::new(), Vec::new());
        write_glb(&model, &[], &t, &mut glb).unwrap();
        write_obj(&model, &[], &t, "x.mtl", &mut obj).unwrap();
        write_stl(&model, &["metal"], &t, &mut stl).unwrap();
        [glb, obj, stl]
    };
    assert!(run() == run());
}

#[test]
fn unknown_solids_are_refused_with_the_known_names() {
    let model = support::blocks::box_with_void();
    let t = mesh_of(&model);
    let refused = write_stl(&model, &["metl"], &t, &mut Vec::new()).unwrap_err();
    assert!(matches!(&refused, ExportError::UnknownSolid { known, .. } if known == &["metal", "core"]));
    assert_eq!(refused.to_string(), "there is no solid `metl`; the model has: metal, core");
    assert!(matches!(write_glb(&Model::default(), &[], &t, &mut Vec::new()), Err(ExportError::NoSolid)));
}
