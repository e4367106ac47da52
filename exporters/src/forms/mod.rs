//! Surfaces, curves and parameter curves in the forms that CAD readers have natively: planes, cylinders, cones, surfaces of
//! revolution and B-splines. STEP and BREP write them, each in its own words; IGES has B-splines alone.

mod curve;
mod jumps;
mod pcurve;
mod ruled;
mod surface;

use coolinggen_nurbs::Knots;

pub(crate) use curve::{CurveForm, curve};
pub(crate) use jumps::jumps;
pub(crate) use pcurve::pcurve;
pub(crate) use surface::{Form, Placement, SurfaceForm, rather_transposed, surface};

/// Distinct knots and their multiplicities, compared exactly.
pub(crate) fn distinct(knots: &Knots) -> (Vec<f64>, Vec<usize>) {
    let (mut values, mut counts): (Vec<f64>, Vec<usize>) = (Vec::new(), Vec::new());
    for &k in knots.values() {
        match (values.last(), counts.last_mut()) {
            (Some(&last), Some(count)) if last == k => *count += 1,
            _ => {
                values.push(k);
                counts.push(1);
            }
        }
    }
    (values, counts)
}
