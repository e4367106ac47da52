//! How small the things are that a mesh must resolve.

use super::Report;
use std::collections::HashMap;

impl Report {
    /// Diameter of the hole or pin, or width of the slot, that a face belongs to; for the faces of the blade and its
    /// passages the thinnest wall between them. In the order of [`Report::faces`], mm.
    pub fn feature_sizes_mm(&self) -> Vec<Option<f64>> {
        let mut sizes: HashMap<&str, f64> = HashMap::new();
        sizes.extend(self.holes.iter().map(|h| (h.name.as_str(), h.diameter_mm)));
        sizes.extend(self.slots.iter().map(|s| (s.name.as_str(), s.width_mm.min(s.height_mm))));
        sizes.extend(self.crossovers.iter().map(|c| (c.name.as_str(), c.diameter_mm)));
        sizes.extend(self.pins.iter().map(|p| (p.name.as_str(), p.diameter_mm)));
        sizes.extend(self.dust_holes.iter().map(|h| (h.name.as_str(), h.diameter_mm)));
        sizes.extend(self.jets.iter().map(|j| (j.name.as_str(), j.diameter_mm)));
        sizes.extend(self.inserts.iter().map(|i| (i.name.as_str(), i.thickness_mm.min)));
        let wall = self.wall_thickness_mm.as_ref().map(|w| w.min).filter(|w| *w > 0.0);
        let size_of = |face: &str| {
            // The thing is the longest path above the face that has a size.
            let above = face.rmatch_indices('/').find_map(|(end, _)| sizes.get(&face[..end]).copied());
            let walled = ["blade/", "chamber/", "turn/", "radial_hole/"].iter().any(|p| face.starts_with(p));
            above.or(wall.filter(|_| walled))
        };
        self.faces.iter().map(|face| size_of(&face.name)).collect()
    }
}
