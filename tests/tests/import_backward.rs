//! Edges that are travelled backward: lengths count from the other end, vehicles may be slower, and listings say so.

use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout, ride, scenario};
use pcr_planning::nodes::LayoutReport;

/// A road of lines of 1 m. They overlap by 4.9 cm at 40 joints, and are apart by as much at 80 more.
struct Road {
    begins: Vec<f64>,
}

impl Road {
    fn new() -> Self {
        let steps = (0..120).map(|joint| if joint < 40 { 1.0 - 0.049 } else { 1.0 + 0.049 });
        let begins = std::iter::once(0.0).chain(steps.scan(0.0, |at, step| {
            *at += step;
            Some(*at)
        }));
        Self { begins: begins.collect() }
    }

    fn text(&self) -> String {
        let record = |x: &f64| format!("<geometry x=\"{x}\" y=\"0\" hdg=\"0\" length=\"1\"><line/></geometry>");
        let records: String = self.begins.iter().map(record).collect();
        format!("<OpenDRIVE><road id=\"1\"><planView>{records}</planView></road></OpenDRIVE>")
    }

    /// Where a vehicle is after a length, by the records.
    fn place(&self, length: f64, backward: bool) -> f64 {
        let along = if backward { self.begins.len() as f64 - length } else { length };
        let record = (along as usize).min(self.begins.len() - 1);
        self.begins[record] + along - record as f64
    }
}

/// Only the distance at the same length from the start was counted.
#[test]
fn the_deviation_of_a_road_is_that_of_the_direction_of_travel() {
    let road = Road::new();
    let options =
        |route: &str| ImportOptions { radius: Some(0.1), routes: vec![route.into()], ..ImportOptions::default() };
    for (route, backward) in [("1/start:1/end", false), ("1/end:1/start", true)] {
        let read = scenario(InputFormat::OpenDrive, &road.text(), &options(route), &mut Warnings::default()).unwrap();
        let agent = &read.agents[0];
        let farthest = (0..=1200).map(|k| {
            let length = f64::from(k) * 0.1;
            let own = agent.start[0] + if backward { -length } else { length };
            (own - road.place(length, backward)).abs()
        });
        let farthest = farthest.fold(0.0, f64::max);
        let grown = agent.radius - 0.1;
        assert!(farthest <= grown + 1e-9 && farthest > 0.9 * grown, "{route}: {farthest} m, counted {grown}");
        // Alone, as for unsafe delays.
        let imported = layout(
            InputFormat::OpenDrive,
            &road.text(),
            &ImportOptions { routes: Vec::new(), ..options(route) },
            &mut Warnings::default(),
        )
        .unwrap();
        let step = imported.layout.edges[0].steps().find(|step| step.backward == backward).unwrap();
        assert_eq!(ride(&imported.vehicle, step).radius, agent.radius);
    }
}

/// A plant of a path that is open backward only, with these vehicles.
fn plant(vehicles: &str) -> String {
    let point = |name: &str, x: u32| format!("<point name=\"{name}\" positionX=\"{x}\" positionY=\"0\"/>");
    let path = "<path name=\"AB\" sourcePoint=\"A\" destinationPoint=\"B\" length=\"9000\" maxVelocity=\"0\" maxReverseVelocity=\"800\"/>";
    format!("<model>{}{}{path}{vehicles}</model>", point("A", 0), point("B", 9000))
}

/// They were driven as fast as forward.
#[test]
fn vehicles_of_opentcs_are_as_slow_backward_as_they_are_said_to_be() {
    let vehicle = |name: &str, back: &str| format!("<vehicle name=\"{name}\" maxVelocity=\"1000\" {back}/>");
    let speed = |vehicles: &str, options: ImportOptions| {
        let mut warnings = Warnings::default();
        let read = layout(InputFormat::OpenTcs, &plant(vehicles), &options, &mut warnings);
        read.map(|read| (read.layout.edges[0].speed[1], warnings.lines())).map_err(|error| error.to_string())
    };
    let disc = || ImportOptions { radius: Some(0.5), ..ImportOptions::default() };
    let of = |vehicles: &str| speed(vehicles, disc()).unwrap().0;
    let [slow, slower] = ["maxReverseVelocity=\"300\"", "maxReverseVelocity=\"200\""];
    assert_eq!((of(""), of(&vehicle("a", "")), of(&vehicle("a", slow))), (Some(0.8), Some(0.8), Some(0.3)));
    assert_eq!(of(&(vehicle("a", slow) + &vehicle("b", slower))), Some(0.2));
    assert_eq!(of(&vehicle("a", "maxReverseVelocity=\"2000\"")), Some(0.8));
    // Another vehicle drives.
    assert_eq!(speed(&vehicle("a", slow), ImportOptions { speed: Some(1.0), ..disc() }).unwrap().0, Some(0.8));
    let (_, warnings) = speed(&vehicle("a", "maxReverseVelocity=\"0\""), disc()).unwrap();
    assert!(warnings.iter().any(|line| line.starts_with("vehicle a: its maxReverseVelocity is 0")), "{warnings:?}");
    for field in ["maxVelocity", "maxReverseVelocity"] {
        let error = speed(&format!("<vehicle name=\"a\" {field}=\"-5\"/>"), disc()).unwrap_err();
        assert_eq!(error, format!("vehicle a, {field}: -5 where a number from 0 is expected"));
    }
}

/// It was listed as if it began where it ends, and its locks, which count from the other end, were taken to be elsewhere.
#[test]
fn an_edge_that_is_open_backward_only_is_listed_as_it_is_in_locks() {
    let options = ImportOptions { radius: Some(0.5), ..ImportOptions::default() };
    let read = layout(InputFormat::OpenTcs, &plant(""), &options, &mut Warnings::default()).unwrap().layout;
    let listing = LayoutReport::new(&read);
    let edge = &listing.edges[0];
    assert_eq!((edge.from.to_string(), edge.to.to_string()), ("A".to_owned(), "B".to_owned()));
    assert_eq!((edge.two_way, edge.backward, edge.speed, edge.speed_back), (false, true, Some(0.8), None));
}
