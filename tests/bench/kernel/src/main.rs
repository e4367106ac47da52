//! Times evaluation and hinted closest point on one bicubic surface, ours and truck's, in turn in one run:
//!
//! ```text
//! cargo run --release -p coolinggen-bench-kernel
//! ```

use coolinggen_nurbs::{Knots, ParametricSurface, Surface, project_on_surface};
use glam::DVec3;
use std::hint::black_box;
use std::time::Instant;
use truck_modeling::{
    BSplineSurface, KnotVec, ParametricSurface as _, ParametricSurface3D as _, Point3, SearchNearestParameter,
};

const CALLS: usize = 20_000;
const ROUNDS: usize = 9;

/// A twisted tube of 20 x 8 control points.
fn surface() -> Surface<DVec3> {
    let (count_u, count_v) = (20, 8);
    let points = (0..count_u * count_v).map(|k| {
        let angle = std::f64::consts::TAU * (k / count_v) as f64 / (count_u - 1) as f64;
        let z = 10.0 * (k % count_v) as f64;
        DVec3::new(40.0 * angle.cos() + 0.1 * z, 12.0 * angle.sin() + 0.05 * z + 5.0 * angle.cos().powi(2), z)
    });
    let knots = |count| Knots::uniform(3, count).expect("more control points than the degree");
    Surface::new(knots(count_u), knots(count_v), points.collect())
        .expect("as many points as the knots ask for")
}

/// Least time of a call over the rounds, nanoseconds.
fn time(mut call: impl FnMut(usize) -> f64) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        let sum: f64 = (0..CALLS).map(&mut call).sum();
        black_box(sum);
        least = least.min(start.elapsed().as_secs_f64() / CALLS as f64 * 1e9);
    }
    least
}

fn row(name: &str, ours: f64, truck: f64) {
    println!("{name:<28} {ours:>10.0} ns {truck:>10.0} ns {:>8.1}", truck / ours);
}

fn main() {
    let ours = surface();
    let (count_u, count_v) = ours.counts();
    let at = |i: usize, j: usize| {
        let p = ours.points()[i * count_v + j];
        Point3::new(p.x, p.y, p.z)
    };
    let net: Vec<Vec<Point3>> = (0..count_u).map(|i| (0..count_v).map(|j| at(i, j)).collect()).collect();
    let knots = |k: &Knots| KnotVec::from(k.values().to_vec());
    let truck = BSplineSurface::new((knots(ours.knots_u()), knots(ours.knots_v())), net);
    // Well-spread parameters, away from the borders.
    let parameters: Vec<(f64, f64)> = (0..CALLS)
        .map(|i| {
            (0.05 + 0.9 * (0.754_877_666 * i as f64).fract(), 0.05 + 0.9 * (0.569_840_29 * i as f64).fract())
        })
        .collect();
    println!("{:<28} {:>13} {:>13} {:>8}", "bicubic, 20 x 8", "ours", "truck", "ratio");
    row(
        "point",
        time(|i| ours.point(parameters[i].0, parameters[i].1).x),
        time(|i| truck.subs(parameters[i].0, parameters[i].1).x),
    );
    row(
        "point, first derivatives",
        time(|i| {
            let (p, u, v) = ours.first_derivatives(parameters[i].0, parameters[i].1);
            p.x + u.y + v.z
        }),
        time(|i| {
            let (u, v) = parameters[i];
            truck.subs(u, v).x + truck.uder(u, v).y + truck.vder(u, v).z
        }),
    );
    // Points a millimetre off the surface, hints near their feet.
    let targets: Vec<(DVec3, (f64, f64))> = (parameters.iter())
        .map(|&(u, v)| {
            let d = ours.derivatives(u, v);
            (d.point + d.normal(), (u + 0.004, v - 0.005))
        })
        .collect();
    row(
        "closest point, near hint",
        time(|i| {
            project_on_surface(&ours, targets[i].0, targets[i].1, true).map_or(f64::NAN, |p| p.distance)
        }),
        time(|i| {
            let (p, hint) = targets[i];
            truck.search_nearest_parameter(Point3::new(p.x, p.y, p.z), Some(hint), 100).map_or(0.0, |uv| uv.0)
        }),
    );
    // Normals keep the trait in use and say that both surfaces are the same one.
    let n = truck.normal(0.3, 0.4);
    let own = ours.derivatives(0.3, 0.4).normal();
    println!("normals differ by {:.1e}", own.distance(DVec3::new(n.x, n.y, n.z)));
}
