//! The shell: the outer profile's offset, corrected until its thickness is right in space (DESIGN 5.3, steps 1, 2).

use super::error::BuildError;
use super::sections::{Grid, Section};
use crate::plan::ShellPlan;
use crate::section::{Camber, Contact, Outline, Refusal, circle_of_radius};
use coolinggen_blade::{Blade, Fault};
use coolinggen_nurbs::{Interpolator, ParametricCurve, ParametricSurface};
use std::ops::RangeInclusive;

/// Greatest relative error of the thickness where the shell governs.
const TOLERANCE: f64 = 1e-5;
/// Rounds of correction before giving up; Newton's method takes three on blades leaned by 30 degrees.
const ROUNDS: usize = 8;
/// Greatest change of the thickness in one round, relative to what is asked.
const GREATEST_CHANGE: f64 = 0.25;

/// An offset section: its outline and camber.
#[derive(Clone, Debug)]
pub(super) struct OffsetSection {
    pub(super) outline: Outline,
    pub(super) camber: Camber,
    /// Where the outer nose is too sharp for a chamber that follows it; there the outline is not corrected.
    pub(super) sharp_nose: Option<RangeInclusive<f64>>,
    /// The circle of the leading chamber's end radius at its front; none where the nose is blunter.
    pub(super) circle: Option<Contact>,
}

impl OffsetSection {
    /// Whether that circle touches behind the sharp part of the nose.
    pub(super) fn circle_is_clear(&self) -> bool {
        let (Some(circle), Some(sharp)) = (&self.circle, &self.sharp_nose) else { return true };
        !sharp.contains(&circle.pressure) && !sharp.contains(&circle.suction)
    }
}

/// Smallest radii, mm in space, at which marching the offset's camber ends at (front, back).
#[derive(Clone, Copy, Debug)]
pub(super) struct EndRadii {
    pub(super) front: f64,
    pub(super) back: f64,
}

impl EndRadii {
    /// The radii in the chart of a section.
    pub(super) fn in_chart(self, section: &Section) -> (f64, f64) {
        let scale = section.scale(section.camber.at(0.5).center);
        (self.front / scale, self.back / scale)
    }
}

/// The inner outline of the shell on one section.
pub(super) fn offset_section(
    blade: &Blade,
    grid: &Grid,
    section: &Section,
    shell: &ShellPlan,
    ends: EndRadii,
) -> Result<OffsetSection, BuildError> {
    let v = section.stream.v();
    let asked: Vec<f64> = grid.nodes.iter().map(|&u| asked_thickness(grid, shell, u, v)).collect();
    let refused = |refusal: &Refusal| BuildError::refused("/cooling/shell", v, refusal);
    let room = room(section, 0.5 * (shell.pressure_side.at(v) + shell.suction_side.at(v)));
    let vanishes = |needed: f64| refused(&Refusal::ChamberVanishes { radius: room.max(0.0), needed });
    // Past the thickest circle no chamber is left, and none of what follows has a solution.
    if room <= ends.front.min(ends.back) {
        return Err(vanishes(ends.front.min(ends.back)));
    }
    let (radii, step) = (ends.in_chart(section), section.march_step());
    let camber_of = |outline: &Outline| {
        Camber::of(outline, grid.nose, grid.leading_edge, radii, step).map_err(|refusal| match refusal {
            Refusal::NoInscribedCircle if room <= ends.front.max(ends.back) => {
                vanishes(ends.front.max(ends.back))
            }
            other => refused(&other),
        })
    };

    // Thickness in the chart, first as if the blade stood upright.
    let frames: Vec<_> = grid.nodes.iter().map(|&u| section.outline.frame(u)).collect();
    let upright: Vec<f64> = asked.iter().zip(&frames).map(|(d, f)| d / section.scale(f.point)).collect();
    let offset = |distance: &[f64]| -> Result<Outline, BuildError> {
        let points: Vec<_> = frames.iter().zip(distance).map(|(f, d)| f.point + f.normal * *d).collect();
        Ok(Outline::new(grid.curve(&points)?, section.outline.inward()))
    };
    let mut outline = offset(&upright)?;
    let rough = camber_of(&outline)?;
    let sharp_nose = sharp_nose(blade, grid, section, &asked, ends.front);
    let ahead = sharp_nose.clone().map(|sharp| {
        // The chamber begins behind it, where the circle at its front touches, or a little before.
        let Some(circle) = circle_of_radius(&outline, rough.front(), radii.0) else { return sharp };
        let slack = |u: f64| 0.05 * upright[0] / section.outline.frame(u).speed;
        let (pressure, suction) = (circle.pressure, circle.suction);
        sharp.start().min(pressure + slack(pressure))..=sharp.end().max(suction - slack(suction))
    });

    // Between its end circles the shell governs; beyond them other parts bound the chamber.
    let governs = |u: f64| {
        (rough.back().pressure..=rough.back().suction).contains(&u)
            && ahead.as_ref().is_none_or(|ahead| !ahead.contains(&u))
    };
    let mut parts = grid
        .piece_nodes()
        .map(|nodes| Part::new(grid, &section.blade_v, nodes, governs))
        .collect::<Result<Vec<_>, BuildError>>()?;
    let mut worst = f64::INFINITY;
    for _ in 0..ROUNDS {
        worst = 0.0;
        for part in &mut parts {
            for (k, &i) in part.samples.iter().enumerate() {
                let u = grid.nodes[i];
                let (inner, dm, dt) = section.stream.to_space_derivatives(outline.curve().point(u));
                // Each sample keeps to its own foot: on a leaned blade that of a neighbour, or the nearest of all, may
                // lie round the nose.
                let foot = blade.closest(inner, part.feet[k])?;
                part.feet[k] = (foot.u, foot.v);
                let missing = asked[i] - foot.distance;
                worst = f64::max(worst, (missing / asked[i]).abs());
                // Newton's method: the gradient of the distance is the unit vector from the foot.
                let normal = frames[i].normal;
                let gain =
                    (dm * normal.x + dt * normal.y).dot(inner - foot.point) / foot.distance * upright[i];
                let change = missing / gain;
                if change.is_finite() {
                    part.factors[k] += change.clamp(-GREATEST_CHANGE, GREATEST_CHANGE);
                }
            }
        }
        if worst <= TOLERANCE {
            break;
        }
        let mut distance = upright.clone();
        for part in &parts {
            let factor = part.factor(grid)?;
            for i in part.nodes.clone() {
                distance[i] = upright[i] * factor(grid.nodes[i]);
            }
        }
        outline = offset(&distance)?;
    }
    if !(worst <= 10.0 * TOLERANCE) {
        let message = format!("at span fraction {v:.4} the shell's thickness stays {worst:.2e} off");
        let fault = Fault::new("/cooling/shell", "geometry", message)
            .hint("the shell is too thick for the curvature of the blade there");
        return Err(BuildError::Refused(vec![fault]));
    }
    let camber = camber_of(&outline)?;
    let circle = circle_of_radius(&outline, camber.front(), radii.0);
    Ok(OffsetSection { outline, camber, sharp_nose, circle })
}

/// About the radius, mm in space, of the thickest circle inside a shell of the given thickness.
fn room(section: &Section, shell: f64) -> f64 {
    let radius = |c: &Contact| c.radius * section.scale(c.center);
    section.camber.contacts().iter().map(radius).fold(0.0, f64::max) - shell
}

/// Where, about the leading edge, the surface of the shell would be sharper than half the fillet radius, or not exist
/// at all: the blade's curvature in space decides, which on a leaned blade is greater than that of its sections.
fn sharp_nose(
    blade: &Blade,
    grid: &Grid,
    section: &Section,
    asked: &[f64],
    fillet: f64,
) -> Option<RangeInclusive<f64>> {
    let (start, end) = grid.leading_edge;
    let inward = if blade.outward { -1.0 } else { 1.0 };
    // The curvature may jump at the joints: the leading edge's own counts.
    let inside = 1e-9 * (end - start);
    let sharp = |i: &usize| {
        let u = grid.nodes[*i].clamp(start + inside, end - inside);
        let d = blade.surface.derivatives(u.rem_euclid(1.0), section.blade_v[*i]);
        let greatest = d.principal_curvatures().map(|k| k * inward).into_iter().fold(0.0, f64::max);
        greatest * (asked[*i] + 0.5 * fillet) >= 1.0
    };
    let within: Vec<usize> =
        (0..grid.nodes.len()).filter(|&i| (start..=end).contains(&grid.nodes[i])).filter(sharp).collect();
    let (first, last) = (within.first()?, within.last()?);
    Some(grid.nodes[*first]..=grid.nodes[*last])
}

/// Thickness asked for at u: by side, blended with two continuous derivatives round the leading edge.
pub(super) fn asked_thickness(grid: &Grid, shell: &ShellPlan, u: f64, v: f64) -> f64 {
    let (start, end) = grid.leading_edge;
    let x = ((u - start) / (end - start)).clamp(0.0, 1.0);
    let blend = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
    let (pressure, suction) = (shell.pressure_side.at(v), shell.suction_side.at(v));
    pressure + (suction - pressure) * blend
}

/// The correction on one region of the outline: a factor for the thickness, which is smooth inside the region only.
struct Part {
    /// Range of the nodes, joints included.
    nodes: RangeInclusive<usize>,
    /// Nodes at which thickness is measured.
    samples: Vec<usize>,
    /// The blade's parameters of their feet.
    feet: Vec<(f64, f64)>,
    /// Factors at the samples.
    factors: Vec<f64>,
    /// Interpolation of the factors over the samples; none where there are too few.
    interpolator: Option<Interpolator>,
}

impl Part {
    /// At most about fifty samples where the shell governs, as dense as the nodes are.
    fn new(
        grid: &Grid,
        blade_v: &[f64],
        nodes: RangeInclusive<usize>,
        governs: impl Fn(f64) -> bool,
    ) -> Result<Self, BuildError> {
        let within: Vec<usize> = nodes.clone().filter(|&i| governs(grid.nodes[i])).collect();
        let stride = (within.len() / 40).max(1);
        let mut samples: Vec<usize> = within.iter().copied().step_by(stride).collect();
        if let (Some(&last), Some(&end)) = (samples.last(), within.last())
            && last != end
        {
            samples.push(end);
        }
        let parameters: Vec<f64> = samples.iter().map(|&i| grid.nodes[i]).collect();
        let interpolator = if samples.len() >= 4 { Some(Interpolator::new(3, &parameters)?) } else { None };
        let feet = samples.iter().map(|&i| (grid.nodes[i], blade_v[i])).collect();
        Ok(Self { nodes, feet, factors: vec![1.0; samples.len()], samples, interpolator })
    }

    /// The factor as a function of u, constant beyond the samples.
    fn factor(&self, grid: &Grid) -> Result<impl Fn(f64) -> f64, BuildError> {
        let mean = self.factors.iter().sum::<f64>() / self.factors.len().max(1) as f64;
        let curve = self.interpolator.as_ref().map(|i| i.curve(&self.factors)).transpose()?;
        let ends =
            self.samples.first().zip(self.samples.last()).map(|(&a, &b)| (grid.nodes[a], grid.nodes[b]));
        Ok(move |u: f64| match (&curve, ends) {
            (Some(curve), Some((low, high))) => curve.point(u.clamp(low, high)),
            _ if mean > 0.0 => mean,
            _ => 1.0,
        })
    }
}
