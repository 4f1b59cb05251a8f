//! Whether vehicles on parts of edges can touch, by the kernels that compute the locks.

use super::area_pair_search::PIECES;
use crate::bodies::BodyFleet;
use pcr_core::{CapacityError, Piece, overlaps};
use pcr_formats::scenario::{Agent, Scenario};

/// Returns whether one of some agents can touch one of others, whatever their motions. What cannot be computed counts as contact.
pub fn can_touch(own: &[Agent], others: &[Agent]) -> bool {
    let fleets = [own, others].map(|agents| BodyFleet::<f64>::new(&Scenario::new("", agents.to_vec())));
    let [Ok(own), Ok(others)] = fleets else { return true };
    let (own, others) = (own.fleet.motions(), others.fleet.motions());
    let mut pieces = vec![Piece::EMPTY; PIECES];
    own.iter().any(|a| {
        others.iter().any(|b| {
            let mut found = false;
            loop {
                match overlaps(a, b, &mut pieces, |_| found = true) {
                    Ok(_) => return found,
                    Err(CapacityError::Pieces { .. }) if pieces.len() < 1 << 20 => {
                        pieces.resize(2 * pieces.len(), Piece::EMPTY)
                    }
                    Err(_) => return true,
                }
            }
        })
    })
}
