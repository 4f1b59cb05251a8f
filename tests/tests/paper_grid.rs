//! The numbers of connected regions of the paper's fleets, counted without the library: on a grid in coordination space.
//!
//! A cell of the grid collides if the discs overlap at its corner; cells that touch are one region. The paths come
//! from the scenario; nothing else does.

use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::{Fleet, build_ecm};

/// Width of a cell \[m\]: no two regions of these fleets are as near to one another, and no neck is as narrow.
const CELL: f64 = 0.01;

/// The points of a path at the corners of the grid.
fn points(path: pcr_core::PathRef<'_, f64>) -> Vec<[f64; 2]> {
    let steps = (path.length() / CELL).ceil() as usize;
    let at = |k: usize| path.point_at(path.length() * k as f64 / steps as f64);
    (0..=steps).map(|k| [at(k).x, at(k).y]).collect()
}

/// The representative of a region, by path halving.
fn root(parents: &mut [usize], mut k: usize) -> usize {
    while parents[k] != k {
        parents[k] = parents[parents[k]];
        k = parents[k];
    }
    k
}

/// The connected sets of corners `(row, column)` at which the distance is at most `r`.
fn connected_sets(first: &[[f64; 2]], second: &[[f64; 2]], r: f64) -> usize {
    let (mut parents, mut sets) = (Vec::new(), 0);
    let mut above: Vec<Option<usize>> = vec![None; second.len()];
    for p in first {
        let mut row = vec![None; second.len()];
        for (k, q) in second.iter().enumerate() {
            if (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2) > r * r {
                continue;
            }
            let label = parents.len();
            parents.push(label);
            sets += 1;
            row[k] = Some(label);
            let left = k.checked_sub(1).and_then(|left| row[left]);
            let touching = above[k.saturating_sub(1)..(k + 2).min(second.len())].iter().copied().chain([left]);
            for neighbour in touching.flatten() {
                let (a, b) = (root(&mut parents, label), root(&mut parents, neighbour));
                if a != b {
                    parents[a] = b;
                    sets -= 1;
                }
            }
        }
        above = row;
    }
    sets
}

#[test]
fn a_grid_in_coordination_space_has_the_same_regions() {
    for name in ["table6-5", "table6-12", "paper12"] {
        let path = format!("{}/data/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let scenario = Scenario::from_json(&std::fs::read_to_string(path).expect("a file")).expect("a scenario");
        let fleet = Fleet::<f64>::new(&scenario).expect("a fleet");
        let motions = fleet.motions();
        let ecm = build_ecm(&motions).expect("a small fleet");
        let grids: Vec<_> = motions.iter().map(|motion| points(motion.path())).collect();
        for second in 0..motions.len() {
            for first in 0..second {
                let r = motions[first].radius() + motions[second].radius();
                let expected = connected_sets(&grids[first], &grids[second], r);
                let found = ecm.pair(&motions, first, second).expect("the table of the fleet").count();
                assert_eq!(found, expected, "{name}: agents {} and {}", first + 1, second + 1);
            }
        }
    }
}
