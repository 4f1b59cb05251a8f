//! The paper's simulation of 12 agents, and the figures that the paper prints about it.

/// The scenario, rebuilt from the paper's tables (the paper gives no coordinates).
pub const SCENARIO: &str = include_str!("../scenarios/paper12.json");

/// Table V, last row: the number of collision regions of each agent. The paper counts crossings.
pub const TABLE_V: [usize; 12] = [14, 10, 18, 9, 15, 10, 8, 6, 12, 9, 10, 5];

/// Agent whose regions Table VII lists.
pub const TABLE_VII_AGENT: u64 = 3;

/// Half a unit of the last digit that the paper prints, in the unit of the number.
pub const ROUNDING: f64 = 0.05;

/// A row of Table VII, as printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperCrossing {
    /// Type of the region.
    pub piece_type: &'static str,
    /// The other agent.
    pub j: u64,
    /// Number of the crossing with that agent, counted along agent 3.
    pub k: usize,
    /// T \[s\].
    pub time: f64,
    /// L \[m\].
    pub length: f64,
    /// r̂ \[m\].
    pub r_hat: f64,
    /// Speed of the other agent \[m/s\].
    pub v: f64,
    /// θ \[rad\].
    pub theta: f64,
    /// Radius of agent 3's arc \[m\].
    pub sigma_i: Option<f64>,
    /// Radius of the other's arc \[m\].
    pub sigma_j: Option<f64>,
    /// Turn of the other's arc: +1 counter-clockwise, -1 clockwise.
    pub dir_j: Option<i8>,
}

/// Number (from 1) of the row whose direction of turn is a misprint: no path of the structure that Table V gives to
/// agent 10 can turn that way there and still meet row 1.
pub const MISPRINT: usize = 17;

const fn line(piece_type: &'static str, j: u64, k: usize, numbers: [f64; 5]) -> PaperCrossing {
    let [time, length, r_hat, v, theta] = numbers;
    PaperCrossing { piece_type, j, k, time, length, r_hat, v, theta, sigma_i: None, sigma_j: None, dir_j: None }
}

const fn on_arc(sigma_i: f64, row: PaperCrossing) -> PaperCrossing {
    PaperCrossing { sigma_i: Some(sigma_i), ..row }
}

const fn other_on_arc(sigma_j: f64, dir_j: i8, row: PaperCrossing) -> PaperCrossing {
    PaperCrossing { sigma_j: Some(sigma_j), dir_j: Some(dir_j), ..row }
}

/// Table VII: the 18 regions of agent 3, in the order of its path.
pub const TABLE_VII: [PaperCrossing; 18] = [
    line("SS", 10, 1, [19.3, 0.9, 0.3, 0.4, -0.9]),
    line("SS", 9, 1, [7.4, 1.5, 0.3, 0.4, -1.0]),
    line("SS", 1, 1, [18.8, 2.1, 0.2, 0.6, -1.1]),
    other_on_arc(1.5, 1, line("SA", 7, 1, [5.9, 2.3, 0.3, 0.5, 2.3])),
    other_on_arc(0.5, 1, line("SA", 9, 2, [10.4, 2.5, 0.3, 0.4, 1.2])),
    other_on_arc(4.0, -1, line("SA", 4, 1, [4.2, 3.2, 0.3, 0.5, 2.1])),
    on_arc(1.1, line("AS", 12, 1, [14.0, 4.2, 0.4, 0.4, -1.2])),
    on_arc(1.2, other_on_arc(2.2, 1, line("AA", 8, 1, [10.4, 4.7, 0.3, 0.4, -1.7]))),
    on_arc(1.1, line("AS", 5, 1, [11.8, 5.6, 0.3, 0.5, -1.7])),
    line("SS", 12, 2, [5.5, 6.4, 0.4, 0.4, -5.2]),
    other_on_arc(2.7, 1, line("SA", 6, 1, [12.1, 6.8, 0.3, 0.5, -1.9])),
    other_on_arc(2.2, 1, line("SA", 8, 2, [5.1, 7.1, 0.3, 0.4, -4.1])),
    other_on_arc(2.3, -1, line("SA", 9, 3, [18.3, 8.2, 0.3, 0.4, -1.5])),
    line("SS", 4, 2, [11.1, 8.7, 0.3, 0.5, -0.7]),
    line("SS", 2, 1, [7.6, 9.0, 0.3, 0.6, -5.0]),
    line("SS", 11, 1, [6.8, 9.2, 0.3, 0.4, -4.2]),
    other_on_arc(1.6, 1, line("SA", 10, 2, [6.3, 10.0, 0.3, 0.4, -4.3])),
    other_on_arc(0.8, 1, line("SA", 1, 2, [9.6, 10.8, 0.2, 0.6, -5.0])),
];
