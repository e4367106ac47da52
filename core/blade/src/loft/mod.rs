//! From section outlines to one surface.

mod nodes;
mod reparameter;

use crate::blade::Region;
use crate::section::{Outline, Piece};
use crate::stream::StreamSurface;
use coolinggen_nurbs::{Curve, Interpolator, Knots, NurbsError, ParametricCurve, Surface};
use glam::{DVec2, DVec3};
use nodes::Grid;
use reparameter::Reparameter;

/// What a section is drawn on.
#[derive(Clone, Debug)]
pub(crate) enum Sheet {
    /// A stream surface: coordinates (m, r theta), or (x, y) in a linear cascade.
    Stream(StreamSurface),
    /// A stream surface: coordinates of its chart.
    Chart(StreamSurface),
    /// A plane of constant z: coordinates (x, y).
    Planar { z: f64 },
}

impl Sheet {
    pub(crate) fn point(&self, q: DVec2) -> DVec3 {
        match self {
            Self::Stream(s) => s.stream_to_space(q.x, q.y),
            Self::Chart(s) => s.to_space(q),
            Self::Planar { z } => q.extend(*z),
        }
    }

    fn direction(&self, q: DVec2, d: DVec2) -> DVec3 {
        match self {
            Self::Stream(s) => s.stream_direction(q.x, q.y, d),
            Self::Chart(s) => {
                let (_, along_m, along_t) = s.to_space_derivatives(q);
                along_m * d.x + along_t * d.y
            }
            Self::Planar { .. } => d.extend(0.0),
        }
    }

    /// Distance of `p` from the sheet, mm; `station` is carried from point to point.
    fn miss(&self, p: DVec3, station: &mut Option<f64>) -> f64 {
        match self {
            Self::Stream(s) | Self::Chart(s) => s.level_near(p, station).0.abs(),
            Self::Planar { z } => (p.z - z).abs(),
        }
    }
}

/// A section ready to be lofted.
#[derive(Clone, Debug)]
pub(crate) struct LoftSection {
    /// Surface parameter.
    pub(crate) w: f64,
    pub(crate) sheet: Sheet,
    pub(crate) outline: Outline,
}

/// The surface with the joints and how it came about.
pub(crate) struct Loft {
    pub(crate) surface: Surface<DVec3>,
    pub(crate) regions: Vec<(Region, [f64; 2])>,
    /// Greatest distance of a section's curve from its sheet, mm.
    pub(crate) off_sheet: f64,
    /// For each section the map between u and arc length.
    maps: Vec<Reparameter>,
}

/// How far section curves may leave their sheets between nodes, mm: what readers of STEP files accept of edges.
const OFF_SHEET: f64 = 3e-8;
/// How far they may leave the outlines drawn through the points, mm.
const OFF_OUTLINE: f64 = 5e-5;
/// Spans around the blade that refinement stops at, and rounds of it.
const MOST_SPANS: usize = 400;
const ROUNDS: usize = 4;

impl Loft {
    /// Lofts sections at increasing w, all with the same regions: cubic along the blade (less with fewer than four
    /// sections; a single one must come as two).
    ///
    /// Around the blade every region is a C2 cubic of its own; regions meet with equal derivatives where the outlines
    /// are smooth.
    ///
    /// # Errors
    /// [`NurbsError`] for too few sections or equal w.
    pub(crate) fn new(sections: &[LoftSection]) -> Result<Self, NurbsError> {
        let Some(first) = sections.first() else {
            return Err(NurbsError::PointCount { count: 0, expected: 2 });
        };
        let joints = reparameter::joints(sections);
        let maps: Vec<_> = sections.iter().map(|s| Reparameter::new(&joints, &s.outline)).collect();
        let mut grid = Grid::new(sections, &maps, &joints);
        let mut best: Option<(Vec<Curve<DVec3>>, f64)> = None;
        for _ in 0..ROUNDS {
            let nodes = grid.nodes();
            let columns = sections
                .iter()
                .zip(&maps)
                .map(|(s, map)| column(s, map, &nodes))
                .collect::<Result<Vec<_>, _>>()?;
            let spans = judged(sections, &maps, &columns, &joints);
            let off = spans.iter().map(|s| s.off_sheet).fold(0.0, f64::max);
            best = Some((columns, off));
            if spans.iter().all(|s| s.excess() <= 1.0) || spans.len() >= MOST_SPANS {
                break;
            }
            grid.refine(&spans);
        }
        let Some((columns, off_sheet)) = best else {
            return Err(NurbsError::NotFound { what: "nodes around the blade" });
        };
        let w: Vec<f64> = sections.iter().map(|s| s.w).collect();
        let surface = Interpolator::new(3.min(w.len().saturating_sub(1)), &w)?.loft(&columns)?;
        let regions = first.outline.pieces.iter().enumerate();
        let regions = regions.map(|(k, p)| (p.region, [joints[k], joints[k + 1]])).collect();
        Ok(Self { surface, regions, off_sheet, maps })
    }

    /// Arc length at `u` in section `k`, mm.
    pub(crate) fn place(&self, k: usize, u: f64) -> f64 {
        self.maps[k].forward(u)
    }

    /// u at arc length `s` of section `k`.
    pub(crate) fn u(&self, k: usize, s: f64) -> f64 {
        self.maps[k].backward(s)
    }
}

/// The curve of one section on the common nodes: cubics with exact derivatives at the joints, chained.
fn column(section: &LoftSection, map: &Reparameter, nodes: &[Vec<f64>]) -> Result<Curve<DVec3>, NurbsError> {
    let mut values: Vec<f64> = Vec::new();
    let mut points: Vec<DVec3> = Vec::new();
    for (k, region) in nodes.iter().enumerate() {
        let piece = &section.outline.pieces[k];
        let at = |u: f64| lifted(section, piece, map, k, u);
        let through: Vec<DVec3> = region.iter().map(|&u| at(u).0).collect();
        let (start, end) = (at(region[0]).1, at(region[region.len() - 1]).1);
        let curve = Interpolator::with_slopes(region)?.curve_with_slopes(&through, start, end)?;
        // Neighbours share the point at the joint, which stands there as a triple knot.
        let skip = usize::from(k > 0);
        if k > 0 {
            values.pop();
        }
        values.extend_from_slice(&curve.knots().values()[if k > 0 { 4 } else { 0 }..]);
        points.extend_from_slice(&curve.points()[skip..]);
    }
    // The ends of the whole meet bit for bit.
    if let [start, .., end] = &mut points[..] {
        *end = *start;
    }
    Curve::new(Knots::new(3, values)?, points)
}

/// Point of a section in space at `u`, and its derivative in u.
fn lifted(section: &LoftSection, piece: &Piece, map: &Reparameter, k: usize, u: f64) -> (DVec3, DVec3) {
    let (s, rate) = map.within(k, u);
    let (q, tangent, _) = piece.at(s);
    (section.sheet.point(q), section.sheet.direction(q, tangent) * rate)
}

/// A span of the section curves, with the greatest errors of all of them in it, mm.
#[derive(Clone, Copy, Debug)]
struct Span {
    u: [f64; 2],
    /// Distance from the sheet.
    off_sheet: f64,
    /// Distance from the outline.
    off_outline: f64,
}

impl Span {
    /// The errors over what they may be, the greater one.
    fn excess(&self) -> f64 {
        (self.off_sheet / OFF_SHEET).max(self.off_outline / OFF_OUTLINE)
    }
}

/// Judges the section curves between their nodes.
fn judged(
    sections: &[LoftSection],
    maps: &[Reparameter],
    columns: &[Curve<DVec3>],
    joints: &[f64],
) -> Vec<Span> {
    let breaks = columns.first().map_or_else(Vec::new, ParametricCurve::breaks);
    let span = |w: &[f64]| Span { u: [w[0], w[1]], off_sheet: 0.0, off_outline: 0.0 };
    let mut spans: Vec<Span> = breaks.windows(2).map(span).collect();
    for ((section, map), column) in sections.iter().zip(maps).zip(columns) {
        let mut station = None;
        for span in &mut spans {
            let [a, b] = span.u;
            for f in [0.35, 0.65] {
                let p = column.point(a + (b - a) * f);
                span.off_sheet = span.off_sheet.max(section.sheet.miss(p, &mut station));
            }
            let middle = 0.5 * (a + b);
            let k = joints[1..joints.len() - 1].partition_point(|&j| j <= middle);
            let (exact, along) = lifted(section, &section.outline.pieces[k], map, k, middle);
            // Along the curve the difference is one of speed only.
            let apart = (column.point(middle) - exact).reject_from(along).length();
            span.off_outline = span.off_outline.max(apart);
        }
    }
    spans
}
