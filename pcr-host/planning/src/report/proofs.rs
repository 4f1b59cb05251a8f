//! What has been proved of motions, as text.

use super::all_called;
use super::figures::{small, thousandths};
use crate::certify::{Contact, Proof};
use pcr_formats::scenario::Labels;

/// A line about it, in which agents are called what they are in the table above.
pub(super) fn proof_line(proof: &Proof, labels: &Labels) -> String {
    let found = match (proof.verdict, &proof.error) {
        (_, Some(_)) => None,
        ("contact", None) => proof.contacts.first().map(|at| ("contact", at)),
        _ => proof.undecided.first().map(|at| ("not decided", at)),
    };
    match found {
        Some((verdict, &Contact { i, j, t, clearance })) => {
            let (agents, t, clearance) = (all_called(labels, &[i, j]), thousandths(t), small(clearance));
            format!("certificate: {verdict}, agents {agents} at {t} s, clearance {clearance} m")
        }
        None => proof.sentence(),
    }
}
