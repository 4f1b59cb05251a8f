//! Finds the tokens by which two edges can exclude each other, starting from the tokens: most pairs of edges have no
//! token in common, and edges with hundreds of locks have few in common.

use crate::{ExclusionRules, TokenSpan};

/// Two edges, or one, in ascending order, and a token that is taken on one and barred on the other; sorted.
pub(crate) struct TokenConflicts(Vec<([usize; 2], usize)>);

/// Tokens that are taken, or barred, and where; sorted.
fn having(rules: &ExclusionRules, bars: bool) -> Vec<(usize, usize)> {
    let mut all = Vec::new();
    for (edge, way) in rules.edges.iter().enumerate().flat_map(|(edge, ways)| ways.iter().map(move |way| (edge, way))) {
        let marks = way.marks().iter().filter(|mark: &&TokenSpan| mark.bars == bars);
        all.extend(marks.map(|mark| (mark.token, edge)));
    }
    all.sort_unstable();
    all.dedup();
    all
}

impl TokenConflicts {
    pub(crate) fn of(rules: &ExclusionRules) -> Self {
        let (taking, barring) = (having(rules, false), having(rules, true));
        let mut found = Vec::new();
        let mut ahead = taking.chunk_by(|a, b| a.0 == b.0).peekable();
        for bars in barring.chunk_by(|a, b| a.0 == b.0) {
            let Some(&(token, _)) = bars.first() else { continue };
            while ahead.next_if(|takes| takes[0].0 < token).is_some() {}
            let takes = ahead.next_if(|takes| takes[0].0 == token).unwrap_or_default();
            for (a, b) in bars.iter().flat_map(|&(_, a)| takes.iter().map(move |&(_, b)| (a, b))) {
                // Two edges of which each takes and bars it are found once.
                let has = |list: &[(usize, usize)], edge| list.binary_search(&(token, edge)).is_ok();
                if a <= b || !has(takes, a) || !has(bars, b) {
                    found.push(([a.min(b), a.max(b)], token));
                }
            }
        }
        found.sort_unstable();
        Self(found)
    }

    /// The tokens of two edges, in either order.
    pub(crate) fn tokens(&self, [a, b]: [usize; 2]) -> impl Iterator<Item = usize> {
        let pair = [a.min(b), a.max(b)];
        let from = self.0.partition_point(|(other, _)| *other < pair);
        self.0[from..].iter().take_while(move |(other, _)| *other == pair).map(|(_, token)| *token)
    }

    /// All pairs that have some.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        self.0.chunk_by(|a, b| a.0 == b.0).filter_map(|of_pair| of_pair.first()).map(|(pair, _)| *pair)
    }
}
