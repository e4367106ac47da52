//! No document brings the program down: ten thousand mutated designs go the whole way from text to solids. Each is
//! built right or refused with faults that point at something, and none takes long.
//!
//! The cases are numbered and drawn by a generator seeded with the number, so that a failure can be repeated:
//! `COOLINGGEN_MUTATION=4711 cargo test -p coolinggen-cooling --test mutations -- --nocapture` runs one case and
//! prints its document.

mod bases;
mod draw;
mod judge;
mod mutate;
mod sound;

use draw::Draw;
use judge::{Outcome, judge};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

/// Designs tried.
const CASES: usize = 10_000;
/// Of these, at least so many get as far as the build of solids.
const LEAST_BUILDS: usize = 1500;
/// Of these, at least so many are built.
const LEAST_BUILT: usize = 500;
/// Of those built, at most so many are found unsound and refused for it: the gate is no substitute for a sound build.
const MOST_UNSOUND: usize = 20;
/// A case longer than this hangs: hundreds of times what the samples take.
const LIMIT: Duration = Duration::from_secs(30);

/// What a case came to and how long it took.
struct Done {
    case: usize,
    outcome: Result<Outcome, String>,
    time: Duration,
}

/// The document of a case.
fn document(bases: &[bases::Base], case: usize) -> String {
    let mut draw = Draw::new(case as u64);
    let total: u32 = bases.iter().map(|b| b.weight).sum();
    let mut pick = draw.below(total as usize) as u32;
    let base = bases.iter().find(|b| {
        let chosen = pick < b.weight;
        pick = pick.saturating_sub(b.weight);
        chosen
    });
    mutate::mutated(&base.unwrap_or(&bases[0]).design, &mut draw)
}

fn run(bases: &[bases::Base], case: usize) -> Done {
    let started = Instant::now();
    let outcome = catch_unwind(AssertUnwindSafe(|| judge(&document(bases, case))));
    let outcome = outcome.unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        let text = text.or_else(|| panic.downcast_ref::<&str>().map(|s| (*s).to_owned()));
        Err(format!("panicked: {}", text.unwrap_or_default()))
    });
    Done { case, outcome, time: started.elapsed() }
}

/// Runs every `workers`-th case from `first` on.
fn work(first: usize, workers: usize, send: &Sender<Done>) {
    let bases = bases::bases();
    for case in (first..CASES).step_by(workers) {
        if send.send(run(&bases, case)).is_err() {
            return;
        }
    }
}

#[test]
fn every_base_is_built() {
    for base in bases::bases() {
        let outcome = judge(&base.design.to_string());
        assert!(matches!(outcome, Ok(Outcome::Built)), "{}: {outcome:?}", base.design["name"]);
    }
}

#[test]
fn ten_thousand_mutated_designs_are_built_right_or_refused_well() {
    if let Some(case) = std::env::var("COOLINGGEN_MUTATION").ok().and_then(|c| c.parse().ok()) {
        let bases = bases::bases();
        println!("{}", document(&bases, case));
        let done = run(&bases, case);
        println!("{:?} in {:?}", done.outcome, done.time);
        assert!(done.outcome.is_ok());
        return;
    }
    let workers = std::thread::available_parallelism().map_or(1, usize::from).min(4);
    let results: Vec<_> = (0..workers)
        .map(|first| {
            let (send, receive) = channel();
            std::thread::spawn(move || work(first, workers, &send));
            receive
        })
        .collect();
    let (mut refused_early, mut refused, mut built) = (0, 0, 0);
    let mut unsound = Vec::new();
    let mut wrong = Vec::new();
    let mut slowest = (Duration::ZERO, 0);
    for k in 0..CASES {
        let done = match results[k % workers].recv_timeout(LIMIT) {
            Ok(done) => done,
            Err(RecvTimeoutError::Timeout) => panic!("case {k} takes longer than {LIMIT:?}"),
            Err(RecvTimeoutError::Disconnected) => panic!("case {k} ended its thread"),
        };
        assert_eq!(done.case, k);
        slowest = slowest.max((done.time, k));
        match done.outcome {
            Ok(Outcome::RefusedEarly) => refused_early += 1,
            Ok(Outcome::RefusedByGeometry) => refused += 1,
            Ok(Outcome::RefusedAtTheGate) => unsound.push(k),
            Ok(Outcome::Built) => built += 1,
            Err(message) => wrong.push(format!("case {k}: {message}")),
        }
    }
    println!(
        "{CASES} designs: {refused_early} refused before geometry, {refused} by geometry, {built} built, \
         unsound {unsound:?}; case {} was slowest with {:.2?}",
        slowest.1, slowest.0
    );
    let shown = wrong.iter().take(100).fold(String::new(), |all, one| all + "\n" + one);
    assert!(wrong.is_empty(), "{} of {CASES} designs went wrong:{shown}", wrong.len());
    assert!(refused + built >= LEAST_BUILDS && built >= LEAST_BUILT);
    assert!(unsound.len() <= MOST_UNSOUND);
}
