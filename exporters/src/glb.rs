//! Binary glTF 2.0.

use crate::materials::Materials;
use crate::select::select;
use crate::{ExportError, Tessellation};
use coolinggen_brep::{FaceUse, Model, Solid};
use glam::{DVec3, Vec3};
use gltf_json as json;
use json::accessor::{ComponentType, GenericComponentType, Type};
use json::buffer::{Stride, Target, View};
use json::validation::Checked::Valid;
use json::validation::USize64;
use json::{Accessor, Index};
use std::collections::BTreeMap;
use std::io::Write;

/// The local origin is a multiple of this in metres: exact in single precision and in a few decimals.
const ORIGIN_STEP: f64 = 1.0 / 64.0;

/// Writes the solids as GLB: metres, Y up (`(x, y, z)` mm becomes `(x, z, -y)` m: the span points up), a node a
/// solid, a primitive a face with its name in `extras.name` (all names of a mesh also in its `extras.faces`, in
/// the order of the primitives), a material a layer. Positions are single precision about a local origin, which is
/// the translation of the nodes.
///
/// # Errors
/// [`ExportError::UnknownSolid`], [`ExportError::NoSolid`], [`ExportError::TooLarge`], [`ExportError::Io`].
pub fn write_glb(
    model: &Model,
    solids: &[&str],
    mesh: &Tessellation,
    out: &mut impl Write,
) -> Result<(), ExportError> {
    let chosen = select(model, solids)?;
    let materials = Materials::of(model, &chosen);
    let mut scene = Scene::new(mesh, origin(mesh, &chosen));
    for material in &materials.list {
        scene.material(&material.name, material.color);
    }
    for solid in &chosen {
        scene.solid(model, solid, &materials)?;
    }
    scene.write(out)
}

/// Millimetres of the machine to metres of glTF.
fn turned(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.z, -p.y)
}

/// The middle of the solids in glTF's axes, rounded.
fn origin(mesh: &Tessellation, solids: &[&Solid]) -> DVec3 {
    let faces = solids.iter().flat_map(|s| s.faces());
    let points = faces.flat_map(|f| &mesh.faces[f.face.0].points).map(|&p| mesh.points[p as usize]);
    let (low, high) =
        points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let middle = (low + high) * 0.5;
    if !middle.is_finite() {
        return DVec3::ZERO;
    }
    (turned(middle) * (1e-3 / ORIGIN_STEP)).round() * ORIGIN_STEP
}

/// The document while it grows. Views: 0 positions, 1 normals, 2 indices.
struct Scene<'a> {
    mesh: &'a Tessellation,
    origin: DVec3,
    root: json::Root,
    positions: Vec<u8>,
    normals: Vec<u8>,
    indices: Vec<u8>,
    nodes: Vec<Index<json::Node>>,
}

impl<'a> Scene<'a> {
    fn new(mesh: &'a Tessellation, origin: DVec3) -> Self {
        let mut root = json::Root::default();
        root.asset.generator = Some(format!("coolinggen {}", env!("CARGO_PKG_VERSION")));
        let (positions, normals, indices) = Default::default();
        Self { mesh, origin, root, positions, normals, indices, nodes: Vec::new() }
    }

    fn material(&mut self, name: &str, [r, g, b]: [f64; 3]) {
        let factor = [r, g, b, 1.0].map(|c| c.clamp(0.0, 1.0) as f32);
        let mut material = json::Material { name: Some(name.to_owned()), ..json::Material::default() };
        let pbr = &mut material.pbr_metallic_roughness;
        pbr.base_color_factor = json::material::PbrBaseColorFactor(factor);
        pbr.metallic_factor = json::material::StrengthFactor(0.2);
        pbr.roughness_factor = json::material::StrengthFactor(0.6);
        self.root.materials.push(material);
    }

    fn solid(&mut self, model: &Model, solid: &Solid, materials: &Materials) -> Result<(), ExportError> {
        let mut primitives = Vec::new();
        let mut names = Vec::new();
        for used in solid.faces() {
            if self.mesh.faces[used.face.0].triangles.is_empty() {
                continue;
            }
            let name = &model.face(used.face).name;
            let mut primitive = self.primitive(used)?;
            primitive.extras = raw(&serde_json::json!({ "name": name }))?;
            primitive.material = Some(Index::new(materials.index(used.face.0) as u32));
            primitives.push(primitive);
            names.push(name);
        }
        let mesh = self.root.push(json::Mesh {
            extensions: None,
            extras: raw(&serde_json::json!({ "faces": names }))?,
            name: Some(solid.name.clone()),
            primitives,
            weights: None,
        });
        let node = json::Node {
            mesh: Some(mesh),
            name: Some(solid.name.clone()),
            translation: Some(self.origin.as_vec3().to_array()),
            ..json::Node::default()
        };
        self.nodes.push(self.root.push(node));
        Ok(())
    }

    fn primitive(&mut self, used: FaceUse) -> Result<json::mesh::Primitive, ExportError> {
        let face = &self.mesh.faces[used.face.0];
        let (starts, count) =
            ([self.positions.len(), self.normals.len(), self.indices.len()], face.points.len());
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for &p in &face.points {
            let p = (turned(self.mesh.points[p as usize]) * 1e-3 - self.origin).as_vec3() + Vec3::ZERO;
            (low, high) = (low.min(p), high.max(p));
            self.positions.extend(p.to_array().iter().flat_map(|c| c.to_le_bytes()));
        }
        for &n in &face.normals {
            let n = turned(if used.forward { n } else { -n }).try_normalize().unwrap_or(DVec3::Y);
            let n = n.as_vec3() + Vec3::ZERO;
            self.normals.extend(n.to_array().iter().flat_map(|c| c.to_le_bytes()));
        }
        self.indices.extend(self.mesh.triangles(used).flatten().flat_map(u32::to_le_bytes));
        let value = |v: Vec3| Some(serde_json::json!(v.to_array().map(f64::from)));
        let float = (ComponentType::F32, Type::Vec3);
        let position = self.accessor(0, starts[0], count, float, (value(low), value(high)))?;
        let normal = self.accessor(1, starts[1], count, float, (None, None))?;
        let integer = (ComponentType::U32, Type::Scalar);
        let indices = self.accessor(2, starts[2], 3 * face.triangles.len(), integer, (None, None))?;
        let attributes = BTreeMap::from([
            (Valid(json::mesh::Semantic::Positions), position),
            (Valid(json::mesh::Semantic::Normals), normal),
        ]);
        Ok(json::mesh::Primitive {
            attributes,
            extensions: None,
            extras: None,
            indices: Some(indices),
            material: None,
            mode: Valid(json::mesh::Mode::Triangles),
            targets: None,
        })
    }

    fn accessor(
        &mut self,
        view: u32,
        offset: usize,
        count: usize,
        (component, shape): (ComponentType, Type),
        (min, max): (Option<json::Value>, Option<json::Value>),
    ) -> Result<Index<Accessor>, ExportError> {
        u32::try_from(self.root.accessors.len() + 1)
            .map_err(|_| ExportError::TooLarge { what: "accessors" })?;
        Ok(self.root.push(Accessor {
            buffer_view: Some(Index::new(view)),
            byte_offset: Some(USize64::from(offset)),
            count: USize64::from(count),
            component_type: Valid(GenericComponentType(component)),
            extensions: None,
            extras: None,
            type_: Valid(shape),
            min,
            max,
            name: None,
            normalized: false,
            sparse: None,
        }))
    }

    fn write(mut self, out: &mut impl Write) -> Result<(), ExportError> {
        let buffer = Index::new(0);
        let mut offset = 0;
        for (data, target) in [
            (&self.positions, Target::ArrayBuffer),
            (&self.normals, Target::ArrayBuffer),
            (&self.indices, Target::ElementArrayBuffer),
        ] {
            let vertices = target == Target::ArrayBuffer;
            self.root.buffer_views.push(View {
                buffer,
                byte_length: USize64::from(data.len()),
                byte_offset: Some(USize64::from(offset)),
                byte_stride: vertices.then_some(Stride(12)),
                name: None,
                target: Some(Valid(target)),
                extensions: None,
                extras: None,
            });
            offset += data.len();
        }
        self.root.buffers.push(json::Buffer {
            byte_length: USize64::from(offset),
            name: None,
            uri: None,
            extensions: None,
            extras: None,
        });
        let scene = json::Scene { extensions: None, extras: None, name: None, nodes: self.nodes };
        self.root.scene = Some(self.root.push(scene));
        let mut text = json::serialize::to_vec(&self.root).map_err(std::io::Error::from)?;
        text.resize(text.len().next_multiple_of(4), b' ');
        let size =
            |n: usize| u32::try_from(n).map_err(|_| ExportError::TooLarge { what: "bytes of the file" });
        // All of the data comes in fours.
        out.write_all(b"glTF")?;
        for number in [2, size(12 + 8 + text.len() + 8 + offset)?, size(text.len())?] {
            out.write_all(&number.to_le_bytes())?;
        }
        out.write_all(b"JSON")?;
        out.write_all(&text)?;
        out.write_all(&size(offset)?.to_le_bytes())?;
        out.write_all(b"BIN\0")?;
        for data in [&self.positions, &self.normals, &self.indices] {
            out.write_all(data)?;
        }
        Ok(())
    }
}

fn raw(value: &serde_json::Value) -> Result<json::Extras, ExportError> {
    let text = json::serialize::to_string(value).map_err(std::io::Error::from)?;
    let value = json::extras::RawValue::from_string(text).map_err(std::io::Error::from)?;
    Ok(Some(value))
}
