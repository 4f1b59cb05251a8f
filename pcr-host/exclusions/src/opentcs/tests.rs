//! Plant models of every version are cut and get exclusions as their own schema has them.

use super::version::{ModelVersion, faults};
use super::*;
use crate::{ExclusionFormat, WriteOptions, write};
use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout};
use std::sync::LazyLock;

const VERSIONS: [&str; 7] = ["0.0.1", "0.0.2", "0.0.3", "0.0.4", "0.0.5", "6.0.0", "7.0.0"];

/// The same plant in each version.
static PLANTS: LazyLock<[String; 7]> = LazyLock::new(|| {
    VERSIONS.map(|version| {
        let path = format!("{}/../../tests/data/small/opentcs/plant-{version}.xml", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
    })
});

fn written(
    text: &str,
    split: Option<f64>,
    envelopes: Option<&str>,
) -> Result<(String, crate::WriteReport), ImportError> {
    let options = ImportOptions { radius: Some(0.55), ..ImportOptions::default() };
    let settings = WriteOptions { target: ExclusionFormat::OpenTcs, split, envelopes: envelopes.map(str::to_owned) };
    write(InputFormat::OpenTcs, text, &options, "plant", &settings).map(|(text, report, _)| (text, report))
}

fn version(text: &str) -> ModelVersion {
    ModelVersion::of(parse(text).unwrap().root_element()).unwrap()
}

fn assert_of_its_version(text: &str) {
    let document = parse(text).unwrap();
    let found = faults(document.root_element(), version(text));
    assert!(found.is_empty(), "{found:?}\n{text}");
}

#[test]
fn new_points_are_where_their_version_has_them() {
    for plant in PLANTS.iter() {
        assert_of_its_version(plant);
        let version = version(plant);
        let (text, report) = written(plant, Some(2.5), None).unwrap();
        assert_of_its_version(&text);
        let document = parse(&text).unwrap();
        let root = document.root_element();
        let points: Vec<Node<'_, '_>> = elements(root, "point").collect();
        // Five parts of A --- B and of E --- 5, four of C --- D; what is curved or belongs to a whole path is left. The first version has
        // no curves.
        let of_straight = usize::from(version == ModelVersion::V001);
        assert_eq!((points.len(), report.nodes), (7 + 4 + 4 + 3 + of_straight, points.len()), "{version}\n{text}");
        let place = |point: &Node<'_, '_>| {
            version.places()[0].map(|name| point.attribute(name).map(|at| at.parse::<i64>().unwrap()))
        };
        let at = |path: &str, k: usize| {
            let mut of = points.iter().filter(|point| name(**point).starts_with(&format!("{path}+")));
            place(of.nth(k - 1).unwrap())
        };
        // A is at (-137, 211, 0), B at (9876, 199, 40).
        for (k, expected) in [(1, [1866, 209, 8]), (2, [3868, 206, 16]), (3, [5871, 204, 24]), (4, [7873, 201, 32])] {
            assert_eq!(at("A --- B", k), expected.map(Some), "{version}");
        }
        // Of E and 5 the height is not said, where it need not be.
        let height = version.has_boxes().then_some(0);
        assert_eq!(at("E --- 5", 2), [Some(3884), Some(1194), height], "{version}");
        assert_eq!(at("C --- D", 2)[..2], [Some(5007), Some(5)], "{version}");
        // Where it is drawn: the same place here.
        let drawn = points.iter().find(|point| name(**point).starts_with("C --- D+2")).unwrap();
        if let Some(names) = version.drawn() {
            let own = elements(*drawn, "pointLayout").next().unwrap();
            assert_eq!(names.map(|name| own.attribute(name)), [Some("5005"), Some("-1997")], "{version}");
        }
        let visual = Visual::of(root);
        if let Some(element) = visual.element(name(*drawn)) {
            let own = ["POSITION_X", "POSITION_Y"].map(|key| Visual::value(element, key));
            assert_eq!(own, [Some("5005"), Some("-1997")], "{version}");
        }
        // In versions up to 0.0.3 whatever has a name is drawn by the visual layout, or nothing is.
        let all = root.children().filter(|child| {
            child.is_element()
                && !["visualLayout", "staticRoute", "group", "property"].contains(&child.tag_name().name())
        });
        let is_drawn: BTreeSet<bool> = all.map(|child| visual.element(name(child)).is_some()).collect();
        assert_eq!(
            is_drawn,
            BTreeSet::from([[ModelVersion::V002, ModelVersion::V003].contains(&version)]),
            "{version}"
        );
        // Groups and blocks have the parts of their paths.
        let members = |kind: &'static str, of: &str| {
            let found =
                elements(root, kind).find(|group| name(*group) == of).map(|group| elements(group, "member").count());
            found.unwrap_or_default()
        };
        assert_eq!(members("block", "mine"), 2 + 2 * 4, "{version}");
        assert!(elements(root, "block").filter(|block| is_ours(name(*block))).count() > 3, "{version}\n{text}");
        assert_eq!(written(&text, Some(2.5), None).unwrap().0, text, "{version}: written again");
    }
}

#[test]
fn parts_share_what_their_path_costs() {
    let (text, report) = written(&PLANTS[1], Some(2.5), None).unwrap();
    let document = parse(&text).unwrap();
    let sum = |attribute: &str, of: &str| -> u32 {
        let parts = elements(document.root_element(), "path").filter(|path| name(*path).starts_with(of));
        parts.map(|path| path.attribute(attribute).unwrap().parse::<u32>().unwrap()).sum()
    };
    assert_eq!((sum("routingCost", "A --- B"), sum("length", "A --- B")), (1001, 10013));
    // A cost of 1 cannot be shared by four.
    assert_eq!(sum("routingCost", "C --- D"), 4);
    let told = "routingCost: smaller than the number of parts, so each part has it: C --- D";
    assert!(report.warnings.iter().any(|line| line.starts_with(told)), "{:?}", report.warnings);
    // What stands for a path as a whole is not cut: here a static route, and actions at distances.
    let plant = PLANTS[1].replace("<property name=\"tcs:routingCostForward\" value=\"9\"/>", "");
    let (_, report) = written(&plant, Some(2.5), None).unwrap();
    assert!(
        report.warnings.iter().any(|line| line.contains("static routes lead over them: G --- 5")),
        "{:?}",
        report.warnings
    );
    let actions = "<typeActions vehicleType=\"t\"><action distance=\"1\" action=\"a\"><orientation name=\"o\"/></action></typeActions>";
    let plant = PLANTS[1].replace("<property name=\"tcs:routingCostForward\" value=\"9\"/>", actions);
    let (_, report) = written(&plant, Some(2.5), None).unwrap();
    assert!(
        report.warnings.iter().any(|line| line.contains("distances along all of them: G --- 5")),
        "{:?}",
        report.warnings
    );
}

#[test]
fn curves_are_the_same_in_every_version_that_has_them() {
    let lengths = PLANTS[1..].iter().map(|plant| {
        let options = ImportOptions { radius: Some(0.55), ..ImportOptions::default() };
        let read = layout(InputFormat::OpenTcs, plant, &options, &mut Warnings::default()).unwrap().layout;
        read.edges.iter().find(|edge| edge.id.to_string() == "17").unwrap().length()
    });
    let lengths: Vec<f64> = lengths.collect();
    assert!(lengths.iter().all(|length| *length == lengths[0] && *length > 5.1), "{lengths:?}");
}

#[test]
fn envelopes_are_written_where_a_version_has_them() {
    for plant in PLANTS.iter() {
        let version = version(plant);
        for split in [None, Some(2.5)] {
            match written(plant, split, Some("all")) {
                Ok((text, _)) => {
                    assert!(version.has_envelopes() && text.contains("<vehicleEnvelope key=\"all\">"), "{version}");
                    assert_of_its_version(&text);
                }
                Err(error) => {
                    let expected = format!("--envelopes: models of version {version} have none");
                    assert!(
                        version < ModelVersion::V004 && error.to_string().starts_with(&expected),
                        "{version}: {error}"
                    );
                }
            }
        }
    }
    // A point without content gets some.
    let plant = |point: &str| {
        format!(
            "<model version=\"0.0.4\" name=\"m\">{point}<point name=\"b\" xPosition=\"3000\" yPosition=\"0\" type=\"HALT_POSITION\"/>\
             <path name=\"p\" sourcePoint=\"a\" destinationPoint=\"b\" maxVelocity=\"1\" maxReverseVelocity=\"0\" locked=\"false\"/>\
             <vehicle name=\"v\"/></model>"
        )
    };
    for end in ["/>", "></point>"] {
        let point = format!("<point name=\"a\" xPosition=\"0\" yPosition=\"0\" type=\"HALT_POSITION\"{end}");
        let (text, _) = written(&plant(&point), None, Some("k")).unwrap();
        assert_of_its_version(&text);
        assert_eq!(text.matches("<vehicleEnvelope key=\"k\">").count(), 3, "{text}");
    }
}

#[test]
fn what_a_version_needs_is_not_made_up() {
    let failed = |text: &str| written(text, Some(2.5), None).expect_err(text).to_string();
    let [old, new] = [&PLANTS[1], &PLANTS[6]];
    // What another version calls a place stays as it is, and is told.
    let other =
        PLANTS[2].replace("xPosition", "positionX").replace("yPosition", "positionY").replace("zPosition", "positionZ");
    let (text, report) = written(&other, Some(2.5), None).unwrap();
    assert!(text.contains("positionX=\"1866\" positionY=\"209\" positionZ=\"8\""), "{text}");
    assert!(
        report.warnings.iter().any(|line| line.starts_with("point, positionX: models of version 0.0.3 do not")),
        "{report:?}"
    );
    for (text, expected) in [
        (old.replace("version=\"0.0.2\" ", ""), "model, version: missing"),
        (new.replace("version=\"7.0.0\"", "version=\"8.0.0\""), "model, version: 8.0.0 is not known"),
        // Names of another version.
        (old.replace("version=\"0.0.2\"", "version=\"7.0.0\""), "point B, maxVehicleBoundingBox: missing"),
        (new.replace("version=\"7.0.0\"", "version=\"0.0.5\""), "point A, xPosition: missing"),
        (new.replace(" positionZ=\"40\"", ""), "point B, positionZ: missing"),
        (
            new.replacen("        <maxVehicleBoundingBox length=\"1200\" width=\"800\" height=\"1500\" referenceOffsetX=\"0\" referenceOffsetY=\"0\"/>\n        <outgoingPath name=\"17\"/>", "        <outgoingPath name=\"17\"/>", 1),
            "point B, maxVehicleBoundingBox: missing",
        ),
        (old.replace("id=\"7\"", "id=\"seven\""), "id: \"seven\" where a whole number is expected"),
        (old.replace("xPosition=\"9876\"", "xPosition=\"9876\" positionX=\"9876\""), "point B: positionX and xPosition"),
        (old.replace(" xPosition=\"9876\"", ""), "point B, positionX: missing"),
    ] {
        let error = failed(&text);
        assert!(error.contains(expected), "{error} is not {expected}");
    }
}
