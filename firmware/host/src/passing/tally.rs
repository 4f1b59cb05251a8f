//! What is counted over all runs.

/// Counts over all runs, and the least distance.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    pub(crate) runs: usize,
    pub(crate) robots: usize,
    /// Orders by which one waits.
    pub(crate) orders: usize,
    /// Paths that were admitted, and refused.
    pub(crate) admitted: usize,
    pub(crate) refused: usize,
    /// Frames on the line, and how many of them suffered a fault.
    pub(crate) frames: usize,
    pub(crate) faults: usize,
    /// Robots that came to the ends of their paths.
    pub(crate) arrived: usize,
    /// Controllers that forgot everything, and those of them that had to find their places.
    pub(crate) restarts: usize,
    pub(crate) resumed: usize,
    /// Least distance between two discs \[m\].
    pub(crate) gap: f64,
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { runs, robots, orders, admitted, refused, frames, faults, arrived, restarts, resumed, gap } = self;
        writeln!(
            f,
            "{runs} runs, {robots} robots, {arrived} at the ends of their paths; {orders} times to wait for one"
        )?;
        writeln!(
            f,
            "{admitted} paths admitted on the way, {refused} refused; {frames} frames, {faults} of them damaged, lost or late"
        )?;
        writeln!(f, "{restarts} controllers restarted, {resumed} of them on the way")?;
        write!(f, "no two discs touch; the least distance is {:.1} mm", gap * 1e3)
    }
}
