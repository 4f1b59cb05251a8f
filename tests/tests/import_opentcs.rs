//! The demo plant of openTCS: its Bézier paths become arcs, and its lengths are warned about.

use pcr_formats::import::{ImportOptions, InputFormat, LayoutEdge, Warnings, layout, scenario};
use pcr_formats::scenario::PathSegment;

const DEMO: &str = include_str!("../data/real/opentcs/Demo-01.xml");

fn options(routes: &[&str]) -> ImportOptions {
    ImportOptions {
        radius: Some(0.6),
        routes: routes.iter().map(ToString::to_string).collect(),
        ..ImportOptions::default()
    }
}

#[test]
fn the_demo_is_read_with_warnings_about_its_lengths() {
    let mut warnings = Warnings::default();
    let plant = layout(InputFormat::OpenTcs, DEMO, &options(&[]), &mut warnings).unwrap().layout;
    assert_eq!((plant.name.as_str(), plant.edges.len()), ("Demo-01", 75));
    let is_curved = |edge: &&LayoutEdge| edge.deviation > 0.0;
    assert_eq!(plant.edges.iter().filter(is_curved).count(), 35);
    assert!(plant.edges.iter().all(|edge| edge.deviation <= 1e-3));
    let listed =
        warnings.iter().find(|(_, problem, _)| *problem == "its length is not that of its geometry, which counts");
    // 34 of the 40 straight ones, and most of the curves.
    let listed = listed.unwrap().2;
    let straight = plant.edges.iter().filter(|edge| !is_curved(edge) && listed.contains(&format!("path {}", edge.id)));
    assert!((30..=34).contains(&straight.count()), "{listed:?}");
    assert!(listed.len() >= 34 + 24, "{}", listed.len());
    for edge in &plant.edges {
        let [from, to] = edge.ends.map(|node| plant.nodes[node].point);
        let (begin, end) = (edge.curve[0].start, edge.curve.last().unwrap().end());
        assert!((from[0] - begin[0]).hypot(from[1] - begin[1]) < 1e-9);
        assert!((to[0] - end[0]).hypot(to[1] - end[1]) < 1e-9);
    }
}

#[test]
fn a_curve_is_the_cubic_of_its_control_points() {
    // Point-0001 to Point-0002 over (610, -180) twice, in units of 50 mm.
    let plant = layout(InputFormat::OpenTcs, DEMO, &options(&[]), &mut Warnings::default()).unwrap().layout;
    let edge = plant.edges.iter().find(|edge| edge.id.to_string() == "Point-0001 --- Point-0002").unwrap();
    let points = [[31.0, 11.0], [30.5, 9.0], [30.5, 9.0], [25.0, 9.0]];
    let mut pieces = 0;
    for piece in &edge.curve {
        // The middle of each arc is near the curve.
        let half = match piece.shape {
            PathSegment::Line { length } => PathSegment::Line { length: length / 2.0 },
            PathSegment::Arc { radius, sweep, .. } => PathSegment::arc(radius, sweep / 2.0),
            _ => panic!("{piece:?}"),
        };
        let middle = pcr_formats::scenario::PlacedSegment { shape: half, ..*piece }.end();
        let distance = |k: u32| {
            let t = f64::from(k) / 20_000.0;
            let weights = [(1.0 - t).powi(3), 3.0 * t * (1.0 - t).powi(2), 3.0 * t * t * (1.0 - t), t.powi(3)];
            let at =
                [0, 1].map(|axis| weights.iter().zip(points).map(|(weight, point)| weight * point[axis]).sum::<f64>());
            (at[0] - middle[0]).hypot(at[1] - middle[1])
        };
        let nearest = (0..=20_000).map(distance).fold(f64::INFINITY, f64::min);
        assert!(nearest <= 1.1e-3, "{nearest}");
        pieces += 1;
    }
    assert!(pieces > 2);
}

/// Straight, or round the point: it cannot be told.
#[test]
fn straight_paths_with_control_points_are_refused() {
    let from = DEMO.find("connectionType=\"BEZIER\"").unwrap();
    let text = format!("{}{}", &DEMO[..from], DEMO[from..].replacen("\"BEZIER\"", "\"DIRECT\"", 1));
    let error = layout(InputFormat::OpenTcs, &text, &options(&[]), &mut Warnings::default()).unwrap_err().to_string();
    assert!(error.contains(": DIRECT with 2 control points is not read"), "{error}");
}

#[test]
fn vehicles_keep_the_velocity_of_a_path() {
    let mut warnings = Warnings::default();
    let scenario = scenario(InputFormat::OpenTcs, DEMO, &options(&["Point-0001:Point-0003"]), &mut warnings).unwrap();
    assert!((scenario.agents[0].length() - 6.0).abs() < 1e-12);
}

#[test]
fn a_plant_is_read_whole_or_refused() {
    let point = |name: &str, x: i32, y: i32| format!("<point name=\"{name}\" positionX=\"{x}\" positionY=\"{y}\"/>");
    let path = |name: &str, from: &str, to: &str, more: &str| {
        format!("<path name=\"{name}\" sourcePoint=\"{from}\" destinationPoint=\"{to}\" length=\"4000\" {more}/>")
    };
    let points = [point("a", 0, 0), point("b", 4000, 0), point("c", 2000, -2000), point("d", 2000, 2000)].concat();
    let read = |parts: &str, partial: bool| {
        let options = ImportOptions { radius: Some(0.3), partial, ..ImportOptions::default() };
        let text = format!("<model>{points}{parts}</model>");
        layout(InputFormat::OpenTcs, &text, &options, &mut Warnings::default()).map_err(|error| error.to_string())
    };
    let twice = [path("p", "a", "b", ""), path("p", "c", "d", ""), path("p", "c", "d", "")].concat();
    let imported = read(&twice, false).unwrap();
    assert_eq!(imported.layout.edges.iter().map(|edge| edge.id.to_string()).collect::<Vec<_>>(), ["p", "p#2"]);
    assert_eq!(pcr_planning::exclusion_table::ExclusionTable::compute(&imported, false).unwrap().locks.len(), 1);
    let curved = "<path name=\"q\" sourcePoint=\"a\" destinationPoint=\"b\" length=\"1\"><pathLayout connectionType=\"BEZIER\"/></path>";
    let lost = [path("p", "a", "z", ""), curved.to_owned(), path("r", "a", "b", "maxVelocity=\"fast\"")].concat();
    let expected = "path p, destinationPoint: there is no node z; path q: BEZIER with 0 control points is not read; \
        path r, maxVelocity: \"fast\" where a number up to 1e10 is expected; --partial leaves that out";
    assert_eq!(read(&lost, false).unwrap_err(), expected);
    assert_eq!(read(&lost, true).unwrap().layout.edges.len(), 0);
    let far = "<point name=\"far\" positionX=\"-1e300\" positionY=\"0\"/>";
    let expected = "point far, positionX: \"-1e300\" where a number up to 1e10 is expected; --partial leaves that out";
    assert_eq!(read(far, false).unwrap_err(), expected);
    let way = path("w", "a", "b", "");
    let named = read(&format!("{way}<vehicle name=\"\"/><vehicle name=\"v\"/>"), false).unwrap().layout.vehicles;
    assert_eq!(named.iter().map(ToString::to_string).collect::<Vec<_>>(), ["v"]);
    let moved = [point("a", 5, 5), path("p", "a", "b", "")].concat();
    assert!(read(&moved, false).unwrap_err().starts_with("path p, sourcePoint: there are several different nodes a"));
    let scaled = |scale: &str| read(&format!("{way}<visualLayout scaleX=\"{scale}\"/>"), false);
    assert!(scaled("0").unwrap_err().starts_with("visualLayout, scaleX: 0 where a number above 0 is expected"));
    assert!(scaled("x").is_err() && scaled("20").is_ok());
    // What vehicles reach out to at a point is there to be seen, and not used.
    let outline = "<point name=\"e\" positionX=\"9\" positionY=\"9\"><vehicleEnvelope key=\"k\"><vertex x=\"1\" y=\"1\"/></vehicleEnvelope></point>";
    let warnings = read(&format!("{way}{outline}"), false).unwrap().layout.warnings;
    assert!(warnings.iter().any(|line| line.starts_with("point e: its vehicleEnvelope is not read")), "{warnings:?}");
    let reversed = read(&path("p", "a", "b", "maxReverseVelocity=\"500\" maxVelocity=\"1500\""), false).unwrap().layout;
    assert_eq!((reversed.edges[0].ways, reversed.edges[0].speed), ([true; 2], [Some(1.5), Some(0.5)]));
}

#[test]
fn paths_have_the_limits_and_the_shape_of_the_file() {
    let read = |path: &str, controls: &[[i32; 2]], kind: &str| {
        let controls: String = controls.iter().map(|[x, y]| format!("<controlPoint x=\"{x}\" y=\"{y}\"/>")).collect();
        let text = format!(
            "<model><point name=\"a\" positionX=\"0\" positionY=\"0\"/><point name=\"b\" positionX=\"4000\" positionY=\"0\">\
            <vehicleEnvelope key=\"k\"/></point><path name=\"p\" sourcePoint=\"a\" destinationPoint=\"b\" {path}>\
            <pathLayout connectionType=\"{kind}\">{controls}</pathLayout></path></model>"
        );
        let imported = layout(InputFormat::OpenTcs, &text, &options(&[]), &mut Warnings::default());
        imported.map(|imported| imported.layout).map_err(|error| error.to_string())
    };
    let stands = read("length=\"4000\" maxVelocity=\"0\" maxReverseVelocity=\"0\"", &[], "DIRECT").unwrap();
    assert_eq!((stands.edges[0].ways, stands.edges[0].speed, stands.edges[0].closed), ([true, false], [None; 2], true));
    assert!(stands.warnings.iter().any(|line| line.contains("its speeds are 0 in both directions")));
    assert!(!stands.warnings.iter().any(|line| line.contains("vehicleEnvelope")), "{:?}", stands.warnings);
    // A speed of 0 closes one direction, the other one has its own; a path that is locked is closed, and locks know both directions.
    let back =
        read("length=\"4000\" maxVelocity=\"0\" maxReverseVelocity=\"500\" locked=\"false\"", &[], "DIRECT").unwrap();
    assert_eq!(
        (back.edges[0].ways, back.edges[0].speed, back.edges[0].closed),
        ([false, true], [None, Some(0.5)], false)
    );
    let locked =
        read("length=\"4000\" maxVelocity=\"1000\" maxReverseVelocity=\"250\" locked=\"true\"", &[], "DIRECT").unwrap();
    assert_eq!(
        (locked.edges[0].ways, locked.edges[0].speed, locked.edges[0].closed),
        ([true; 2], [Some(1.0), Some(0.25)], true)
    );
    assert!(locked.warnings.iter().any(|line| line.contains("it is locked: no routes lead over it")));
    // One per cent is not warned about.
    for (length, warned) in [(4000, false), (4030, false), (3970, false), (4050, true), (3950, true)] {
        let plant = read(&format!("length=\"{length}\""), &[], "DIRECT").unwrap();
        assert_eq!(plant.warnings.iter().any(|line| line.contains("its length is not that")), warned, "{length}");
    }
    // Units of 50 mm if the model names none, y down; twice the same point is no line.
    let poly = read("", &[[40, -20], [40, -20]], "POLYPATH").unwrap();
    let ends: Vec<[f64; 2]> = poly.edges[0].curve.iter().map(|piece| piece.end()).collect();
    assert_eq!(ends.len(), 2);
    assert!((ends[0][0] - 2.0).abs() < 1e-12 && (ends[0][1] - 1.0).abs() < 1e-12, "{ends:?}");
    assert!(
        read("", &[[1, 1], [2, 2], [3, 3]], "BEZIER").unwrap_err().contains("BEZIER with 3 control points is not read")
    );
}

#[test]
fn xml_is_known_by_its_first_element_and_not_nested_without_end() {
    let format = |text: &str| InputFormat::detect("x.xml".as_ref(), text);
    for text in [
        "<model>",
        "<model/>",
        "<model name=\"a\"/>",
        "<?xml version=\"1.0\"?>\n<!-- > -->\n <model>",
        "\u{feff}<model>",
    ] {
        assert_eq!(format(text), Some(InputFormat::OpenTcs), "{text}");
    }
    assert_eq!((format("<models>"), format("<graphml>"), format("model")), (None, Some(InputFormat::Ccbs), None));
    let read = |inner: &str| {
        let points =
            ["a", "b"].map(|name| format!("<point name=\"{name}\" positionX=\"0\" positionY=\"0\"/>")).concat();
        let way = "<path name=\"w\" sourcePoint=\"a\" destinationPoint=\"b\" length=\"1\"/>";
        let text = format!("<model>{points}{way}{inner}</model>");
        layout(InputFormat::OpenTcs, &text, &options(&[]), &mut Warnings::default()).map_err(|error| error.to_string())
    };
    let nested = |depth: usize| format!("{}{}", "<a>".repeat(depth), "</a>".repeat(depth));
    assert!(read(&nested(190)).is_ok());
    assert_eq!(read(&nested(210)).unwrap_err(), "not XML that is read: nested deeper than 200 elements");
    // What is beside one another is not nested.
    for many in ["<a></a>", "<a/>", "<a b=\"c\"/>", "<!-- a -->", "<?a b?>"] {
        assert!(read(&many.repeat(300)).is_ok(), "{many}");
    }
}

/// Routes, traffic and locks of a triangle of which one path is locked, one leads back only, and one is slow backward.
#[test]
fn routes_go_where_the_plant_model_lets_vehicles_go() {
    let point = |name: &str, x: u32, y: u32| format!("<point name=\"{name}\" positionX=\"{x}\" positionY=\"{y}\"/>");
    let path = |ends: [&str; 2], length: u32, speeds: [u32; 2], locked: bool| {
        let [a, b] = ends;
        format!(
            "<path name=\"{a}{b}\" sourcePoint=\"{a}\" destinationPoint=\"{b}\" length=\"{length}\" maxVelocity=\"{}\" \
            maxReverseVelocity=\"{}\" locked=\"{locked}\"/>",
            speeds[0], speeds[1]
        )
    };
    let text = [
        "<model>".to_owned(),
        point("a", 0, 0) + &point("b", 4000, 0) + &point("c", 0, 3000),
        path(["a", "b"], 4000, [1000, 1000], true) + &path(["b", "c"], 5000, [0, 400], false),
        path(["c", "a"], 3000, [1000, 250], false) + "</model>",
    ]
    .concat();
    let route = |ends: &str| {
        let read = scenario(InputFormat::OpenTcs, &text, &options(&[ends]), &mut Warnings::default());
        read.map(|scenario| (scenario.agents[0].length(), scenario.agents[0].duration()))
            .map_err(|error| error.to_string())
    };
    let (length, duration) = route("a:b").expect("over c");
    assert!(
        (length - 8.0).abs() < 1e-6 && duration > 3.0 / 0.25 + 5.0 / 0.4 && duration < 32.0,
        "{length} m, {duration} s"
    );
    let (length, duration) = route("c:a").expect("straight");
    assert!((length - 3.0).abs() < 1e-9 && duration < 6.0, "{length} m, {duration} s");
    assert!(route("b:a").is_err_and(|error| error.contains("no way") || error.contains("no route")));
    let imported = layout(InputFormat::OpenTcs, &text, &options(&[]), &mut Warnings::default()).expect("a layout");
    // The path that is locked has locks all the same.
    let steps: Vec<usize> = imported.layout.edges.iter().map(|edge| edge.steps().count()).collect();
    assert_eq!(steps, [2, 1, 2]);
}

/// A plant of two parallel paths 1.4 m apart, with these vehicles.
fn plant(vehicles: &str) -> String {
    let point = |name: &str, x: f64, y: f64| {
        format!("<point name=\"{name}\" positionX=\"{x}\" positionY=\"{y}\" positionZ=\"0\"/>")
    };
    let path = |name: &str, from: &str, to: &str| {
        let ends = format!("sourcePoint=\"{from}\" destinationPoint=\"{to}\"");
        format!("<path name=\"{name}\" {ends} length=\"20000\" maxVelocity=\"0.0\" maxReverseVelocity=\"0\"/>")
    };
    let points = [point("A->", 0.0, 0.0), point("B", 2e4, 0.0), point("C", 0.0, 1400.0), point("D", 2e4, 1400.0)];
    let paths = [path("A-B", "A->", "B"), path("C-D", "C", "D")].map(|path| path.replacen("0.0", "1000", 1));
    format!("<model version=\"7.0.0\" name=\"m\">{}{}{vehicles}</model>", points.concat(), paths.concat())
}

/// They were said not to be in the file.
#[test]
fn vehicles_have_the_boxes_and_speeds_of_the_file() {
    let vehicle = |name: &str, speed: u32, sizes: &str| {
        format!("<vehicle name=\"{name}\" maxVelocity=\"{speed}\"><boundingBox {sizes}/></vehicle>")
    };
    let large = vehicle("large", 2000, "length=\"3000\" width=\"1600\" height=\"1000\"");
    let aside =
        vehicle("aside", 1500, "length=\"1000\" width=\"400\" referenceOffsetX=\"-300\" referenceOffsetY=\"650\"");
    let read = |vehicles: &str, options: &ImportOptions| {
        let mut warnings = Warnings::default();
        let imported = layout(InputFormat::OpenTcs, &plant(vehicles), options, &mut warnings).unwrap();
        let locks = pcr_planning::exclusion_table::ExclusionTable::compute(&imported, false).unwrap().locks.len();
        (imported.vehicle, locks, warnings.lines())
    };
    let (vehicle, locks, warnings) = read(&large, &ImportOptions::default());
    let corners = vehicle.footprint.as_ref().map(|outline| outline.polygon().to_vec());
    assert_eq!(corners, Some(vec![[1.5, 0.8], [-1.5, 0.8], [-1.5, -0.8], [1.5, -0.8]]));
    assert_eq!((vehicle.speed, locks), (2.0, 1));
    assert!(warnings.iter().all(|line| !line.contains("radius")), "{warnings:?}");
    // A reference point off the middle counts to both sides, and of speeds the least.
    let (vehicle, _, warnings) = read(&format!("{large}{aside}"), &ImportOptions::default());
    let corners = vehicle.footprint.as_ref().map(|outline| outline.polygon()[0]);
    let [ahead, left] = corners.expect("an outline");
    assert!((ahead, vehicle.speed) == (1.5, 1.5) && (left - 0.85).abs() < 1e-12, "{left}");
    assert!(warnings.contains(&"vehicles: their maxVelocity differs; the least of 1.5 m/s is taken".to_owned()));
    // What is asked for counts, and is told where the boxes reach further.
    let asked = ImportOptions { radius: Some(0.5), speed: Some(1.0), ..ImportOptions::default() };
    let (vehicle, locks, warnings) = read(&large, &asked);
    assert_eq!((vehicle.radius, vehicle.speed, vehicle.footprint.is_none(), locks), (0.5, 1.0, true, 0));
    assert!(
        warnings.contains(
            &"radius: 0.5 m, a disc; the outline of the vehicle, which is not used then, reaches 1.700 m".to_owned()
        ),
        "{warnings:?}"
    );
    let (_, _, warnings) = read(&large, &ImportOptions { radius: Some(1.8), ..asked });
    assert!(warnings.iter().all(|line| !line.contains("radius")), "{warnings:?}");
    let (vehicle, ..) = read("", &ImportOptions::default());
    assert_eq!((vehicle.radius, vehicle.speed), (0.5, 1.0));
}

#[test]
fn directions_at_points_that_an_outline_does_not_have_are_told() {
    let large = "<vehicle name=\"large\" maxVelocity=\"2000\"><boundingBox length=\"3000\" width=\"1600\"/></vehicle>";
    let told = |angle: &str, options: &ImportOptions| {
        let text = plant(large).replacen("<point ", &format!("<point vehicleOrientationAngle=\"{angle}\" "), 1);
        let mut warnings = Warnings::default();
        layout(InputFormat::OpenTcs, &text, options, &mut warnings).map(|_| {
            warnings
                .lines()
                .iter()
                .any(|line| line.starts_with("point A->: its vehicleOrientationAngle is that of none"))
        })
    };
    let told_of_box = |angle: &str| told(angle, &ImportOptions::default());
    // Along its path, turned by half a turn, which is the same for a box, or any.
    for angle in ["0.0", "360", "-180.0", "NaN"] {
        assert_eq!(told_of_box(angle), Ok(false), "{angle}");
    }
    assert_eq!([told_of_box("90.0"), told_of_box("-45")], [Ok(true), Ok(true)]);
    // To a disc it does not matter.
    assert_eq!([told("90", &options(&[])), told("north", &options(&[]))], [Ok(false), Ok(false)]);
    let refused = told_of_box("north").expect_err("no number").to_string();
    assert!(refused.contains("point A->, vehicleOrientationAngle: \"north\" where a number"), "{refused}");
}

#[test]
fn names_with_angles_and_models_before_version_7_are_read() {
    let names: String = (0..300).map(|k| format!("<location name=\"{k}->\"/><!-- <a> -->")).collect();
    let deep =
        plant(&format!("{names}<property name='a \">\"' value=\"<![CDATA[<b>]]&gt;\"/>").replace("<![CDATA[<b>]]", ""));
    let old = deep.replace("positionX", "xPosition").replace("positionY", "yPosition");
    for text in [deep, old] {
        let plant = layout(InputFormat::OpenTcs, &text, &options(&[]), &mut Warnings::default()).unwrap().layout;
        let places = [[0.0, 0.0], [20.0, 0.0], [0.0, 1.4], [20.0, 1.4]];
        let apart = |(node, at): (&pcr_formats::import::LayoutNode, [f64; 2])| {
            (node.point[0] - at[0]).hypot(node.point[1] - at[1])
        };
        assert!(plant.nodes.iter().zip(places).map(apart).all(|apart| apart < 1e-12), "{:?}", plant.nodes);
    }
    let nested = plant(&format!("{}{}", "<a b=\">\">".repeat(300), "</a>".repeat(300)));
    let error = layout(InputFormat::OpenTcs, &nested, &options(&[]), &mut Warnings::default()).unwrap_err().to_string();
    assert!(error.contains("nested deeper than 200 elements"), "{error}");
}

fn failed(text: &str) -> String {
    layout(InputFormat::OpenTcs, text, &ImportOptions::default(), &mut Warnings::default()).unwrap_err().to_string()
}

/// Vehicles without a box silently had that of the others.
#[test]
fn each_vehicle_has_a_box_if_any_has() {
    let small = "<vehicle name=\"small\"><boundingBox length=\"300\" width=\"300\" height=\"9\"/></vehicle>";
    for (other, expected) in [
        ("", "vehicle B, boundingBox: missing, and others have one"),
        ("<boundingBox length=\"3000\" height=\"9\"/>", "vehicle B, boundingBox, width: missing"),
        (
            "<boundingBox length=\"-3000\" width=\"-3000\"/>",
            "vehicle B, boundingBox, length: -3000 where a number above 0 is",
        ),
        ("<boundingBox length=\"3000\" width=\"0\"/>", "vehicle B, boundingBox, width: 0 where a number above 0 is"),
    ] {
        let text = plant(&format!("{small}<vehicle name=\"B\">{other}</vehicle>"));
        assert!(failed(&text).starts_with(expected), "{}", failed(&text));
        // A radius that is given is that of all, and so is what can be read, if that is asked for.
        let given = layout(InputFormat::OpenTcs, &text, &options(&[]), &mut Warnings::default()).unwrap();
        assert_eq!(given.vehicle.radius, 0.6);
        let (partial, mut warnings) =
            (ImportOptions { partial: true, ..ImportOptions::default() }, Warnings::default());
        let read = layout(InputFormat::OpenTcs, &text, &partial, &mut warnings).unwrap();
        assert!(
            read.vehicle.footprint.is_some() && warnings.lines()[0].starts_with(expected),
            "{:?}",
            warnings.lines()
        );
    }
    // Models before version 6 have lengths only.
    let told = |radius: Option<f64>| {
        let text = plant("<vehicle name=\"A\" length=\"3000\"/><vehicle name=\"B\" length=\"900\"/>");
        let mut warnings = Warnings::default();
        layout(InputFormat::OpenTcs, &text, &ImportOptions { radius, ..ImportOptions::default() }, &mut warnings)
            .unwrap();
        warnings.lines().into_iter().filter(|line| line.contains("m long")).collect::<Vec<_>>()
    };
    let [a, b] = [("A", 3.0), ("B", 0.9)].map(|(name, long)| {
        format!("vehicle {name}: it is {long} m long, and the model says nothing more of its outline")
    });
    assert_eq!(told(None), [a.clone(), b]);
    assert_eq!(told(Some(0.6)), [a]);
    assert!(told(Some(1.5)).is_empty());
}

/// Their ends were where the points are, and their middle where the points are drawn.
#[test]
fn curves_are_where_the_layout_has_their_points() {
    let curved = |drawn: &str, kind: &str| {
        let layout = format!(
            "<pathLayout connectionType=\"{kind}\"><controlPoint x=\"100\" y=\"-10\"/><controlPoint x=\"300\" y=\"-10\"/></pathLayout></path>"
        );
        let text = plant("").replacen(
            "length=\"20000\" maxVelocity=\"1000\" maxReverseVelocity=\"0\"/>",
            &format!("length=\"20000\" maxVelocity=\"1000\" maxReverseVelocity=\"0\">{layout}"),
            1,
        );
        text.replacen(
            "positionX=\"20000\" positionY=\"0\" positionZ=\"0\"/>",
            &format!("positionX=\"20000\" positionY=\"0\" positionZ=\"0\"><pointLayout {drawn}/></point>"),
            1,
        )
    };
    let deviation = |drawn: &str| {
        let text = curved(drawn, "BEZIER");
        layout(InputFormat::OpenTcs, &text, &options(&[]), &mut Warnings::default())
            .map(|read| read.layout.edges[0].deviation)
    };
    let there = deviation("labelOffsetX=\"-10\"").unwrap();
    assert_eq!(deviation("positionX=\"20000\" positionY=\"0\""), Ok(there));
    // The shift, and by how much the first and the last leg may be longer.
    assert!((deviation("xPosition=\"20003\" yPosition=\"4\"").unwrap() - there - 0.005 * 3.0).abs() < 1e-9);
    for (kind, drawn) in [("BEZIER", "positionX=\"120000\""), ("POLYPATH", "xPosition=\"120000\" yPosition=\"0\"")] {
        let expected = "path A-B: its control points are in the frame of the visual layout, where its end points are 100.000 m away from their places in the model (pointLayout)";
        assert!(failed(&curved(drawn, kind)).starts_with(expected), "{}", failed(&curved(drawn, kind)));
    }
    // Straight paths go from point to point, wherever these are drawn.
    let straight = plant("").replacen(
        "positionZ=\"0\"/>",
        "positionZ=\"0\"><pointLayout positionX=\"9000\" positionY=\"9\"/></point>",
        1,
    );
    assert!(layout(InputFormat::OpenTcs, &straight, &options(&[]), &mut Warnings::default()).is_ok());
}

/// Curves of models up to version 0.0.3 are in the visual layout, and were straight.
#[test]
fn curves_of_the_first_models_are_those_of_the_later_ones() {
    let property = |name: &str, value: &str| format!("<property name=\"{name}\" value=\"{value}\"/>");
    let element = |of: &str, properties: &[String]| {
        format!(
            "<modelLayoutElement visualizedObjectName=\"{of}\" layer=\"0\">{}</modelLayoutElement>",
            properties.concat()
        )
    };
    let model = |elements: &str| {
        plant(&format!("<visualLayout name=\"v\" scaleX=\"50\" scaleY=\"50\">{elements}</visualLayout>"))
    };
    let path =
        |kind: &str, points: &str| element("A-B", &[property("CONN_TYPE", kind), property("CONTROL_POINTS", points)]);
    let at = |of: &str, x: &str, y: &str| element(of, &[property("POSITION_X", x), property("POSITION_Y", y)]);
    let placed = [at("A->", "0", "0"), at("B", "20000", "0")].concat();
    let read = |elements: &str| {
        let mut warnings = Warnings::default();
        let read = layout(InputFormat::OpenTcs, &model(elements), &options(&[]), &mut warnings);
        read.map(|read| (read.layout.edges[0].clone(), warnings.lines()))
    };
    let later = plant("").replacen(
        "length=\"20000\" maxVelocity=\"1000\" maxReverseVelocity=\"0\"/>",
        "length=\"20000\" maxVelocity=\"1000\" maxReverseVelocity=\"0\"><pathLayout connectionType=\"BEZIER\">\
         <controlPoint x=\"100\" y=\"-10\"/><controlPoint x=\"300\" y=\"-10\"/></pathLayout></path>",
        1,
    );
    let later =
        layout(InputFormat::OpenTcs, &later, &options(&[]), &mut Warnings::default()).unwrap().layout.edges[0].clone();
    // Releases differ in the case of the names.
    for kind in ["BEZIER", "Bezier"] {
        let (edge, warnings) = read(&[&placed, path(kind, "100,-10;300,-10").as_str()].concat()).unwrap();
        assert_eq!(edge, later);
        assert!(warnings.iter().all(|line| !line.contains("drawn")), "{warnings:?}");
    }
    // Where its points are drawn matters, and is told where it is not said.
    let (edge, warnings) = read(&path("BEZIER", "100,-10;300,-10")).unwrap();
    assert_eq!(edge, later);
    assert!(
        warnings.iter().any(|line| line.starts_with("path A-B: where its points are drawn is not said")),
        "{warnings:?}"
    );
    let moved = [at("A->", "0", "30"), at("B", "20000", "0")].concat();
    let (edge, _) = read(&[&moved, path("BEZIER", "100,-10;300,-10").as_str()].concat()).unwrap();
    assert!((edge.deviation - later.deviation - 3.0 * 0.03).abs() < 1e-9, "{} {}", edge.deviation, later.deviation);
    let (straight, _) = read(&[&placed, path("DIRECT", "").as_str()].concat()).unwrap();
    assert_eq!(straight.length(), 20.0);
    for (kind, points, expected) in [
        ("DIRECT", "1,2", "path A-B: DIRECT with 1 control points is not read"),
        ("ELBOW", "", "path A-B: ELBOW with 0 control points is not read"),
        ("Slanted", "", "path A-B: SLANTED with 0 control points is not read"),
        ("BEZIER", "1,2;3", "A-B, CONTROL_POINTS: \"3\" where x,y is expected"),
        ("BEZIER", "1,2;x,4", "A-B, modelLayoutElement, CONTROL_POINTS: \"x\" where a number is expected"),
    ] {
        let error = read(&[&placed, path(kind, points).as_str()].concat()).unwrap_err().to_string();
        assert!(error.starts_with(expected), "{error}");
    }
    let error = read(&[at("A->", "0", "x"), path("BEZIER", "100,-10;300,-10")].concat()).unwrap_err().to_string();
    assert!(error.starts_with("A->, modelLayoutElement, POSITION_Y: \"x\" where"), "{error}");
    let twice = [path("BEZIER", "100,-10;300,-10"), path("DIRECT", "")].concat();
    assert!(read(&twice).unwrap_err().to_string().contains("modelLayoutElement A-B: there are several"));
}

/// They disappeared.
#[test]
fn paths_that_are_elsewhere_in_a_model_are_refused() {
    let path = "<path name=\"x\" sourcePoint=\"B\" destinationPoint=\"C\" length=\"1\" maxVelocity=\"1\" maxReverseVelocity=\"0\"/>";
    let nested = failed(&plant(&format!("<group>{path}</group>")));
    assert!(nested.starts_with("path x, in group: what is read is path in model; --partial"), "{nested}");
    let upper = failed(&plant(&path.replace("<path", "<Path")));
    assert!(upper.starts_with("Path x, in model: what is read is path in model; --partial"), "{upper}");
    let vehicle = failed(&plant("<fleet><vehicle name=\"v\"/></fleet>"));
    assert!(vehicle.starts_with("vehicle v, in fleet: "), "{vehicle}");
    let mut warnings = Warnings::default();
    let more =
        format!("<block name=\"b\"/><group name=\"g\"/><lane name=\"l\"/>{}", path.replace("/>", "><curve/></path>"));
    let text = plant(&more);
    layout(InputFormat::OpenTcs, &text, &options(&[]), &mut warnings).unwrap();
    for expected in ["lane: not known in model, and not read", "curve: not known in path, and not read"] {
        assert!(warnings.lines().contains(&expected.to_owned()), "{:?}", warnings.lines());
    }
    assert!(
        !warnings.lines().iter().any(|line| line.contains("block") || line.contains("group")),
        "{:?}",
        warnings.lines()
    );
}

/// A closure of the block would leave them open.
#[test]
fn members_of_blocks_that_are_not_there_are_told() {
    let mut warnings = Warnings::default();
    let text = plant(
        "<location name=\"L\"/><block name=\"b\"><member name=\"A->\"/><member name=\"L\"/><member name=\"A-X\"/><membr name=\"B\"/></block>",
    );
    let read = layout(InputFormat::OpenTcs, &text, &options(&[]), &mut warnings).unwrap().layout;
    let lines = warnings.lines();
    let told: Vec<&String> = lines.iter().filter(|line| line.contains("block")).collect();
    assert_eq!(
        told,
        [
            "membr: not known in block, and not read",
            "block b: its member A-X is not there; a closure of the block does not close it"
        ]
    );
    let named: Vec<String> = read.zones[0].nodes.iter().map(|&node| read.nodes[node].id.to_string()).collect();
    assert_eq!((read.zones.len(), named, read.zones[0].edges.len()), (1, vec!["A->".to_owned()], 0));
}
