//! Materials of the mesh formats: one a layer and colour.

use coolinggen_brep::{Model, Solid};

/// A named colour.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Material {
    /// The layer; with a number where a layer has faces of several colours.
    pub(crate) name: String,
    /// Linear red, green, blue.
    pub(crate) color: [f64; 3],
}

/// Materials in the order in which faces first use them, and that of each face of the model that is used.
pub(crate) struct Materials {
    pub(crate) list: Vec<Material>,
    of_face: Vec<usize>,
}

impl Materials {
    pub(crate) fn of(model: &Model, solids: &[&Solid]) -> Self {
        let mut list: Vec<Material> = Vec::new();
        let mut keys: Vec<(&str, [u64; 3])> = Vec::new();
        let mut of_face = vec![usize::MAX; model.faces.len()];
        for used in solids.iter().flat_map(|s| s.faces()) {
            let style = &model.face(used.face).style;
            let key = (style.layer.as_str(), style.color.map(f64::to_bits));
            let known = keys.iter().position(|k| *k == key);
            of_face[used.face.0] = known.unwrap_or_else(|| {
                let same_layer = keys.iter().filter(|k| k.0 == key.0).count();
                let suffix = if same_layer == 0 { String::new() } else { format!("#{}", same_layer + 1) };
                list.push(Material { name: format!("{}{suffix}", style.layer), color: style.color });
                keys.push(key);
                list.len() - 1
            });
        }
        Self { list, of_face }
    }

    /// Index into the list for a face of the chosen solids.
    pub(crate) fn index(&self, face: usize) -> usize {
        self.of_face[face]
    }
}

/// A linear component as STEP and IGES have it: a display value (sRGB), which is how OpenCASCADE reads and writes them.
pub(crate) fn display_value(linear: f64) -> f64 {
    let c = linear.clamp(0.0, 1.0);
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// A name as one word of a text format: white space and control characters become underscores.
pub(crate) fn word(name: &str) -> String {
    let word: String =
        name.chars().map(|c| if c.is_whitespace() || c.is_control() { '_' } else { c }).collect();
    if word.is_empty() { "_".to_owned() } else { word }
}
