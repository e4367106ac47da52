//! Random medial blades: built to watertight solids, or refused with reasons.

use coolinggen_cooling::design::Design;
use coolinggen_cooling::generate;
use serde_json::{Value, json};
use std::path::Path;

/// SplitMix64: the same designs on every machine.
struct Random(u64);

impl Random {
    fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.part()
    }

    fn law(&mut self, low: f64, high: f64) -> Value {
        match (3.0 * self.part()) as usize {
            0 => json!(self.within(low, high)),
            1 => json!([[0, self.within(low, high)], [1, self.within(low, high)]]),
            _ => {
                json!([
                    [0, self.within(low, high)],
                    [0.5, self.within(low, high)],
                    [1, self.within(low, high)]
                ])
            }
        }
    }
}

fn turbine(random: &mut Random) -> Value {
    let (hub, span) = (random.within(30.0, 250.0), random.within(20.0, 120.0));
    let chord = random.within(20.0, 100.0);
    let shift = |random: &mut Random| random.within(-0.15, 0.15) * chord;
    let edge = |random: &mut Random, x: f64| {
        json!([
            [x + shift(random), hub],
            [x + shift(random), hub + 0.5 * span],
            [x + shift(random), hub + span]
        ])
    };
    let turn = (chord / hub).to_degrees();
    let closing = ["sharp", "blunt", "rounded"][(3.0 * random.part()) as usize];
    json!({"format": "coolinggen/1", "name": "random",
        "space": {"kind": "annular", "hub": [[-2.0 * chord, hub], [2.0 * chord, hub]],
            "shroud": [[-2.0 * chord, hub + span], [2.0 * chord, hub + span]]},
        "blade": {"kind": "medial-turbine",
            "leading_edge": edge(random, -0.5 * chord), "trailing_edge": edge(random, 0.5 * chord),
            "phi0_deg": random.law(-0.3 * turn, 0.3 * turn), "phi1_deg": random.law(-1.5 * turn, 1.5 * turn),
            "beta0_deg": random.law(20.0, 160.0), "beta1_deg": random.law(20.0, 160.0),
            "zeta0": random.law(0.1, 0.6), "zeta1": random.law(0.1, 0.6),
            "thickness": random.law(0.02 * chord, 0.3 * chord), "closing": closing,
            "profile": {"kind": "naca_4_digit", "closed": closing == "sharp"},
            "skin": {"tolerance": 0.02}}})
}

fn propeller(random: &mut Random) -> Value {
    let hub = random.within(0.15, 0.3);
    let (chord, pitch, skew) = (random.within(0.1, 0.6), random.within(0.4, 2.0), random.within(-50.0, 50.0));
    let rows: Vec<Value> = (0..=9)
        .map(|i| {
            let part = f64::from(i) / 9.0;
            let round = (1.0 - part * part).max(0.0).sqrt() * (0.6 + part);
            json!({"radius_r": if i == 9 { 1.0 } else { hub + (1.0 - hub) * part },
                "chord_d": if i == 9 { 0.0 } else { chord * round }, "pitch_d": pitch * (1.1 - 0.1 * part),
                "skew_deg": skew * part * part, "camber_c": 0.02,
                "thickness_c": random.within(0.9, 1.1) * (0.2 - 0.16 * part)})
        })
        .collect();
    json!({"format": "coolinggen/1", "name": "random",
        "space": {"kind": "annular", "hub": [[-400, 100.0 * hub], [400, 100.0 * hub]],
            "shroud": [[-400, 100], [400, 100]]},
        "blade": {"kind": "propeller-table", "diameter": 200, "rows": rows, "skin": {"tolerance": 0.02}}})
}

#[test]
fn random_parameters_are_built_or_refused_with_the_reason() {
    build_or_refuse(40);
}

#[test]
#[ignore = "takes minutes: cargo test --release -p coolinggen-cooling --test medial -- --ignored"]
fn five_hundred_random_parameters_are_built_or_refused_with_the_reason() {
    build_or_refuse(500);
}

fn build_or_refuse(count: usize) {
    let mut random = Random(4119);
    let (mut built, mut refused) = (0, 0);
    for round in 0..count {
        let document = if round % 5 == 4 { propeller(&mut random) } else { turbine(&mut random) };
        let text = document.to_string();
        let design = Design::from_json(&text).unwrap_or_else(|f| panic!("{round}: {f:?}\n{text}"));
        match generate(&design, Path::new(".")) {
            Ok(generated) => {
                built += 1;
                let report = &generated.report;
                assert!(report.watertight, "{round}: not watertight\n{text}");
                let volume = report.solids["metal"].volume_mm3;
                assert!(volume > 0.0 && report.max_edge_deviation_mm < 3e-8, "{round}: {volume}\n{text}");
            }
            Err(faults) => {
                refused += 1;
                assert!(!faults.is_empty());
                for fault in faults {
                    let known = fault.pointer.starts_with("/blade/") || fault.pointer.starts_with("/space");
                    assert!(known && !fault.message.is_empty(), "{round}: {fault}\n{text}");
                }
            }
        }
    }
    println!("{built} built, {refused} refused");
    assert!(3 * built >= count && 25 * refused >= count, "{built} built, {refused} refused");
}
