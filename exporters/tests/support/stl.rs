//! A reader of ASCII STL; the command line's tests use it, too.

use glam::DVec3;

/// Regions of an ASCII STL: names and triangles.
pub fn read_stl(text: &str) -> Vec<(String, Vec<[DVec3; 3]>)> {
    let mut out: Vec<(String, Vec<[DVec3; 3]>)> = Vec::new();
    let mut corners = Vec::new();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next().unwrap() {
            "solid" => out.push((words.next().unwrap().to_owned(), Vec::new())),
            "endsolid" => assert_eq!(words.next(), out.last().map(|r| r.0.as_str())),
            "vertex" => {
                let c: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
                corners.push(DVec3::new(c[0], c[1], c[2]));
            }
            "endfacet" => {
                out.last_mut().unwrap().1.push([corners[0], corners[1], corners[2]]);
                corners.clear();
            }
            _ => {}
        }
    }
    out
}
