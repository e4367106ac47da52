//! The group of every face: what its name implies, or what the design says.

use crate::design::{FaceGroup, Role};
use coolinggen_brep::{Grouping, Model};
use wildmatch::WildMatch;

/// Groups the faces of a model; of the design's groups that a face's name fits, the first counts.
pub(crate) fn grouping(model: &Model, wanted: &[FaceGroup]) -> Grouping {
    let wanted: Vec<(WildMatch, &FaceGroup)> = wanted.iter().map(|g| (WildMatch::new(&g.faces), g)).collect();
    Grouping::new(model, |face| {
        let (name, role) = implied(&face.name);
        let (name, role) = match wanted.iter().find(|(pattern, _)| pattern.matches(&face.name)) {
            Some((_, group)) => (group.name.clone(), group.role.unwrap_or(role)),
            None => (name, role),
        };
        (name, role.name())
    })
}

/// Group and role of a face by its name, which is the path of what made it (ARCHITECTURE.md). The blades of a row have
/// their groups in common.
fn implied(face: &str) -> (String, Role) {
    let parts: Vec<&str> = face.split('/').collect();
    let bore = |thing: &str, row: &str, exit: bool, open: Role| match exit {
        true => (format!("{thing}/{row}/exit"), open),
        false => (format!("{thing}/{row}"), Role::BoreWall),
    };
    match parts[..] {
        ["blade", "hub", ..] => ("blade/hub".to_owned(), Role::Hub),
        ["blade", "tip", ..] => ("blade/tip".to_owned(), Role::Tip),
        ["blade", region, ..] => (format!("blade/{region}"), Role::HotWall),
        [thing @ ("chamber" | "turn" | "radial_hole"), name, ..] => {
            (format!("{thing}/{name}"), Role::CoolantWall)
        }
        ["film", row, _, ref part @ ..] => bore("film", row, part.first() == Some(&"exit"), Role::FilmExit),
        ["slot", row, _, ref part @ ..] => bore("slot", row, part.first() == Some(&"exit"), Role::SlotExit),
        ["dust_hole", name, ref part @ ..] => {
            bore("dust_hole", name, part.first() == Some(&"exit"), Role::TipExit)
        }
        ["crossover", row, ..] => (format!("crossover/{row}"), Role::BoreWall),
        ["pin", array, ..] => (format!("pin/{array}"), Role::PinWall),
        ["insert", chamber, "jet", array, ..] => (format!("insert/{chamber}/jet/{array}"), Role::JetWall),
        ["insert", chamber, part, ..] => (format!("insert/{chamber}/{part}"), Role::InsertWall),
        ["coolant", "inlet", name, "inlet_extension", ..] => {
            (format!("coolant/inlet/{name}/extension"), Role::CoolantWall)
        }
        ["coolant", "inlet", name, ..] => (format!("coolant/inlet/{name}"), Role::CoolantInlet),
        ["coolant", "outlet", name, ..] => (format!("coolant/outlet/{name}"), Role::CoolantOutlet),
        [wall @ ("hub" | "shroud"), part, ..] => (format!("{wall}/{part}"), Role::AnnulusWall),
        _ => (face.to_owned(), Role::Other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_imply_groups_and_roles() {
        let cases = [
            ("blade/suction_side", "blade/suction_side", Role::HotWall),
            ("blade/trailing_edge/3", "blade/trailing_edge", Role::HotWall),
            ("blade/tip/2", "blade/tip", Role::Tip),
            ("chamber/leading/wall/w1/fillet_suction_side", "chamber/leading", Role::CoolantWall),
            ("turn/a/inner", "turn/a", Role::CoolantWall),
            ("radial_hole/03/b", "radial_hole/03", Role::CoolantWall),
            ("film/ss1/007/metering/2", "film/ss1", Role::BoreWall),
            ("film/ss1/007/exit", "film/ss1/exit", Role::FilmExit),
            ("film/head/007/exit/2", "film/head/exit", Role::FilmExit),
            ("slot/te/001/exit", "slot/te/exit", Role::SlotExit),
            ("slot/te/001/cutback/2", "slot/te", Role::BoreWall),
            ("crossover/x1/001/bore/1", "crossover/x1", Role::BoreWall),
            ("pin/te/01/001/side/1", "pin/te", Role::PinWall),
            ("dust_hole/d1/exit", "dust_hole/d1/exit", Role::TipExit),
            ("insert/le/jet/head/001/bore/2", "insert/le/jet/head", Role::JetWall),
            ("insert/le/outside/suction_side", "insert/le/outside", Role::InsertWall),
            ("coolant/inlet/leading", "coolant/inlet/leading", Role::CoolantInlet),
            ("coolant/inlet/leading/plenum", "coolant/inlet/leading", Role::CoolantInlet),
            ("coolant/inlet/leading/inlet_extension/4", "coolant/inlet/leading/extension", Role::CoolantWall),
            ("coolant/outlet/front", "coolant/outlet/front", Role::CoolantOutlet),
            ("hub/flow/3", "hub/flow", Role::AnnulusWall),
        ];
        for (face, group, role) in cases {
            assert_eq!(implied(face), (group.to_owned(), role), "{face}");
        }
    }
}
