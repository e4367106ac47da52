//! Designs to start from: the samples that need no other file.

/// Name and text of every template; the first is the default.
pub(crate) const TEMPLATES: &[(&str, &str)] = &[
    ("rotor", include_str!("../../../samples/rotor.json")),
    ("rotor-serpentine", include_str!("../../../samples/rotor-serpentine.json")),
    ("c3x", include_str!("../../../samples/c3x.json")),
    ("c3x-film", include_str!("../../../samples/c3x-film.json")),
    ("pritchard", include_str!("../../../samples/pritchard.json")),
    ("surface", include_str!("../../../samples/surface.json")),
    ("francis", include_str!("../../../samples/francis.json")),
    ("kaplan", include_str!("../../../samples/kaplan.json")),
    ("medial-cooled", include_str!("../../../samples/medial-cooled.json")),
    ("propeller", include_str!("../../../samples/propeller.json")),
    ("medial-propeller", include_str!("../../../samples/medial-propeller.json")),
];
