//! Bags of ROS 2, written by programs that share nothing with the reader (`tests/data/bags/make.py`).

use pcr_formats::import::{ImportOptions, PoseLog, PoseOptions, Warnings, poses_in_bag};
use pcr_formats::splitmix64::SplitMix64;
use pcr_planning::approaches::ApproachReport;
use std::f64::consts::{FRAC_PI_2, TAU};

const LOCALIZED: &[u8] = include_bytes!("../data/bags/localized.mcap");
const FRAMES: &[u8] = include_bytes!("../data/bags/frames.mcap");
const FLEET: &[u8] = include_bytes!("../data/bags/fleet.mcap");
const PLANS: &[u8] = include_bytes!("../data/bags/plans.mcap");

fn read(bytes: &[u8], topics: &[&str]) -> Result<(PoseLog, Vec<String>), String> {
    let options = ImportOptions { radius: Some(0.4), ..ImportOptions::default() };
    let topics = topics.iter().map(ToString::to_string).collect();
    let pose_options = PoseOptions { deviation: Some(0.0), topics, ..PoseOptions::default() };
    let mut warnings = Warnings::default();
    let log = poses_in_bag(&mut &*bytes, &options, &pose_options, &mut warnings).map_err(|error| error.to_string())?;
    Ok((log, warnings.lines()))
}

/// The poses of `left` and `up` are those that the script says.
fn is_the_crossing(log: &PoseLog, names: [&str; 2], map: &str) {
    let labels: Vec<String> = log.tracks.iter().map(|track| log.labels.display_name(track.id)).collect();
    assert_eq!(labels, names.iter().enumerate().map(|(id, name)| format!("{id} {name}")).collect::<Vec<_>>());
    assert_eq!((log.maps.as_slice(), log.origin.as_deref()), ([map.to_owned()].as_slice(), Some("1780000000")));
    for (track, is_left) in log.tracks.iter().zip([true, false]) {
        assert_eq!(track.poses.len(), 13);
        for (k, pose) in track.poses.iter().enumerate() {
            let t = 0.5 * k as f64;
            let (point, heading) = if is_left { ([t, 0.0], 0.0) } else { ([3.0, t - 3.0], FRAC_PI_2) };
            let turn = pose.heading.unwrap() - heading;
            let turn = turn - TAU * (turn / TAU).round();
            assert!((pose.t - t).abs() < 1e-9 && turn.abs() < 1e-6, "{pose:?}");
            assert!(pose.point.iter().zip(point).all(|(a, b)| (a - b).abs() < 1e-12), "{pose:?}");
            assert_eq!(pose.is_joined, k > 0);
        }
    }
    let report = ApproachReport::compute("", log, true, Vec::new(), &|_, _| {}).unwrap();
    let [approach] = report.approaches.as_slice() else { panic!("{:?}", report.approaches) };
    // Centres are √2 |t − 3| apart.
    let half = 0.8 / 2_f64.sqrt();
    assert!((approach.t[0] - (3.0 - half)).abs() < 1e-6 && (approach.t[1] - (3.0 + half)).abs() < 1e-6, "{approach:?}");
    assert!(report.has_contact() && report.closest.unwrap()[0].separation[1] < 1e-6);
}

#[test]
fn stamped_poses_and_odometry_are_read_by_the_namespaces_of_their_topics() {
    let (log, warnings) = read(LOCALIZED, &["amcl_pose", "ground_truth"]).unwrap();
    is_the_crossing(&log, ["left", "up"], "map");
    let unread = "topics: not read: /left/note (std_msgs/msg/String), /left/goal_pose (geometry_msgs/msg/PoseStamped)";
    assert!(warnings.len() == 1 && warnings[0].starts_with(unread), "{warnings:?}");
}

#[test]
fn frames_are_composed_and_fleets_and_plans_are_read() {
    is_the_crossing(&read(FRAMES, &[]).unwrap().0, ["left", "up"], "map");
    is_the_crossing(&read(FLEET, &[]).unwrap().0, ["carts/left", "carts/up"], "L1");
    is_the_crossing(&read(PLANS, &["plan"]).unwrap().0, ["left", "up"], "map");
}

#[test]
fn a_vehicle_has_poses_of_one_topic() {
    let error = read(LOCALIZED, &[]).unwrap_err();
    assert_eq!(error, "vehicle left: poses in /left/amcl_pose and in /left/goal_pose; say by --topic which to read");
    assert_eq!(read(LOCALIZED, &["amcl"]).unwrap_err(), "--topic amcl: there is no such topic in it");
    let error = read(LOCALIZED, &["note"]).unwrap_err();
    assert_eq!(error, "--topic /left/note: messages of std_msgs/msg/String, in which no pose is read");
    // Plans are no motions, unless they are asked for.
    assert_eq!(read(PLANS, &[]).unwrap_err(), "there is no pose in it");
}

#[test]
fn a_bag_cut_anywhere_is_an_error() {
    for (whole, topics) in [(LOCALIZED, ["amcl_pose"].as_slice()), (FRAMES, &[]), (FLEET, &[]), (PLANS, &["plan"])] {
        assert!(read(whole, topics).is_ok());
        for length in 0..whole.len() {
            assert!(read(&whole[..length], topics).is_err(), "{length} of {}", whole.len());
        }
        let cut = read(&whole[..whole.len() / 2], topics).unwrap_err();
        assert!(cut.starts_with("the bag ends before its footer"), "{cut}");
    }
}

#[test]
fn a_damaged_bag_is_an_error_or_is_read_as_it_was() {
    let mut random = SplitMix64(5);
    let mut refused = 0;
    for (whole, topics) in [(LOCALIZED, ["amcl_pose"].as_slice()), (FRAMES, &[]), (FLEET, &[]), (PLANS, &["plan"])] {
        let as_it_was = read(whole, topics).unwrap().0;
        for _ in 0..2000 {
            let mut damaged = whole.to_vec();
            let at = (random.unit() * damaged.len() as f64) as usize;
            damaged[at] ^= 1 << (random.unit() * 8.0) as u32;
            match read(&damaged, topics) {
                // In an index, or in a name that nothing depends on.
                Ok((log, _)) => assert_eq!(log, as_it_was, "bit in byte {at}"),
                Err(_) => refused += 1,
            }
        }
    }
    assert!(refused > 6000, "{refused}");
}
