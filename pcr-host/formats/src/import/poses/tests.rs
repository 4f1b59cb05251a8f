use super::*;

fn read(text: &str, top_speed: f64) -> Result<(PoseLog, Vec<String>), String> {
    let options = ImportOptions { radius: Some(0.4), ..ImportOptions::default() };
    let poses_options = PoseOptions { top_speed: Some(top_speed), ..PoseOptions::default() };
    let mut warnings = Warnings::default();
    let log = poses(text, &options, &poses_options, &mut warnings).map_err(|error| error.in_file("f"))?;
    Ok((log, warnings.lines()))
}

fn plan(text: &str) -> Result<PoseLog, String> {
    let options = ImportOptions { radius: Some(0.4), ..ImportOptions::default() };
    poses(text, &options, &PoseOptions::default(), &mut Warnings::default()).map_err(|error| error.in_file("f"))
}

const TABLE: &str = "id,t,x,y,map\n1,0,0,0,a\n2,0,5,5,a\n1,1,1,0,a\n1,2,1,0,b\n";

#[test]
fn a_table_is_read_and_a_way_between_maps_is_not_known() {
    let (log, warnings) = read(TABLE, 2.0).unwrap();
    assert_eq!((log.tracks.len(), warnings.len(), log.maps), (2, 0, vec!["a".to_owned(), "b".to_owned()]));
    let joined: Vec<bool> = log.tracks[0].poses.iter().map(|pose| pose.is_joined).collect();
    assert_eq!(joined, [false, true, false]);
}

#[test]
fn damaged_tables_are_refused_by_position() {
    for (from, to, expected) in [
        ("1,1,1,0,a", "1,1,1,x,a", "f:4:7: \"x\" where a number is expected"),
        ("1,1,1,0,a", "1,1,1,0", "f:4:8: 4 fields, and the header has 5"),
        ("1,2,1,0,b", "1,0.5,1,0,b", "f:5:1: agent 1: its time goes back, from that of line 4"),
        ("1,2,1,0,b", "1,1,1,3,b", "f:5:1: agent 1: at the same time as in line 4, at another place"),
        (
            "1,1,1,0,a",
            "1,1,9,0,a",
            "f:4:1: agent 1: 9.000 m from the pose before, in 1.000 s; at --top-speed 2 it does not get here",
        ),
        ("1,1,1,0,a", "1,2026-05-04T10:00:00Z,1,0,a", "f:4:3: seconds among time stamps, or the other way round"),
    ] {
        assert_eq!(read(&TABLE.replace(from, to), 2.0).unwrap_err(), expected);
    }
}

const PLAN: &str = "agents=2\nsolved=1\nmakespan=1\nsolution=\n0:(0,0),(2,0),\n1:(1,0),(2,0),\n";

#[test]
fn plans_on_grids_are_exact_and_damaged_ones_are_refused() {
    assert_eq!(plan(PLAN).unwrap().between, BetweenPoses::Straight(0.0));
    for (from, to, expected) in [
        ("solved=1", "solved=0", "f:2:1: solved=0: the file says that there is no plan"),
        ("1:(1,0),(2,0),", "1:(1,0),", "f:6:9: 1 cells for 2 agents"),
        ("1:(1,0)", "1:(3,0)", "f:6:3: agent 0: this cell shares no side with the one before"),
        ("1:(1,0)", "2:(1,0)", "f:6:1: `1:` is expected"),
        ("1:(1,0),(2,0),\n", "", "f: makespan=1, and there are 1 configurations: the file was cut, or is another one"),
    ] {
        assert_eq!(plan(&PLAN.replace(from, to)).unwrap_err(), expected);
    }
    let schedule = "schedule:\n  a:\n    - {x: 0, y: 0, t: 0}\n    - {x: 1, y: 0, t: 1}\n";
    assert_eq!(plan(schedule).unwrap().between, BetweenPoses::Straight(0.0));
    // A wait and a step, or a slow one: nobody says which.
    assert!(plan(&schedule.replace("t: 1", "t: 3")).unwrap_err().contains("--deviation"));
}

#[test]
fn messages_are_read_and_contradictions_are_refused_by_position() {
    let message = |stamp: &str, serial: &str, x: f64, is_known: bool| {
        format!(
            "1777888800.5 uagv/v2/A/1/state {{\"timestamp\": \"2026-05-04T10:00:{stamp}Z\", \"version\": \"2.1.0\", \"manufacturer\": \"A\", \"serialNumber\": \"{serial}\", \"agvPosition\": {{\"x\": {x}, \"y\": 0, \"theta\": 0, \"mapId\": \"m\", \"positionInitialized\": {is_known}}}}}\n"
        )
    };
    let log = message("00", "1", 0.0, true) + &message("01", "1", 1.0, false) + &message("02", "1", 2.0, true);
    let (read_log, warnings) = read(&log, 2.0).unwrap();
    assert_eq!((read_log.tracks[0].poses.len(), read_log.tracks[0].poses[1].is_joined), (2, false));
    assert!(warnings[0].contains("not localized"), "{warnings:?}");
    let back = message("05", "1", 0.0, true) + &message("01", "1", 0.0, true);
    let problem = read(&back, 2.0).unwrap_err();
    assert!(problem.starts_with("f:2:46: state, timestamp: goes back, from that of line 1"), "{problem}");
    let other = read(&message("00", "2", 0.0, true), 2.0).unwrap_err();
    assert!(other.starts_with("f:1:") && other.ends_with("serialNumber: 2, and the topic says 1"), "{other}");
    let cut = &log[..log.len() - 9];
    assert!(read(cut, 2.0).unwrap_err().starts_with("f:3:"), "{:?}", read(cut, 2.0));
}

#[test]
fn what_is_neither_in_the_file_nor_given_is_asked_for() {
    let none = PoseOptions::default();
    let refusal = |text: &str, options: &ImportOptions| {
        poses(text, options, &none, &mut Warnings::default()).unwrap_err().to_string()
    };
    assert!(refusal(PLAN, &ImportOptions::default()).ends_with("its radius is not in the file; give --radius"));
    let round = ImportOptions { radius: Some(0.4), ..ImportOptions::default() };
    assert!(refusal(TABLE, &round).contains("give --deviation"));
    assert!(refusal("result:\n- states: [[0, 0, 0]]\n", &round).contains("give --step"));
}
