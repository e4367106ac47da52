//! The meridian contour of a blade and the parameters of its streamlines.

use super::read;
use crate::error::BladeError;
use crate::fault::{Fault, Pointer};
use crate::law::{Law, LawSpec};
use crate::medial::{Angles, Streamline, Trace, TraceFlaw};
use crate::source::OUTSIDE_CONTOURS;
use crate::stream::{Annular, ContourSpec};
use coolinggen_nurbs::{Knots, NurbsError};

/// What streamlines are drawn from.
pub(super) struct Contour<'a> {
    pub(super) space: &'a Annular,
    /// Leading and trailing edge.
    pub(super) traces: [Trace; 2],
    pub(super) phi: [Law; 2],
    beta: [Law; 2],
    zeta: [Law; 2],
}

impl<'a> Contour<'a> {
    /// Reads the traces of leading and trailing edge and the laws phi0, phi1, beta0, beta1, zeta0, zeta1. The traces run to
    /// the shroud, or to a tip (`pointed`).
    pub(super) fn read(
        edges: [&ContourSpec; 2],
        laws: [&LawSpec; 6],
        space: &'a Annular,
        pointed: bool,
        faults: &mut Vec<Fault>,
    ) -> Option<Self> {
        const NAMES: [&str; 2] = ["leading_edge", "trailing_edge"];
        let traces = [0, 1].map(|i| trace(edges[i], NAMES[i], space, pointed, faults));
        let (turn, angle, part) = ((-3600.0, 3600.0), (2.0, 178.0), (0.02, 1.0));
        let limits = [
            ("phi0_deg", turn, "deg"),
            ("phi1_deg", turn, "deg"),
            ("beta0_deg", angle, "deg"),
            ("beta1_deg", angle, "deg"),
            ("zeta0", part, ""),
            ("zeta1", part, ""),
        ];
        let before = faults.len();
        let mut read = |k: usize| {
            let (name, limits, unit) = limits[k];
            read::law(laws[k], Pointer::root().at(name), limits, unit, faults)
        };
        let read = [0, 1, 2, 3, 4, 5].map(&mut read);
        let traces = match traces {
            [Some(a), Some(b)] => [a, b],
            _ => return None,
        };
        if !pointed {
            in_order([&traces[0], &traces[1]], space, 1.0, faults);
        }
        let [Some(phi0), Some(phi1), Some(beta0), Some(beta1), Some(zeta0), Some(zeta1)] = read else {
            return None;
        };
        let contour = Self { space, traces, phi: [phi0, phi1], beta: [beta0, beta1], zeta: [zeta0, zeta1] };
        contour.wrapped(faults);
        (faults.len() == before).then_some(contour)
    }

    /// The streamline at span fraction `fraction`, with the laws at `v`.
    pub(super) fn streamline(&self, fraction: f64, v: f64) -> Result<Streamline, Vec<Fault>> {
        let outside = |e: BladeError| vec![Fault::new("", OUTSIDE_CONTOURS, e.to_string()).unit("mm")];
        let surface = self.space.surface(fraction).map_err(outside)?;
        let mut m = [0.0; 2];
        for i in [0, 1] {
            let station = self.traces[i].station(self.space, fraction).map_err(outside)?;
            m[i] = surface.chart_of_station(station);
        }
        let angles = Angles {
            phi: [0, 1].map(|i| self.phi[i].at(v).to_radians()),
            beta: [0, 1].map(|i| self.beta[i].at(v).to_radians()),
            zeta: [0, 1].map(|i| self.zeta[i].at(v)),
        };
        Streamline::new(surface, m, &angles).map_err(|_| {
            let message = format!(
                "at span fraction {fraction:.3} the streamline does not run on from the leading to the trailing edge"
            );
            vec![
                Fault::new("/zeta0", "runs_back", message)
                    .value(angles.zeta[0])
                    .hint("smaller zeta0 or zeta1, or angles that fit phi1 - phi0 better"),
            ]
        })
    }

    /// Quintic knots over the span, with room for the kinks in derivatives that laws and traces have at their knots.
    pub(super) fn knots_v(&self, spans: usize) -> Result<Knots, NurbsError> {
        let laws = [&self.phi, &self.beta, &self.zeta].into_iter().flatten();
        let mut breaks: Vec<f64> = laws.flat_map(Law::breaks).collect();
        breaks.extend(self.traces.iter().flat_map(|t| t.breaks(self.space)));
        breaks.extend([0.0, 1.0]);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
        let mut values = vec![0.0; 6];
        for pair in breaks.windows(2) {
            let parts = (spans as f64 * (pair[1] - pair[0])).ceil().max(1.0) as usize;
            let size = (pair[1] - pair[0]) / parts as f64;
            values.extend((1..parts).map(|k| pair[0] + size * k as f64));
            // Laws, traces and contours are twice differentiable at their knots, directions of contours once.
            values.extend(std::iter::repeat_n(pair[1], if pair[1] < 1.0 { 4 } else { 6 }));
        }
        Knots::new(5, values)
    }

    /// Refuses a blade that goes round the machine.
    fn wrapped(&self, faults: &mut Vec<Fault>) {
        const MOST: f64 = 300.0;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for law in &self.phi {
            let (a, b) = law.bounds();
            (low, high) = (low.min(a), high.max(b));
        }
        if !(high - low <= MOST) {
            let message =
                format!("the blade covers {:.1} degrees of the machine, {MOST} at most", high - low);
            let fault = Fault::new("/phi1_deg", "out_of_range", message);
            faults.push(fault.value(high - low).max(MOST).unit("deg"));
        }
    }
}

fn trace(
    spec: &ContourSpec,
    name: &str,
    space: &Annular,
    pointed: bool,
    faults: &mut Vec<Fault>,
) -> Option<Trace> {
    let at = Pointer::root().at(name);
    let curve = spec.curve(&at).map_err(|mut more| faults.append(&mut more)).ok()?;
    let explain = |flaw| match flaw {
        TraceFlaw::Outside(e) => Fault::new(at.clone(), OUTSIDE_CONTOURS, e.to_string()).unit("mm"),
        TraceFlaw::Short { start, end } => {
            let message = format!(
                "the trace runs from span fraction {start:.4} to {end:.4}, not from the hub (0) to the shroud (1) or a tip"
            );
            Fault::new(at.clone(), "short_of_contour", message)
                .hint("its first point lies on the hub, its last on the shroud or at the tip")
        }
        TraceFlaw::TurnsBack { v } => {
            let message = format!("the trace turns back at span fraction {v:.4}");
            Fault::new(at.clone(), "not_increasing", message).value(v)
        }
    };
    Trace::new(curve, space, pointed).map_err(|flaw| faults.push(explain(flaw))).ok()
}

/// Refuses edges that meet or stand in the wrong order.
fn in_order([leading, trailing]: [&Trace; 2], space: &Annular, last: f64, faults: &mut Vec<Fault>) {
    for k in 0..=20 {
        let v = last * f64::from(k) / 20.0;
        let (Ok(a), Ok(b)) = (leading.station(space, v), trailing.station(space, v)) else { continue };
        if !(b > a + 1e-3) {
            let message =
                format!("at span fraction {v:.2} the trailing edge does not lie behind the leading edge");
            faults.push(
                Fault::new("/trailing_edge", "order", message).hint("contours and traces run with the flow"),
            );
            return;
        }
    }
}
