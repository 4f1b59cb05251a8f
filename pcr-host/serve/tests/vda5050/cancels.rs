//! Orders that end before they are done: their way is free only when the vehicle stands and can take nothing more of them.

use crate::pair::order;
use crate::puppet::Puppet;
use pcr_formats::vda5050::topics::TopicKind;

const WAY: [[f64; 2]; 3] = [[0.0, 0.0], [5.0, 0.0], [10.0, 0.0]];

/// Under way, with all of an order of 10 m.
fn driving() -> Puppet {
    let mut own = Puppet::new();
    own.manager(TopicKind::Order, order("a", 0, 0, &WAY, 3));
    own.is_at("a", 0, 0, &[2, 4], 0.0, false);
    own.is_at("a", 0, 0, &[2, 4], 1.0, true);
    assert_eq!(own.orders(), 1);
    own
}

/// At the end of what it has of an order, of which an update was sent that it has not taken.
fn waiting() -> Puppet {
    let mut own = Puppet::new();
    own.manager(TopicKind::Order, order("a", 0, 0, &WAY[..2], 2));
    own.is_at("a", 0, 0, &[2], 0.0, false);
    own.is_at("a", 0, 2, &[], 5.0, false);
    own.manager(TopicKind::Order, order("a", 1, 2, &WAY[1..], 2));
    own.lasts(0.5);
    assert_eq!(own.got.last().unwrap().1["orderUpdateId"], 1);
    own
}

/// It had nothing ahead any more, a second `cancelOrder` had failed, and it was still braking: its way was given to others.
#[test]
fn a_vehicle_that_brakes_keeps_its_way() {
    for is_second in [false, true] {
        let mut own = driving();
        own.cancels("c1");
        if is_second {
            own.cancels("c2");
        }
        own.ends(if is_second { "c2" } else { "c1" }, "FAILED");
        own.is_at("a", 0, 0, &[], 2.0, true);
        own.is_at("a", 0, 0, &[], 3.0, true);
        assert!(own.has_job() && own.robot().course.length() > 9.0, "it drives");
        own.is_at("a", 0, 0, &[], 3.5, false);
        assert!(!own.has_job() && own.robot().course.length() == 0.0);
    }
}

/// The cancellation came first: the vehicle took the update afterwards, when its way had been given to others.
#[test]
fn an_update_may_come_after_the_cancellation() {
    for is_taken in [false, true] {
        let mut own = waiting();
        own.cancels("c1");
        own.ends("c1", "FINISHED");
        own.lasts(20.0);
        assert!(own.has_job(), "the update may still come");
        if is_taken {
            own.is_at("a", 1, 2, &[4], 6.0, true);
            own.lasts(2.0);
            let again = own.asked("cancelOrder");
            assert!(again.len() >= 2 && own.has_job(), "{again:?}");
            own.ends(again.last().unwrap(), "FINISHED");
            own.is_at("a", 1, 2, &[], 7.0, false);
            assert!(!own.has_job());
            continue;
        }
        own.lasts(45.0);
        let again = own.asked("cancelOrder");
        assert_eq!((again.len(), own.has_job()), (2, true), "until that is answered");
        own.ends(&again[1], "FAILED");
        own.lasts(1.0);
        assert!(!own.has_job());
    }
}

/// With the update lost, nothing ever ended a cancelled order.
#[test]
fn a_cancelled_order_of_which_an_update_was_lost_is_over() {
    for is_restarted in [false, true] {
        let mut own = waiting();
        own.cancels("c1");
        own.ends("c1", "FAILED");
        own.lasts(2.0);
        if is_restarted {
            own.restart();
        }
        own.lasts(65.0);
        let again = own.asked("cancelOrder");
        own.ends(again.last().unwrap(), "FAILED");
        own.lasts(1.0);
        assert!(!own.has_job(), "{is_restarted}");
        own.manager(TopicKind::Order, order("b", 0, 0, &[WAY[1], WAY[0]], 2));
        own.lasts(1.0);
        assert_eq!(own.got.last().unwrap().1["orderId"], "b");
    }
}

/// Somebody at the vehicle ended its order, which it still names: to the manager it was under way for ever.
#[test]
fn a_vehicle_that_drops_its_order_has_lost_it() {
    for is_patient in [false, true] {
        let mut own = driving();
        own.is_at("a", 0, 0, &[], 3.0, false);
        own.lasts(3.0);
        assert_eq!(own.told["nodeStates"].as_array().map(Vec::len), Some(0), "{}", own.told);
        assert!(own.has_job());
        if is_patient {
            own.lasts(35.0);
            assert!(!own.has_job());
            assert_eq!(own.asked("cancelOrder").len(), 1, "it may have it all the same");
        }
        own.manager(TopicKind::Order, order("b", 0, 0, &[[3.0, 0.0], [0.0, 0.0]], 2));
        own.lasts(1.0);
        assert_eq!(own.got.last().unwrap().1["orderId"], "b");
    }
}

/// Each state was followed by another `cancelOrder`.
#[test]
fn a_second_cancellation_is_no_storm() {
    let mut own = driving();
    own.cancels("c1");
    own.ends("c1", "RUNNING");
    own.cancels("c2");
    own.ends("c2", "FAILED");
    own.is_at("a", 0, 0, &[2, 4], 2.0, true);
    own.lasts(10.0);
    assert_eq!(own.asked("cancelOrder"), ["c1", "c2"]);
    own.ends("c1", "FINISHED");
    own.is_at("a", 0, 0, &[], 3.0, false);
    assert!(!own.has_job());
    // Where the first one is not listed: once in a second.
    let mut own = driving();
    own.cancels("c");
    own.ends("c", "FAILED");
    for _ in 0..40 {
        own.time -= 0.4;
        own.lasts(0.1);
        for id in own.asked("cancelOrder") {
            own.ends(&id, "FAILED");
        }
    }
    let count = own.asked("cancelOrder").len();
    assert!((2..=6).contains(&count), "{count}");
}

/// It was let go while it still braked: it paused afterwards, and that was taken for a pause of somebody else.
#[test]
fn a_pause_that_begins_after_it_was_ended_is_ended_again() {
    for status in ["FAILED", "FINISHED"] {
        let mut own = driving();
        let abilities = own.robot().abilities.clone();
        let start = pcr_serve::owned_path::StartPose { x: 6.0, y: 0.0, heading: 0.0 };
        own.supervisor.add("new", abilities, start).unwrap();
        own.lasts(0.5);
        let pause = own.asked("startPause").pop().unwrap();
        own.ends(&pause, "RUNNING");
        own.lasts(0.5);
        own.supervisor.remove("new").unwrap();
        own.lasts(0.5);
        own.ends(&own.asked("stopPause")[0].clone(), status);
        own.lasts(2.0);
        own.ends(&pause, "FINISHED");
        (own.state["paused"], own.state["driving"]) = (true.into(), false.into());
        let before = own.asked("stopPause").len();
        own.lasts(1.0);
        assert!(own.asked("stopPause").len() > before, "{status}");
        let last = own.asked("stopPause").pop().unwrap();
        own.ends(&last, "FINISHED");
        own.state["paused"] = false.into();
        own.lasts(1.0);
        let after = own.asked("stopPause").len();
        // Now it is somebody else.
        own.state["paused"] = true.into();
        own.lasts(5.0);
        assert_eq!(own.asked("stopPause").len(), after, "{status}");
    }
}
