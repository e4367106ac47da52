//! What a role says of the flow.

/// What to set at faces of a role where fluid is beside them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Boundary {
    /// Coolant enters.
    Inflow,
    /// Coolant leaves.
    Outflow,
    /// Nothing passes.
    Wall,
}

impl Boundary {
    /// Flow enters and leaves through the coolant's openings, all else is wall.
    pub(crate) fn of_role(role: &str) -> Self {
        match role {
            "coolant_inlet" => Self::Inflow,
            "coolant_outlet" | "film_exit" | "slot_exit" | "tip_exit" => Self::Outflow,
            _ => Self::Wall,
        }
    }
}
