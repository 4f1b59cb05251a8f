//! Orders that are extended for hours.

use crate::pair::{Pair, order};
use pcr_formats::vda5050::topics::TopicKind;

/// Corners every few metres, so that vehicles turn at nodes, and straight parts with several nodes.
fn place(node: usize) -> [f64; 2] {
    let (lap, k) = (node / 8, node % 8);
    let x = 3.0 * lap as f64;
    match k {
        0..=2 => [x + 0.5 * k as f64, 0.0],
        3..=5 => [x + 1.0, 0.5 * (k - 2) as f64],
        _ => [x + 1.0 + 0.75 * (k - 5) as f64, 1.5 - 0.5 * (k - 5) as f64],
    }
}

/// All of it was kept, written again with each update, and refused after 10,000 nodes.
#[test]
fn what_a_vehicle_has_passed_of_an_order_is_left_out() {
    let mut own = Pair::new();
    let ahead = |first: usize, last: usize| (first..=last).map(place).collect::<Vec<_>>();
    own.says(TopicKind::Order, order("a", 0, 0, &ahead(0, 6), 7));
    let (mut last, mut update, mut most, mut restarts) = (6, 0, 0, 0);
    while last < 600 {
        own.lasts(1.0);
        assert!(own.time < 3_000.0, "it does not go on");
        let robot = own.supervisor.robot("sim/001").unwrap();
        assert!(robot.alarm.is_none() && robot.waiting.is_none(), "{robot:?}");
        let job = own.bridge.lanes().next().unwrap().job().unwrap();
        let at = job.order.nodes[job.order.base].sequence_id;
        assert_eq!(at, 2 * last as u64);
        most = most.max(job.order.nodes.len());
        assert!(job.stops.len() < 150, "{}", job.stops.len());
        if robot.course.length() - robot.arc_length < 4.0 {
            update += 1;
            let next = last + 5;
            own.says(TopicKind::Order, order("a", update, 2 * last as u64, &ahead(last, next), 6));
            last = next;
            if update % 20 == 0 {
                restarts += 1;
                own.restart();
            }
        }
    }
    own.lasts(40.0);
    assert!(own.is_done("a") && own.errors().is_empty(), "{:?}", own.state);
    let [x, y] = own.vehicle.true_position();
    let [to, at] = place(last);
    assert!((x - to).hypot(y - at) < 0.2, "{x} {y}");
    // Numbers and names for the manager are its own.
    let state = own.state.as_ref().unwrap();
    assert_eq!((state.last_node_sequence_id, state.order_update_id), (2 * last as u64, update));
    assert!(most < 150 && restarts > 3, "{most} nodes, {restarts} restarts");
}
