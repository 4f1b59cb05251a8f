//! Locks on curves that lines and arcs stand for, and on ways that are a point: as far as the file has them.

use pcr_formats::footprint::Footprint;
use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, VehicleTraits, Warnings, layout, ride};
use pcr_formats::scenario::PlacedSegment;
use pcr_planning::exclusion_table::ExclusionTable;
use serde_json::{Value, json};

type Point = [f64; 2];

/// A truck of 4.5 m, whose reference point is near its rear.
const TRUCK: [Point; 4] = [[4.0, 0.3], [-0.5, 0.3], [-0.5, -0.3], [4.0, -0.3]];

fn node(id: &str, [x, y]: Point) -> Value {
    json!({ "nodeId": id, "mapId": "m", "nodePosition": { "x": x, "y": y } })
}

/// An edge with a trajectory through control points for each type of vehicle.
fn edge(id: &str, ends: [&str; 2], types: &[(&str, &[Point])]) -> Value {
    let property = |(name, points): &(&str, &[Point])| {
        let degree = points.len() - 1;
        let knots: Vec<u8> = (0..2 * points.len()).map(|k| u8::from(k > degree)).collect();
        let points: Vec<Value> = points.iter().map(|[x, y]| json!({ "x": x, "y": y })).collect();
        json!({ "vehicleTypeId": name, "trajectory": { "degree": degree, "knotVector": knots, "controlPoints": points } })
    };
    let properties: Vec<Value> = types.iter().map(property).collect();
    json!({ "edgeId": id, "startNodeId": ends[0], "endNodeId": ends[1], "vehicleTypeEdgeProperties": properties })
}

fn read(nodes: Vec<Value>, edges: Vec<Value>, options: &ImportOptions) -> ImportedLayout {
    let meta = json!({ "projectIdentification": "", "creator": "", "exportTimestamp": "2030-01-01T00:00:00Z", "lifVersion": "1.0.0" });
    let file = json!({ "metaInformation": meta, "layouts": [{ "layoutId": "l", "layoutVersion": "1", "nodes": nodes, "edges": edges }] });
    layout(InputFormat::Lif, &file.to_string(), options, &mut Warnings::default()).unwrap()
}

fn at([a, b, c, d]: [Point; 4], t: f64) -> Point {
    let s = 1.0 - t;
    [0, 1].map(|k| s * s * s * a[k] + 3.0 * s * s * t * b[k] + 3.0 * s * t * t * c[k] + t * t * t * d[k])
}

/// The pose of lines and arcs at a length.
fn pose(pieces: &[PlacedSegment], length: f64) -> (Point, f64) {
    let mut rest = length;
    for piece in pieces {
        let whole = piece.shape.length();
        if rest <= whole {
            let part = piece.part(0.0, rest.max(0.0));
            return (part.end(), part.heading_at_end());
        }
        rest -= whole;
    }
    pieces.last().map_or(([0.0; 2], 0.0), |last| (last.end(), last.heading_at_end()))
}

/// The reference point was within the tolerance and the heading was not: corners of a long vehicle were up to some centimetres outside of
/// all that was taken as its area, and locks were missing.
#[test]
fn an_outline_covers_itself_on_the_curve_of_the_file() {
    let bends = [
        [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [4.0, 4.0]],
        [[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [3.0, 3.0]],
        [[0.0, 0.0], [1.5, 0.0], [1.5, 3.0], [3.0, 3.0]],
        [[0.0, 0.0], [0.3, 0.0], [3.0, 0.5], [3.0, 2.0]],
    ];
    for (bend, tolerance) in bends.into_iter().flat_map(|bend| [1e-1, 1e-2, 1e-3, 1e-4].map(|it| (bend, it))) {
        let options = ImportOptions { radius: Some(5.0), tolerance: Some(tolerance), ..ImportOptions::default() };
        let nodes = vec![node("A", bend[0]), node("B", bend[3])];
        let imported = read(nodes, vec![edge("e", ["A", "B"], &[("V", &bend)])], &options);
        let outline = Footprint::new(TRUCK.to_vec()).unwrap();
        let vehicle = VehicleTraits {
            radius: outline.circumscribed_radius(),
            footprint: Some(outline),
            ..imported.vehicle.clone()
        };
        let edge = &imported.layout.edges[0];
        let agent = ride(&vehicle, edge.steps().next().unwrap());
        let footprint = agent.footprint.as_ref().unwrap();
        let (mut length, mut worst) = (0.0, f64::NEG_INFINITY);
        const STEPS: u32 = 2_000;
        for k in 0..STEPS {
            let [from, to] = [k, k + 1].map(|k| at(bend, f64::from(k) / f64::from(STEPS)));
            let step = (to[0] - from[0]).hypot(to[1] - from[1]);
            let heading = (to[1] - from[1]).atan2(to[0] - from[0]);
            let place = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
            let (there, turned) = pose(&edge.curve, length + 0.5 * step);
            length += step;
            for [x, y] in TRUCK {
                let (sin, cos) = heading.sin_cos();
                let corner = [place[0] + x * cos - y * sin, place[1] + x * sin + y * cos];
                let (sin, cos) = turned.sin_cos();
                // From where the vehicle is on the curve that it was read as.
                let [dx, dy] = [corner[0] - there[0], corner[1] - there[1]];
                let [x, y] = [dx * cos + dy * sin, dy * cos - dx * sin];
                let around = footprint.polygon().iter().map(|[a, b]| [a - x, b - y]).collect();
                let depth = Footprint::new(around).unwrap().inner_radius() + footprint.growth();
                worst = worst.max(-depth);
            }
        }
        assert!(worst <= 1e-5, "{bend:?}, {tolerance}: {worst} m outside");
        // 5 mrad are accepted at 1 mm, and what differs at equal lengths is a little more.
        let off = edge.position_error(&vehicle);
        assert!(tolerance > 1e-3 || off < 0.025, "{bend:?}, {tolerance}: {off} m larger");
    }
}

/// The lock began a nanometre behind the corner at which the vehicle turns.
#[test]
fn a_lock_of_a_turn_within_an_edge_has_its_length() {
    let text = r#"<model name="p" version="6.0.0">
        <point name="A" positionX="0" positionY="0"/><point name="B" positionX="2000" positionY="2000"/>
        <point name="C" positionX="3200" positionY="1200"/><point name="D" positionX="4200" positionY="2200"/>
        <path name="e" sourcePoint="A" destinationPoint="B" length="4000">
          <pathLayout connectionType="POLYPATH"><controlPoint x="40" y="0"/></pathLayout></path>
        <path name="x" sourcePoint="C" destinationPoint="D" length="1414"/></model>"#;
    let options = ImportOptions { radius: Some(2.0), ..ImportOptions::default() };
    let mut imported = layout(InputFormat::OpenTcs, text, &options, &mut Warnings::default()).unwrap();
    let outline = Footprint::new(vec![[1.0, 0.2], [-1.0, 0.2], [-1.0, -0.2], [1.0, -0.2]]).unwrap();
    (imported.vehicle.radius, imported.vehicle.footprint) = (outline.circumscribed_radius(), Some(outline));
    let locks = ExclusionTable::compute(&imported, false).unwrap().locks;
    // While it turns to the left at 2 m, its front comes to the other way.
    let at_the_corner = locks.iter().any(|lock| lock.a_length[0] <= 2.0 && lock.a_length[1] >= 2.0);
    assert!(at_the_corner, "{locks:?}");
}

/// A way without length between two nodes that are apart, over a point between them: whoever has travelled it stands at the second one,
/// which no lock contained. And of two types of vehicles the ways of both count.
#[test]
fn a_way_that_is_a_point_reaches_to_both_of_its_nodes() {
    let nodes =
        || vec![node("A", [0.0, 0.0]), node("B", [0.099, 0.0]), node("C", [0.65, 0.0]), node("D", [0.65, -3.0])];
    let far = edge("x", ["C", "D"], &[("V", &[[0.65, 0.0], [0.65, -3.0]])]);
    let options = ImportOptions { radius: Some(0.28), ..ImportOptions::default() };
    let point: [Point; 2] = [[0.0495, 0.0]; 2];
    let imported = read(nodes(), vec![edge("e", ["A", "B"], &[("V", &point)]), far.clone()], &options);
    assert_eq!(ExclusionTable::compute(&imported, false).unwrap().locks.len(), 1);
    let nodes = vec![node("A", [0.0, 0.0]), node("B", [0.02, 0.0]), node("C", [0.65, 0.0]), node("D", [0.65, -3.0])];
    let (near, wide): ([Point; 2], [Point; 2]) = ([[0.01, 0.0]; 2], [[0.045, 0.0]; 2]);
    for types in [[("V", &near[..]), ("W", &wide[..])], [("W", &wide[..]), ("V", &near[..])]] {
        let imported = read(nodes.clone(), vec![edge("e", ["A", "B"], &types), far.clone()], &options);
        let deviations: Vec<f64> = imported.layout.edges.iter().map(|edge| edge.deviation).collect();
        assert!((deviations[0] - 0.045).abs() < 1e-9, "{deviations:?}");
    }
}
