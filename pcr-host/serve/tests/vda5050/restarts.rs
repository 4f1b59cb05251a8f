//! What is known after a restart of the supervisor, and at the start of an order.

use crate::pair::order;
use crate::puppet::Puppet;
use pcr_formats::vda5050::topics::TopicKind;

const TO: [[f64; 2]; 2] = [[0.0, 0.0], [4.0, 0.0]];
const ROUND: [[f64; 2]; 3] = [[0.0, 0.0], [4.0, 0.0], [0.0, 0.0]];

/// It has done an order, of one update.
fn done(places: &[[f64; 2]]) -> Puppet {
    let mut own = Puppet::new();
    own.manager(TopicKind::Order, order("a", 0, 0, places, places.len()));
    let ahead: Vec<u64> = (1..places.len() as u64).map(|k| 2 * k).collect();
    own.is_at("a", 0, 0, &ahead, 0.0, false);
    for (k, place) in places.iter().enumerate().skip(1) {
        own.is_at("a", 0, ahead[k - 1], &ahead[k..], place[0], false);
    }
    assert!(own.robot().arc_length > own.robot().course.length() - 0.1);
    assert_eq!(own.orders(), 1);
    own
}

/// Length of its way ahead.
fn left(own: &Puppet) -> f64 {
    own.robot().course.length() - own.robot().arc_length
}

/// The order was sent again, and driven again, while its way was free for others. One without a way back was sent for ever.
#[test]
fn an_order_that_was_done_is_not_sent_again_after_a_restart() {
    for places in [&TO[..], &ROUND] {
        let mut own = done(places);
        own.forgets();
        own.restart();
        own.lasts(20.0);
        assert_eq!((own.orders(), own.has_job()), (1, true));
        own.lasts(20.0);
        assert_eq!((own.orders(), own.has_job()), (1, false), "void after half a minute");
        assert_eq!(own.asked("cancelOrder").len(), 1);
        let [x, y] = *places.last().unwrap();
        own.manager(TopicKind::Order, order("b", 0, 0, &[[x, y], [x, y + 4.0]], 2));
        own.lasts(1.0);
        assert_eq!(own.got.last().unwrap().1["orderId"], "b");
    }
}

/// The same with a journal that does not say what the vehicle has confirmed.
#[test]
fn an_order_of_an_older_journal_is_not_sent_again_either() {
    let mut own = done(&TO);
    own.supervisor.note("sim/001", "received", serde_json::Value::Null).unwrap();
    own.forgets();
    own.restart();
    own.lasts(40.0);
    assert_eq!((own.orders(), own.has_job()), (1, false));
}

/// A state from before the restart ended an alarm.
#[test]
fn a_state_from_before_a_restart_ends_no_alarm() {
    for lists in [true, false] {
        let mut own = Puppet::new();
        let old = own.written();
        (own.state["agvPosition"]["y"], own.state["driving"]) = (1.5.into(), true.into());
        own.lasts(1.0);
        assert!(own.robot().alarm.is_some());
        own.lists = lists;
        own.restart();
        own.hears(&old);
        assert!(own.robot().alarm.is_some());
        // Back where it was: proved at once, or else after a minute.
        own.state["agvPosition"]["y"] = 0.0.into();
        own.lasts(2.0);
        assert_eq!(own.robot().alarm.is_some(), !lists);
        own.lasts(62.0);
        assert!(own.robot().alarm.is_none(), "{lists}");
    }
}

/// A new vehicle was put where it had been before, and others were let go.
#[test]
fn nobody_is_released_anything_for_a_state_that_may_be_old() {
    for lists in [true, false] {
        let mut own = Puppet::new();
        own.supervisor.remove("sim/001").unwrap();
        own.lists = lists;
        own.restart();
        own.lasts(1.0);
        own.manager(TopicKind::Order, order("a", 0, 0, &TO, 2));
        own.lasts(2.0);
        assert_eq!(own.orders() > 0, lists);
        own.lasts(62.0);
        assert!(own.orders() > 0, "{lists}");
    }
}

/// It named the order with the last node of the order before, which has the same name and number in both: all of the way was free.
#[test]
fn the_last_node_of_the_order_before_is_not_the_end_of_this_one() {
    let mut own = done(&ROUND);
    own.manager(TopicKind::Order, order("b", 0, 0, &ROUND, 3));
    own.lasts(0.5);
    own.is_at("b", 0, 4, &[], 0.0, false);
    own.lasts(5.0);
    assert!(left(&own) > 7.5, "{}", left(&own));
    assert_eq!(own.told["nodeStates"].as_array().map(Vec::len), Some(2), "{}", own.told);
    own.is_at("b", 0, 4, &[2, 4], 0.0, false);
    own.is_at("b", 0, 0, &[2, 4], 1.0, true);
    assert!((6.5..7.5).contains(&left(&own)), "{}", left(&own));
    // The states between were lost: it is believed after a while.
    let mut own = done(&ROUND);
    own.manager(TopicKind::Order, order("b", 0, 0, &ROUND, 3));
    own.lasts(0.5);
    own.is_at("b", 0, 4, &[], 0.0, false);
    own.lasts(32.0);
    assert!(left(&own) < 1.0, "{}", left(&own));
}

/// It was refused as if the vehicle still had something to do.
#[test]
fn an_order_before_the_first_state_after_a_restart_waits_for_it() {
    for is_cancelled in [false, true] {
        let mut own = done(&TO);
        own.restart();
        own.manager(TopicKind::Order, order("b", 0, 0, &[TO[1], TO[0]], 2));
        if is_cancelled {
            own.cancels("c");
            own.ends("c", "FAILED");
        }
        own.lasts(2.0);
        assert_eq!(own.orders() > 1, !is_cancelled, "{}", own.told["errors"]);
        assert_eq!(own.told["errors"].as_array().map(Vec::len), Some(0));
    }
}

/// The number of our own update was taken for one of the manager's.
#[test]
fn the_manager_sees_its_own_numbers_after_a_restart() {
    let mut own = Puppet::new();
    own.manager(TopicKind::Order, order("a", 7, 0, &TO[..1], 1));
    own.is_at("a", 0, 0, &[], 0.0, false);
    own.manager(TopicKind::Order, order("a", 8, 0, &TO, 2));
    own.lasts(0.5);
    own.restart();
    own.lasts(1.0);
    assert_eq!((own.told["orderId"].as_str(), own.told["orderUpdateId"].as_u64()), (Some("a"), Some(7)));
}
