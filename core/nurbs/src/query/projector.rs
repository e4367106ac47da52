//! Closest points without a start value, proved to be the closest.

use super::global::{Piece, Pieces};
use super::project_curve::{CurveProjection, project_on_curve};
use super::project_surface::{Projection, project_on_surface};
use crate::edit::{BezierCurve, BezierSurface};
use crate::error::NurbsError;

/// Finds closest points on a surface without start values; prepared once, asked often.
///
/// The result is the global minimum: no point of the surface has a squared distance less than the one returned by
/// more than 1e-14 of the squared size of the numbers on the Bezier patch in question (its extent and the distance).
/// The proof is by branch and bound on the Bernstein form of the squared distance; the point itself is that of
/// [`project_on_surface`], with its accuracy.
#[derive(Clone, Debug)]
pub struct SurfaceProjector<S: BezierSurface> {
    surface: S,
    closed_u: bool,
    pieces: Pieces<S::Space>,
}

impl<S: BezierSurface> SurfaceProjector<S> {
    /// Prepares `surface` (or a reference to one): cuts it into Bezier patches. `closed_u` as in
    /// [`project_on_surface`].
    pub fn new(surface: S, closed_u: bool) -> Self {
        let patches = surface.homogeneous_patches();
        let count_v = surface.breaks_v().len() - 1;
        let pieces = patches.into_iter().map(|p| Piece {
            u: p.knots_u().domain(),
            v: p.knots_v().domain(),
            counts: p.counts(),
            net: p.points().to_vec(),
        });
        let pieces = Pieces::new(pieces.collect(), count_v, |u, v| surface.point(u, v));
        Self { surface, closed_u, pieces }
    }

    /// The surface.
    pub fn surface(&self) -> &S {
        &self.surface
    }

    /// Whether the surface counts as closed in u.
    pub fn closed_u(&self) -> bool {
        self.closed_u
    }

    /// Centre and radius of a sphere around the surface.
    pub fn bounding_sphere(&self) -> (S::Space, f64) {
        self.pieces.sphere()
    }

    /// The closest point of the whole surface to `point`.
    ///
    /// # Errors
    /// As [`project_on_surface`]; [`NurbsError::NoConvergence`] also if the proof takes more than 100 000 boxes, as
    /// it does when a whole region is nearly equally close without being a piece of a sphere.
    pub fn closest(&self, point: S::Space) -> Result<Projection<S::Space>, NurbsError> {
        let mut best: Option<Projection<S::Space>> = None;
        self.pieces.closest(point, |u, v| {
            let found = project_on_surface(&self.surface, point, (u, v), self.closed_u)?;
            if best.is_none_or(|b| found.distance < b.distance) {
                best = Some(found);
            }
            Ok(found.distance)
        })?;
        best.ok_or(NurbsError::NotFound { what: "closest point on a surface" })
    }
}

/// Finds closest points on a curve without start values; prepared once, asked often.
///
/// The result is the global minimum, in the sense of [`SurfaceProjector`].
#[derive(Clone, Debug)]
pub struct CurveProjector<C: BezierCurve> {
    curve: C,
    closed: bool,
    pieces: Pieces<C::Space>,
}

impl<C: BezierCurve> CurveProjector<C> {
    /// Prepares `curve` (or a reference to one): cuts it into Bezier segments. `closed` as in [`project_on_curve`].
    pub fn new(curve: C, closed: bool) -> Self {
        let pieces = curve.homogeneous_segments().into_iter().map(|s| Piece {
            u: s.knots().domain(),
            v: (0.0, 1.0),
            counts: (s.points().len(), 1),
            net: s.points().to_vec(),
        });
        let pieces = Pieces::new(pieces.collect(), 1, |t, _| curve.point(t));
        Self { curve, closed, pieces }
    }

    /// The curve.
    pub fn curve(&self) -> &C {
        &self.curve
    }

    /// Centre and radius of a sphere around the curve.
    pub fn bounding_sphere(&self) -> (C::Space, f64) {
        self.pieces.sphere()
    }

    /// The closest point of the whole curve to `point`.
    ///
    /// # Errors
    /// As [`project_on_curve`]; [`NurbsError::NoConvergence`] also if the proof takes more than 100 000 boxes.
    pub fn closest(&self, point: C::Space) -> Result<CurveProjection<C::Space>, NurbsError> {
        let mut best: Option<CurveProjection<C::Space>> = None;
        self.pieces.closest(point, |t, _| {
            let found = project_on_curve(&self.curve, point, t, self.closed)?;
            if best.is_none_or(|b| found.distance < b.distance) {
                best = Some(found);
            }
            Ok(found.distance)
        })?;
        best.ok_or(NurbsError::NotFound { what: "closest point on a curve" })
    }
}
