//! Cooling.
