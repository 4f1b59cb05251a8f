//! Orders and updates that the vehicle refuses.
//!
//! A vehicle names them in its errors, for as long as it likes. It may take them later, as when it is switched to automatic operation, so
//! they are sent again for some time. A first order that it still refuses then is over, as the standard says; an update is over when
//! the manager cancels the order.

use super::ActiveOrder;
use pcr_formats::vda5050::state::{ErrorEntry, ORDER, State, text};
use serde_json::Value;

/// Time for which a first order is sent to a vehicle that refuses it \[s\].
pub(super) const TRIED: f64 = 20.0;

impl ActiveOrder {
    /// Whether the vehicle refuses the last update that was sent.
    pub(super) fn is_refused(&self, state: &State) -> bool {
        let Some(sent) = self.sent.filter(|_| !self.is_acknowledged()) else { return false };
        state.errors.iter().any(|error| {
            let update = error.reference(UPDATE);
            error.refuses(&self.order.order_id) && update.is_none_or(|update| update == sent.update.to_string())
        })
    }

    /// Gives errors about our last update the manager's number of it.
    pub(super) fn name_updates(&self, errors: &mut [ErrorEntry]) {
        let Some(sent) = self.sent else { return };
        for error in errors {
            if error.reference(ORDER).as_deref() != Some(&self.order.order_id) {
                continue;
            }
            for said in references_mut(error).filter(|said| said["referenceKey"] == UPDATE) {
                if text(&said["referenceValue"]).as_deref() == Some(&sent.update.to_string()) {
                    said["referenceValue"] = sent.manager.to_string().into();
                }
            }
        }
    }
}

const UPDATE: &str = "orderUpdateId";

fn references_mut(error: &mut ErrorEntry) -> impl Iterator<Item = &mut Value> {
    error.rest.get_mut("errorReferences").and_then(Value::as_array_mut).into_iter().flatten()
}
