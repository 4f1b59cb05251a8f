//! What has been proved of motions, as text.

use super::{all_called, counted};
use crate::certify::{CertificateContact, MotionCertificate};
use crate::figures::{small, thousandths};
use pcr_formats::scenario::Labels;

/// A line about a proof, in which agents have their labels.
pub fn proof_line(proof: &MotionCertificate, labels: &Labels) -> String {
    let place = |those: &[CertificateContact]| {
        those.first().map_or(String::new(), |&CertificateContact { i, j, t, clearance }| {
            let (agents, t) = (all_called(labels, &[i, j]), thousandths(t));
            let clearance = if clearance.is_nan() { "unknown".into() } else { format!("{} m", small(clearance)) };
            format!("agents {agents} at {t} s, clearance {clearance}")
        })
    };
    let found = match (proof.verdict, &proof.error) {
        (_, Some(problem)) => format!("none, {problem}"),
        ("proved", _) => {
            let pairs = counted(proof.pairs, "pair");
            let bodies = match proof.outlines {
                0 => "discs".into(),
                outlines => format!("bodies; {}", counted(outlines, "outline")),
            };
            format!("no contact at any time, proved ({pairs} of {bodies})")
        }
        ("contact", _) => format!("contact, {}", place(&proof.contacts)),
        _ => format!("not decided, {}", place(&proof.undecided)),
    };
    format!("certificate: {found}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distance_that_is_not_known_is_no_clearance() {
        let told = |clearance| {
            let undecided = vec![CertificateContact { i: 1, j: 2, t: 5.0, clearance }];
            let proof = MotionCertificate {
                verdict: "undecided",
                pairs: 1,
                outlines: 0,
                steps: 1,
                contacts: Vec::new(),
                undecided,
                error: None,
            };
            (
                proof_line(&proof, &Labels::default()),
                serde_json::to_value(proof.undecided[0]).unwrap()["clearance"].clone(),
            )
        };
        let (text, number) = told(f64::NAN);
        assert_eq!(text, "certificate: not decided, agents 1 and 2 at 5.000 s, clearance unknown");
        assert!(number.is_null());
        assert_eq!(told(-0.5).0, "certificate: not decided, agents 1 and 2 at 5.000 s, clearance -0.500 m");
    }
}
