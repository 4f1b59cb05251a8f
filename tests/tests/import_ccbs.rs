//! Continuous-CBS: plans of others, checked against separations that are computed here from their sections.

use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout, scenario};
use pcr_formats::scenario::Scenario;
use pcr_planning::check::CheckReport;
use pcr_planning::fleet::Fleet;

const GRID: &str = include_str!("../data/real/ccbs/example_grid_task_log.xml");
const PUBLISHED: &str = include_str!("../data/real/ccbs/example_roadmap_task_log.xml");
const MAP: &str = include_str!("../data/real/ccbs/sparse_map.xml");

/// Radius of `example_config.xml`.
const RADIUS: f64 = 0.353_553;

fn read(text: &str, radius: f64) -> Scenario {
    let options = ImportOptions { radius: Some(radius), ..ImportOptions::default() };
    scenario(InputFormat::Ccbs, text, &options, &mut Warnings::default()).unwrap()
}

/// A section: begin and end in time, and in space.
type Section = ([f64; 2], [[f64; 2]; 2]);

/// The sections of every agent, cut out of the text.
fn sections(text: &str) -> Vec<Vec<Section>> {
    let value = |line: &str, name: &str| -> f64 {
        let rest = line.split_once(&format!("{name}=\"")).unwrap().1;
        rest.split('"').next().unwrap().parse().unwrap()
    };
    let mut agents: Vec<Vec<Section>> = Vec::new();
    for line in text.lines() {
        if line.contains("<agent number") {
            agents.push(Vec::new());
        } else if line.contains("<section") {
            let [from, to] =
                [["start_i", "start_j"], ["goal_i", "goal_j"]].map(|names| names.map(|name| value(line, name)));
            let sections = agents.last_mut().unwrap();
            let begin = sections.last().map_or(0.0, |(time, _)| time[1]);
            sections.push(([begin, begin + value(line, "duration")], [from, to]));
        }
    }
    for sections in &mut agents {
        let &([_, end], [_, at]) = sections.last().unwrap();
        // It stays at its goal.
        sections.push(([end, 1e6], [at, at]));
    }
    agents
}

/// Smallest separation of two agents, and when: of each pair of sections the distance is the root of a parabola in time.
fn closest(a: &[Section], b: &[Section]) -> (f64, f64) {
    let mut best = (f64::INFINITY, 0.0);
    for (time, own) in a {
        for (other_time, other) in b {
            let (begin, end) = (time[0].max(other_time[0]), time[1].min(other_time[1]));
            if begin > end {
                continue;
            }
            let at = |t: f64| {
                let place = |time: &[f64; 2], [from, to]: &[[f64; 2]; 2], k: usize| {
                    from[k] + (to[k] - from[k]) * (t - time[0]) / (time[1] - time[0])
                };
                [0, 1].map(|k| place(time, own, k) - place(other_time, other, k))
            };
            let (first, last) = (at(begin), at(end));
            let step = [last[0] - first[0], last[1] - first[1]];
            let square = step[0] * step[0] + step[1] * step[1];
            let share =
                if square > 0.0 { (-(first[0] * step[0] + first[1] * step[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
            let separation = (first[0] + step[0] * share).hypot(first[1] + step[1] * share);
            if separation < best.0 {
                best = (separation, begin + (end - begin) * share);
            }
        }
    }
    best
}

#[test]
fn separations_are_those_of_the_sections() {
    let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/data/real/ccbs/solved");
    let mut files: Vec<_> = std::fs::read_dir(directory).unwrap().map(|file| file.unwrap().path()).collect();
    files.sort();
    assert_eq!(files.len(), 7);
    let mut texts: Vec<(String, String)> = Vec::new();
    for file in files {
        texts.push((file.file_name().unwrap().to_str().unwrap().to_owned(), std::fs::read_to_string(&file).unwrap()));
    }
    texts.push(("published".into(), PUBLISHED.into()));
    texts.push(("grid".into(), GRID.into()));
    // The smallest separation of each in nanometres, as it was computed elsewhere.
    let known = [
        ("01", 707_106_780),
        ("02", 707_105_743),
        ("04", 707_106_789),
        ("05", 707_106_748),
        ("07", 707_106_786),
        ("08", 707_106_846),
        ("09", 707_106_831),
    ];
    for (name, text) in &texts {
        let agents = sections(text);
        let scenario = read(text, RADIUS);
        assert_eq!(scenario.agents.len(), agents.len());
        let verdict = CheckReport::compute::<f64>(&scenario, true).unwrap();
        let mut least = f64::INFINITY;
        for pair in verdict.closest.as_ref().unwrap() {
            let (separation, time) = closest(&agents[pair.i as usize], &agents[pair.j as usize]);
            // Ramps of a nanosecond and turns of a nanometre.
            assert!((pair.separation - separation).abs() < 1e-7, "{name} {pair:?}: {separation} at {time}");
            least = least.min(pair.separation);
            let conflicts = verdict.conflicts.iter().filter(|conflict| (conflict.i, conflict.j) == (pair.i, pair.j));
            let deepest = conflicts.map(|conflict| conflict.depth).fold(0.0, f64::max);
            let overlap = 2.0 * RADIUS - separation;
            assert!((deepest - overlap.max(0.0)).abs() < 1e-7, "{name} {pair:?}: {deepest} {overlap}");
        }
        if let Some((_, expected)) = known.iter().find(|(number, _)| name.starts_with(&format!("sparse_{number}"))) {
            assert!((least - f64::from(*expected) * 1e-9).abs() < 1e-8, "{name}: {least} {expected}");
        }
    }
}

#[test]
fn the_published_plan_collides_and_the_solved_ones_only_touch() {
    let radius = std::f64::consts::SQRT_2 / 4.0;
    let verdict = CheckReport::compute::<f64>(&read(PUBLISHED, radius), true).unwrap();
    let deep: Vec<_> = verdict.conflicts.iter().filter(|conflict| conflict.depth > 1e-5).collect();
    assert_eq!(deep.len(), 1, "{deep:?}");
    assert_eq!((deep[0].i, deep[0].j), (0, 3));
    assert!((deep[0].t[0] - 76.6741).abs() < 1e-4 && (deep[0].t[1] - 76.9845).abs() < 1e-4, "{:?}", deep[0]);
    let pair = verdict.closest.unwrap().into_iter().find(|pair| (pair.i, pair.j) == (0, 3)).unwrap();
    assert!((pair.separation - 0.641329).abs() < 1e-6 && (pair.t - 76.829).abs() < 1e-3, "{pair:?}");
    // Exact tangency: free for a radius that is a millionth smaller.
    let touching = CheckReport::compute::<f64>(&read(GRID, radius), true).unwrap();
    assert!(touching.conflicts.iter().all(|conflict| conflict.depth < 1e-7));
    assert!(!touching.conflicts.is_empty());
    assert!(CheckReport::compute::<f64>(&read(GRID, RADIUS), false).unwrap().conflicts.is_empty());
}

#[test]
fn a_roadmap_is_a_layout() {
    let options = ImportOptions { radius: Some(RADIUS), ..ImportOptions::default() };
    let imported = layout(InputFormat::Ccbs, MAP, &options, &mut Warnings::default()).unwrap();
    assert_eq!((imported.layout.nodes.len(), imported.layout.edges.len()), (170, 698));
    let locks = pcr_planning::exclusion_table::ExclusionTable::compute(&imported, false).unwrap();
    assert!(locks.locks.len() > 698 / 2, "at least every edge with the one back");
}

#[test]
fn what_is_no_plan_is_refused_by_name() {
    let failed = |text: &str| {
        scenario(InputFormat::Ccbs, text, &ImportOptions::default(), &mut Warnings::default()).unwrap_err().to_string()
    };
    for (text, expected) in [
        (
            include_str!("../data/real/ccbs/example_grid_task.xml"),
            "a task of Continuous-CBS without its plan; the plan is in the log that the program writes",
        ),
        (include_str!("../data/real/ccbs/example_grid_map.xml"), "root: there is no log in it, hence no plan"),
        (include_str!("../data/real/ccbs/example_config.xml"), "root: there is no log in it, hence no plan"),
        ("<root><log/></root>", "log: there is no agent in it"),
        ("<root><log><agent number=\"4\"/></log></root>", "agent 4, path: missing"),
        (
            "<root><log><agent number=\"4\"><path/><path/></agent></log></root>",
            "agent, path: there are several; one is expected",
        ),
        ("<root><log/><log/></root>", "root, log: there are several; one is expected"),
        (
            "<root><log><agent number=\"x\"/></log></root>",
            "agent at place 1, number: a whole number from 0 is expected",
        ),
        ("<root><log><agent number=\"4\"><path/></agent></log></root>", "agent 4: no point at all"),
    ] {
        assert_eq!(failed(text), expected);
    }
    let torn = GRID.replacen("number=\"1\" start_i=\"5\"", "number=\"1\" start_i=\"5.5\"", 1);
    assert_eq!(failed(&torn), "agent 0, section 1: it does not begin where the one before it ends");
    let text = GRID.replacen("duration=\"1\"", "duration=\"long\"", 1);
    assert!(failed(&text).ends_with("duration: \"long\" where a number up to 1e10 is expected"), "{}", failed(&text));
    let negative = GRID.replacen("duration=\"1\"", "duration=\"-1\"", 1);
    assert!(failed(&negative).starts_with("agent 0: point "), "{}", failed(&negative));
}

#[test]
fn a_roadmap_is_read_whole_or_refused() {
    let node = |id: &str, at: &str| format!("<node id=\"{id}\"><data>{at}</data></node>");
    let edge = |id: &str, from: &str, to: &str| format!("<edge id=\"{id}\" source=\"{from}\" target=\"{to}\"/>");
    let graph = |attributes: &str, parts: &[String]| {
        let attributes = if attributes.is_empty() { "edgedefault=\"directed\"" } else { attributes };
        format!("<graphml><graph {attributes}>{}</graph></graphml>", parts.concat())
    };
    let read = |text: &str, partial: bool| {
        let options = ImportOptions { radius: Some(0.3), partial, ..ImportOptions::default() };
        layout(InputFormat::Ccbs, text, &options, &mut Warnings::default()).map_err(|error| error.to_string())
    };
    let square = [node("a", "0,0"), node("b", "4,0"), node("c", "2,-2"), node("d", "2,2")];
    // One name for two edges that cross.
    let twice = graph("", &[square.concat(), edge("e", "a", "b"), edge("e", "c", "d"), edge("e", "a", "b")]);
    let imported = read(&twice, false).unwrap();
    let ids: Vec<String> = imported.layout.edges.iter().map(|edge| edge.id.to_string()).collect();
    assert_eq!(ids, ["e", "e#2"]);
    assert_eq!(pcr_planning::exclusion_table::ExclusionTable::compute(&imported, false).unwrap().locks.len(), 1);
    let lost = graph("", &[square.concat(), edge("e", "a", "b"), edge("f", "a", "z"), node("g", "x")]);
    let error = read(&lost, false).unwrap_err();
    assert_eq!(
        error,
        "node g: its first datum is not x,y; edge f, target: there is no node z; --partial leaves that out"
    );
    assert_eq!(read(&lost, true).unwrap().layout.edges.len(), 1);
    let moved = graph("", &[square.concat(), node("a", "1,1"), edge("e", "a", "b")]);
    assert_eq!(
        read(&moved, false).unwrap_err(),
        "edge e, source: there are several different nodes a; --partial leaves that out"
    );
    // Directions as GraphML has them.
    let ways = |attributes: &str, edge: &str| {
        let text = graph(attributes, &[square.concat(), edge.to_owned()]);
        read(&text, false).unwrap().layout.edges[0].is_two_way()
    };
    assert!(
        !ways("edgedefault=\"directed\"", &edge("e", "a", "b"))
            && ways("edgedefault=\"undirected\"", &edge("e", "a", "b"))
    );
    assert!(ways("", "<edge source=\"a\" target=\"b\" directed=\"false\"/>"));
    let still = read(&graph("", &[square.concat(), node("z", "0,0"), edge("e", "a", "z"), edge("f", "a", "b")]), false)
        .unwrap()
        .layout;
    assert_eq!(still.edges.iter().map(|edge| edge.curve.len()).collect::<Vec<_>>(), [0, 1]);
    assert!(still.warnings.contains(&"edge e: its length is 0 [zero-length]".to_owned()), "{:?}", still.warnings);
    assert!(!still.warnings.iter().any(|line| line.starts_with("edge f")), "{:?}", still.warnings);
    let two = format!("<graphml>{}</graphml>", "<graph/>".repeat(2));
    assert_eq!(read(&two, false).unwrap_err(), "graphml, graph: there are several; one is expected");
}

#[test]
fn every_point_is_reached_when_it_has_to_be() {
    let stops = [
        ([0.0, 0.0], 0.0),
        ([0.0, 0.0], 5.0),
        ([3.0, 0.0], 8.0),
        ([3.0, 0.0], 10.0),
        ([3.0, 4.0], 12.0),
        ([0.0, 4.0], 12.5),
        ([0.0, 4.0], 12.5),
        ([-1.0, 4.0], 20.0),
    ];
    let sections: String = stops
        .windows(2)
        .map(|pair| {
            let [([x, y], begin), ([u, v], end)] = [pair[0], pair[1]];
            let duration = end - begin;
            format!(r#"<section start_i="{x}" start_j="{y}" goal_i="{u}" goal_j="{v}" duration="{duration}"/>"#)
        })
        .collect();
    let log = format!(r#"<root><log><agent number="0"><path>{sections}</path></agent></log></root>"#);
    let fleet = Fleet::<f64>::new(&read(&log, 0.5)).unwrap();
    let motion = fleet.motions()[0];
    assert!((motion.time().hi - 20.0).abs() < 1e-9);
    for pair in stops.windows(2) {
        let [(from, begin), (to, end)] = [pair[0], pair[1]];
        for k in 0..=20 {
            let share = f64::from(k) / 20.0;
            let at = motion.position_at(begin + (end - begin) * share);
            let expected = [0, 1].map(|k| from[k] + (to[k] - from[k]) * if end > begin { share } else { 1.0 });
            let off = (at.x - expected[0]).hypot(at.y - expected[1]);
            assert!(off < 2e-8, "{off} at {begin} + {share}");
        }
    }
}

/// What had been cut off was no fault: robots were missing, or stood where they had come to.
#[test]
fn a_plan_that_was_cut_is_refused() {
    let failed = |text: &str| {
        assert_ne!(text, GRID);
        scenario(InputFormat::Ccbs, text, &ImportOptions::default(), &mut Warnings::default()).unwrap_err().to_string()
    };
    let section = |number: usize| {
        let log = GRID.find("<log").unwrap();
        let begin = log + GRID[log..].find(&format!("<section number=\"{number}\"")).unwrap();
        begin..begin + GRID[begin..].find("/>").unwrap() + 2
    };
    let without = |range: std::ops::Range<usize>| [&GRID[..range.start], &GRID[range.end..]].concat();
    assert_eq!(failed(&without(section(0))), "agent 0, section 0, number: 1, as if some were missing before it");
    let last = (0..)
        .take_while(|number| {
            GRID[section(0).start..].split("</path>").next().unwrap().contains(&format!("number=\"{number}\""))
        })
        .last()
        .unwrap();
    let error = failed(&without(section(last)));
    assert!(error.starts_with("agent 0, path, duration: ") && error.contains(", and its sections last "), "{error}");
    let log = GRID.find("<log").unwrap();
    let begin = log + GRID[log..].find("<agent").unwrap();
    let end = begin + GRID[begin..].find("</agent>").unwrap() + "</agent>".len();
    let error = failed(&without(begin..end));
    assert_eq!(error, "log: it has the paths of 12 agents, and the task before it has 13");
    let hidden = [&GRID[..begin], "<group>", &GRID[begin..end], "</group>", &GRID[end..]].concat();
    let error = failed(&hidden);
    assert!(error.contains("12 agents"), "{error}");
    let log = "<root><log><agent><path><section start_i=\"0\" start_j=\"0\" goal_i=\"1\" goal_j=\"0\" duration=\"1\"/></path></agent>MORE</log></root>";
    assert!(
        scenario(InputFormat::Ccbs, &log.replace("MORE", ""), &ImportOptions::default(), &mut Warnings::default())
            .is_ok()
    );
    let nested = failed(&log.replace("MORE", "<group><agent number=\"4\"/></group>"));
    assert_eq!(nested, "agent 4, in group: what is read is agent in log");
    let again = failed(&log.replace("MORE", "<agent number=\"0\"><path><section start_i=\"0\" start_j=\"0\" goal_i=\"1\" goal_j=\"0\" duration=\"1\"/></path></agent>"));
    assert_eq!(again, "agent 0: it is in the log twice");
}

/// They disappeared, or led one way only.
#[test]
fn edges_of_other_kinds_are_refused() {
    let graph = |attributes: &str, more: &str| {
        let nodes = "<node id=\"a\"><data>0,0</data></node><node id=\"b\"><data>4,0</data></node>";
        let attributes = if attributes.is_empty() { "edgedefault=\"directed\"" } else { attributes };
        format!(
            "<graphml><graph {attributes}>{nodes}<edge id=\"e\" source=\"a\" target=\"b\"/>{more}</graph></graphml>"
        )
    };
    let failed = |text: &str| {
        layout(InputFormat::Ccbs, text, &ImportOptions::default(), &mut Warnings::default()).unwrap_err().to_string()
    };
    let hyper = failed(&graph("", "<hyperedge id=\"h\"/>"));
    assert!(hyper.starts_with("hyperedge h: it joins any number of nodes, and an edge joins two"), "{hyper}");
    let nested = failed(&graph(
        "",
        "<node id=\"c\"><data>9,9</data><graph id=\"g\"><edge id=\"f\" source=\"a\" target=\"b\"/></graph></node>",
    ));
    for expected in
        ["graph g, in node: what is read is graph in graph", "edge f, in graph: what is read is edge in graph"]
    {
        assert!(nested.contains(expected), "{nested}");
    }
    let odd = failed(&graph("", "<edge id=\"o\" source=\"a\" target=\"b\" directed=\"no\"/>"));
    assert!(odd.starts_with("edge o, directed: no where true or false is expected"), "{odd}");
    assert_eq!(failed(&graph("edgedefault=\"both\"", "")), "graph, edgedefault: both is not read");
    // The direction has no default.
    assert_eq!(
        failed(&graph("id=\"g\"", "")),
        "edge e: neither it (directed) nor the graph (edgedefault) says whether it leads in both directions"
    );
}

/// What is less than 1 µm was closed, and the disc passed where it does not in the file.
#[test]
fn gaps_between_sections_make_the_agent_larger() {
    let radius = |gap: f64| {
        let text = format!(
            "<root><log><agent number=\"0\"><path><section start_i=\"0\" start_j=\"0\" goal_i=\"1\" goal_j=\"0\" duration=\"1\"/>\
            <section start_i=\"1\" start_j=\"{gap}\" goal_i=\"2\" goal_j=\"0\" duration=\"1\"/></path></agent></log></root>"
        );
        read(&text, 0.5).agents[0].radius
    };
    assert!(radius(0.0) == 0.5 && (radius(8e-7) - 0.5 - 8e-7).abs() < 1e-15);
}

/// The number was read up to the comment: the node was elsewhere, and its lock missing.
#[test]
fn coordinates_are_read_past_comments() {
    let graph = |place: &str| {
        format!(
            r#"<!DOCTYPE graphml><graphml><graph id="g" edgedefault="directed"><node id="a"><data key="coords">{place}</data></node>
            <node id="b"><data key="coords">9,9</data></node><edge id="e" source="a" target="b"/></graph></graphml>"#
        )
    };
    let at = |place: &str| {
        let text = graph(place).replace("<!DOCTYPE graphml>", "");
        let read = layout(InputFormat::Ccbs, &text, &ImportOptions::default(), &mut Warnings::default()).unwrap();
        read.layout.nodes[0].point
    };
    for place in ["0,15", "0,1<!-- c -->5", "0,1<?p i?>5", "0,1<![CDATA[5]]>"] {
        assert_eq!(at(place), [0.0, 15.0], "{place}");
    }
    // What it is, is known also where it is refused.
    let text = graph("0,15");
    assert_eq!(InputFormat::detect(std::path::Path::new("g"), &text), Some(InputFormat::Ccbs));
    let refused =
        layout(InputFormat::Ccbs, &text, &ImportOptions::default(), &mut Warnings::default()).unwrap_err().to_string();
    assert!(refused.contains("DTD"), "{refused}");
}
