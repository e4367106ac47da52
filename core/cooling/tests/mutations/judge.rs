//! What must hold of every answer.

use super::bases::folder;
use super::sound::check_report;
use coolinggen_blade::Fault;
use coolinggen_cooling::design::Design;
use coolinggen_cooling::generate;
use coolinggen_cooling::plan::Plan;
use serde_json::Value;

/// How far a design came.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// The document, the plan, or the blade's source was refused.
    RefusedEarly,
    /// The solids could not be built.
    RefusedByGeometry,
    /// The solids were built and found unsound.
    RefusedAtTheGate,
    /// It was built.
    Built,
}

/// Takes a document the whole way. The error says what went wrong with the answer.
pub(crate) fn judge(text: &str) -> Result<Outcome, String> {
    let design = match Design::from_json(text) {
        Ok(design) => design,
        Err(faults) => return check_faults(text, &faults).map(|()| Outcome::RefusedEarly),
    };
    match generate(&design, &folder()) {
        Ok(generated) => check_report(&generated.report).map(|()| Outcome::Built),
        Err(faults) => {
            check_faults(text, &faults)?;
            let early = design.cooling.as_ref().is_some_and(|c| Plan::new(c).is_err())
                || coolinggen_blade::build(&design.space, &design.blade, &folder()).is_err();
            let at_the_gate = faults.iter().any(|f| f.message.contains("came out unsound"));
            Ok(match (early, at_the_gate) {
                (true, _) => Outcome::RefusedEarly,
                (_, true) => Outcome::RefusedAtTheGate,
                _ => Outcome::RefusedByGeometry,
            })
        }
    }
}

fn check_faults(text: &str, faults: &[Fault]) -> Result<(), String> {
    let document: Option<Value> = serde_json::from_str(text).ok();
    if faults.is_empty() {
        return Err("refused without a fault".into());
    }
    for fault in faults {
        let place = match &document {
            None => fault.pointer.is_empty() && fault.code == "syntax",
            Some(document) => points_at(document, fault),
        };
        let message = &fault.message;
        // A number that is none has no place in a sentence, unless the document says the word.
        let words = !message.trim().is_empty() && (!message.contains("NaN") || text.contains("NaN"));
        if !place || !words || serde_json::to_string(fault).is_err() {
            return Err(format!("a poor fault: {fault:?}"));
        }
    }
    Ok(())
}

/// The fault is at something in the document, or at a field that is not there of an object that is. The whole
/// document is to blame only for what no part of it is.
fn points_at(document: &Value, fault: &Fault) -> bool {
    if fault.pointer.is_empty() {
        return fault.code == "more" || (fault.code == "type" && !document.is_object());
    }
    let holder = || fault.pointer.rsplit_once('/').and_then(|(holder, _)| document.pointer(holder));
    document.pointer(&fault.pointer).is_some() || holder().is_some_and(Value::is_object)
}
