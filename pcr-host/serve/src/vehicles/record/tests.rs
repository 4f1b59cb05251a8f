use super::certify::windows;
use super::*;
use std::f64::consts::PI;

fn record(apart: f64) -> String {
    let vehicles = ["a", "b"].map(|name| RecordVehicle { name: name.into(), radius: Some(0.5), footprint: None });
    let mut record = RecordWriter::new(Vec::new(), &vehicles).unwrap();
    // Past one another with a distance of `apart`, there and back.
    for k in 0..=600 {
        let time = f64::from(k) * 0.1;
        let x = if k <= 300 { time } else { 60.0 - time };
        record.push(0, time, [x, 0.0], 0.0).unwrap();
        record.push(1, time, [20.0 - x.min(20.0), apart], 0.0).unwrap();
    }
    String::from_utf8(record.finish().unwrap()).unwrap()
}

#[test]
fn contacts_are_found_and_their_absence_is_proved() {
    let free = certify(record(1.001).as_bytes()).unwrap();
    assert_eq!((free.verdict, free.contacts.len(), free.undecided), ("proved", 0, 0), "{free:?}");
    assert!((free.travelled - 100.0).abs() < 1e-6 && (free.time - 60.0).abs() < 1e-9);
    let touched = certify(record(0.999).as_bytes()).unwrap();
    assert_eq!(touched.verdict, "contact");
    assert!(touched.contacts.len() >= 2 && touched.contacts[0].clearance < 0.0);
}

#[test]
fn a_record_that_was_cut_proves_nothing() {
    let whole = record(1.001);
    let lines: Vec<&str> = whole.lines().collect();
    for kept in (3..lines.len()).step_by(97).chain([lines.len() - 1]) {
        let cut = certify(lines[..kept].join("\n").as_bytes()).unwrap();
        assert_eq!((cut.verdict, cut.contacts.len()), ("undecided", 0), "{kept} lines");
        assert_eq!(cut.error.unwrap(), "the record is cut: its last line is missing");
    }
    let mut gap = lines.clone();
    gap.drain(100..300);
    let gap = certify(gap.join("\n").as_bytes()).unwrap();
    assert_eq!(gap.verdict, "undecided");
    assert!(gap.error.unwrap().starts_with("the record is cut: it has "));
    let other = certify(whole.replacen("\"radius\":0.5", "\"radius\":0.4", 1).as_bytes()).unwrap();
    assert_eq!(other.error.unwrap(), "the record is not as it was written: its checksum is another one");
    assert_eq!(other.verdict, "undecided");
    // Records written by hand need no checksum.
    let end = whole.rfind(",\"crc32\"").unwrap();
    assert_eq!(certify(format!("{}}}", &whole[..end]).as_bytes()).unwrap().verdict, "proved");
    let twice = certify(format!("{whole}{whole}").as_bytes()).unwrap_err();
    assert_eq!(twice.to_string(), format!("line {}: it comes after the last line of a record", lines.len() + 1));
    // A contact is one, whatever comes after it.
    let touched = record(0.999);
    let most = touched.rsplit_once("\n{").unwrap().0;
    assert_eq!(certify(most.as_bytes()).unwrap().verdict, "contact");
}

/// Within a line it was refused as one that is no record.
#[test]
fn a_record_that_was_cut_at_any_byte_proves_nothing() {
    let whole = record(1.001);
    let head = whole.find('\n').unwrap() + 1;
    for end in
        (head..head + 200).chain((head + 200..whole.len()).step_by(1009)).chain(whole.len() - 40..whole.len() - 1)
    {
        let cut = certify(&whole.as_bytes()[..end]).unwrap();
        assert_eq!((cut.verdict, cut.contacts.len(), cut.vehicles), ("undecided", 0, 2), "{end}");
        assert_eq!(cut.error.unwrap(), "the record is cut: its last line is missing");
    }
    assert_eq!(certify(&whole.as_bytes()[..whole.len() - 1]).unwrap().verdict, "proved");
    // A contact that is in the record remains a contact.
    let touched = record(0.999);
    assert_eq!(certify(&touched.as_bytes()[..touched.len() - 50]).unwrap().verdict, "contact");
    // A record with further lines was not cut, nor one without the names of its vehicles.
    let broken = whole.replacen("]\n", "\n", 1);
    assert!(certify(broken.as_bytes()).unwrap_err().to_string().starts_with("line 2: "));
    assert!(certify(&whole.as_bytes()[..head - 5]).unwrap_err().to_string().starts_with("line 1: "));
}

/// With ways of 10 million kilometres, rounding would hide contacts of a millionth of a metre.
#[test]
fn what_rounding_would_hide_is_refused() {
    let record = |points: &str| {
        let head =
            r#"{"format":"pcr-record","version":2,"vehicles":[{"name":"a","radius":0.5},{"name":"b","radius":0.5}]}"#;
        let text = format!("{head}\n{points}\n{{\"lines\":{}}}", points.lines().count());
        certify(text.as_bytes())
    };
    let far = record("[0,0.0,0.0,0.0]\n[0,1.0,1e8,0.0]\n[1,0.0,0.0,5.0]").unwrap_err().to_string();
    assert_eq!(far, "line 3: coordinates up to 1e7 m are expected, not 1e8");
    let fast = record("[0,0.0,0.0,0.0]\n[0,1.0,5000.0,0.0]\n[1,0.0,0.0,5.0]").unwrap_err().to_string();
    assert_eq!(fast, "line 3: speeds up to 1e3 m/s are expected, not 5e3");
    let again = record("[0,0.0,0.0,0.0]\n[0,0.0,0.0,0.0]\n[1,0.0,0.0,5.0]").unwrap_err().to_string();
    assert_eq!(again, "line 3: not later than the line before of this vehicle");
    for (time, told) in [("1e300", "1e300"), ("-1e12", "-1e12"), ("10000000001.0", "1.0000000001e10")] {
        let late = record(&format!("[1,{time},0.0,5.0]\n[0,0.0,0.0,0.0]")).unwrap_err().to_string();
        assert_eq!(late, format!("line 2: times up to 1e10 s are expected, not {told}"));
    }
    // As far as is allowed, on ways with many turns, discs that overlap by less than a micrometre.
    for k in 0..50 {
        let (mut points, base) = (String::new(), 9.9e6);
        for step in 0..=200 {
            let (time, side) = (f64::from(step) * 0.1, f64::from((step * 7 + k) % 11) * 5.0);
            let last = step == 200;
            let [x, y] = if last { [base, -base] } else { [base - 60.0 + side, -base + 40.0 - side] };
            points += &format!("[0,{time:?},{x:?},{y:?}]\n");
        }
        points += &format!("[1,0.0,{:?},{:?}]", base + 1.0 - 1e-6, -base);
        assert_eq!(record(&points).unwrap().verdict, "contact", "{k}");
    }
}

/// From time to time a line, for three hundred years.
#[test]
fn times_without_lines_take_no_time() {
    let head =
        r#"{"format":"pcr-record","version":2,"vehicles":[{"name":"a","radius":0.5},{"name":"b","radius":0.5}]}"#;
    let found = |points: &str| {
        let text = format!("{head}\n{points}\n{{\"lines\":{}}}", points.lines().count());
        certify(text.as_bytes()).unwrap()
    };
    let free = found("[0,-1e10,0,0]\n[0,1e10,100,0]\n[1,0,50,1.001]");
    assert_eq!((free.verdict, free.time, free.travelled), ("proved", 2e10, 100.0), "{free:?}");
    let touched = found("[0,-1e10,0,0]\n[0,1e10,100,0]\n[1,0,50,0.999]");
    assert_eq!((touched.verdict, touched.undecided), ("contact", 0), "{touched:?}");
    // A second at full speed in between.
    let fast = |side: f64| format!("[0,0,0,0]\n[0,1e9,0,0]\n[0,1000000001,900,0]\n[0,1e10,900,0]\n[1,5e9,450,{side}]");
    assert_eq!(found(&fast(1.001)).verdict, "proved");
    let touched = found(&fast(0.999));
    assert_eq!((touched.verdict, touched.contacts.len()), ("contact", 1), "{touched:?}");
    assert!((touched.contacts[0].time - 1e9 - 0.5).abs() < 0.01, "{touched:?}");
}

#[test]
fn windows_are_few_and_leave_nothing_out() {
    assert_eq!(windows(&[3.0]), [[3.0, 3.0]]);
    assert_eq!(windows(&[0.0, 1.0, 30.0, 40.0]), [[0.0, 20.0], [20.0, 40.0]]);
    assert_eq!(windows(&[0.0, 0.0, 1e9, 1e9 + 5.0]), [[0.0, 1e9], [1e9, 1e9 + 5.0]]);
    assert_eq!(windows(&[0.0, 10.0, 100.0]), [[0.0, 20.0], [20.0, 100.0]]);
}

#[test]
fn what_is_no_record_is_refused() {
    let text = record(2.0);
    for (from, to) in [("pcr-record", "pcr-plan"), ("[1,", "[2,"), ("[0,0.1,", "[0,99.0,")] {
        assert!(certify(text.replacen(from, to, 1).as_bytes()).is_err(), "{to}");
    }
    for radius in ["0.0", "-0.0", "-0.5"] {
        let error =
            certify(text.replacen("\"radius\":0.5", &format!("\"radius\":{radius}"), 1).as_bytes()).unwrap_err();
        assert!(error.to_string().starts_with("line 1: a radius above 0 is expected"), "{error}");
    }
    let nobody = certify(&br#"{"format":"pcr-record","version":2,"vehicles":[]}"#[..]).unwrap_err();
    assert_eq!(nobody.to_string(), "line 1: no vehicles");
    let one = "{\"format\":\"pcr-record\",\"version\":2,\"vehicles\":[{\"name\":\"a\",\"radius\":0.5}]}\n[0,0,0,0]\n{\"lines\":1}";
    let alone = certify(one.as_bytes()).unwrap_err();
    assert_eq!(alone.to_string(), "line 1: there are no two vehicles, of which contacts could be certified");
    assert!(certify(&b""[..]).is_err());
    let nowhere = certify(format!("{}\n{{\"lines\":0}}", text.lines().next().unwrap()).as_bytes()).unwrap_err();
    assert_eq!(nowhere.to_string(), "line 1: nothing about a");
}

/// A truck, 1.2 m long and 0.8 m wide, and what passes it.
fn beside_a_truck(other: RecordVehicle, points: impl Fn(f64) -> [f64; 3]) -> RecordCertificate {
    let truck = Footprint::new(vec![[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]]).unwrap();
    let truck = RecordVehicle { name: "truck".into(), radius: None, footprint: Some(truck) };
    let mut record = RecordWriter::new(Vec::new(), &[truck, other]).unwrap();
    for k in 0..=600 {
        let time = f64::from(k) * 0.1;
        record.push(0, time, [0.5 * time - 15.0, 0.0], 0.0).unwrap();
        let [x, y, heading] = points(time);
        record.push(1, time, [x, y], heading).unwrap();
    }
    certify(record.finish().unwrap().as_slice()).unwrap()
}

fn truck() -> RecordVehicle {
    let footprint = Footprint::new(vec![[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]]).unwrap();
    RecordVehicle { name: "other".into(), radius: None, footprint: Some(footprint) }
}

#[test]
fn outlines_are_judged_as_they_are() {
    let disc = || RecordVehicle { name: "disc".into(), radius: Some(0.5), footprint: None };
    for (apart, verdict) in [(0.001, "proved"), (-0.001, "contact")] {
        // In the opposite lane, with its heading half a turn beyond the largest one that is written.
        let passes =
            beside_a_truck(truck(), |time| [15.0 - 0.5 * time, 0.8 + apart, if time < 30.0 { PI } else { -PI }]);
        assert_eq!((passes.verdict, passes.undecided), (verdict, 0), "{passes:?}");
        let passes = beside_a_truck(disc(), |time| [15.0 - 0.5 * time, 0.9 + apart, 0.0]);
        assert_eq!((passes.verdict, passes.undecided), (verdict, 0), "{passes:?}");
        // It stands and turns, on and on: its corners are up to 0.7211 m from where it stands.
        let corner = 0.6_f64.hypot(0.4);
        let turns = beside_a_truck(truck(), |time| [0.0, 0.4 + corner + apart, (2.9 * time) % 6.0]);
        assert_eq!((turns.verdict, turns.undecided), (verdict, 0), "{turns:?}");
    }
    // It goes round a corner with its heading, and turns while it moves.
    let bends = beside_a_truck(truck(), |time| {
        let (sin, cos) = (0.05 * time).sin_cos();
        [20.0 * sin, 25.0 - 20.0 * cos, 0.05 * time]
    });
    assert_eq!(bends.verdict, "proved", "{bends:?}");
    assert!((bends.travelled - 90.0).abs() < 0.1, "{}", bends.travelled);
    // The truck drives between the prongs of a fork, which is concave.
    let fork = vec![[0.0, -1.5], [3.0, -1.5], [3.0, -0.5], [0.3, -0.5], [0.3, 0.5], [3.0, 0.5], [3.0, 1.5], [0.0, 1.5]];
    let fork = RecordVehicle { name: "fork".into(), radius: None, footprint: Some(Footprint::new(fork).unwrap()) };
    let inside = beside_a_truck(fork.clone(), |_| [16.0, 0.0, PI]);
    assert_eq!((inside.verdict, inside.undecided), ("proved", 0), "{inside:?}");
    let struck = beside_a_truck(fork, |_| [15.8, 0.0, PI]);
    assert_eq!(struck.verdict, "contact", "{struck:?}");
}

#[test]
fn headings_belong_to_outlines() {
    let mut own = RecordWriter::new(Vec::new(), &[truck(), truck()]).unwrap();
    (0..2).for_each(|k| own.push(k, 0.0, [3.0 * k as f64, 0.0], 0.5).unwrap());
    let text = String::from_utf8(own.finish().unwrap()).unwrap();
    assert!(text.contains("\n[1,0.0,3.0,0.0,0.5]\n"), "{text}");
    let head = text.lines().next().unwrap();
    let read = |head: &str, line: &str| {
        certify(format!("{head}\n{line}\n{{\"lines\":1}}").as_bytes()).unwrap_err().to_string()
    };
    assert_eq!(read(head, "[0,0,0,0]"), "line 2: the heading is missing");
    assert_eq!(read(head, "[0,0,0,0,1e5]"), "line 2: headings up to 1e4 rad are expected, not 1e5");
    let early = read(&head.replace("\"version\":3", "\"version\":2"), "[0,0,0,0,0]");
    assert_eq!(early, "line 1: a footprint of other in a record of version 2");
    let discs = record(1.001);
    assert_eq!(read(discs.lines().next().unwrap(), "[0,0,0,0,0]"), "line 2: a disc has no heading");
    let both = head.replacen("\"footprint\"", "\"radius\":1,\"footprint\"", 1);
    assert_eq!(read(&both, "[0,0,0,0,0]"), "line 1: a radius or a footprint of other is expected");
}
