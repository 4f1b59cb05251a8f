//! What readers have in common: formats by names, options, and what is assumed where nothing is given.

use pcr_formats::import::{Format, Options, Warnings, layout, scenario};

const ONE_ID: &str = include_str!("../data/cases/one-id-two-edges.geojson");

#[test]
fn formats_are_known_by_the_names_of_files() {
    for (name, format) in [
        ("a.geojson", Format::Nav2),
        ("A.GEOJSON", Format::Nav2),
        ("a.lif.json", Format::Lif),
        ("a.lif", Format::Lif),
        ("a.yaml", Format::Rmf),
        ("a.yml", Format::Rmf),
        ("a.path", Format::Path),
        ("a.csv", Format::Path),
        ("a.xodr", Format::OpenDrive),
    ] {
        assert_eq!(Format::of(name.as_ref(), "{}"), Some(format), "{name}");
    }
    for name in ["a.json", "geojson", "a.txt", ""] {
        assert_eq!(Format::of(name.as_ref(), "{}"), None, "{name}");
    }
}

#[test]
fn every_option_for_layouts_is_one() {
    let none = Options::default();
    assert!(none.given().is_empty() && Options { margin: Some(0.1), ..none.clone() }.given() == ["--margin"]);
    for options in [
        Options { radius: Some(1.0), ..none.clone() },
        Options { routes: vec!["a:b".into()], ..none.clone() },
        Options { vehicle: Some("t".into()), ..none.clone() },
        Options { fleet: Some("f".into()), ..none.clone() },
        Options { graph: Some(1), ..none.clone() },
        Options { horizon: true, ..none.clone() },
        Options { partial: true, ..none.clone() },
    ] {
        assert_eq!(options.given().len(), 1, "{options:?}");
    }
}

#[test]
fn what_is_assumed_is_told() {
    let told = |options: &Options, moves: bool| {
        let mut warnings = Warnings::default();
        if moves {
            scenario(Format::Nav2, ONE_ID, options, &mut warnings).unwrap();
        } else {
            layout(Format::Nav2, ONE_ID, options, &mut warnings).unwrap();
        }
        warnings.lines().into_iter().filter(|line| line.starts_with("vehicle: ")).collect::<Vec<_>>()
    };
    let routes = vec!["0:1".to_owned()];
    let none = Options { routes, ..Options::default() };
    let some = "vehicle: not in the file and not given, hence taken as: ";
    assert_eq!(told(&none, false), [format!("{some}radius [m] 0.5")]);
    let all =
        "radius [m] 0.5, speed [m/s] 1, acceleration [m/s²] 0.5, rotation [rad/s] 1, rotation-acceleration [rad/s²] 1";
    assert_eq!(told(&none, true), [format!("{some}{all}")]);
    let round = Options { radius: Some(0.4), speed: Some(1.0), ..none.clone() };
    let rest = "acceleration [m/s²] 0.5, rotation [rad/s] 1, rotation-acceleration [rad/s²] 1";
    assert_eq!(told(&round, true), [format!("{some}{rest}")]);
    assert!(told(&round, false).is_empty());
    assert_eq!(layout(Format::Nav2, " ", &none, &mut Warnings::default()).unwrap_err().to_string(), "empty");
}

#[test]
fn routes_have_times_of_a_size_that_is_one() {
    let starts = |route: &str| {
        let options = Options { routes: vec![route.into()], ..Options::default() };
        scenario(Format::Nav2, ONE_ID, &options, &mut Warnings::default()).map(|scenario| scenario.agents[0].t_start)
    };
    assert_eq!((starts("0:1"), starts("0:1@-7.5"), starts("0:1@999999")), (Ok(0.0), Ok(-7.5), Ok(999_999.0)));
    assert!(starts("0:1@1000001").is_err() && starts("0:1@nan").is_err());
}

/// The margin of the fleet, or of the command line, was dropped for plans with times.
#[test]
fn plans_with_times_have_the_margin_of_their_vehicle() {
    let log = include_str!("../data/real/ccbs/example_grid_task_log.xml");
    let grid = include_str!("../data/small/grid.path");
    let state = include_str!("../data/small/state.json");
    let points = include_str!("../data/small/points.path");
    for (format, text) in [(Format::Ccbs, log), (Format::Grid, grid), (Format::Vda5050, state), (Format::Path, points)]
    {
        let options = Options { radius: Some(0.3), margin: Some(0.5), ..Options::default() };
        let scenario = scenario(format, text, &options, &mut Warnings::default()).unwrap();
        assert!(scenario.agents.iter().all(|agent| agent.margin == 0.5), "{format}");
    }
}
