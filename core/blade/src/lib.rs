//! Blade sources and stream space.
