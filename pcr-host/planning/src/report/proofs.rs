//! What has been proved of motions, as text.

use super::figures::{small, thousandths};
use super::{all_called, counted};
use crate::certify::{Contact, Proof};
use pcr_formats::scenario::Labels;

/// A line about a proof, in which agents have their labels.
pub fn proof_line(proof: &Proof, labels: &Labels) -> String {
    let place = |those: &[Contact]| {
        those.first().map_or(String::new(), |&Contact { i, j, t, clearance }| {
            let (agents, t) = (all_called(labels, &[i, j]), thousandths(t));
            let clearance = if clearance.is_nan() { "unknown".into() } else { format!("{} m", small(clearance)) };
            format!("agents {agents} at {t} s, clearance {clearance}")
        })
    };
    let found = match (proof.verdict, &proof.error) {
        (_, Some(problem)) => format!("none, {problem}"),
        ("proved", _) => format!("no contact at any time, proved ({} of discs)", counted(proof.pairs, "pair")),
        ("contact", _) => format!("contact, {}", place(&proof.contacts)),
        _ => format!("not decided, {}", place(&proof.undecided)),
    };
    format!("certificate: {found}")
}
