//! What readers have in common: formats by names, options, and what is assumed where nothing is given.

use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout, scenario};

const ONE_ID: &str = include_str!("../data/cases/one-id-two-edges.geojson");

#[test]
fn formats_are_known_by_the_names_of_files() {
    for (name, format) in [
        ("a.geojson", InputFormat::Nav2),
        ("A.GEOJSON", InputFormat::Nav2),
        ("a.lif.json", InputFormat::Lif),
        ("a.lif", InputFormat::Lif),
        ("a.yaml", InputFormat::Rmf),
        ("a.yml", InputFormat::Rmf),
        ("a.path", InputFormat::Path),
        ("a.csv", InputFormat::Path),
        ("a.xodr", InputFormat::OpenDrive),
    ] {
        assert_eq!(InputFormat::detect(name.as_ref(), "{}"), Some(format), "{name}");
    }
    for name in ["a.json", "geojson", "a.txt", ""] {
        assert_eq!(InputFormat::detect(name.as_ref(), "{}"), None, "{name}");
    }
}

#[test]
fn every_option_for_layouts_is_one() {
    let none = ImportOptions::default();
    assert!(none.given().is_empty() && ImportOptions { margin: Some(0.1), ..none.clone() }.given() == ["--margin"]);
    for options in [
        ImportOptions { radius: Some(1.0), ..none.clone() },
        ImportOptions { routes: vec!["a:b".into()], ..none.clone() },
        ImportOptions { vehicle: Some("t".into()), ..none.clone() },
        ImportOptions { fleet: Some("f".into()), ..none.clone() },
        ImportOptions { graph: Some(1), ..none.clone() },
        ImportOptions { horizon: true, ..none.clone() },
        ImportOptions { partial: true, ..none.clone() },
    ] {
        assert_eq!(options.given().len(), 1, "{options:?}");
    }
}

#[test]
fn what_is_assumed_is_told() {
    let told = |options: &ImportOptions, moves: bool| {
        let mut warnings = Warnings::default();
        if moves {
            scenario(InputFormat::Nav2, ONE_ID, options, &mut warnings).unwrap();
        } else {
            layout(InputFormat::Nav2, ONE_ID, options, &mut warnings).unwrap();
        }
        warnings.lines().into_iter().filter(|line| line.starts_with("vehicle: ")).collect::<Vec<_>>()
    };
    let routes = vec!["0:1".to_owned()];
    let none = ImportOptions { routes, ..ImportOptions::default() };
    let some = "vehicle: not in the file and not given, hence taken as: ";
    assert_eq!(told(&none, false), [format!("{some}radius [m] 0.5")]);
    let all =
        "radius [m] 0.5, speed [m/s] 1, acceleration [m/s²] 0.5, rotation [rad/s] 1, rotation-acceleration [rad/s²] 1";
    assert_eq!(told(&none, true), [format!("{some}{all}")]);
    let round = ImportOptions { radius: Some(0.4), speed: Some(1.0), ..none.clone() };
    let rest = "acceleration [m/s²] 0.5, rotation [rad/s] 1, rotation-acceleration [rad/s²] 1";
    assert_eq!(told(&round, true), [format!("{some}{rest}")]);
    assert!(told(&round, false).is_empty());
    assert_eq!(layout(InputFormat::Nav2, " ", &none, &mut Warnings::default()).unwrap_err().to_string(), "empty");
}

#[test]
fn routes_have_times_of_a_size_that_is_one() {
    let starts = |route: &str| {
        let options = ImportOptions { routes: vec![route.into()], ..ImportOptions::default() };
        scenario(InputFormat::Nav2, ONE_ID, &options, &mut Warnings::default())
            .map(|scenario| scenario.agents[0].t_start)
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
    for (format, text) in [
        (InputFormat::Ccbs, log),
        (InputFormat::Grid, grid),
        (InputFormat::Vda5050, state),
        (InputFormat::Path, points),
    ] {
        let options = ImportOptions { radius: Some(0.3), margin: Some(0.5), ..ImportOptions::default() };
        let scenario = scenario(format, text, &options, &mut Warnings::default()).unwrap();
        assert!(scenario.agents.iter().all(|agent| agent.margin == 0.5), "{format}");
    }
}
