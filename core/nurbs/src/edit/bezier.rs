//! Decomposition into Bezier pieces, and back.

use super::insert::insert_once;
use crate::curve::{Curve, ParametricCurve, RationalCurve};
use crate::error::NurbsError;
use crate::knots::Knots;
use crate::surface::{ParametricSurface, RationalSurface, Surface};
use crate::vector::{Homogeneous, VectorSpace};

/// A curve that is made of Bezier pieces: what methods with guarantees ask for, since a piece lies in the convex
/// hull of its control points.
pub trait BezierCurve: ParametricCurve<Self::Space> {
    /// Where its points live.
    type Space: VectorSpace;

    /// The B-spline in homogeneous coordinates, with positive weights.
    fn homogeneous_form(&self) -> Curve<Homogeneous<Self::Space>>;

    /// The pieces between breaks in homogeneous coordinates.
    fn homogeneous_segments(&self) -> Vec<Curve<Homogeneous<Self::Space>>> {
        self.homogeneous_form().bezier_segments()
    }
}

/// A surface that is made of Bezier patches, see [`BezierCurve`].
pub trait BezierSurface: ParametricSurface<Self::Space> {
    /// Where its points live.
    type Space: VectorSpace;

    /// The B-spline in homogeneous coordinates, with positive weights.
    fn homogeneous_form(&self) -> Surface<Homogeneous<Self::Space>>;

    /// The patches between breaks in homogeneous coordinates, u outermost.
    fn homogeneous_patches(&self) -> Vec<Surface<Homogeneous<Self::Space>>> {
        self.homogeneous_form().bezier_patches()
    }
}

impl<V: VectorSpace> BezierCurve for Curve<V> {
    type Space = V;
    fn homogeneous_form(&self) -> Curve<Homogeneous<V>> {
        self.map(|&p| Homogeneous::new(p, 1.0))
    }
}

impl<V: VectorSpace> BezierCurve for RationalCurve<V> {
    type Space = V;
    fn homogeneous_form(&self) -> Curve<Homogeneous<V>> {
        self.homogeneous.clone()
    }
}

impl<C: BezierCurve> BezierCurve for &C {
    type Space = C::Space;
    fn homogeneous_form(&self) -> Curve<Homogeneous<C::Space>> {
        (*self).homogeneous_form()
    }
}

impl<V: VectorSpace> BezierSurface for Surface<V> {
    type Space = V;
    fn homogeneous_form(&self) -> Surface<Homogeneous<V>> {
        self.map(|&p| Homogeneous::new(p, 1.0))
    }
}

impl<V: VectorSpace> BezierSurface for RationalSurface<V> {
    type Space = V;
    fn homogeneous_form(&self) -> Surface<Homogeneous<V>> {
        self.homogeneous.clone()
    }
}

impl<S: BezierSurface> BezierSurface for &S {
    type Space = S::Space;
    fn homogeneous_form(&self) -> Surface<Homogeneous<S::Space>> {
        (*self).homogeneous_form()
    }
}

impl<V: VectorSpace> Curve<V> {
    /// The polynomial pieces between the breaks, each a curve without interior knots on its own part of the
    /// domain (knot insertion, *The NURBS Book* section 5.3). Exact up to rounding; neighbours share their end
    /// points bit for bit, unless the curve jumps there.
    pub fn bezier_segments(&self) -> Vec<Self> {
        let p = self.degree();
        let breaks = self.knots.breaks();
        let mut values = self.knots.values().to_vec();
        let mut points = self.points.clone();
        for &t in &breaks {
            for _ in values.iter().filter(|&&k| k == t).count()..p {
                insert_once(p, &mut values, &mut points, t);
            }
        }
        let piece = |ends: &[f64]| {
            let span = values.partition_point(|&k| k <= ends[0]) - 1;
            let knots = Knots::clamped(p, ends).expect("successive breaks are clamped knots");
            Self { knots, points: points[span - p..=span].to_vec() }
        };
        breaks.windows(2).map(piece).collect()
    }

    /// One curve from pieces of equal degree whose domains follow each other: the inverse of
    /// [`Curve::bezier_segments`], for clamped pieces of any kind. Interior joints get knots of full multiplicity.
    ///
    /// # Errors
    /// [`NurbsError::Degree`] for differing degrees, [`NurbsError::KnotOrder`] where domains do not follow each
    /// other or a piece is not clamped, [`NurbsError::NotJoined`] where a piece starts farther than `tolerance` from
    /// the end of the one before, [`NurbsError::PointCount`] for no pieces.
    pub fn joined(pieces: &[Self], tolerance: f64) -> Result<Self, NurbsError> {
        let Some(first) = pieces.first() else {
            return Err(NurbsError::PointCount { count: 0, expected: 1 });
        };
        let p = first.degree();
        let mut values = first.knots.values().to_vec();
        let mut points = first.points.clone();
        for (index, piece) in pieces.iter().enumerate() {
            let (start, end) = piece.knots.domain();
            let (knots, before) = (piece.knots.values(), values[values.len() - 1]);
            if piece.degree() != p {
                return Err(NurbsError::Degree { degree: piece.degree(), greatest: p });
            }
            if knots[0] != start || knots[knots.len() - 1] != end || (index > 0 && start != before) {
                return Err(NurbsError::KnotOrder { index, before, value: start });
            }
            if index == 0 {
                continue;
            }
            let gap = points[points.len() - 1].distance_to(&piece.points[0]);
            if !(gap <= tolerance) {
                return Err(NurbsError::NotJoined { index, gap });
            }
            values.pop();
            values.extend_from_slice(&knots[p + 1..]);
            points.extend_from_slice(&piece.points[1..]);
        }
        Self::new(Knots::new(p, values)?, points)
    }
}

impl<V: VectorSpace> Surface<V> {
    /// The polynomial pieces between the breaks in u and v, u outermost, each on its own part of the domain.
    pub fn bezier_patches(&self) -> Vec<Self> {
        let strips = |s: &Self| -> Vec<Self> {
            // Every row is cut at the same breaks: gather piece k of all rows.
            let rows = s.points.chunks_exact(s.knots_v.control_count());
            let cut =
                rows.map(|row| Curve { knots: s.knots_v.clone(), points: row.to_vec() }.bezier_segments());
            let cut: Vec<Vec<Curve<V>>> = cut.collect();
            (0..cut[0].len())
                .map(|k| Self {
                    knots_u: s.knots_u.clone(),
                    knots_v: cut[0][k].knots.clone(),
                    points: cut.iter().flat_map(|row| row[k].points.iter().copied()).collect(),
                })
                .collect()
        };
        let across = strips(&self.transposed());
        across.iter().flat_map(|strip| strips(&strip.transposed())).collect()
    }
}
