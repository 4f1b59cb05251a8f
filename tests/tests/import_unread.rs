//! What readers of layouts do not read is refused or told: an answer without it would be one about another layout.

use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout};

/// The warnings about a layout, or why it is refused.
fn read(format: InputFormat, text: &str) -> Result<Vec<String>, String> {
    let mut warnings = Warnings::default();
    let options = ImportOptions { radius: Some(0.5), ..ImportOptions::default() };
    let read = layout(format, text, &options, &mut warnings);
    read.map(|_| warnings.lines()).map_err(|error| error.to_string())
}

/// A road of OpenDRIVE with these links, in a file with some more.
fn road(links: &str, view: &str, more: &str) -> String {
    let line = "<geometry x=\"0\" y=\"0\" hdg=\"0\" length=\"5\"><line/></geometry>";
    let other = line.replace("x=\"0\"", "x=\"5\"");
    format!(
        "<OpenDRIVE>{more}<road id=\"1\">{links}<planView>{line}{view}</planView></road>\
        <road id=\"2\"><planView>{other}</planView></road></OpenDRIVE>"
    )
}

/// They were left out, and there were no locks with the roads in them.
#[test]
fn parts_of_opendrive_in_other_files_are_refused() {
    let include = "<include file=\"more.xodr\"/>";
    for (text, parent) in [(road("", "", include), "OpenDRIVE"), (road("", include, ""), "planView")] {
        let error = read(InputFormat::OpenDrive, &text).unwrap_err();
        assert!(error.contains(&format!("include of more.xodr, in {parent}")), "{error}");
    }
    let error = read(
        InputFormat::OpenDrive,
        &road("", "<Geometry x=\"5\" y=\"0\" hdg=\"0\" length=\"5\"><line/></Geometry>", ""),
    );
    assert!(error.clone().is_err_and(|error| error.starts_with("road 1, planView: Geometry is not read")), "{error:?}");
}

/// The ends of the roads were two nodes, and nothing was said.
#[test]
fn links_of_opendrive_that_are_not_understood_are_told() {
    let link =
        |kind: &str| road(&format!("<link><successor {kind} elementId=\"2\" contactPoint=\"start\"/></link>"), "", "");
    assert_eq!(read(InputFormat::OpenDrive, &link("elementType=\"road\"")), Ok(Vec::new()));
    assert_eq!(read(InputFormat::OpenDrive, &link("elementType=\"junction\"")), Ok(Vec::new()));
    for kind in ["", "elementType=\"Road\""] {
        let warnings = read(InputFormat::OpenDrive, &link(kind)).unwrap();
        let expected = "road 1, successor: its elementType is not road and not junction; no route leads over it";
        assert_eq!(warnings, [expected], "{kind}");
    }
    let twice = road("<link/><link/>", "", "");
    assert!(read(InputFormat::OpenDrive, &twice).is_err_and(|error| error.contains("road, link: there are several")));
}

/// A model of openTCS with two points and a path between them.
fn model(path: &str, point: &str, more: &str) -> String {
    let at = |name: &str, x: u32| format!("<point name=\"{name}\" positionX=\"{x}\" positionY=\"0\">{point}</point>");
    let ends = "name=\"p\" sourcePoint=\"a\" destinationPoint=\"b\" length=\"5000\"";
    format!("<model>{}{}<path {ends} {path}/>{more}</model>", at("a", 0), at("b", 5000))
}

/// A lock that was written in another way was none.
#[test]
fn attributes_of_opentcs_that_are_not_understood_are_refused() {
    for (locked, closed) in [("true", true), ("1", true), ("false", false), (" 0 ", false)] {
        let warnings = read(InputFormat::OpenTcs, &model(&format!("locked=\"{locked}\""), "", "")).unwrap();
        assert_eq!(warnings.iter().any(|line| line.contains("it is locked")), closed, "{locked}");
    }
    for (path, expected) in [
        ("locked=\"TRUE\"", "path p, locked: TRUE where true or false is expected"),
        ("locked=\"\"", "path p, locked:  where true or false is expected"),
        ("maxVelocity=\"-1\"", "path p, maxVelocity: -1 where a number from 0 is expected"),
        ("maxReverseVelocity=\"-1\"", "path p, maxReverseVelocity: -1 where a number from 0 is expected"),
    ] {
        let error = read(InputFormat::OpenTcs, &model(path, "", "")).unwrap_err();
        assert!(error.starts_with(expected), "{error}");
    }
}

/// A box of another name was no box, and the vehicle the usual disc.
#[test]
fn elements_of_opentcs_that_are_not_known_are_told() {
    let vehicle = |inner: &str| format!("<vehicle name=\"v\"><{inner} length=\"4000\" width=\"3000\"/></vehicle>");
    for (text, expected) in [
        (model("", "", &vehicle("BoundingBox")), "BoundingBox: not known in vehicle, and not read"),
        (model("", "<pointlayout/>", ""), "pointlayout, pointlayout: not known in point, and not read"),
    ] {
        let warnings = read(InputFormat::OpenTcs, &text).unwrap();
        assert!(warnings.contains(&expected.to_owned()), "{warnings:?}");
    }
    let known = model("maxVelocity=\"1000\"", "<maxVehicleBoundingBox/><property/>", &vehicle("vehicleLayout"));
    assert_eq!(read(InputFormat::OpenTcs, &known), Ok(Vec::new()));
}

/// A place in the file was the name of what had none, and written exclusions named a path that has an empty name.
#[test]
fn what_has_no_name_is_refused() {
    let plant = model("", "", "");
    let roadmap = |node: &str| {
        let at = |id: &str, x: u32| format!("<node {id}><data key=\"c\">{x},0</data></node>");
        format!(
            "<graphml><key id=\"c\" for=\"node\" attr.name=\"coords\"/><graph edgedefault=\"undirected\">{}{}{}\
             <edge source=\"a\" target=\"b\"/></graph></graphml>",
            at("id=\"a\"", 0),
            at("id=\"b\"", 5),
            at(node, 9)
        )
    };
    let road = |id: &str| {
        let line = "<geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"5\"><line/></geometry>";
        let one = |id: &str| format!("<road {id} junction=\"-1\" length=\"5\"><planView>{line}</planView></road>");
        format!("<OpenDRIVE>{}{}</OpenDRIVE>", one("id=\"1\""), one(id))
    };
    for (format, text, expected) in [
        (InputFormat::OpenTcs, plant.replacen("path name=", "path names=", 1), "path at place 1: it has no name"),
        (InputFormat::OpenTcs, plant.replacen("name=\"p\"", "name=\" \"", 1), "path at place 1: it has no name"),
        (InputFormat::OpenTcs, plant.replacen(" name=\"b\"", "", 1), "point at place 2: it has no name"),
        (InputFormat::Ccbs, roadmap(""), "node at place 3: it has no id"),
        (InputFormat::Ccbs, roadmap("id=\"\""), "node at place 3: it has no id"),
        (InputFormat::OpenDrive, road(""), "road at place 2: it has no id"),
        (InputFormat::OpenDrive, road("id=\"\""), "road at place 2: it has no id"),
    ] {
        let error = read(format, &text).expect_err(expected);
        assert!(error.starts_with(expected), "{error}");
    }
    for (format, text) in [
        (InputFormat::OpenTcs, plant),
        (InputFormat::Ccbs, roadmap("id=\"c\"")),
        (InputFormat::OpenDrive, road("id=\"2\"")),
    ] {
        assert!(read(format, &text).is_ok(), "{text}");
    }
}
