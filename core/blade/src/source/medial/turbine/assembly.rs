//! From the sides to a closed blade.

use super::{ClosingSpec, KnotsSpec, Plan, failed};
use crate::blade::{Blade, FitReport, Region};
use crate::fault::{Fault, Pointer};
use crate::medial::{Sides, Skin, SkinSize, unit_normal};
use crate::source::assemble;
use crate::source::closed::surgery::{glued, rebased};
use crate::source::medial::closing;
use crate::stream::StreamSpace;
use crate::surface::BladeSurface;
use coolinggen_nurbs::{NurbsError, ParametricSurface, Surface};
use glam::DVec3;

/// The leading edge reaches to where the profile has turned by this from its tip, radians, seen half way up.
const NOSE_TURN: f64 = 1.1;
/// Grid of the error that is reported: points a side, lines.
const GRID: [usize; 2] = [81, 25];

pub(super) fn blade(
    plan: &Plan<'_>,
    sides: &Sides,
    suction: usize,
    space: &StreamSpace,
) -> Result<Blade, Vec<Fault>> {
    unfolded(sides)?;
    let spec = &plan.source.skin;
    let pressure = 1 - suction;
    let skin = match spec.control_points {
        Some(counts) => {
            let optimised = spec.knots == KnotsSpec::Optimised;
            Skin::new(sides, pressure, SkinSize { degree: spec.degree, counts, optimised })
        }
        None => Skin::within(sides, pressure, spec.degree, spec.tolerance),
    }
    .map_err(failed)?;
    let deviation = skin.deviation(sides, GRID[0], GRID[1]).map_err(failed)?;
    if spec.control_points.is_none() && !(deviation.greatest <= spec.tolerance) {
        let message = format!(
            "the sides are {:.2e} mm off a surface of {} by {} control points: they change too fast",
            deviation.greatest,
            skin.surface.counts().0,
            skin.surface.counts().1
        );
        let fault = Fault::new("/skin/tolerance", "no_surface", message);
        return Err(vec![fault.value(spec.tolerance).min(deviation.greatest).unit("mm")]);
    }
    let (closed, regions) = closed(&skin, nose(sides, &skin, pressure), plan.closing).map_err(failed)?;
    let surface = assemble::reaching(BladeSurface::BSpline(closed), space, &Pointer::root())?;
    let (count_u, count_v) = skin.surface.counts();
    let notes = vec![
        format!("medial surface within {:.1e} mm of its streamlines", sides.medial.residual),
        format!(
            "blade angles of the medial surface within {:.1e} deg",
            sides.medial.angle_residual.to_degrees()
        ),
        format!("normals within {:.1e}", sides.medial.normal_residual),
        format!("pace along the profile within {:.1e} of its mean", sides.sides[0].pace.residual),
        format!(
            "both sides by {count_u} x {count_v} control points of degree {} x {}: average error {:.2e} mm, greatest {:.2e} mm",
            spec.degree[0], spec.degree[1], deviation.average, deviation.greatest
        ),
    ];
    let outward = surface.is_outward();
    let fit = FitReport {
        greatest_distance_mm: deviation.greatest,
        average_distance_mm: deviation.average,
        notes,
        ..assemble::report(&surface)
    };
    Ok(Blade { surface, regions, outward, fit })
}

/// Refuses sides that fold over: thicker than the medial surface's curvature allows.
fn unfolded(sides: &Sides) -> Result<(), Vec<Fault>> {
    let (around, along) = (60, 16);
    for (k, sign) in [1.0, -1.0].into_iter().enumerate() {
        for (i, j) in (1..=around).flat_map(|i| (0..=along).map(move |j| (i, j))) {
            let (t, v) = (f64::from(i) / f64::from(around), f64::from(j) / f64::from(along));
            let (_, along_t, along_v) = sides.derivatives(k, t, v);
            let normal = unit_normal(&sides.medial.surface, sides.sides[k].pace.at(t), v);
            if !(along_t.cross(along_v).dot(normal) > 0.0) {
                let message = format!(
                    "the blade folds over itself at span fraction {v:.3}, {:.0} % of the way to the trailing edge",
                    100.0 * sides.sides[k].profile.at(t)[0].x
                );
                let scale = sides.sides[k].scale.at(v);
                let fault = Fault::new("/thickness", "folded", message).value(scale).unit("mm");
                let _ = sign;
                return Err(vec![fault.hint("a thinner blade, or one less curved, has room for its sides")]);
            }
        }
    }
    Ok(())
}

/// s at which the leading edge begins and ends.
fn nose(sides: &Sides, skin: &Skin, pressure: usize) -> [f64; 2] {
    let length = sides.medial.surface.iso_v(0.5);
    let length: f64 = (0..200)
        .map(|i| {
            use coolinggen_nurbs::ParametricCurve;
            length.point(f64::from(i) / 200.0).distance(length.point(f64::from(i + 1) / 200.0))
        })
        .sum();
    [pressure, 1 - pressure].map(|k| {
        let side = &sides.sides[k];
        let turned = |t: f64| {
            let slope = side.profile.at(t)[1];
            (length * slope.x).atan2(side.scale.at(0.5) * slope.y)
        };
        let steps = 400;
        let t = (1..steps).map(|i| f64::from(i) / f64::from(steps)).find(|&t| turned(t) >= NOSE_TURN);
        skin.place(k, t.unwrap_or(0.1).clamp(0.02, 0.5))
    })
}

/// The closed surface from the start of the leading edge on, with its regions.
fn closed(
    skin: &Skin,
    nose: [f64; 2],
    how: ClosingSpec,
) -> Result<(Surface<DVec3>, Vec<(Region, [f64; 2])>), NurbsError> {
    let net = match how {
        ClosingSpec::Sharp => closing::sharp(&skin.surface)?,
        ClosingSpec::Blunt | ClosingSpec::Rounded => skin.surface.clone(),
    };
    let tail = match how {
        ClosingSpec::Sharp => None,
        ClosingSpec::Blunt => Some(closing::blunt(&net)?),
        ClosingSpec::Rounded => Some(closing::rounded(&net)?),
    };
    // Parameters in proportion to lengths half way up.
    let length = |s: &Surface<DVec3>| -> f64 {
        let ((a, b), _) = s.domain();
        let at = |i: u32| s.point(a + (b - a) * f64::from(i) / 400.0, 0.5);
        (0..400).map(|i| at(i).distance(at(i + 1))).sum()
    };
    let sides = length(&net);
    let part = tail.as_ref().map_or(0.0, |t| length(t) / sides);
    let total = 1.0 + part;
    let front = net.restricted_u(nose[0], 1.0)?;
    let back = net.restricted_u(0.0, nose[0])?;
    let [a, b, c] = [nose[1] - nose[0], 1.0 - nose[0], 1.0 - nose[0] + part].map(|x| x / total);
    let mut pieces = vec![rebased(&front, (0.0, b))?];
    let mut regions = vec![(Region::LeadingEdge, [0.0, a]), (Region::SuctionSide, [a, b])];
    if let Some(tail) = tail {
        pieces.push(rebased(&tail, (b, c))?);
        regions.push((Region::TrailingEdge, [b, c]));
    }
    let c = if part > 0.0 { c } else { b };
    pieces.push(rebased(&back, (c, 1.0))?);
    regions.push((Region::PressureSide, [c, 1.0]));
    let closed = glued(&pieces)?;
    // The seam is one line, bit for bit.
    let columns = closed.counts().1;
    let mut points = closed.points().to_vec();
    let last = points.len() - columns;
    points.copy_within(0..columns, last);
    Ok((Surface::new(closed.knots_u().clone(), closed.knots_v().clone(), points)?, regions))
}
