//! Areas, volumes and centroids by exact integration over trimmed faces.
//!
//! By Green's theorem an integral over a face is one along its parameter curves, with the integral in the other
//! parameter inside. On B-splines both are polynomials between knots, which Gauss's rules integrate without error;
//! on surfaces of revolution the integral over the angle is known; on planes all is known.

mod cells;
mod net;
mod pairs;
mod plane;
mod revolution;
mod ruled;
mod spline;

use crate::geometry::SurfaceGeometry;
use crate::model::{Face, Loop, Model, Solid};
use coolinggen_nurbs::Surface;
use glam::DVec3;
use std::ops::AddAssign;

/// Integrals over one face; its natural normal (u cross v) is `n`, positions `X` count from the model's origin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaceIntegrals {
    /// Area, mm2.
    pub area_mm2: f64,
    /// Centroid of the area, mm.
    pub centroid_mm: DVec3,
    /// Integral of `n`, mm2: sums to zero over a closed shell.
    pub vector_area_mm2: DVec3,
    /// A third of the integral of `X . n`, mm3: sums to the volume over a closed shell.
    pub flux_mm3: f64,
    /// A quarter of the integral of `X (X . n)`, mm4: sums to volume times centroid over a closed shell.
    pub moment_mm4: DVec3,
}

/// What a solid weighs, per density.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolidMass {
    /// Volume, mm3; negative if the faces look inwards.
    pub volume_mm3: f64,
    /// Area of all faces, mm2.
    pub area_mm2: f64,
    /// Centre of the volume, mm.
    pub centroid_mm: DVec3,
    /// Volume each shell encloses, mm3: positive for the outer one, negative for voids.
    pub shell_volumes_mm3: Vec<f64>,
    /// Length of the sum of the faces' vector areas, mm2: zero but for the gaps between faces, of which it is a
    /// measure.
    pub open_area_mm2: f64,
}

impl Model {
    /// [`face_integrals`] of every face, in the order of [`Model::faces`]: faces shared by solids count once.
    pub fn face_integrals(&self) -> Vec<FaceIntegrals> {
        self.faces.iter().map(face_integrals).collect()
    }

    /// Sums up the faces of `solid`; `faces` has the integrals of every face of the model. A face that `faces` has
    /// no entry for counts nothing.
    pub fn solid_mass(&self, solid: &Solid, faces: &[FaceIntegrals]) -> SolidMass {
        let mut mass = SolidMass::default();
        let (mut position, mut moment, mut open) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        let mut shells = Vec::with_capacity(solid.shells.len());
        for shell in &solid.shells {
            let (mut volume, mut shell_open) = (0.0, DVec3::ZERO);
            for face in &shell.faces {
                let Some(f) = faces.get(face.face.0) else { continue };
                let sign = if face.forward { 1.0 } else { -1.0 };
                volume += sign * f.flux_mm3;
                shell_open += sign * f.vector_area_mm2;
                moment += sign * f.moment_mm4;
                position += f.area_mm2 * f.centroid_mm;
                mass.area_mm2 += f.area_mm2;
            }
            open += shell_open;
            shells.push((volume, shell_open));
        }
        // Gaps between faces weigh by their distance from the origin of the flux: better one amid the faces.
        let middle = position / mass.area_mm2;
        mass.shell_volumes_mm3 =
            shells.iter().map(|(volume, open)| volume - middle.dot(*open) / 3.0).collect();
        mass.volume_mm3 = mass.shell_volumes_mm3.iter().sum();
        mass.centroid_mm = moment / mass.volume_mm3;
        mass.open_area_mm2 = open.length();
        mass
    }
}

/// Integrates over a face.
///
/// Exact but for rounding on planes, and for all but the area (whose integrand has a root) on B-spline faces with
/// straight parameter curves and on surfaces of revolution with parameter curves along them; along other parameter
/// curves, and on rational surfaces, Gauss's rules are dense enough for 1e-12 of the value on curves that turn by
/// less than a right angle from knot to knot. Areas of B-spline faces are good to 1e-8 of the value, on faces of
/// more than a few spans to rounding.
pub fn face_integrals(face: &Face) -> FaceIntegrals {
    integrals_by(face, &mut loop_sums)
}

/// [`face_integrals`] with what each loop adds on a B-spline surface from `of_loop`.
pub(crate) fn integrals_by(
    face: &Face,
    of_loop: &mut dyn FnMut(&Surface<DVec3>, &Loop) -> Sums,
) -> FaceIntegrals {
    let sums = match &face.surface {
        SurfaceGeometry::Plane(s) => plane::integrate(s, &face.loops),
        SurfaceGeometry::Revolution(s) => revolution::integrate(s, &face.loops),
        SurfaceGeometry::BSpline(s) => total(face.loops.iter().map(|bound| of_loop(s, bound))),
        SurfaceGeometry::Rational(s) => spline::integrate_rational(s, &face.loops),
    };
    FaceIntegrals {
        area_mm2: sums.area,
        centroid_mm: sums.position / sums.area,
        vector_area_mm2: sums.normal,
        flux_mm3: sums.flux / 3.0,
        moment_mm4: sums.moment / 4.0,
    }
}

/// What one loop adds to the sums over a part of `surface`.
pub(crate) fn loop_sums(surface: &Surface<DVec3>, bound: &Loop) -> Sums {
    spline::integrate(surface, bound)
}

fn total(parts: impl Iterator<Item = Sums>) -> Sums {
    let mut sums = Sums::default();
    parts.for_each(|part| sums += part);
    sums
}

/// Sums over quadrature points.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    /// Integral of 1.
    area: f64,
    /// Integral of `X`.
    position: DVec3,
    /// Integral of `n`.
    normal: DVec3,
    /// Integral of `X . n`.
    flux: f64,
    /// Integral of `X (X . n)`.
    moment: DVec3,
}

impl Sums {
    /// Adds a surface point with weight `weight`; `normal` is the cross product of the derivatives.
    #[inline(always)]
    fn add(&mut self, weight: f64, point: DVec3, normal: DVec3) {
        let area = weight * normal.length();
        let flux = weight * point.dot(normal);
        self.area += area;
        self.position += point * area;
        self.normal += normal * weight;
        self.flux += flux;
        self.moment += point * flux;
    }

    fn scaled(self, factor: f64) -> Self {
        Self {
            area: self.area * factor,
            position: self.position * factor,
            normal: self.normal * factor,
            flux: self.flux * factor,
            moment: self.moment * factor,
        }
    }
}

impl AddAssign for Sums {
    fn add_assign(&mut self, other: Self) {
        self.area += other.area;
        self.position += other.position;
        self.normal += other.normal;
        self.flux += other.flux;
        self.moment += other.moment;
    }
}
