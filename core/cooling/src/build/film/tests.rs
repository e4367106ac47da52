//! Holes in a flat wall, against closed forms.

use super::super::blank::Parts;
use super::super::sides::SurfacePoint;
use super::hole::Hole;
use crate::bore::{BoreNames, Drill, Mouth};
use crate::design::{HoleShape, Side};
use crate::plan::{FilmRowPlan, RowHoles, RowPlacement};
use coolinggen_blade::{Law, LawSpec, Pointer};
use coolinggen_brep::{
    Face, FaceId, FaceIntegrals, Loop, LoopEdges, Model, Style, SurfaceGeometry, face_integrals,
};
use coolinggen_nurbs::{Curve, Knots, ParametricCurve, Surface};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

fn constant(value: f64) -> Law {
    LawSpec::Constant(value).law(&Pointer::root()).unwrap()
}

fn style() -> Style {
    Style { layer: "test".into(), color: [0.5; 3] }
}

/// The square |x|, |y| <= 20 at height z, as a bilinear patch with edges.
fn plate(model: &mut Model, z: f64) -> FaceId {
    let corner = |x: f64, y: f64| DVec3::new(20.0 * x, 20.0 * y, z);
    let knots = Knots::clamped(1, &[0.0, 1.0]).unwrap();
    let points = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, -1.0), corner(1.0, 1.0)];
    let surface = Surface::new(knots.clone(), knots, points).unwrap();
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| corner(x, y));
    let vertices = corners.map(|p| model.add_vertex(p));
    let edges: Vec<_> = (0..4)
        .map(|i| {
            let j = (i + 1) % 4;
            (model.add_edge(vertices[i], vertices[j], Curve::segment(corners[i], corners[j])), true)
        })
        .collect();
    let border = LoopEdges { edges: &edges, near: DVec2::ZERO };
    model.trimmed_face(format!("plate{z}"), surface, &[border], 1e-9, style()).unwrap()
}

fn row(shape: HoleShape) -> FilmRowPlan {
    FilmRowPlan {
        name: "test".into(),
        side: Side::SuctionSide,
        at: RowPlacement::Position(constant(0.5)),
        span: [0.0, 1.0],
        holes: RowHoles::Count(1),
        stagger: 0.0,
        chamber: None,
        diameter: constant(1.0),
        inclination_deg: constant(30.0),
        compound_deg: constant(0.0),
        shape,
    }
}

/// Drills a hole of diameter 1 at 30 degrees through a flat wall as thick as makes it `length` long. Answers with the
/// breakout as a face, the exit's area ratio and its width.
fn drilled(shape: HoleShape, length: f64) -> (Model, Face, f64, f64) {
    let alpha = 30f64.to_radians();
    let mut model = Model::default();
    let lower = plate(&mut model, -length * alpha.sin());
    let upper = plate(&mut model, 0.0);
    let row = row(shape);
    let at = SurfacePoint {
        at: DVec2::new(0.5, 0.5),
        point: DVec3::ZERO,
        normal: DVec3::Z,
        downstream: DVec3::X,
        spanwise: DVec3::Y,
    };
    let axis = DVec3::new(alpha.cos(), 0.0, alpha.sin());
    let (angles_deg, pointer) = ([30.0, 0.0], String::new());
    let hole = Hole { row: &row, pointer, number: 1, at, axis, angles_deg, radius: 0.5, pitch: None };
    let (shape, area_ratio, width) = hole.shape(length).unwrap();
    let inner = -axis * length;
    let mouths = [
        (&[lower][..], Mouth { face: lower, at: DVec2::new(0.5 + inner.x / 40.0, 0.5), z: -length }),
        (&[upper][..], Mouth { face: upper, at: DVec2::new(0.5, 0.5), z: 0.0 }),
    ];
    let names = BoreNames { path: "film/test/001", stages: &["metering", "diffuser"], style: &style() };
    let bored =
        Drill::default().bore(&mut model, &shape, mouths, &names, &Parts::of(0), &mut |_| Ok(())).unwrap();
    let [_, upper] = bored.imprints;
    let (parent, border) = upper.inside.into_iter().next().unwrap();
    let exit = Face { loops: vec![border], ..model.face(parent).clone() };
    (model, exit, area_ratio, width)
}

/// Extent of a loop's edges along a direction.
fn extent(model: &Model, border: &Loop, direction: DVec3) -> f64 {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for coedge in &border.coedges {
        let curve = &model.edge(coedge.edge).curve;
        let (start, end) = curve.domain();
        for i in 0..=2000 {
            let x = curve.point(start + (end - start) * f64::from(i) / 2000.0).dot(direction);
            (low, high) = (low.min(x), high.max(x));
        }
    }
    high - low
}

fn area(face: &Face) -> f64 {
    let FaceIntegrals { area_mm2, .. } = face_integrals(face);
    assert!(matches!(face.surface, SurfaceGeometry::BSpline(_)));
    area_mm2
}

#[test]
fn a_cylinder_breaks_out_in_an_ellipse() {
    let (model, exit, area_ratio, _) = drilled(HoleShape::Cylindrical, 6.0);
    let (length, width) =
        (extent(&model, &exit.loops[0], DVec3::X), extent(&model, &exit.loops[0], DVec3::Y));
    assert!((length / width - 2.0).abs() < 1e-6, "{length} x {width}");
    assert!((width - 1.0).abs() < 1e-6);
    assert!((area(&exit) - 0.25 * PI * 2.0).abs() < 1e-6);
    assert_eq!(area_ratio, 1.0);
}

/// The 7-7-7 hole of Schroeder and Thole (GT2014-25992): area ratio 2.5, coverage 0.35 at a pitch of 6 diameters.
#[test]
fn the_7_7_7_hole_has_its_published_measures() {
    let shape = HoleShape::Shaped {
        metering_length_d: 2.5,
        lateral_expansion_deg: 7.0,
        forward_expansion_deg: 7.0,
        corner_radius_d: 0.5,
    };
    let (model, exit, area_ratio, width) = drilled(shape, 6.0);
    assert!((area_ratio - 2.502).abs() < 0.003, "{area_ratio}");
    assert!((width / 6.0 - 0.349).abs() < 1e-3, "{width}");
    let breakout = extent(&model, &exit.loops[0], DVec3::X);
    assert!((breakout - 3.362).abs() < 1e-3, "{breakout}");
    // The round corners reach a little farther than the flat side walls do.
    let corners = extent(&model, &exit.loops[0], DVec3::Y);
    assert!(corners > width && corners < 1.02 * width, "{corners} {width}");
}
