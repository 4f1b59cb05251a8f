//! Buildings of Open-RMF: scales, levels, lanes and the limits of the fleets.

use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Layout, Warnings, layout, scenario};
use pcr_formats::scenario::{MotionSpec, Scenario};
use pcr_planning::exclusion_table::ExclusionTable;
use std::path::PathBuf;

const OFFICE: &str = include_str!("../data/real/rmf/office.building.yaml");
const TRIPLE_H: &str = include_str!("../data/real/rmf/triple_H.building.yaml");
const ROYALE: &str = include_str!("../data/real/rmf/battle_royale.building.yaml");
const HOTEL: &str = include_str!("../data/real/rmf/hotel.building.yaml");

fn fleet(name: &str) -> Option<PathBuf> {
    Some(PathBuf::from(format!("{}/data/real/rmf/config/{name}_config.yaml", env!("CARGO_MANIFEST_DIR"))))
}

fn read(text: &str, options: &ImportOptions) -> (ImportedLayout, Vec<String>) {
    let mut warnings = Warnings::default();
    let imported = layout(InputFormat::Rmf, text, options, &mut warnings).unwrap();
    (imported, warnings.lines())
}

fn tiny(routes: &[&str]) -> ImportOptions {
    ImportOptions {
        fleet: fleet("office_tinyRobot"),
        routes: routes.iter().map(ToString::to_string).collect(),
        ..ImportOptions::default()
    }
}

fn node(layout: &Layout, name: &str) -> [f64; 2] {
    layout.nodes[layout.node(name).unwrap()].point
}

#[test]
fn scales_are_the_mean_of_the_measurements() {
    // Pixels of a vertex of a lane, and the metres of a pixel.
    for (text, lanes, vertex, pixels, scale) in [
        (TRIPLE_H, 22, "L1/0", [46.368, 40.342], 0.044166),
        (OFFICE, 30, "", [0.0; 2], 0.008465),
        (ROYALE, 20, "", [0.0; 2], 0.052414),
        (HOTEL, 122, "", [0.0; 2], 0.055680),
    ] {
        let (imported, _) = read(text, &tiny(&[]));
        let layout = &imported.layout;
        assert_eq!(layout.edges.len(), lanes);
        assert!(layout.edges.iter().all(|edge| edge.is_two_way() && edge.speed == [None; 2]));
        if vertex.is_empty() {
            // The scale by the first lane of the file and its vertices.
            let lane = text.lines().skip_while(|line| !line.contains("lanes:")).nth(1).unwrap();
            let ends: Vec<usize> = lane.split(['[', ',']).filter_map(|part| part.trim().parse().ok()).take(2).collect();
            let vertices =
                text.lines().skip_while(|line| !line.trim_start().starts_with("vertices:") || line.contains('['));
            let vertices: Vec<[f64; 2]> = vertices
                .skip(1)
                .map_while(|line| {
                    let mut numbers = line.trim().strip_prefix("- [")?.split(',').map(|part| part.trim().parse().ok());
                    Some([numbers.next()??, numbers.next()??])
                })
                .collect();
            let [a, b] = [vertices[ends[0]], vertices[ends[1]]];
            let measured = layout.edges[0].length() / (a[0] - b[0]).hypot(a[1] - b[1]);
            assert!((measured / scale - 1.0).abs() < 1e-4, "{measured} {scale}");
        } else {
            let [x, y] = node(layout, vertex);
            // y points down in pixels.
            assert!((x / pixels[0] / scale - 1.0).abs() < 2e-5 && (-y / pixels[1] / scale - 1.0).abs() < 2e-5);
        }
    }
    let (office, warnings) = read(OFFICE, &tiny(&[]));
    let length: f64 = office.layout.edges.iter().map(|edge| edge.length()).sum();
    assert!((length - 68.6).abs() < 0.05, "{length}");
    // Its measurements differ by 0.3 %.
    assert!(warnings.iter().all(|line| !line.contains("measurement")), "{warnings:?}");
}

#[test]
fn fleets_have_their_limits() {
    let (ImportedLayout { vehicle, .. }, _) = read(OFFICE, &tiny(&[]));
    assert_eq!(
        (vehicle.name.as_deref(), vehicle.radius, vehicle.speed, vehicle.acceleration),
        (Some("tinyRobot"), 0.3, 0.5, 0.75)
    );
    assert_eq!((vehicle.margin * 1e9).round(), 0.2 * 1e9);
    assert_eq!((vehicle.rotation, vehicle.rotation_acceleration), (0.6, 2.0));
    let options = ImportOptions { radius: Some(1.5), fleet: fleet("hotel_cleanerBotA"), ..ImportOptions::default() };
    let (ImportedLayout { vehicle, .. }, warnings) = read(TRIPLE_H, &options);
    assert_eq!((vehicle.radius, vehicle.speed, warnings.len()), (1.5, 0.7, 0));
    let wrong = ImportOptions { fleet: Some("nowhere.yaml".into()), ..ImportOptions::default() };
    let error = layout(InputFormat::Rmf, OFFICE, &wrong, &mut Warnings::default()).unwrap_err().problem().to_owned();
    assert!(error.starts_with("nowhere.yaml: cannot be read"), "{error}");
}

#[test]
fn vehicles_stop_and_turn_at_corners() {
    let mut warnings = Warnings::default();
    let scenario = scenario(InputFormat::Rmf, TRIPLE_H, &tiny(&["TopLeft:TopCenterLeft"]), &mut warnings).unwrap();
    let agent = &scenario.agents[0];
    let turns: Vec<f64> =
        agent.path.iter().filter(|segment| segment.letter() == 'T').map(|turn| turn.sweep().abs()).collect();
    // Down, to the right, up again; the lanes between are straight to a hundredth of a radian.
    assert_eq!(turns.iter().filter(|turn| (**turn - std::f64::consts::FRAC_PI_2).abs() < 0.01).count(), 2, "{turns:?}");
    assert!(turns.iter().all(|turn| *turn < 0.01 || *turn > 1.5));
    let MotionSpec::Profile { pieces, .. } = &agent.motion else { panic!() };
    let duration: f64 = pieces.iter().map(|piece| piece.duration).sum();
    // Three straight drives and two turns, each from rest to rest.
    let pixels = [(160.537 - 40.342), (166.427 - 46.387), (160.494 - 40.353)];
    let drive = |length: f64| length / 0.5 + 0.5 / 0.75;
    let turn = std::f64::consts::FRAC_PI_2 / 0.6 + 0.6 / 2.0;
    let expected = pixels.iter().map(|pixels| drive(pixels * 0.044166)).sum::<f64>() + 2.0 * turn;
    assert!((duration - expected).abs() < 0.02, "{duration} {expected}");
    assert!(Scenario::from_json(&scenario.to_json()).is_ok());
}

#[test]
fn levels_are_apart_and_lifts_are_not_read() {
    let (imported, warnings) = read(HOTEL, &tiny(&[]));
    assert_eq!(imported.layout.levels, ["L1", "L2", "L3"]);
    let lanes = |level: usize| imported.layout.edges.iter().filter(|edge| imported.layout.level(edge) == level).count();
    assert_eq!([0, 1, 2].map(lanes), [58, 32, 32]);
    assert!(warnings.contains(&"lifts: they are not read; routes stay on their level".to_owned()));
    assert!(
        warnings.contains(&"graphs 0, 1, 2: the lanes of all of them are taken (--graph N)".to_owned()),
        "{warnings:?}"
    );
    let (one, _) = read(HOTEL, &ImportOptions { graph: Some(1), ..tiny(&[]) });
    assert!(one.layout.edges.len() < 122 && !one.layout.edges.is_empty());
    let table = ExclusionTable::compute(&imported, false).unwrap();
    let level = |id: &pcr_formats::import::ElementId| id.to_string().split('/').next().map(str::to_owned);
    assert!(!table.locks.is_empty() && table.locks.iter().all(|lock| level(&lock.a) == level(&lock.b)));
}

/// Two levels that are drawn at other scales: L2 is that of L1, twice as large in pixels, rotated by a quarter turn and moved.
fn two_levels(more: &str, fiducials: [&str; 2], measurements: [&str; 2]) -> String {
    let level = |name: &str, vertices: &str, fiducials: &str, measurements: &str| {
        format!(
            "  {name}:\n    vertices: {vertices}\n    fiducials: {fiducials}\n    measurements: {measurements}\n    lanes: [[0, 1, {{}}]]\n"
        )
    };
    let [below, above] = ["[[0, 0, 0, a], [100, 0, 0, b]]", "[[10, 30, 0, a], [10, -170, 0, b]]"];
    format!(
        "name: b\nlevels:\n{}{}{more}",
        level("upper", below, fiducials[0], measurements[0]),
        level("lower", above, fiducials[1], measurements[1])
    )
}

/// As the building tools of Open-RMF do, whose formulas the expected figures are by.
#[test]
fn levels_are_laid_upon_the_reference_level_by_their_fiducials() {
    let (own, none) = ("[[0, 1, {distance: [3, 5.0]}]]", "[]");
    // The level rotated by +90 degrees (y up) and twice as large: (x, y) is at (10 - 2 y, 30 - 2 x) there, y down.
    let fiducials = ["[[0, 0, p], [40, 0, q], [0, 30, r], [7, 7, only]]", "[[10, 30, p], [10, -50, q], [70, 30, r]]"];
    for (more, measurements) in [("", [own, none]), ("reference_level_name: upper\n", [own, own])] {
        let (imported, warnings) = read(&two_levels(more, fiducials, measurements), &tiny(&[]));
        for (name, at) in
            [("upper/0", [0.0, 0.0]), ("upper/1", [5.0, 0.0]), ("lower/0", [0.0; 2]), ("lower/1", [5.0, 0.0])]
        {
            let found = node(&imported.layout, name);
            assert!((found[0] - at[0]).hypot(found[1] - at[1]) < 1e-12, "{name}: {found:?}");
        }
        assert_eq!(warnings, [""; 0], "{more}");
    }
    // By name the other level is the reference, and its own measurement gives both scales.
    let half = "[[0, 1, {distance: [3, 40.0]}]]";
    let (imported, warnings) = read(&two_levels("reference_level_name: lower\n", fiducials, [own, half]), &tiny(&[]));
    let lengths: Vec<f64> = imported.layout.edges.iter().map(|edge| edge.length()).collect();
    assert!(lengths.iter().all(|length| (length - 40.0).abs() < 1e-9), "{lengths:?}");
    assert_eq!(
        warnings,
        [
            "level upper: its measurements give a scale that differs by -87.5 %; that of its fiducials counts, as for Open-RMF"
        ]
    );
    // One fiducial gives no scale.
    let one = [fiducials[0], "[[10, 30, p]]"];
    let (imported, warnings) = read(&two_levels("", one, [own, own]), &tiny(&[]));
    assert!((imported.layout.edges[0].length() - 5.0).abs() < 1e-9);
    assert_eq!(
        warnings,
        ["level lower: no two fiducials place it upon level upper; it has the scale of its own measurements"]
    );
    let failed = |text: &str| {
        layout(InputFormat::Rmf, text, &tiny(&[]), &mut Warnings::default()).unwrap_err().problem().to_owned()
    };
    let unscaled = |name: &str| format!("level {name}, measurements: none that gives the scale of its pixels");
    assert_eq!(failed(&two_levels("", one, [own, none])), unscaled("lower"));
    assert_eq!(failed(&two_levels("", fiducials, [none, none])), unscaled("lower"));
    assert_eq!(
        failed(&two_levels("reference_level_name: L9\n", fiducials, [own, own])),
        "building, reference_level_name: there is no level L9"
    );
    // A fiducial in a wrong place: the pairs do not give one scale.
    let [right, wrong] = [fiducials[1], "[[10, 30, p], [10, 30, q], [70, 30, r]]"];
    let spread = |places: &str| {
        let (_, warnings) = read(&two_levels("", [fiducials[0], places], [own, none]), &tiny(&[]));
        warnings.iter().any(|line| line.starts_with("level lower: its fiducials give scales that differ"))
    };
    assert_eq!([spread(right), spread(wrong)], [false, true]);
    for (wrong, problem) in [
        ("[[10, 30, p], [10, -50, q], [70, 30, p]]", "level lower, fiducial 2: another one is p"),
        ("[[10, 30, p], [10, -50, q], [70, up, r]]", "level lower, fiducial 2: no place and name"),
    ] {
        // A level has no other scale if parts may be left out.
        for partial in [false, true] {
            let options = ImportOptions { partial, ..tiny(&[]) };
            let text = two_levels("", [fiducials[0], wrong], [own, none]);
            let refused =
                layout(InputFormat::Rmf, &text, &options, &mut Warnings::default()).unwrap_err().problem().to_owned();
            assert_eq!(refused, problem);
        }
    }
    // A real one: by its fiducials L2 has 0.056199 m a pixel, by its own measurements 0.055452 m.
    let upper = |text: &str| {
        let (ImportedLayout { layout, .. }, _) = read(text, &tiny(&[]));
        let of_level = layout.edges.iter().filter(|edge| layout.levels[layout.level(edge)] == "L2");
        of_level.map(|edge| edge.length()).sum::<f64>()
    };
    let place = HOTEL.find("\n  L2:").unwrap();
    let alone = format!("{}{}", &HOTEL[..place], HOTEL[place..].replace(", ref", ", other"));
    let ratio = upper(HOTEL) / upper(&alone);
    assert!((ratio - 0.056199 / 0.055452).abs() < 1e-4, "{ratio}");
}

#[test]
fn what_is_wrong_is_named() {
    let failed = |text: &str| {
        layout(InputFormat::Rmf, text, &tiny(&[]), &mut Warnings::default()).unwrap_err().problem().to_owned()
    };
    let start = TRIPLE_H.find("measurements:").unwrap();
    let end = start + TRIPLE_H[start..].find("vertices:").unwrap();
    let unmeasured = format!("{}{}", &TRIPLE_H[..start], &TRIPLE_H[end..]);
    assert_eq!(failed(&unmeasured), "level L1, measurements: none that gives the scale of its pixels");
    assert_eq!(
        failed(&format!("coordinate_system: mars\n{TRIPLE_H}")),
        "building, coordinate_system: mars is not read"
    );
    assert_eq!(failed("a: b"), "building, levels: missing");
    let config = std::fs::read_to_string(fleet("office_tinyRobot").unwrap()).unwrap();
    assert_eq!(failed(&config), "it is the configuration of a fleet; give it beside a building, with --fleet");
    let unread = layout(InputFormat::Rmf, "a: [", &tiny(&[]), &mut Warnings::default()).unwrap_err();
    assert!(unread.to_string().starts_with("line 1, column 4: not YAML: "), "{unread}");
    let broken = TRIPLE_H.replacen("- [0, 1, {", "- [0, 999, {", 1);
    assert_eq!(failed(&broken), "lane L1/0: there is no vertex 999; --partial leaves that out");
    let (rest, warnings) = read(&broken, &ImportOptions { partial: true, ..tiny(&[]) });
    assert_eq!(rest.layout.edges.len(), 21);
    assert_eq!(warnings, ["lane L1/0: there is no vertex 999: left out"]);
    let typed = TRIPLE_H.replacen("bidirectional: [4, ", "bidirectional: [4, perhaps ", 1);
    assert_ne!(typed, TRIPLE_H);
    assert!(failed(&typed).starts_with("lane L1/0: bidirectional: \"perhaps "), "{}", failed(&typed));
}

/// A level of 20 m by 10 m with the diagonal as a third vertex, lanes, and what else is in the building.
fn building(measurements: &str, lanes: &[&str], more: &str) -> String {
    let lanes: String = lanes.iter().map(|lane| format!("      - {lane}\n")).collect();
    format!(
        "name: b\nlevels:\n  L1:\n    vertices: [[0, 0, 0, a], [200, 0, 0, b], [0, 100, 0, c], [200, 0, 0, d]]\n    measurements: {measurements}\n    \
        lanes:\n{lanes}{more}"
    )
}

#[test]
fn lanes_have_the_parameters_of_the_file() {
    let measured = "[[0, 1, {distance: [3, 20.0]}]]";
    let lanes = [
        "[0, 1, {graph_idx: [2, 0], bidirectional: [4, true], speed_limit: [3, 0.5]}]",
        "[0, 2, {graph_idx: [2, 1], speed_limit: [3, 0]}]",
        "[2, 0, {graph_idx: [2, 1], bidirectional: [4, false], speed_limit: [3, 2e6]}]",
        "[1, 3, {}]",
    ];
    let text = building(measured, &lanes, "lifts: {one: {}}\n");
    let (imported, warnings) = read(&text, &tiny(&[]));
    let edges: Vec<_> =
        imported.layout.edges.iter().map(|edge| (edge.is_two_way(), edge.speed[0], edge.curve.len())).collect();
    assert_eq!(edges, [(true, Some(0.5), 1), (false, None, 1), (false, None, 1), (false, None, 0)]);
    assert!((imported.layout.edges[1].length() - 10.0).abs() < 1e-12);
    // A lift of one level leads nowhere.
    assert_eq!(warnings, ["lane L1/3: its length is 0", "graphs 0, 1: the lanes of all of them are taken (--graph N)"]);
    for (graph, count) in [(0, 2), (1, 2)] {
        let (one, _) = read(&text, &ImportOptions { graph: Some(graph), ..tiny(&[]) });
        let all: Vec<_> = one.layout.edges.iter().map(|edge| edge.id.to_string()).collect();
        assert_eq!((all.len(), all.contains(&"L1/1".to_owned())), (count, graph == 1), "{all:?}");
    }
    // 20 m and 11 m for 10 m, of which the mean is 5 % off both.
    let (_, warnings) =
        read(&building("[[0, 1, {distance: [3, 20]}], [0, 2, {distance: [3, 11]}]]", &lanes[..1], ""), &tiny(&[]));
    assert_eq!(warnings, ["level L1: its measurements differ from their mean by up to 4.8 %"]);
    // Without one of them the scale would be another one.
    for other in ["[0, 9, {}]", "[0, 2, {distance: [3, 0]}]", "[0, 2, {}]"] {
        let text = building(&format!("[[0, 1, {{distance: [3, 20]}}], {other}]"), &lanes[..1], "");
        let problem = "level L1, measurement 1: it gives no scale";
        for partial in [false, true] {
            let options = ImportOptions { partial, ..tiny(&[]) };
            let refused = layout(InputFormat::Rmf, &text, &options, &mut Warnings::default()).expect_err(other);
            assert_eq!(refused.problem(), problem);
        }
    }
}

#[test]
fn limits_of_a_fleet_are_two_numbers_above_zero() {
    let read = |linear: &str| {
        let text = format!("rmf_fleet:\n  name: f\n  limits: {{linear: {linear}, angular: [1, 2]}}\n");
        pcr_formats::import::vehicle(&text, &ImportOptions::default(), &mut Warnings::default())
    };
    assert_eq!(read("[0.5, 0.75]").map(|vehicle| [vehicle.speed, vehicle.acceleration]), Ok([0.5, 0.75]));
    for wrong in ["[0, 1]", "[1, 0]", "[-1, 1]", "[1]", "[1, 2, 3]", "[2e6, 1]", "[1, 2e6]", "[x, 1]"] {
        assert!(read(wrong).unwrap_err().problem().to_owned().contains("speed and acceleration above 0"), "{wrong}");
    }
}

/// A lane led one way, or had no limit of speed, where its parameters could not be read.
#[test]
fn parameters_without_a_value_are_refused() {
    for (parameters, expected) in [
        ("{bidirectional: []}", "bidirectional: [] is not read"),
        ("{bidirectional: [4]}", "bidirectional: [4] is not read"),
        ("{speed_limit: [3, -1]}", "speed_limit: -1 is not read"),
        ("{graph_idx: []}", "graph_idx: [] is not read"),
        ("[bidirectional]", "its parameters [\"bidirectional\"] are not read"),
    ] {
        let text = building("[[0, 1, {distance: [3, 20.0]}]]", &[&format!("[0, 1, {parameters}]")], "");
        let error =
            layout(InputFormat::Rmf, &text, &tiny(&[]), &mut Warnings::default()).unwrap_err().problem().to_owned();
        assert!(error.starts_with(&format!("lane L1/0: {expected}")), "{error}");
    }
}

/// Names of vertices, levels, fiducials, buildings and fleets are any scalars, as they are written. Some had no name, and nothing was said;
/// others were refused, and left out a level got another scale.
#[test]
fn names_are_any_scalars() {
    let building = |name: &str| {
        format!(
            "name: {name}\nreference_level_name: {name}\nlevels:\n  {name}:\n    vertices: [[0, 0, 0, {name}], [10, 0, 0, b]]\n    \
             fiducials: [[0, 0, {name}], [10, 0, 2]]\n    measurements: [[0, 1, {{distance: [3, 10]}}]]\n    lanes: [[0, 1, {{}}]]\n  \
             upper:\n    vertices: [[50, 50, 0, c], [70, 50, 0, d]]\n    fiducials: [[50, 50, {name}], [70, 50, 2]]\n    \
             measurements: [[0, 1, {{distance: [3, 21]}}]]\n    lanes: [[0, 1, {{}}]]\n"
        )
    };
    for (written, name) in [
        ("101", "101"),
        ("\"102\"", "102"),
        ("007", "007"),
        ("1.50", "1.50"),
        ("true", "true"),
        ("no", "no"),
        ("~", "null"),
        ("null", "null"),
        ("0x1F", "0x1F"),
        ("'a b'", "a b"),
        ("-3", "-3"),
        ("2026-11-28", "2026-11-28"),
    ] {
        for partial in [false, true] {
            let options = ImportOptions { radius: Some(0.4), partial, ..ImportOptions::default() };
            let (imported, warnings) = read(&building(written), &options);
            let layout = &imported.layout;
            let is_named = name != "null";
            assert_eq!(layout.name, if is_named { name } else { "" }, "{written}");
            assert!(layout.levels.iter().any(|level| level == name), "{written}: {:?}", layout.levels);
            assert_eq!(node(layout, &format!("{name}/1")), [10.0, 0.0]);
            assert_eq!(layout.nodes[layout.node(&format!("{name}/0")).unwrap()].name.as_deref(), Some(name));
            // The upper level has the scale of its fiducials.
            let upper = layout.edges.iter().find(|edge| edge.id.to_string() == "upper/0").unwrap();
            assert!((upper.length() - 10.0).abs() < 1e-12, "{written}: {}", upper.length());
            let scales = warnings.iter().filter(|line| line.contains("give a scale that differs by +110.0 %")).count();
            assert_eq!(scales, 1, "{written}: {warnings:?}");
        }
    }
    // Which of its programs reads it would decide.
    for [here, there] in [["1", "\"1\""], ["1", "1.0"], ["1", "true"]] {
        let text = building("9").replace("[0, 0, 9]", &format!("[0, 0, {here}]"));
        let text = text.replace("[50, 50, 9]", &format!("[50, 50, {there}]"));
        let options = ImportOptions { partial: true, ..tiny(&[]) };
        let error =
            layout(InputFormat::Rmf, &text, &options, &mut Warnings::default()).unwrap_err().problem().to_owned();
        assert!(error.contains("the programs of Open-RMF differ"), "{error}");
    }
    // Navigation graphs, and fleets.
    let graph = "building_name: 12\nlevels:\n  3:\n    vertices: [[0, 0, {name: 04}], [5, 0, {name: true}]]\n    lanes: [[0, 1, {}]]\n";
    let (imported, _) = read(graph, &ImportOptions { radius: Some(0.4), ..ImportOptions::default() });
    assert_eq!((imported.layout.name.as_str(), imported.layout.levels), ("12", vec!["3".to_owned()]));
    let names: Vec<_> = imported.layout.nodes.iter().map(|node| node.name.as_deref().unwrap()).collect();
    assert_eq!(names, ["04", "true"]);
    let fleet = "rmf_fleet:\n  name: 042\n  profile: {footprint: 0.3}\n";
    let vehicle = pcr_formats::import::vehicle(fleet, &ImportOptions::default(), &mut Warnings::default()).unwrap();
    assert_eq!((vehicle.name.as_deref(), vehicle.radius), (Some("042"), 0.3));
}

/// A building with longitudes and latitudes, as the building tools project it: expected figures by pyproj (PROJ 9).
#[test]
fn longitudes_and_latitudes_are_projected() {
    let campus = |crs: &str| {
        format!(
            "coordinate_system: wgs84\nlevels:\n  L1:\n    elevation: 0\n    vertices:\n      - [103.8198, 1.3521, 0, a]\n      \
             - [103.8208, 1.3529, 0, b]\n      - [999, 0, 0, \"\"]\n    lanes:\n      - [0, 1, {{bidirectional: [4, true]}}]\nname: campus\n\
             parameters:\n  generate_crs: [1, {crs}]\n  suggested_offset_x: [3, 22000]\n  suggested_offset_y: [3, 31500]\n"
        )
    };
    for (crs, a, b, is_mirrored) in [
        ("EPSG:3414", [26495.534871029, 37133.868476454], [26606.824033736, 37222.327796764], false),
        ("EPSG:32648", [149479.866291019, 368700.272373035], [149568.255591945, 368811.583247583], true),
    ] {
        let (imported, warnings) = read(&campus(crs), &tiny(&[]));
        let found = ["a", "b"].map(|name| node(&imported.layout, name));
        for (found, expected) in found.into_iter().zip([a, b]) {
            assert!((found[0] - expected[0]).hypot(found[1] - expected[1]) < 1e-6, "{crs}: {found:?}");
        }
        assert_eq!(warnings.iter().any(|line| line.contains("easting for a northing")), is_mirrored, "{warnings:?}");
    }
    let failed = |text: &str| {
        layout(InputFormat::Rmf, text, &tiny(&[]), &mut Warnings::default()).unwrap_err().problem().to_owned()
    };
    let unknown = failed(&campus("EPSG:4326"));
    assert!(unknown.starts_with("building, parameters, generate_crs: EPSG:4326 is not read; EPSG:326xx"), "{unknown}");
    let none = campus("EPSG:3414").replace("generate_crs", "other");
    assert_eq!(failed(&none), "building, parameters, generate_crs: missing");
    let far = failed(&campus("EPSG:3414").replace("[0, 1, {", "[0, 2, {"));
    assert!(far.starts_with("lane L1/0: longitude 999, latitude 0: out of range"), "{far}");
    // Left and right would be exchanged.
    let factsheet = PathBuf::from(format!("{}/data/small/factsheet.json", env!("CARGO_MANIFEST_DIR")));
    let options = ImportOptions { fleet: Some(factsheet), ..ImportOptions::default() };
    let mirrored = layout(InputFormat::Rmf, &campus("EPSG:32648"), &options, &mut Warnings::default()).unwrap_err();
    assert!(mirrored.to_string().contains("a contour is refused"), "{mirrored}");
    assert!(layout(InputFormat::Rmf, &campus("EPSG:3414"), &options, &mut Warnings::default()).is_ok());
}

/// YAML does not tell where it ends: the rest of a building could be missing without a word.
#[test]
fn a_building_that_may_be_cut_is_told() {
    let end = HOTEL.find("\nname:").expect("its name is behind its levels");
    for (text, is_told) in [(HOTEL, false), (&HOTEL[..end], true)] {
        let mut warnings = Warnings::default();
        layout(InputFormat::Rmf, text, &ImportOptions::default(), &mut warnings).unwrap();
        assert_eq!(warnings.lines().iter().any(|line| line.contains("may be cut")), is_told);
    }
}
