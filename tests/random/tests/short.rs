//! The first random designs: none is built wrong, most are built, and what is refused is impossible. All thousand: see
//! docs/random.md.

use coolinggen_random::{Confirmation, Outcome, confirm, design, outcome};

const DESIGNS: u64 = 24;
/// 95 % are to be built.
const LEAST_BUILT: usize = 23;

#[test]
fn designs_are_built_right_or_are_impossible() {
    let mut built = 0;
    for seed in 0..DESIGNS {
        let document = design(seed);
        match outcome(&document) {
            Outcome::Built(_) => built += 1,
            Outcome::Refused(faults) => match confirm(&document, &faults[0]) {
                Confirmation::Contradicted(what) => panic!("{seed}: {}, yet {what}", faults[0]),
                other => println!("{seed}: {} ({other:?})", faults[0]),
            },
            Outcome::Wrong(what) => panic!("design {seed} is wrong: {what}"),
        }
    }
    assert!(built >= LEAST_BUILT, "{built} of {DESIGNS} designs are built");
}

/// A check that confirms everything would be worth nothing: what was built must contradict the same faults.
#[test]
fn no_hole_of_a_built_design_is_found_to_meet_a_wall() {
    let (mut holes, mut slots) = (0, 0);
    for seed in 0..DESIGNS {
        let document = design(seed);
        let Outcome::Built(generated) = outcome(&document) else { continue };
        for (k, hole) in generated.report.holes.iter().take(3).enumerate() {
            let parts: Vec<&str> = hole.name.split('/').collect();
            let [_, name, number] = parts[..] else { panic!("{}", hole.name) };
            let rows = document["cooling"]["film_rows"].as_array().expect("rows");
            let index = rows.iter().position(|r| r["name"] == name).expect("a row of this name");
            let number: u32 = number.parse().expect("a number");
            let fault = coolinggen_blade::Fault::new(
                format!("/cooling/film_rows/{index}"),
                "meets_wall",
                format!("hole {number} of film row"),
            );
            if let Confirmation::Confirmed(what) = confirm(&document, &fault) {
                panic!("{seed}, row {index}, hole {number}: {what}");
            }
            holes += usize::from(k == 0);
        }
        if !generated.report.slots.is_empty() {
            let fault =
                coolinggen_blade::Fault::new("/cooling/slot_rows/0/width", "side_wall", "slot 1 of row");
            if let Confirmation::Confirmed(what) = confirm(&document, &fault) {
                panic!("{seed}, slot 1: {what}");
            }
            slots += 1;
        }
    }
    assert!(holes > 3 && slots > 0, "{holes} designs with holes, {slots} with slots");
}

/// Designs that were refused although they can be built: camber lines that bend so tightly in a turn that fibres at the wall's
/// angle cross; chambers that end about the centre of a round trailing edge, where slots had no direction; a nose over
/// which a spline cuts too deep.
#[test]
fn what_was_refused_without_need_is_built() {
    for seed in [73, 181, 235, 240, 571, 575, 612, 382, 120, 149, 592] {
        match outcome(&design(seed)) {
            Outcome::Built(_) => {}
            Outcome::Refused(faults) => panic!("{seed}: {}", faults[0]),
            Outcome::Wrong(what) => panic!("design {seed} is wrong: {what}"),
        }
    }
}

/// A hole of a showerhead, which stands on the nose itself, runs past its chamber.
#[test]
fn a_hole_on_the_nose_is_found_to_miss_its_chamber() {
    let document = design(687);
    let Outcome::Refused(faults) = outcome(&document) else { panic!("687 is not refused") };
    let confirmation = confirm(&document, &faults[0]);
    assert!(matches!(confirmation, Confirmation::Confirmed(_)), "{}: {confirmation:?}", faults[0]);
}
