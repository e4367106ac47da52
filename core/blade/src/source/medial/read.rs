//! Reading what the medial sources have in common: laws within limits, profiles.

use super::spec::{ClosingSpec, ProfileSpec, SideSpec};
use crate::fault::{Fault, Pointer};
use crate::law::{Law, LawSpec};
use crate::medial::{Profile, ProfileFlaw};
use glam::DVec2;

/// Reads the law at `pointer` and checks that its values lie between `min` and `max`, both included.
pub(super) fn law(
    spec: &LawSpec,
    pointer: Pointer,
    (min, max): (f64, f64),
    unit: &'static str,
    faults: &mut Vec<Fault>,
) -> Option<Law> {
    let law = spec.law(&pointer).map_err(|mut more| faults.append(&mut more)).ok()?;
    let (least, greatest) = law.bounds();
    if let Some(value) = [least, greatest].into_iter().find(|v| !(min..=max).contains(v)) {
        let name = pointer.to_string();
        let name = name.trim_start_matches('/');
        let message = format!("{name} must lie between {min} and {max} {unit}, but is {value}");
        faults.push(
            Fault::new(pointer, "out_of_range", message.trim_end()).value(value).min(min).max(max).unit(unit),
        );
        return None;
    }
    Some(law)
}

/// Reads a profile.
pub(super) fn profile(spec: &ProfileSpec, at: &Pointer, faults: &mut Vec<Fault>) -> Option<Profile> {
    let points = match spec {
        ProfileSpec::Naca4Digit { closed } => {
            let made = Profile::naca_four_digit(*closed);
            return made.map_err(|e| faults.push(Fault::new(at.clone(), "profile", e.to_string()))).ok();
        }
        ProfileSpec::Bezier { control_points } => control_points,
    };
    let points: Vec<DVec2> = points.iter().map(|&p| DVec2::from_array(p)).collect();
    let at = at.at("control_points");
    let explain = |flaw| match flaw {
        ProfileFlaw::Count(count) => {
            let message = format!("a profile has 3 to 10 finite control points, here are {count}");
            Fault::new(at.clone(), "point_count", message).value(count).min(3.0).max(10.0)
        }
        ProfileFlaw::Fixed { index, x, y } => {
            let part = |name: &str, value: Option<f64>| value.map(|v| format!("{name} = {v}"));
            let wanted: Vec<String> = [part("x", x), part("y", y)].into_iter().flatten().collect();
            let message = format!("control point {index} must have {} and no negative y", wanted.join(", "));
            Fault::new(at.at(index), "profile_end", message)
                .hint("a profile begins with [0, 0], [0, y] and ends with [1, y]")
        }
        ProfileFlaw::Order(index) => {
            let message = "x must grow from each control point to the next";
            Fault::new(at.at(index).at(0), "not_increasing", message)
        }
        ProfileFlaw::Thin { x } => {
            let message = format!("the profile has no thickness at x = {x:.4}");
            Fault::new(at.clone(), "no_thickness", message).value(x)
        }
    };
    Profile::bezier(&points).map_err(|flaw| faults.push(explain(flaw))).ok()
}

/// What stands on both sides.
pub(super) struct Sections {
    /// Profile and scale of suction and pressure side.
    pub(super) sides: [(Profile, Law); 2],
    pub(super) closing: ClosingSpec,
}

/// Reads profile and scale (mm, within `limits` and as `fits` wants them) of both sides, and how they are closed.
pub(super) fn sections(
    (profile, thickness): (&ProfileSpec, &LawSpec),
    pressure_side: Option<&SideSpec>,
    closing_asked: Option<ClosingSpec>,
    limits: (f64, f64),
    fits: impl Fn(&Law, Pointer, &mut Vec<Fault>),
    faults: &mut Vec<Fault>,
) -> Option<Sections> {
    let before = faults.len();
    let root = Pointer::root();
    let mut scale = |spec: &LawSpec, at: Pointer| {
        let read = law(spec, at.clone(), limits, "mm", faults)?;
        fits(&read, at, faults);
        Some(read)
    };
    let at = root.at("pressure_side");
    let suction_scale = scale(thickness, root.at("thickness"));
    let other_scale = match pressure_side.and_then(|s| s.thickness.as_ref()) {
        Some(spec) => scale(spec, at.at("thickness")),
        None => suction_scale.clone(),
    };
    let suction_profile = self::profile(profile, &root.at("profile"), faults);
    let other_profile = match pressure_side.and_then(|s| s.profile.as_ref()) {
        Some(spec) => self::profile(spec, &at.at("profile"), faults),
        None => suction_profile.clone(),
    };
    let sides = [suction_profile?, other_profile?];
    let closing = closing(closing_asked, [sides[0].tail(), sides[1].tail()], faults);
    let [suction, other] = sides;
    let sides = [(suction, suction_scale?), (other, other_scale?)];
    (faults.len() == before).then_some(Sections { sides, closing })
}

/// How the trailing edge is closed where the profiles of the sides end with y = `tails`.
pub(super) fn closing(asked: Option<ClosingSpec>, tails: [f64; 2], faults: &mut Vec<Fault>) -> ClosingSpec {
    let open = tails[0] + tails[1] > 0.0;
    let closing = asked.unwrap_or(if open { ClosingSpec::Blunt } else { ClosingSpec::Sharp });
    let message = match (closing, open) {
        (ClosingSpec::Sharp, true) => "a sharp trailing edge needs a profile that ends with y = 0",
        (ClosingSpec::Blunt | ClosingSpec::Rounded, false) => {
            "a blunt or rounded trailing edge needs a profile that ends with y > 0"
        }
        _ => return closing,
    };
    faults.push(Fault::new("/closing", "closing", message).value(tails[0]));
    closing
}
