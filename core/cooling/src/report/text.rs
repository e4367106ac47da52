//! The report as a page of text.

use super::{HoleReport, JetReport, PassageReport, Range, Report, SlotReport, StationReport};
use std::fmt::Write;

/// A table of what matters first.
pub(super) fn render(report: &Report) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write(report, &mut text);
    text
}

fn write(report: &Report, out: &mut String) -> std::fmt::Result {
    writeln!(out, "{}", report.name)?;
    let state = if report.watertight { "watertight" } else { "NOT watertight" };
    writeln!(out, "  {state}, edges within {:.1e} mm of their faces", report.max_edge_deviation_mm)?;
    writeln!(
        out,
        "\n  {:<24} {:>14} {:>14} {:>7} {:>7}",
        "solid", "volume mm3", "area mm2", "faces", "genus"
    )?;
    for (name, solid) in &report.solids {
        let genus = report.genus.get(name).and_then(|g| g.found).map_or("?".into(), |g| g.to_string());
        writeln!(
            out,
            "  {name:<24} {:>14.3} {:>14.3} {:>7} {genus:>7}",
            solid.volume_mm3, solid.area_mm2, solid.faces
        )?;
    }
    writeln!(out, "  {:<24} {:>14.3}", "blade without cooling", report.blank.volume_mm3)?;
    if let Some(wall) = &report.wall_thickness_mm {
        let [x, y, z] = wall.at_mm;
        writeln!(out, "\n  thinnest wall {:.4} mm at ({x:.3}, {y:.3}, {z:.3}) on {}", wall.min, wall.face)?;
    }
    if !report.passages.is_empty() {
        writeln!(
            out,
            "\n  {:<24} {:>10} {:>21} {:>21}",
            "passage", "length mm", "flow area mm2", "hydraulic diam. mm"
        )?;
        for passage in &report.passages {
            write_passage(passage, out)?;
        }
    }
    if !report.radial_holes.is_empty() {
        writeln!(
            out,
            "\n  {:<12} {:>10} {:>10} {:>28} {:>9}",
            "radial hole", "d hub mm", "d tip mm", "axis at hub mm", "wall mm"
        )?;
        for hole in &report.radial_holes {
            let [x, y, z] = hole.hub_mm;
            let at = format!("{x:.3}, {y:.3}, {z:.3}");
            let [hub, tip] = hole.diameter_mm;
            writeln!(out, "  {:<12} {hub:>10.4} {tip:>10.4} {at:>28} {:>9.4}", hole.name, hole.wall_mm)?;
        }
    }
    film_rows(report, out)?;
    slot_rows(report, out)?;
    inner_bores(report, out)?;
    inserts(report, out)?;
    let fit = &report.blade_fit;
    if fit.points > 0 {
        writeln!(
            out,
            "\n  the surface passes {} points within {:.2e} mm",
            fit.points, fit.greatest_distance_mm
        )?;
    }
    writeln!(out, "\n  {:.1} ms", report.timings_ms.total)
}

/// A line a row: the holes themselves are in the JSON report.
fn film_rows(report: &Report, out: &mut String) -> std::fmt::Result {
    if report.holes.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "\n  {:<16} {:>6} {:>9} {:>7} {:>11} {:>9} {:>12}  fed by",
        "film row", "holes", "d mm", "L/D", "area ratio", "t/P", "ligament mm"
    )?;
    for holes in report.holes.chunk_by(|a, b| row(&a.name) == row(&b.name)) {
        let mean = |of: fn(&HoleReport) -> f64| holes.iter().map(of).sum::<f64>() / holes.len() as f64;
        let ligament = holes.iter().filter_map(|h| h.ligament_mm).min_by(f64::total_cmp);
        let mut fed: Vec<&str> = holes.iter().map(|h| h.passage.as_str()).collect();
        fed.dedup();
        writeln!(
            out,
            "  {:<16} {:>6} {:>9.4} {:>7.2} {:>11.3} {:>9} {:>12}  {}",
            row(&holes[0].name),
            holes.len(),
            mean(|h| h.diameter_mm),
            mean(|h| h.length_d),
            mean(|h| h.area_ratio),
            optional(holes[0].coverage),
            optional(ligament),
            fed.join(", ")
        )?;
    }
    Ok(())
}

/// A table of bores: a line for each group of neighbours whose names share their path.
struct BoreTable<'r> {
    /// What a group is, how many of what it has, what lies between its neighbours, and where it is.
    titles: [&'r str; 4],
    /// Name, diameter, length, ligament and place of each bore.
    bores: Vec<(&'r str, f64, f64, Option<f64>, String)>,
}

impl BoreTable<'_> {
    fn write(&self, out: &mut String) -> std::fmt::Result {
        if self.bores.is_empty() {
            return Ok(());
        }
        let [group, count, gap, place] = self.titles;
        writeln!(out, "\n  {group:<16} {count:>6} {:>9} {:>18} {gap:>12}  {place}", "d mm", "length mm")?;
        // The kind is said by the title.
        let path = |name: &str| {
            let name = name.split_once('/').map_or(name, |(_, rest)| rest);
            name.rsplit_once('/').map_or(name, |(path, _)| path).to_owned()
        };
        for bores in self.bores.chunk_by(|a, b| path(a.0) == path(b.0)) {
            let lengths = bores.iter().map(|b| b.2);
            let (low, high) = lengths.fold((f64::INFINITY, 0.0f64), |(l, h), x| (l.min(x), h.max(x)));
            let gap = bores.iter().filter_map(|b| b.3).min_by(f64::total_cmp);
            writeln!(
                out,
                "  {:<16} {:>6} {:>9.4} {:>18} {:>12}  {}",
                path(bores[0].0),
                bores.len(),
                bores.iter().map(|b| b.1).sum::<f64>() / bores.len() as f64,
                format!("{low:.3} .. {high:.3}"),
                gap.map_or("-".into(), |gap| format!("{gap:.3}")),
                bores[0].4
            )?;
        }
        Ok(())
    }
}

fn inner_bores(report: &Report, out: &mut String) -> std::fmt::Result {
    let crossovers = report.crossovers.iter();
    let crossovers = crossovers
        .map(|h| (h.name.as_str(), h.diameter_mm, h.length_mm, h.ligament_mm, h.chambers.join(", ")));
    let pins = report.pins.iter();
    let pins = pins.map(|p| (p.name.as_str(), p.diameter_mm, p.length_mm, p.gap_mm, p.chamber.clone()));
    let dust = report.dust_holes.iter();
    let dust =
        dust.map(|h| (h.name.as_str(), h.diameter_mm, h.length_mm, Some(h.ligament_mm), h.passage.clone()));
    let tables = [
        BoreTable {
            titles: ["crossover row", "holes", "ligament mm", "between"],
            bores: crossovers.collect(),
        },
        BoreTable { titles: ["row of pins", "pins", "gap mm", "in"], bores: pins.collect() },
        BoreTable { titles: ["dust hole", "holes", "ligament mm", "from"], bores: dust.collect() },
    ];
    tables.iter().try_for_each(|table| table.write(out))
}

/// A line an insert, and below it one for each of its arrays: the jets themselves are in the JSON report.
fn inserts(report: &Report, out: &mut String) -> std::fmt::Result {
    if report.inserts.is_empty() {
        return Ok(());
    }
    let range = |range: &Range| format!("{:.3} .. {:.3}", range.min, range.max);
    let head = ["insert", "sheet mm2", "thickness mm", "gap mm", "jets", "jet area mm2"];
    let [name, area, thickness, gap, jets, jet_area] = head;
    writeln!(out, "\n  {name:<24} {area:>10} {thickness:>16} {gap:>16} {jets:>6} {jet_area:>13}")?;
    for insert in &report.inserts {
        let (thickness, gap) = (range(&insert.thickness_mm), range(&insert.gap_mm));
        let (name, area, jets, jet_area) = (&insert.name, insert.area_mm2, insert.jets, insert.jet_area_mm2);
        writeln!(out, "  {name:<24} {area:>10.3} {thickness:>16} {gap:>16} {jets:>6} {jet_area:>13.4}")?;
    }
    if report.jets.is_empty() {
        return Ok(());
    }
    let [name, count, d, x, y, z] = ["jet array", "jets", "d mm", "x/d", "y/d", "z/d"];
    writeln!(out, "\n  {name:<24} {count:>6} {d:>9} {x:>7} {y:>7} {z:>16}")?;
    let array =
        |jet: &JetReport| jet.name.rsplit_once('/').map_or(String::new(), |(array, _)| array.to_owned());
    for jets in report.jets.chunk_by(|a, b| array(a) == array(b)) {
        let optional = |x: Option<f64>| x.map_or("-".into(), |x| format!("{x:.2}"));
        let distances = jets.iter().filter_map(|jet| jet.target_d);
        let (low, high) = distances.fold((f64::INFINITY, 0.0f64), |(l, h), z| (l.min(z), h.max(z)));
        let z = if low <= high { format!("{low:.2} .. {high:.2}") } else { "-".into() };
        let (first, name) = (&jets[0], array(&jets[0]).replacen("insert/", "", 1).replacen("/jet/", "/", 1));
        let (x, y) = (optional(first.streamwise_pitch_d), optional(first.spanwise_pitch_d));
        writeln!(out, "  {name:<24} {:>6} {:>9.4} {x:>7} {y:>7} {z:>16}", jets.len(), first.diameter_mm)?;
    }
    Ok(())
}

/// A line a row of slots.
fn slot_rows(report: &Report, out: &mut String) -> std::fmt::Result {
    if report.slots.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "\n  {:<16} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}  fed by",
        "slot row",
        "slots",
        "height mm",
        "width mm",
        "length mm",
        "land mm",
        "suction",
        "pressure",
        "open mm"
    )?;
    for slots in report.slots.chunk_by(|a, b| row(&a.name) == row(&b.name)) {
        let least = |of: &dyn Fn(&SlotReport) -> Option<f64>| {
            optional(slots.iter().filter_map(of).min_by(f64::total_cmp))
        };
        let mean = slots.iter().map(|s| s.length_mm).sum::<f64>() / slots.len() as f64;
        writeln!(
            out,
            "  {:<16} {:>6} {:>9.4} {:>9.4} {mean:>9.3} {:>9} {:>9} {:>9} {:>9}  {}",
            row(&slots[0].name),
            slots.len(),
            slots[0].height_mm,
            slots[0].width_mm,
            least(&|s| s.land_mm),
            least(&|s| s.side_walls_mm[0]),
            least(&|s| s.side_walls_mm[1]),
            least(&|s| s.open_length_mm),
            slots[0].passage
        )?;
    }
    Ok(())
}

/// The row in a path `film/<row>/<number>`.
fn row(path: &str) -> &str {
    path.split('/').nth(1).unwrap_or(path)
}

fn optional(x: Option<f64>) -> String {
    x.map_or("-".into(), |x| format!("{x:.3}"))
}

/// A line for the passage and one for each of its parts: length, range of flow area and of hydraulic diameter.
fn write_passage(passage: &PassageReport, out: &mut String) -> std::fmt::Result {
    let mut line = |name: &str, [from, to]: [f64; 2]| {
        let within = |s: &&StationReport| (from..=to).contains(&s.length_mm);
        let range = |value: &dyn Fn(&StationReport) -> f64| {
            let values = passage.stations.iter().filter(within).map(value);
            let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(l, h), x| (l.min(x), h.max(x)));
            format!("{low:.3} .. {high:.3}")
        };
        let (area, diameter) = (range(&|s| s.area_mm2), range(&|s| s.hydraulic_diameter_mm));
        writeln!(out, "  {name:<24} {:>10.3} {area:>21} {diameter:>21}", to - from)
    };
    line(&passage.name, [0.0, passage.length_mm])?;
    // A passage of one part says nothing more there.
    for part in passage.parts.iter().filter(|_| passage.parts.len() > 1) {
        line(&format!("  {}", part.name), part.from_to_mm)?;
    }
    Ok(())
}
