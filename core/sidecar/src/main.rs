//! The coolinggen binary.
fn main() {}
