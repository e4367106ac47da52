//! B-rep.
