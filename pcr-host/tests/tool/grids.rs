//! Plans on grids: those without vertex and edge conflicts have no conflict of discs at the default radius, and others have.

use crate::fixture::{file, run};
use pcr_formats::import::{ImportOptions, InputFormat, Warnings, scenario};
use pcr_formats::splitmix64::SplitMix64;
use pcr_planning::check::{CheckReport, ConflictEntry};

fn real(name: &str) -> String {
    format!("{}/../tests/data/real/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// A plan without vertex and edge conflicts on a square of cells. Each step is drawn again until it has none; agents may follow one
/// another into cells that are left.
fn random_plan(random: &mut SplitMix64, agents: usize, side: i32, steps: usize, origin: i32) -> Vec<Vec<[i32; 2]>> {
    let mut free: Vec<[i32; 2]> = (0..side * side).map(|k| [origin + k % side, origin + k / side]).collect();
    let mut paths: Vec<Vec<[i32; 2]>> = (0..agents).map(|_| vec![free.swap_remove(random.below(free.len()))]).collect();
    'step: for _ in 0..steps {
        let now: Vec<[i32; 2]> = paths.iter().map(|path| path[path.len() - 1]).collect();
        // Random steps until they fit together; if they do not, all wait.
        for _ in 0..50 {
            let next: Vec<[i32; 2]> = now
                .iter()
                .map(|[x, y]| {
                    let [dx, dy] = [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]][random.below(5)];
                    [(x + dx).clamp(origin, origin + side - 1), (y + dy).clamp(origin, origin + side - 1)]
                })
                .collect();
            if conflict_of(&now, &next).is_none() {
                paths.iter_mut().zip(next).for_each(|(path, cell)| path.push(cell));
                continue 'step;
            }
        }
        paths.iter_mut().zip(now).for_each(|(path, cell)| path.push(cell));
    }
    paths
}

/// Two agents that are in one cell after a step, or have exchanged their cells.
fn conflict_of(now: &[[i32; 2]], next: &[[i32; 2]]) -> Option<[usize; 2]> {
    let pairs = (0..now.len()).flat_map(|a| (0..a).map(move |b| [b, a]));
    let mut meet = pairs.filter(|[a, b]| next[*a] == next[*b] || next[*a] == now[*b] && next[*b] == now[*a]);
    meet.next()
}

fn plan_text(paths: &[Vec<[i32; 2]>]) -> String {
    let line = |(k, path): (usize, &Vec<[i32; 2]>)| {
        format!("Agent {k}: {}\n", path.iter().map(|[x, y]| format!("({x},{y})->")).collect::<String>())
    };
    paths.iter().enumerate().map(line).collect()
}

fn grid_conflicts(text: &str) -> Vec<ConflictEntry> {
    let (options, mut warnings) = (ImportOptions::default(), Warnings::default());
    let scenario = scenario(InputFormat::Grid, text, &options, &mut warnings).unwrap();
    CheckReport::compute::<f64>(&scenario, false).unwrap().conflicts
}

/// At the default radius no valid plan has a conflict, however it is rounded, and a plan that is not valid has one.
#[test]
fn valid_plans_on_grids_have_no_conflict() {
    let mut random = SplitMix64(54);
    let (mut followed, mut invalid) = (0, 0);
    for k in 0..300 {
        let (agents, side) = (2 + k % 7, 3 + (k % 4) as i32);
        let origin = [0, -7, 40, 999_000, -1_000_000][k % 5];
        let paths = random_plan(&mut random, agents, side, 12, origin);
        let text = plan_text(&paths);
        assert_eq!(grid_conflicts(&text), [], "{text}");
        followed += corners(&paths);
        // The last agent goes the way of the first one backward: they are in one cell after half of the steps.
        let mut wrong = paths.clone();
        wrong[agents - 1] = paths[0].iter().rev().copied().collect();
        invalid += usize::from(!grid_conflicts(&plan_text(&wrong)).is_empty());
    }
    assert_eq!(invalid, 300);
    assert!(followed > 100, "{followed}");
}

/// How often an agent leaves a cell that another one enters around a corner, which is as near as two agents come.
fn corners(paths: &[Vec<[i32; 2]>]) -> usize {
    let step = |path: &[[i32; 2]]| [path[1][0] - path[0][0], path[1][1] - path[0][1]];
    let is_corner = |a: &[[i32; 2]], b: &[[i32; 2]]| {
        let [u, v] = [step(a), step(b)];
        a[1] == b[0] && u != [0, 0] && v != [0, 0] && u[0] * v[0] + u[1] * v[1] == 0
    };
    let pairs = paths.iter().flat_map(|a| paths.iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| a.windows(2).zip(b.windows(2)).filter(|(a, b)| is_corner(a, b)).count()).sum()
}

/// Plans in which agents follow one another around corners, and the least plans that are not valid.
#[test]
fn rings_on_grids_are_free_and_exchanges_are_not() {
    let ring = "Agent 0: (0,0)->(1,0)->(2,0)->\nAgent 1: (1,0)->(2,0)->(2,1)->\nAgent 2: (2,0)->(2,1)->(1,1)->\n\
                Agent 3: (2,1)->(1,1)->(0,1)->\nAgent 4: (1,1)->(0,1)->(0,0)->\nAgent 5: (0,1)->(0,0)->(1,0)->\n";
    let waits = "Agent 0: (2,2)->(3,2)->(2,2)->(2,2)->(3,2)->\nAgent 1: (2,1)->(2,0)->(2,0)->(2,0)->(2,1)->\n\
                 Agent 2: (2,0)->(3,0)->(3,0)->(3,0)->(3,1)->\nAgent 3: (1,1)->(0,1)->(0,1)->(0,0)->(0,0)->\n\
                 Agent 4: (4,1)->(3,1)->(3,1)->(2,1)->(1,1)->\nAgent 5: (1,2)->(1,2)->(0,2)->(0,1)->(0,1)->\n";
    for (name, text, status) in [
        ("ring.txt", ring, 0),
        ("waits.txt", waits, 0),
        ("vertex.txt", "Agent 0: (0,0)->(1,0)->\nAgent 1: (2,0)->(1,0)->\n", 1),
        ("edge.txt", "Agent 0: (0,0)->(1,0)->\nAgent 1: (1,0)->(0,0)->\n", 1),
        ("stays.txt", "Agent 0: (0,0)->(1,0)->(2,0)->\nAgent 1: (2,0)->\n", 1),
    ] {
        let run = run(&["check", &file("formats", name, text)]);
        assert_eq!(run.status, status, "{name}: {}{}", run.out, run.err);
        assert!(run.err.contains("radius: not in the file and not given, hence taken as 0.35 m"), "{}", run.err);
    }
    let log = run(&["check", &real("ccbs/example_grid_task_log.xml")]);
    assert!(log.status == 0 && log.err.contains("0.3535 m, just below √2/4"), "{}{}", log.out, log.err);
}
