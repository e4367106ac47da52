//! The methods: one table of names, parameters and meanings, from which the page of the protocol is made, too.

use super::mesh;
use super::models::Models;
use super::rpc::RpcError;
use super::task::Task;
use crate::export::{Export, Format, SolidChoice};
use crate::templates::TEMPLATES;
use coolinggen_blade::Fault;
use coolinggen_brep::FaceId;
use coolinggen_cooling::design::{Design, design_schema, faults_against};
use coolinggen_cooling::report::WallField;
use coolinggen_cooling::{Generated, Stopped, Watch};
use coolinggen_exporters::{FaceMesh, KeptMeshes, Tessellation, TessellationOptions, tessellate_again};
use glam::DVec3;
use schemars::{JsonSchema, schema_for};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, TryLockError};
use std::thread;
use std::time::Duration;

/// Version of the protocol; it changes when clients of the one before would no longer understand.
pub(super) const PROTOCOL: u32 = 1;

/// What a method works with.
pub(super) struct Context<'a> {
    pub(super) models: &'a Models,
    pub(super) client: u64,
    pub(super) task: &'a Task,
}

/// A method of the protocol.
pub(super) struct Method {
    pub(super) name: &'static str,
    /// What it does, in one sentence.
    pub(super) summary: &'static str,
    /// Its result, member by member.
    pub(super) result: &'static str,
    /// Whether it is answered before the next message is read.
    pub(super) quick: bool,
    /// JSON Schema of its parameters.
    pub(super) params: fn() -> Value,
    run: fn(&Context<'_>, Value) -> Result<Value, RpcError>,
}

/// All methods but `shutdown`, which ends the conversation.
pub(super) static METHODS: &[Method] = &[
    Method {
        name: "initialize",
        summary: "Begins a conversation; must be the first request.",
        result: "`protocol_version`; `server` with `name` and `version`; `format`, the format of designs; \
                 `schema_sha256` of the text that `schema/get` gives; `units` of `length` and `angle`; `methods`, their \
                 names; `formats` of files",
        quick: true,
        params: || schema_for!(Initialize).to_value(),
        run: |context, params| initialize(context, &typed("initialize", params)?),
    },
    Method {
        name: "schema/get",
        summary: "The JSON Schema of a design.",
        result: "`schema`",
        quick: true,
        params: || schema_for!(Nothing).to_value(),
        run: |_, params| typed::<Nothing>("schema/get", params).map(|_| json!({ "schema": design_schema() })),
    },
    Method {
        name: "template/get",
        summary: "A design to start from.",
        result: "`design`; `names` of all templates",
        quick: true,
        params: || schema_for!(Template).to_value(),
        run: |_, params| template(&typed("template/get", params)?),
    },
    Method {
        name: "design/validate",
        summary: "Says everything that is wrong with a design without building it.",
        result: "`faults`, empty for a sound one; their pointers are relative to the design",
        quick: false,
        params: || schema_for!(Validate).to_value(),
        run: |_, params| validate(&typed("design/validate", params)?),
    },
    Method {
        name: "design/generate",
        summary: "Builds a design as a model, in the place of the last of that name, of which it reuses what has not \
                  changed. While it runs the last one can be had.",
        result: "`model`, its name; `report`, unless it was not wanted",
        quick: false,
        params: || schema_for!(Generate).to_value(),
        run: |context, params| generate(context, typed("design/generate", params)?),
    },
    Method {
        name: "model/list",
        summary: "The models there are, of all clients.",
        result: "`models`, their names",
        quick: true,
        params: || schema_for!(Nothing).to_value(),
        run: |context, params| {
            typed::<Nothing>("model/list", params).map(|_| json!({ "models": context.models.names() }))
        },
    },
    Method {
        name: "model/inspect",
        summary: "The report of a model.",
        result: "`report`",
        quick: false,
        params: || schema_for!(OfModel).to_value(),
        run: |context, params| {
            let OfModel { model } = typed("model/inspect", params)?;
            Ok(json!({ "report": last(context, &model)?.report.to_json() }))
        },
    },
    Method {
        name: "model/tessellate",
        summary: "Meshes of a model inside the message, for a preview.",
        result: "`solids`: for each its `name`; `vertices` (x, y, z in mm) and unit `normals`, little-endian 32-bit \
                 floats in base64; `triangles`, little-endian 32-bit vertex indices in base64; `faces` in their order, each \
                 with `name`, `layer`, `color` and its numbers of `vertices` and `triangles`; and, if it was wanted, \
                 `wall_thickness_mm` of the vertices, little-endian 32-bit floats in base64: on passages the distance to the \
                 outer surface, on that the way along its normal to the first passage, else no number (NaN)",
        quick: false,
        params: || schema_for!(Tessellate).to_value(),
        run: |context, params| mesh_of(context, &typed("model/tessellate", params)?),
    },
    Method {
        name: "model/export",
        summary: "Writes a model's files into a folder, each complete or not at all.",
        result: "`files`: for each `path`, `bytes` and `sha256`",
        quick: false,
        params: || schema_for!(ExportModel).to_value(),
        run: |context, params| export(context, &typed("model/export", params)?),
    },
    Method {
        name: "model/close",
        summary: "Ends this client's use of a model; with its last client a model is forgotten. A client that leaves \
                  closes all of its.",
        result: "`closed`, whether this client used it",
        quick: true,
        params: || schema_for!(OfModel).to_value(),
        run: |context, params| {
            let OfModel { model } = typed("model/close", params)?;
            Ok(json!({ "closed": context.models.close(&model, context.client) }))
        },
    },
];

impl Method {
    pub(super) fn call(&self, context: &Context<'_>, params: Value) -> Result<Value, RpcError> {
        (self.run)(context, params)
    }
}

/// No parameters.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Nothing {}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Initialize {
    /// Version of the protocol that the client speaks.
    protocol_version: u32,
    /// Who the client is, for logs.
    #[serde(default, rename = "client")]
    _client: Option<Client>,
}

/// A client.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Client {
    /// Name of the program.
    #[serde(rename = "name")]
    _name: String,
    /// Its version.
    #[serde(default, rename = "version")]
    _version: Option<String>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Template {
    /// Name of the template; the first if not given.
    name: Option<String>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Validate {
    /// The design.
    design: Value,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Generate {
    /// Name of the model, chosen by the client; the design's name if not given.
    model: Option<String>,
    /// The design.
    design: Value,
    /// The folder that relative paths in the design refer to; the server's if not given.
    folder: Option<PathBuf>,
    /// Whether the report is wanted.
    #[serde(default = "yes")]
    report: bool,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct OfModel {
    /// Name of the model.
    model: String,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Tessellate {
    /// Name of the model.
    model: String,
    /// Greatest distance between mesh and surface, mm.
    #[serde(default = "chord")]
    #[schemars(extend("minimum" = 1e-5, "maximum" = 1e3, "unit" = "mm"))]
    chord_mm: f64,
    /// Greatest angle between the normals of a triangle and of the surface at its corners, degrees.
    #[serde(default = "angle")]
    #[schemars(extend("minimum" = 0.1, "maximum" = 60.0, "unit" = "deg"))]
    angle_deg: f64,
    /// The solids wanted, by their names or the first parts of these; all if not given.
    solids: Option<Vec<String>>,
    /// Whether the thickness of the metal is wanted at each vertex.
    #[serde(default)]
    wall_thickness: bool,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ExportModel {
    /// Name of the model.
    model: String,
    /// Folder for the files; made if it does not exist.
    folder: PathBuf,
    /// Formats to write.
    formats: Vec<Format>,
    /// Which solids go into files of their own, `assembly` is all of them in one.
    #[serde(default = "all_choices")]
    solids: Vec<SolidChoice>,
    /// Greatest distance between mesh and surface, mm.
    #[serde(default = "chord")]
    #[schemars(extend("minimum" = 1e-5, "maximum" = 1e3, "unit" = "mm"))]
    chord_mm: f64,
    /// Greatest angle between the normals of a triangle and of the surface at its corners, degrees.
    #[serde(default = "angle")]
    #[schemars(extend("minimum" = 0.1, "maximum" = 60.0, "unit" = "deg"))]
    angle_deg: f64,
}

fn yes() -> bool {
    true
}

fn chord() -> f64 {
    TessellationOptions::default().chord_mm
}

fn angle() -> f64 {
    TessellationOptions::default().angle_deg
}

fn all_choices() -> Vec<SolidChoice> {
    use clap::ValueEnum;
    SolidChoice::value_variants().to_vec()
}

/// Schemas of all methods' parameters by name.
static SCHEMAS: LazyLock<HashMap<&str, Value>> =
    LazyLock::new(|| METHODS.iter().map(|m| (m.name, (m.params)())).collect());

/// The parameters of a method as its type, or everything that is wrong with them.
fn typed<T: DeserializeOwned>(method: &str, params: Value) -> Result<T, RpcError> {
    if let Some(schema) = SCHEMAS.get(method) {
        let faults = faults_against(schema, &params);
        if !faults.is_empty() {
            return Err(RpcError::invalid_params(&faults));
        }
    }
    serde_json::from_value(params)
        .map_err(|e| RpcError::invalid_params(&[Fault::new("", "type", e.to_string())]))
}

fn initialize(_: &Context<'_>, params: &Initialize) -> Result<Value, RpcError> {
    if params.protocol_version != PROTOCOL {
        let (asked, spoken) = (params.protocol_version, f64::from(PROTOCOL));
        let message = format!("version {asked} of the protocol is not spoken here, version {PROTOCOL} is");
        let fault = Fault::new("/protocol_version", "version", message).value(asked).min(spoken).max(spoken);
        return Err(RpcError::invalid_params(&[fault.hint("client and coolinggen of the same release fit")]));
    }
    Ok(json!({
        "protocol_version": PROTOCOL,
        "server": { "name": env!("CARGO_PKG_NAME"), "version": env!("CARGO_PKG_VERSION") },
        "format": coolinggen_cooling::design::FORMAT,
        "schema_sha256": hexadecimal(&Sha256::digest(design_schema().to_string().as_bytes())),
        "units": { "length": "mm", "angle": "deg" },
        "methods": METHODS.iter().map(|m| m.name).chain(["shutdown"]).collect::<Vec<_>>(),
        "formats": Format::names(),
    }))
}

fn template(params: &Template) -> Result<Value, RpcError> {
    let names: Vec<&str> = TEMPLATES.iter().map(|(name, _)| *name).collect();
    let wanted = params.name.as_deref().unwrap_or(names[0]);
    let Some((_, text)) = TEMPLATES.iter().find(|(name, _)| *name == wanted) else {
        let message = format!("there is no template \"{wanted}\"");
        let fault = Fault::new("/name", "template", message).hint(format!("one of {}", names.join(", ")));
        return Err(RpcError::invalid_params(&[fault]));
    };
    let design: Value = serde_json::from_str(text).map_err(|e| RpcError::internal(e.to_string()))?;
    Ok(json!({ "design": design, "names": names }))
}

fn validate(params: &Validate) -> Result<Value, RpcError> {
    let faults = Design::from_json(&params.design.to_string()).err().unwrap_or_default();
    Ok(json!({ "faults": faults }))
}

fn generate(context: &Context<'_>, params: Generate) -> Result<Value, RpcError> {
    let refused = |faults: Vec<Fault>| {
        let moved: Vec<Fault> = faults.into_iter().map(|f| f.under("/design")).collect();
        RpcError::invalid_params(&moved)
    };
    let design = Design::from_json(&params.design.to_string()).map_err(refused)?;
    let name = params.model.unwrap_or_else(|| design.name.clone());
    let folder = params.folder.unwrap_or_else(|| PathBuf::from("."));
    let warm = context.models.warm(&name, context.client);
    let result = patiently(&warm, context.task)?.generate(&design, &folder, context.task);
    let generated = Arc::new(result.map_err(|stopped| match stopped {
        Stopped::Refused(faults) => refused(faults),
        Stopped::Cancelled => RpcError::cancelled(),
    })?);
    context.task.go_on()?;
    context.models.settle(&name, &generated);
    let mut result = json!({ "model": name });
    if params.report {
        result["report"] = generated.report.to_json();
    }
    Ok(result)
}

/// Locks what another request may hold for long, unless this one is cancelled in the meantime. What a panic left is
/// whole or empty.
fn patiently<'m, T>(mutex: &'m Mutex<T>, task: &Task) -> Result<MutexGuard<'m, T>, RpcError> {
    const PERIOD: Duration = Duration::from_millis(2);
    loop {
        task.go_on()?;
        match mutex.try_lock() {
            Ok(guard) => return Ok(guard),
            Err(TryLockError::Poisoned(left)) => return Ok(left.into_inner()),
            Err(TryLockError::WouldBlock) => thread::sleep(PERIOD),
        }
    }
}

/// The last generation of a model.
fn last(context: &Context<'_>, model: &str) -> Result<Arc<Generated>, RpcError> {
    context.models.last(model, context.client).ok_or_else(|| {
        let message = format!("there is no model \"{model}\"");
        RpcError::invalid_params(&[Fault::new("/model", "model", message).hint("design/generate makes it")])
    })
}

fn tessellation(chord_mm: f64, angle_deg: f64) -> TessellationOptions {
    TessellationOptions { chord_mm, angle_deg, ..TessellationOptions::default() }
}

fn mesh_of(context: &Context<'_>, params: &Tessellate) -> Result<Value, RpcError> {
    let generated = last(context, &params.model)?;
    context.task.progress("tessellate", 0.0);
    let model = &generated.blade.model;
    let meshes = context.models.meshes(&params.model);
    // Who tessellates beside another tessellation of the model does not wait for it.
    let (mut kept, mut own) = (meshes.try_lock(), KeptMeshes::default());
    let kept = kept.as_deref_mut().unwrap_or(&mut own);
    let options = tessellation(params.chord_mm, params.angle_deg);
    let mesh = tessellate_again(model, &options, kept, &|| context.task.cancelled());
    context.task.go_on()?;
    let mesh = mesh.map_err(|e| RpcError::internal(e.to_string()))?;
    let wanted = |name: &str| {
        let begins = |part: &String| {
            name == part || name.strip_prefix(part.as_str()).is_some_and(|r| r.starts_with('/'))
        };
        params.solids.as_ref().is_none_or(|parts| parts.iter().any(begins))
    };
    let walls = if params.wall_thickness { Some(thickness(context, &generated, &mesh)?) } else { None };
    Ok(json!({ "solids": mesh::solids(model, &mesh, wanted, walls.as_deref()) }))
}

/// The thickness of the metal at the vertices of every face, NaN where there is none.
fn thickness(
    context: &Context<'_>,
    generated: &Generated,
    mesh: &Tessellation,
) -> Result<Vec<Vec<f32>>, RpcError> {
    let field = WallField::new(generated);
    let of_face = |(i, face): (usize, &FaceMesh)| {
        let at = |(&point, &normal): (&u32, &DVec3)| {
            context.task.go_on()?;
            let found = field.at(FaceId(i), mesh.points[point as usize], normal);
            let found = found.map_err(|e| RpcError::internal(e.to_string()))?;
            Ok(found.map_or(f32::NAN, |thickness| thickness as f32))
        };
        face.points.iter().zip(&face.normals).map(at).collect()
    };
    mesh.faces.iter().enumerate().map(of_face).collect()
}

fn export(context: &Context<'_>, params: &ExportModel) -> Result<Value, RpcError> {
    let generated = last(context, &params.model)?;
    let export = Export {
        folder: &params.folder,
        formats: &params.formats,
        solids: &params.solids,
        tessellation: tessellation(params.chord_mm, params.angle_deg),
        stop: &|| context.task.cancelled(),
    };
    let (mut done, steps) = (0.0, export.steps().max(1) as f64);
    let written = export.write(&generated, &mut |_| {
        context.task.progress("export", done / steps);
        done += 1.0;
    });
    context.task.go_on()?;
    let written = written.map_err(|f| RpcError::file(f.what, &f.path, &f.error))?;
    let files: Vec<Value> =
        written.iter().map(|path| described(path, context.task)).collect::<Result<_, _>>()?;
    Ok(json!({ "files": files }))
}

/// A file's path, size and hash.
fn described(path: &Path, task: &Task) -> Result<Value, RpcError> {
    let failed = |e: std::io::Error| RpcError::file("read", path, e);
    let mut file = File::open(path).map_err(failed)?;
    let (mut hash, mut size, mut part) = (Sha256::new(), 0, vec![0; 1 << 20]);
    loop {
        task.go_on()?;
        let read = file.read(&mut part).map_err(failed)?;
        if read == 0 {
            return Ok(json!({ "path": path, "bytes": size, "sha256": hexadecimal(&hash.finalize()) }));
        }
        hash.update(&part[..read]);
        size += read;
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
