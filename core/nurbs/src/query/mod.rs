//! Questions to curves and surfaces: closest points, lengths, curvatures, hits of rays.

mod global;
mod length;
mod line;
mod march;
mod project_curve;
mod project_surface;
mod projector;

pub use length::{ArcLength, curvature, signed_curvature};
pub use line::{LineHit, line_meets, line_meets_surface};
pub use march::{
    CERTIFIED, CurveHit, SurfaceHit, march_to_curve, march_to_surface, ray_meets_curve, ray_meets_surface,
};
pub use project_curve::{CurveProjection, project_on_curve};
pub use project_surface::{Projection, project_on_surface};
pub use projector::{CurveProjector, SurfaceProjector};
