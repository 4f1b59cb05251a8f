//! OpenDRIVE: lines and arcs as they are, joints closed, roads joined at shared nodes.

use pcr_formats::import::{ElementId, ImportOptions, InputFormat, Layout, LayoutEdge, Warnings, layout, scenario};
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use pcr_planning::exclusion_table::ExclusionTable;

const TOWN_1: &str = include_str!("../data/real/opendrive/Town01.planview.xodr");
const TOWN_2: &str = include_str!("../data/real/opendrive/Town02.planview.xodr");

fn read(text: &str) -> (Layout, Vec<String>) {
    let mut warnings = Warnings::default();
    let options = ImportOptions { radius: Some(0.9), ..ImportOptions::default() };
    let imported = layout(InputFormat::OpenDrive, text, &options, &mut warnings).unwrap();
    (imported.layout, warnings.lines())
}

#[test]
fn every_record_is_a_line_or_an_arc() {
    for (text, roads, lines, arcs, kilometres) in [(TOWN_1, 98, 240, 112, 3.92), (TOWN_2, 68, 329, 81, 1.76)] {
        assert_eq!(InputFormat::detect("town".as_ref(), text), Some(InputFormat::OpenDrive));
        let (layout, warnings) = read(text);
        let pieces = || layout.edges.iter().flat_map(|edge| &edge.curve);
        let is_line = |shape: &PathSegment| matches!(shape, PathSegment::Line { .. });
        // Records without length are not there.
        let empty = text.matches("length=\"0.0000000000000000e+0\"><").count();
        assert_eq!(layout.edges.len(), roads);
        let found = [
            pieces().filter(|piece| is_line(&piece.shape)).count(),
            pieces().filter(|piece| !is_line(&piece.shape)).count(),
        ];
        assert!(found[0] + found[1] + empty == lines + arcs && found[1] <= arcs, "{found:?} {empty}");
        let length: f64 = layout.edges.iter().map(LayoutEdge::length).sum();
        assert!((length / 1000.0 - kilometres).abs() < 0.005, "{length}");
        for piece in pieces() {
            if let PathSegment::Arc { radius, .. } = piece.shape {
                assert!((2.69..512.0).contains(&radius), "{radius}");
            }
        }
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        assert!(warnings[0].contains("joints are open, by "), "{warnings:?}");
        assert!(warnings[1].contains("from its curve, by which the vehicle is larger"), "{warnings:?}");
    }
}

#[test]
fn linked_roads_share_nodes() {
    for text in [TOWN_1, TOWN_2] {
        let (layout, _) = read(text);
        assert!(layout.nodes.len() < 2 * layout.edges.len());
        for edge in &layout.edges {
            let (first, last) = (edge.curve.first().unwrap(), edge.curve.last().unwrap());
            for (node, at) in edge.ends.into_iter().zip([first.start, last.end()]) {
                let [x, y] = layout.nodes[node].point;
                assert!((x - at[0]).hypot(y - at[1]) < 0.05, "road {}: {x} {y} {at:?}", edge.id);
            }
        }
    }
}

#[test]
fn paths_keep_to_the_records() {
    let (layout, _) = read(TOWN_1);
    let options = |k: usize| {
        let [from, to] = layout.edges[k].ends.map(|node| &layout.nodes[node].id);
        ImportOptions { radius: Some(0.9), routes: vec![format!("{from}:{to}")], ..ImportOptions::default() }
    };
    let mut driven = 0;
    for (k, edge) in layout.edges.iter().enumerate().step_by(9) {
        let Ok(scenario) = scenario(InputFormat::OpenDrive, TOWN_1, &options(k), &mut Warnings::default()) else {
            panic!("road {}", edge.id);
        };
        let agent = &scenario.agents[0];
        // Open joints are margin, up to what the maps are off by, a little more for gaps of several.
        assert!(agent.radius >= 0.9 && agent.radius < 0.91, "road {}: {}", edge.id, agent.radius);
        driven += agent.path.len();
    }
    assert!(driven > 11);
}

#[test]
fn roads_that_start_together_lock_each_other() {
    let (layout, _) = read(TOWN_1);
    let options = ImportOptions { radius: Some(0.9), ..ImportOptions::default() };
    let imported =
        pcr_formats::import::layout(InputFormat::OpenDrive, TOWN_1, &options, &mut Warnings::default()).unwrap();
    let table = ExclusionTable::compute(&imported, false).unwrap();
    for (k, a) in layout.edges.iter().enumerate() {
        for b in layout.edges.iter().skip(k + 1).filter(|b| b.ends[0] == a.ends[0]) {
            let (first, second) = if a.id < b.id { (a, b) } else { (b, a) };
            let starts = table.locks.iter().any(|lock| {
                (&lock.a, &lock.b) == (&first.id, &second.id) && lock.a_length[0] <= 0.0 && lock.b_length[0] <= 0.0
            });
            assert!(starts, "{} {}", a.id, b.id);
        }
    }
}

#[test]
fn what_is_wrong_is_refused_by_name_and_left_out_if_asked_for() {
    let road = |id: &str, geometry: &str| format!("<road id=\"{id}\"><planView>{geometry}</planView></road>");
    let line = "<geometry x=\"0\" y=\"0\" hdg=\"0\" length=\"5\"><line/></geometry>";
    let file = |roads: &[String]| format!("<OpenDRIVE>{}</OpenDRIVE>", roads.concat());
    let other = line.replace("<line/>", "<bezier/>");
    let apart = line.replace("x=\"0\"", "x=\"6\"");
    let text = file(&[
        road("7", line),
        road("8", &other),
        road("9", &format!("{line}{apart}")),
        road("10", &line.replace("5", "1e300")),
        road("7", line),
        road("12", &line.replace("<line/>", "<arc curvature=\"1e4\"/>")),
        road("11", ""),
    ]);
    let error = layout_error(&text);
    let mut warnings = Warnings::default();
    let partial = ImportOptions { partial: true, ..ImportOptions::default() };
    let read = layout(InputFormat::OpenDrive, &text, &partial, &mut warnings).unwrap().layout;
    assert_eq!((read.edges.len(), read.nodes.len()), (1, 2));
    let warnings = warnings.lines().join("\n");
    for expected in [
        "road 8, geometry 1: bezier is not read",
        "road 9, geometry 2: it begins 1.000 m from the end of the one before",
        "road 10, geometry 1, length: \"1e300\" where a number up to 1e10 is expected",
        "road 12, geometry 1: its length, heading or sweep is out of range",
        "road 11: it has no geometry",
    ] {
        assert!(error.contains(expected), "{expected} in {error}");
        assert!(warnings.contains(expected), "{expected} in {warnings}");
    }
    assert!(warnings.contains("edge 7: given twice, the same each time"), "{warnings}");
    let failed = |text: &str| layout_error(text);
    assert_eq!(failed("<a/>"), "a: not an OpenDRIVE file");
    assert_eq!(failed(&file(&[])), "OpenDRIVE: there is no road in it that can be read");
    let expected = "road 1, geometry 1: bezier is not read; --partial leaves that out";
    assert_eq!(failed(&file(&[road("1", &other)])), expected);
    let two =
        format!("<planView>{line}</planView>{}", road("1", line).replace("<road id=\"1\">", "").replace("</road>", ""));
    assert!(failed(&file(&[format!("<road id=\"1\">{two}</road>")])).starts_with("road, planView: there are several"));
}

#[test]
fn limits_of_a_record_are_limits() {
    let geometry = |attribute: &str, value: &str| {
        let line = "<geometry x=\"0\" y=\"0\" hdg=\"0\" length=\"5\"><line/></geometry>";
        let zero = format!("{attribute}=\"{}\"", if attribute == "length" { "5" } else { "0" });
        let changed = line.replace(&zero, &format!("{attribute}=\"{value}\""));
        assert_ne!(changed, line);
        format!("<OpenDRIVE><road id=\"1\"><planView>{changed}</planView></road></OpenDRIVE>")
    };
    let out = "road 1, geometry 1: its length, heading or sweep is out of range; --partial leaves that out";
    for (attribute, value) in [("length", "-5"), ("length", "-1e-9"), ("hdg", "1.1e6"), ("hdg", "-1.1e6")] {
        assert_eq!(layout_error(&geometry(attribute, value)), out, "{attribute} {value}");
    }
    assert_eq!(read(&geometry("hdg", "1e6")).0.edges.len(), 1);
}

#[test]
fn roads_have_the_least_of_their_speed_limits() {
    let limit =
        |max: &str, unit: &str| format!("<type s=\"0\" type=\"town\"><speed max=\"{max}\" unit=\"{unit}\"/></type>");
    let road = |limits: &str| {
        let line = "<geometry x=\"0\" y=\"0\" hdg=\"0\" length=\"5\"><line/></geometry>";
        format!("<OpenDRIVE><road id=\"1\">{limits}<planView>{line}</planView></road></OpenDRIVE>")
    };
    // 25 mph are 25 miles of 1609.344 m in 3600 s.
    let speed = |limits: &str| read(&road(limits)).0.edges[0].speed[0];
    assert!((speed(&limit("25", "mph")).unwrap() - 25.0 * 1609.344 / 3600.0).abs() < 1e-12);
    assert!((speed(&limit("36", "km/h")).unwrap() - 10.0).abs() < 1e-12);
    assert_eq!((speed(&limit("7", "m/s")), speed(&limit("no limit", "mph")), speed("")), (Some(7.0), None, None));
    assert_eq!((speed(&limit("0", "m/s")), speed(&limit("2e6", "m/s"))), (None, None), "no limits");
    // It took away the other one, and said that the least one is taken.
    let (layout, warnings) = read(&road(&[limit("7", "m/s"), limit("0", "m/s")].concat()));
    assert_eq!((layout.edges[0].speed[0], warnings.len()), (Some(7.0), 0), "{warnings:?}");
    let (layout, warnings) = read(&road(&[limit("7", "m/s"), limit("5", "m/s"), limit("6", "m/s")].concat()));
    assert_eq!(layout.edges[0].speed[0], Some(5.0));
    assert_eq!(warnings, ["road 1: its speed limit changes on the way; the least one is taken for all of it"]);
    let unknown = layout_error(&road(&limit("7", "knots")));
    assert!(unknown.starts_with("road 1, speed, unit: knots is not known"), "{unknown}");
}

#[test]
fn an_arc_that_is_nearly_straight_counts_as_deviation() {
    let arc = "<geometry x=\"0\" y=\"0\" hdg=\"0\" length=\"10000\"><arc curvature=\"1e-10\"/></geometry>";
    let text = format!("<OpenDRIVE><road id=\"1\"><planView>{arc}</planView></road></OpenDRIVE>");
    let edge = &read(&text).0.edges[0];
    // At its end the arc is L² / 2R from its tangent.
    assert!((edge.deviation - 5e-3).abs() < 1e-12, "{}", edge.deviation);
}

/// Where a curve is at a length.
fn place(curve: &[PlacedSegment], length: f64) -> [f64; 2] {
    let mut rest = length;
    for piece in curve {
        if rest < piece.shape.length() {
            let shape = match piece.shape {
                PathSegment::Arc { radius, sweep, .. } => PathSegment::arc(radius, (rest / radius).copysign(sweep)),
                _ => PathSegment::Line { length: rest },
            };
            return PlacedSegment { shape, ..*piece }.end();
        }
        rest -= piece.shape.length();
    }
    curve.last().unwrap().end()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[test]
fn open_joints_are_closed_and_count_as_deviation_along_and_across() {
    let records = [
        PlacedSegment::line([0.0, 0.0], [5.0, 0.0]),
        PlacedSegment::line([5.04, 0.0], [10.0, 0.0]),
        PlacedSegment { start: [10.03, 0.03], heading: 0.0, shape: PathSegment::arc(4.0, 1.5) },
        PlacedSegment { start: [14.0, 3.73], heading: 1.5, shape: PathSegment::arc(2.0, -1.0) },
        PlacedSegment::line([15.01, 5.37], [18.0, 6.9]),
    ];
    let written = records.map(|PlacedSegment { start: [x, y], heading, shape }| {
        let length = shape.length();
        let shape = match shape {
            PathSegment::Arc { radius, sweep, .. } => format!("<arc curvature=\"{}\"/>", sweep.signum() / radius),
            _ => "<line/>".to_owned(),
        };
        format!("<geometry x=\"{x}\" y=\"{y}\" hdg=\"{heading}\" length=\"{length}\">{shape}</geometry>")
    });
    let text = format!("<OpenDRIVE><road id=\"1\"><planView>{}</planView></road></OpenDRIVE>", written.concat());
    let (layout, warnings) = read(&text);
    assert!(warnings[0].contains("joints are open, by "), "{warnings:?}");
    let edge = &layout.edges[0];
    for pair in edge.curve.windows(2) {
        assert!(distance(pair[0].end(), pair[1].start) < 1e-12, "{pair:?}");
    }
    let all: f64 = records.iter().map(|record| record.shape.length()).sum();
    assert!((edge.length() - all).abs() > 0.02, "the gaps do not show in the length");
    let lengths = (0..=2000).map(|k| all.max(edge.length()) * f64::from(k) / 2000.0);
    let farthest =
        lengths.map(|length| distance(place(&records, length), place(&edge.curve, length))).fold(0.0, f64::max);
    assert!(
        farthest > 0.05 && farthest <= edge.deviation && edge.deviation < 2.5 * farthest,
        "{farthest} {}",
        edge.deviation
    );
}

/// Two roads share a node 4 cm from where one of them begins. There a vehicle touches one on the third road, 1.79 m away; at the end of
/// the other road it would not.
#[test]
fn locks_hold_what_is_between_a_road_and_its_node() {
    let road = |id: u8, [x, y, heading]: [f64; 3], link: &str| {
        let line = format!("<geometry x=\"{x}\" y=\"{y}\" hdg=\"{heading}\" length=\"5\"><line/></geometry>");
        format!("<road id=\"{id}\"><link>{link}</link><planView>{line}</planView></road>")
    };
    let next = "<successor elementType=\"road\" elementId=\"2\" contactPoint=\"start\"/>";
    let roads = [road(1, [0.0, 0.0, 0.0], next), road(2, [5.0, 0.04, -1.57], ""), road(3, [2.5, 1.83, 0.0], "")];
    let text = format!("<OpenDRIVE>{}</OpenDRIVE>", roads.concat());
    let options = ImportOptions { radius: Some(0.9), ..ImportOptions::default() };
    let imported = layout(InputFormat::OpenDrive, &text, &options, &mut Warnings::default()).unwrap();
    assert_eq!(imported.layout.nodes.len(), 5);
    let deviations: Vec<f64> = imported.layout.edges.iter().map(|edge| edge.deviation).collect();
    assert!(deviations[0] == 0.0 && (deviations[1] - 0.04).abs() < 1e-12 && deviations[2] == 0.0, "{deviations:?}");
    let table = ExclusionTable::compute(&imported, true).unwrap();
    let has = |a: u64, b: u64| {
        table.locks.iter().any(|lock| (lock.a.clone(), lock.b.clone()) == (ElementId::Number(a), ElementId::Number(b)))
    };
    assert!(has(2, 3) && !has(1, 3), "{:?}", table.locks);
    let nodes = table.nodes.unwrap();
    let at_node =
        nodes.iter().any(|lock| lock.node == ElementId::Text("1/end".into()) && lock.edge == ElementId::Number(3));
    assert!(at_node, "{nodes:?}");
    // A road that is linked to the second one, 4 cm further: 8 cm from the node, where no route passes.
    let third = "<predecessor elementType=\"road\" elementId=\"2\" contactPoint=\"start\"/>";
    let text = text.replace("</OpenDRIVE>", &format!("{}</OpenDRIVE>", road(4, [5.0, 0.08, -1.57], third)));
    let edge = &read(&text).0.edges[3];
    assert!((edge.deviation - 0.08).abs() < 1e-12, "{}", edge.deviation);
}

#[test]
fn different_roads_of_one_name_are_both_there() {
    let road = |y: &str| {
        let line = format!("<geometry x=\"0\" y=\"{y}\" hdg=\"0\" length=\"5\"><line/></geometry>");
        format!("<road id=\"3\"><planView>{line}</planView></road>")
    };
    let link = "<link><successor elementType=\"road\" elementId=\"3\" contactPoint=\"start\"/></link>";
    let linked = road("9").replace("<road id=\"3\">", &format!("<road id=\"4\">{link}"));
    let (layout, warnings) = read(&format!("<OpenDRIVE>{}{}{linked}</OpenDRIVE>", road("0"), road("1")));
    assert_eq!(layout.edges.iter().map(|edge| edge.id.to_string()).collect::<Vec<_>>(), ["3", "3#2", "4"]);
    let expected = "road 4, successor: there are several different edges 3; no route leads over it";
    assert!(warnings.contains(&expected.to_owned()), "{warnings:?}");
}

/// A road of 60 m that has less geometry, a hole in it, or two shapes in a record.
#[test]
fn roads_whose_geometry_has_holes_are_refused() {
    let road = |length: f64, records: &str| {
        format!("<OpenDRIVE><road id=\"1\" length=\"{length}\"><planView>{records}</planView></road></OpenDRIVE>")
    };
    let line = |s: f64, x: f64, shape: &str| {
        format!("<geometry s=\"{s}\" x=\"{x}\" y=\"0\" hdg=\"0\" length=\"30\">{shape}</geometry>")
    };
    let [first, second] = [line(0.0, 0.0, "<line/>"), line(30.0, 30.0, "<userData/><line/>")];
    assert_eq!(read(&road(60.0, &format!("{first}{second}"))).0.edges.len(), 1);
    for (text, expected) in [
        (road(60.0, &first), "road 1: its length is 60, and its records have 30.000 m"),
        (
            road(90.0, &format!("{first}{}", line(60.0, 30.0, "<line/>"))),
            "road 1, geometry 2: its s is 60, after 30.000 m of records",
        ),
        (road(30.0, &line(0.0, 0.0, "<line/><arc curvature=\"0.1\"/>")), "road 1, geometry 1: a second shape, arc"),
    ] {
        let error = layout_error(&text);
        assert!(error.contains(expected), "{expected} in {error}");
    }
}

fn layout_error(text: &str) -> String {
    layout(InputFormat::OpenDrive, text, &ImportOptions::default(), &mut Warnings::default()).unwrap_err().to_string()
}

/// Two roads, one after the other, and a third on another lane; the first road is linked to both.
fn lanes() -> String {
    let road = |id: &str, at: [f64; 2], link: &str| {
        let [x, y] = at;
        format!(
            "<road id=\"{id}\"><link>{link}</link><planView><geometry x=\"{x}\" y=\"{y}\" hdg=\"0\" length=\"10\">\
             <line/></geometry></planView></road>"
        )
    };
    let link = |side: &str, other: &str, point: &str| {
        format!("<{side} elementType=\"road\" elementId=\"{other}\" contactPoint=\"{point}\"/>")
    };
    let roads = [
        road("1", [0.0, 0.0], &link("successor", "2", "start")),
        road("2", [10.0, 0.0], &link("predecessor", "1", "end")),
        road("3", [10.0, 3.5], &link("predecessor", "1", "end")),
    ];
    format!("<OpenDRIVE><header name=\"lanes\"/>{}</OpenDRIVE>", roads.concat())
}

#[test]
fn routes_take_every_end_of_every_road() {
    let (layout, warnings) = read(&lanes());
    assert_eq!((layout.edges.len(), layout.nodes.len()), (3, 5));
    for text in [&lanes(), TOWN_1, TOWN_2] {
        let (layout, _) = read(text);
        for edge in &layout.edges {
            for (end, node) in ["start", "end"].into_iter().zip(edge.ends) {
                assert_eq!(layout.node(&format!("{}/{end}", edge.id)), Some(node), "{} {end}", edge.id);
            }
        }
    }
    let expected = "links of roads: 1 of 2 are between reference lines up to 3.500 m apart; no route passes there from road to road";
    assert_eq!(warnings, [expected]);
    let route = |route: &str| {
        let options = ImportOptions { radius: Some(0.9), routes: vec![route.into()], ..ImportOptions::default() };
        scenario(InputFormat::OpenDrive, &lanes(), &options, &mut Warnings::default())
            .map_err(|error| error.to_string())
    };
    assert_eq!(route("1/start:2/end").unwrap().agents[0].length(), 20.0);
    assert_eq!(route("1/end:2/end").unwrap(), route("2/start:2/end").unwrap());
    assert_eq!(route("1/start:3/end").unwrap_err(), "route 1/start:3/end: there is no way from node to node");
}

/// Of two ways the one without a gap is taken, also where the other one is shorter.
#[test]
fn joints_without_gaps_are_preferred() {
    let road = |id: &str, at: [f64; 2], length: f64, links: &str| {
        let [x, y] = at;
        format!(
            "<road id=\"{id}\"><link>{links}</link><planView><geometry x=\"{x}\" y=\"{y}\" hdg=\"0\" length=\"{length}\">\
             <line/></geometry></planView></road>"
        )
    };
    let link = |side: &str, other: &str, point: &str| {
        format!("<{side} elementType=\"road\" elementId=\"{other}\" contactPoint=\"{point}\"/>")
    };
    // From 1 to 9 over the short road 2, which lies 4 m beside, or over 3 and 4.
    let text = [
        road("1", [0.0, 0.0], 10.0, ""),
        road("2", [10.0, 4.0], 20.0, &(link("predecessor", "1", "end") + &link("successor", "9", "start"))),
        road("3", [10.0, 0.0], 10.0, &link("predecessor", "1", "end")),
        road("4", [20.0, 0.0], 10.0, &(link("predecessor", "3", "end") + &link("successor", "9", "start"))),
        road("9", [30.0, 0.0], 10.0, ""),
    ];
    let text = format!("<OpenDRIVE>{}</OpenDRIVE>", text.concat());
    let options = ImportOptions { radius: Some(0.9), routes: vec!["1/start:9/end".into()], ..ImportOptions::default() };
    let mut warnings = Warnings::default();
    let scenario = scenario(InputFormat::OpenDrive, &text, &options, &mut warnings).unwrap();
    assert_eq!(scenario.agents[0].length(), 40.0);
    assert!(
        warnings.lines().iter().any(|line| line.contains("2 of 5 are between reference lines up to 4.000 m apart"))
    );
}

#[test]
fn records_without_length_windings_and_open_joints() {
    let line = |x: f64, hdg: f64, length: f64| {
        format!("<geometry x=\"{x}\" y=\"0\" hdg=\"{hdg}\" length=\"{length}\"><line/></geometry>")
    };
    let road = |records: &str| format!("<OpenDRIVE><road id=\"1\"><planView>{records}</planView></road></OpenDRIVE>");
    let (layout, warnings) = read(&road(&[line(0.0, 0.0, 4.0), line(4.0, 0.0, 0.0), line(4.0, 0.0, 1.0)].concat()));
    assert_eq!((layout.edges[0].curve.len(), layout.edges[0].is_two_way(), warnings.len()), (2, true, 0));
    // The widest of three joints, angles to either side.
    let joints = [line(0.0, 0.0, 4.0), line(4.01, 1e-3, 4.0), line(8.01, -2e-3, 4.0), line(12.03, -2e-3, 1.0)];
    let (_, warnings) = read(&road(&joints.concat()));
    assert!(warnings[0].starts_with("road 1: joints are open, by 2.2e-2 m and 3.0e-3 rad at most;"), "{warnings:?}");
    let arc = |turns: f64| {
        let curvature = std::f64::consts::TAU * turns / 1000.0;
        road(&format!(
            "<geometry x=\"0\" y=\"0\" hdg=\"0\" length=\"1000\"><arc curvature=\"{curvature}\"/></geometry>"
        ))
    };
    assert_eq!((read(&arc(99.0)).0.edges.len(), read(&arc(-99.0)).0.edges.len()), (1, 1));
    assert!(
        layout_error(&arc(101.0)).contains("sweep is out of range")
            && layout_error(&arc(-101.0)).contains("sweep is out")
    );
}

/// They disappeared.
#[test]
fn roads_that_are_elsewhere_are_refused() {
    let road = |id: &str| {
        format!(
            "<road id=\"{id}\"><planView><geometry x=\"0\" y=\"0\" hdg=\"0\" length=\"5\"><line/></geometry></planView></road>"
        )
    };
    let file = |more: &str| format!("<OpenDRIVE>{}{more}</OpenDRIVE>", road("1"));
    for (parent, element) in
        [("junction", road("2")), ("group", road("2")), ("OpenDRIVE", road("2").replace("road", "Road"))]
    {
        let text =
            if parent == "OpenDRIVE" { file(&element) } else { file(&format!("<{parent}>{element}</{parent}>")) };
        let name = if parent == "OpenDRIVE" { "Road" } else { "road" };
        let error = layout_error(&text);
        assert!(error.starts_with(&format!("{name} 2, in {parent}: what is read is road in OpenDRIVE")), "{error}");
    }
    let mut warnings = Warnings::default();
    layout(InputFormat::OpenDrive, &file("<junction id=\"9\"/><way/>"), &ImportOptions::default(), &mut warnings)
        .unwrap();
    // What others add is called as they like.
    layout(
        InputFormat::OpenDrive,
        &file("<userData><Road a=\"1\"/></userData>"),
        &ImportOptions::default(),
        &mut Warnings::default(),
    )
    .unwrap();
    let unknown: Vec<_> = warnings.lines().into_iter().filter(|line| line.contains("not known")).collect();
    assert_eq!(unknown, ["way: not known in OpenDRIVE, and not read"]);
}

/// `01` and `1` were one name, and a speed below 0 was no limit.
#[test]
fn names_are_as_they_are_written_and_speeds_no_less_than_0() {
    let road = |id: &str, x: f64, more: &str| {
        format!(
            "<road id=\"{id}\">{more}<planView><geometry x=\"{x}\" y=\"0\" hdg=\"0\" length=\"5\"><line/></geometry></planView></road>"
        )
    };
    let file = |roads: &[String]| format!("<OpenDRIVE>{}</OpenDRIVE>", roads.concat());
    let text = file(&[road("1", 0.0, ""), road("01", 9.0, ""), road("+2", 18.0, "")]);
    let read =
        layout(InputFormat::OpenDrive, &text, &ImportOptions::default(), &mut Warnings::default()).unwrap().layout;
    assert_eq!(read.edges.iter().map(|edge| edge.id.to_string()).collect::<Vec<_>>(), ["1", "01", "+2"]);
    let error = layout_error(&file(&[road("1", 0.0, "<type><speed max=\"-3\"/></type>")]));
    assert!(error.starts_with("road 1, speed, max: -3 where a number from 0 is expected"), "{error}");
}
