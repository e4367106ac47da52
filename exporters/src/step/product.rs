//! What stands around the geometry: header, units, products, colours, layers, aspects.

use super::geometry::PLACEMENT_LENGTH;
use super::rewrite::Written;
use super::text::{List, Ref, Text};
use super::{StepOptions, StepSchema};
use crate::forms::Placement;
use crate::materials::display_value;
use crate::number::Real;
use coolinggen_brep::Style;
use glam::DVec3;
use std::collections::BTreeMap;
use std::io::{self, Write};
use truck_stepio::out::StepDisplay;

/// Entity of the context of parameter curves.
pub(crate) const PARAMETER_CONTEXT: usize = 10;

/// What is known of a face.
pub(crate) struct Described<'a> {
    pub(crate) name: &'a str,
    pub(crate) style: &'a Style,
    /// Number of its solid.
    pub(crate) solid: usize,
}

/// Header and the entities before the geometry: contexts, units, uncertainty.
pub(crate) fn preamble(options: &StepOptions, out: &mut impl Write) -> io::Result<()> {
    let (schema, protocol, year, context) = match options.schema {
        StepSchema::Ap214 => (
            "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }",
            "automotive_design",
            2000,
            "core data for automotive mechanical design processes",
        ),
        StepSchema::Ap242 => (
            "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }",
            "ap242_managed_model_based_3d_engineering",
            2014,
            "managed model based 3d engineering",
        ),
    };
    write!(
        out,
        "ISO-10303-21;
HEADER;
FILE_DESCRIPTION(('cooled blade, boundary representation, mm'),'2;1');
FILE_NAME({},{},({}),({}),'truck-stepio 0.3.0','coolinggen {}','');
FILE_SCHEMA(('{schema}'));
ENDSEC;
DATA;
#1 = APPLICATION_PROTOCOL_DEFINITION('international standard','{protocol}',{year},#2);
#2 = APPLICATION_CONTEXT('{context}');
#8 = PRODUCT_CONTEXT('',#2,'mechanical');
#9 = PRODUCT_DEFINITION_CONTEXT('part definition',#2,'design');
#10 = (GEOMETRIC_REPRESENTATION_CONTEXT(2) PARAMETRIC_REPRESENTATION_CONTEXT() \
REPRESENTATION_CONTEXT('','parameters'));
#11 = (GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#15)) \
GLOBAL_UNIT_ASSIGNED_CONTEXT((#12,#13,#14)) REPRESENTATION_CONTEXT('','3D'));
#12 = (LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));
#13 = (NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.));
#14 = (NAMED_UNIT(*) SI_UNIT($,.STERADIAN.) SOLID_ANGLE_UNIT());
#15 = UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({}),#12,'distance_accuracy_value','');
",
        Text(&options.name),
        Text(&options.time_stamp),
        Text(&options.author),
        Text(&options.organisation),
        env!("CARGO_PKG_VERSION"),
        Real(options.uncertainty_mm)
    )
}

/// A counter of entities.
struct Entities<'a, W: Write> {
    out: &'a mut W,
    next: usize,
}

impl<W: Write> Entities<'_, W> {
    fn add(&mut self, body: std::fmt::Arguments<'_>) -> io::Result<usize> {
        let id = self.next;
        self.next += 1;
        writeln!(self.out, "#{id} = {body};")?;
        Ok(id)
    }
}

/// Products, styles, layers and, in AP242, aspects, after the geometry. `faces` are those of `written.faces`.
pub(crate) fn closing(
    names: &[&str],
    faces: &[Described<'_>],
    written: &Written,
    schema: StepSchema,
    out: &mut impl Write,
) -> io::Result<()> {
    let mut entities = Entities { out, next: written.next };
    let shapes = products(names, written, &mut entities)?;
    colours(faces, written, &mut entities)?;
    layers(faces, written, &mut entities)?;
    if schema == StepSchema::Ap242 {
        aspects(faces, &shapes, written, &mut entities)?;
    }
    write!(entities.out, "ENDSEC;\nEND-ISO-10303-21;\n")
}

/// The shape of a product: what it is defined by, and what it is represented by.
struct ProductShape {
    definition: usize,
    representation: usize,
}

/// One product a solid, with its own representation.
fn products<W: Write>(
    names: &[&str],
    written: &Written,
    e: &mut Entities<'_, W>,
) -> io::Result<Vec<ProductShape>> {
    let axes = e.next;
    let placement = Placement { origin: DVec3::ZERO, axis: DVec3::Z, reference: DVec3::X };
    write!(e.out, "{}", StepDisplay::new(placement, axes))?;
    e.next += PLACEMENT_LENGTH;
    let mut products = Vec::with_capacity(names.len());
    let mut shapes = Vec::with_capacity(names.len());
    for (name, brep) in names.iter().zip(&written.solids) {
        let name = Text(name);
        let product = e.add(format_args!("PRODUCT({name},{name},'',(#8))"))?;
        let formation = e.add(format_args!("PRODUCT_DEFINITION_FORMATION('','',#{product})"))?;
        let definition = e.add(format_args!("PRODUCT_DEFINITION('design','',#{formation},#9)"))?;
        let shape = e.add(format_args!("PRODUCT_DEFINITION_SHAPE('','',#{definition})"))?;
        let representation =
            e.add(format_args!("ADVANCED_BREP_SHAPE_REPRESENTATION({name},(#{axes},#{brep}),#11)"))?;
        e.add(format_args!("SHAPE_DEFINITION_REPRESENTATION(#{shape},#{representation})"))?;
        products.push(product);
        shapes.push(ProductShape { definition: shape, representation });
    }
    let products = List(products.iter().map(|&p| Ref(p)));
    e.add(format_args!("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,{products})"))?;
    Ok(shapes)
}

/// A styled item a face; faces of one colour share the style.
fn colours<W: Write>(faces: &[Described<'_>], written: &Written, e: &mut Entities<'_, W>) -> io::Result<()> {
    let mut known: BTreeMap<[u64; 3], usize> = BTreeMap::new();
    let mut items = Vec::with_capacity(faces.len());
    for (Described { style, .. }, face) in faces.iter().zip(&written.faces) {
        let key = style.color.map(f64::to_bits);
        let assignment = match known.get(&key) {
            Some(&id) => id,
            None => {
                let [r, g, b] = style.color.map(|c| Real(display_value(c)));
                let colour = e.add(format_args!("COLOUR_RGB('',{r},{g},{b})"))?;
                let fill = e.add(format_args!("FILL_AREA_STYLE_COLOUR('',#{colour})"))?;
                let area = e.add(format_args!("FILL_AREA_STYLE('',(#{fill}))"))?;
                let surface = e.add(format_args!("SURFACE_STYLE_FILL_AREA(#{area})"))?;
                let side = e.add(format_args!("SURFACE_SIDE_STYLE('',(#{surface}))"))?;
                let usage = e.add(format_args!("SURFACE_STYLE_USAGE(.BOTH.,#{side})"))?;
                let id = e.add(format_args!("PRESENTATION_STYLE_ASSIGNMENT((#{usage}))"))?;
                known.insert(key, id);
                id
            }
        };
        items.push(e.add(format_args!("STYLED_ITEM('colour',(#{assignment}),#{face})"))?);
    }
    let items = List(items.iter().map(|&i| Ref(i)));
    e.add(format_args!("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',{items},#11)"))?;
    Ok(())
}

fn layers<W: Write>(faces: &[Described<'_>], written: &Written, e: &mut Entities<'_, W>) -> io::Result<()> {
    let mut of_layer: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (Described { style, .. }, &face) in faces.iter().zip(&written.faces) {
        of_layer.entry(&style.layer).or_default().push(face);
    }
    for (layer, faces) in of_layer {
        let faces = List(faces.iter().map(|&f| Ref(f)));
        e.add(format_args!("PRESENTATION_LAYER_ASSIGNMENT({},'',{faces})", Text(layer)))?;
    }
    Ok(())
}

/// A shape aspect a face, which names it as part of its product, and its use: which face of which representation it is.
/// CAx Implementor Forum, "Recommended Practices for the Representation and Presentation of Product Manufacturing
/// Information (AP242)", of geometric items that aspects stand for.
fn aspects<W: Write>(
    faces: &[Described<'_>],
    shapes: &[ProductShape],
    written: &Written,
    e: &mut Entities<'_, W>,
) -> io::Result<()> {
    for (Described { name, solid, .. }, face) in faces.iter().zip(&written.faces) {
        let Some(ProductShape { definition, representation }) = shapes.get(*solid) else { continue };
        let aspect = e.add(format_args!("SHAPE_ASPECT({},'face',#{definition},.T.)", Text(name)))?;
        e.add(format_args!("GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#{aspect},#{representation},#{face})"))?;
    }
    Ok(())
}
