//! Messages of other projects.

use pcr_formats::vda5050::decode::{MessageLimits, read};
use pcr_formats::vda5050::order::Order;
use pcr_formats::vda5050::order_state::OrderState;

fn sample(name: &str) -> Vec<u8> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/real/vda5050");
    std::fs::read(format!("{folder}/{name}")).unwrap()
}

#[test]
fn an_order_of_another_project_is_read_and_kept_whole() {
    let bytes = sample("order_v2_flywei.json");
    let order: Order = read(&bytes, MessageLimits::default()).unwrap();
    let held = OrderState::new(order.clone()).unwrap();
    assert_eq!((held.nodes.len(), held.base), (2, 1));
    // What is passed on has everything that was in it.
    let written = serde_json::to_value(&order).unwrap();
    assert_eq!(written, serde_json::from_slice::<serde_json::Value>(&bytes).unwrap());
}

#[test]
fn null_is_nothing_and_numbers_that_do_not_follow_are_refused() {
    let order: Order = read(&sample("order_v2_nulls_opentcs.json"), MessageLimits::default()).unwrap();
    assert_eq!(order.nodes.len(), 2);
    assert!(!serde_json::to_string(&order).unwrap().contains("null"));
    // All of its numbers are 0.
    assert_eq!(OrderState::new(order).unwrap_err().refusal.field, "edges[0].sequenceId");
}
