//! Splitting an edge in all faces it bounds.

use crate::geometry::EdgeCurve;
use crate::model::{Coedge, Edge, EdgeId, FaceId, Model, VertexId};
use coolinggen_nurbs::{NurbsError, ParametricCurve};

impl Model {
    /// Splits an edge at the parameter `t` of its curve; the first part keeps the id. `faces` are those that it bounds:
    /// their parameter curves are split at the same parameter.
    ///
    /// # Errors
    /// [`NurbsError::OutOfDomain`] for `t` outside the open domain.
    pub fn split_edge(&mut self, edge: EdgeId, t: f64, faces: &[FaceId]) -> Result<VertexId, NurbsError> {
        let Edge { start, end, curve } = self.edge(edge).clone();
        let (first, second) = match &curve {
            EdgeCurve::BSpline(c) => {
                let (a, b) = c.split(t)?;
                (EdgeCurve::from(a), EdgeCurve::from(b))
            }
            EdgeCurve::Rational(c) => {
                let (a, b) = c.split(t)?;
                (EdgeCurve::from(a), EdgeCurve::from(b))
            }
        };
        let middle = self.add_vertex(second.point(t));
        let rest = self.add_edge(middle, end, second);
        self.edges[edge.0] = Edge { start, end: middle, curve: first };
        for &face in faces {
            for lp in &mut self.faces[face.0].loops {
                let Some(at) = lp.coedges.iter().position(|c| c.edge == edge) else { continue };
                let (a, b) = lp.coedges[at].pcurve.split(t)?;
                let forward = lp.coedges[at].forward;
                let first = Coedge { edge, forward, pcurve: a };
                let second = Coedge { edge: rest, forward, pcurve: b };
                let both = if forward { [first, second] } else { [second, first] };
                lp.coedges.splice(at..=at, both);
                break;
            }
        }
        Ok(middle)
    }
}
