//! An edge in one direction, and the resources that a vehicle holds on its stretches.

use crate::ResourceClaim;
use std::sync::Arc;

/// A stretch of an edge on which a vehicle has a claim.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimSpan {
    /// From and to, from the start of the edge \[m\].
    pub length: [f64; 2],
    /// What it has there.
    pub claim: ResourceClaim,
}

/// A stretch on which a vehicle takes a token, or bars others from taking it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TokenSpan {
    /// Number of the token.
    pub token: usize,
    /// Whether others are barred.
    pub bars: bool,
    /// From and to, from the start of the edge \[m\].
    pub range: [f64; 2],
}

/// An edge in one direction. What it has is held by marks, as sections of an edge with hundreds of locks would each repeat most of them.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectedEdgeRules {
    length: f64,
    back: bool,
    /// By token.
    marks: Arc<Vec<TokenSpan>>,
    /// Where nobody may be.
    closed: Arc<Vec<[f64; 2]>>,
}

impl DirectedEdgeRules {
    /// Both directions of an edge with the same marks.
    pub(crate) fn both(length: f64, marks: Vec<TokenSpan>, closed: Vec<[f64; 2]>) -> [Self; 2] {
        let ahead = Self::one_way(length, false, marks, closed);
        let back = Self { back: true, ..ahead.clone() };
        [ahead, back]
    }

    /// One direction of an edge.
    pub(crate) fn one_way(length: f64, back: bool, mut marks: Vec<TokenSpan>, closed: Vec<[f64; 2]>) -> Self {
        marks.sort_by(|a, b| (a.token, a.bars).cmp(&(b.token, b.bars)).then(a.range[0].total_cmp(&b.range[0])));
        Self { length, back, marks: Arc::new(marks), closed: Arc::new(closed) }
    }

    /// Whether it is travelled from its end to its start.
    pub(crate) fn is_backward(&self) -> bool {
        self.back
    }

    /// One claim on all of an edge.
    pub(crate) fn whole(length: f64, back: bool, claim: &ResourceClaim) -> Self {
        let range = [0.0, length];
        let mark = |bars: bool| move |&token: &usize| TokenSpan { token, bars, range };
        let marks = claim.acquired.iter().map(mark(false)).chain(claim.blocked.iter().map(mark(true))).collect();
        let [ahead, backward] = Self::both(length, marks, if claim.closed { vec![range] } else { Vec::new() });
        if back { backward } else { ahead }
    }

    /// What is taken and barred somewhere, by token; again for every stretch.
    pub fn marks(&self) -> &[TokenSpan] {
        &self.marks
    }

    /// Its stretches in the order in which they are travelled, each with its claim.
    pub fn sections(&self) -> Vec<ClaimSpan> {
        self.cut(&self.marks)
    }

    /// The sections of two ways as far as one of them excludes the other, by tokens that one of them takes and the other bars.
    pub(crate) fn between(a: &Self, b: &Self, tokens: impl IntoIterator<Item = usize>) -> [Vec<ClaimSpan>; 2] {
        let [mut of_a, mut of_b] = [Vec::new(), Vec::new()];
        for token in tokens {
            let [own, other] = [a, b].map(|way| way.of(token));
            let has = |marks: &[TokenSpan], bars: bool| marks.iter().any(|mark| mark.bars == bars);
            if [false, true].iter().any(|&bars| has(own, bars) && has(other, !bars)) {
                of_a.extend_from_slice(own);
                of_b.extend_from_slice(other);
            }
        }
        [a.cut(&of_a), b.cut(&of_b)]
    }

    /// The marks of a token.
    fn of(&self, token: usize) -> &[TokenSpan] {
        let from = self.marks.partition_point(|mark| mark.token < token);
        let long = self.marks[from..].iter().take_while(|mark| mark.token == token).count();
        &self.marks[from..from + long]
    }

    /// Its sections as far as somebody with this claim keeps others off them.
    pub(crate) fn excluded_spans(&self, claim: &ResourceClaim) -> Vec<ClaimSpan> {
        let barred = |mark: &&TokenSpan| !mark.bars && claim.blocked.binary_search(&mark.token).is_ok();
        self.cut(&self.marks.iter().filter(barred).copied().collect::<Vec<_>>())
    }

    /// Cut wherever one of these marks begins or ends.
    fn cut(&self, marks: &[TokenSpan]) -> Vec<ClaimSpan> {
        let ends = marks.iter().flat_map(|mark| mark.range).chain(self.closed.iter().flatten().copied());
        let mut cuts: Vec<f64> = ends.chain([0.0, self.length]).map(|cut| cut.clamp(0.0, self.length)).collect();
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        if cuts.len() == 1 {
            cuts.push(self.length);
        }
        let section = |pair: &[f64]| {
            let covers = |[from, to]: [f64; 2]| from <= pair[0] && pair[1] <= to;
            let tokens = |bars: bool| {
                let there = marks.iter().filter(|mark| mark.bars == bars && covers(mark.range));
                let mut tokens: Vec<usize> = there.map(|mark| mark.token).collect();
                tokens.dedup();
                tokens
            };
            let closed = self.closed.iter().any(|&range| covers(range));
            ClaimSpan {
                length: [pair[0], pair[1]],
                claim: ResourceClaim { acquired: tokens(false), blocked: tokens(true), closed },
            }
        };
        let mut sections: Vec<ClaimSpan> = Vec::new();
        for pair in cuts.windows(2) {
            let next = section(pair);
            match sections.last_mut() {
                Some(last) if last.claim == next.claim => last.length[1] = next.length[1],
                _ => sections.push(next),
            }
        }
        if self.back {
            sections.reverse();
        }
        sections
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::splitmix64::SplitMix64;

    #[test]
    fn an_edge_without_length_is_one_section() {
        let marks = vec![TokenSpan { token: 3, bars: true, range: [0.0, 0.0] }];
        let [ahead, _] = DirectedEdgeRules::both(0.0, marks, Vec::new());
        let claim = ResourceClaim { acquired: Vec::new(), blocked: vec![3], closed: false };
        assert_eq!(ahead.sections(), [ClaimSpan { length: [0.0, 0.0], claim }]);
    }

    #[test]
    fn sections_between_two_ways_exclude_as_all_of_them_do() {
        let mut random = SplitMix64(9);
        let mut below = |most: usize| random.below(most);
        let mut excluded = 0;
        for _ in 0..300 {
            let mut way = |closes: bool| {
                let mark = |_| {
                    let (from, long) = (below(10), below(6));
                    let range = [from as f64, (from + long) as f64];
                    TokenSpan { token: below(5), bars: below(2) == 0, range }
                };
                let marks = (0..8).map(mark).collect();
                let [ahead, _] =
                    DirectedEdgeRules::both(10.0, marks, if closes { vec![[2.0, 3.0]] } else { Vec::new() });
                ahead
            };
            let (a, b) = (way(false), way(true));
            let [of_a, of_b] = DirectedEdgeRules::between(&a, &b, 0..5);
            assert!(of_a.len() <= a.sections().len());
            let at = |sections: &[ClaimSpan], l: f64| {
                let found = sections.iter().find(|section| section.length[0] <= l && l <= section.length[1]);
                found.map(|section| section.claim.clone()).unwrap()
            };
            for l in (0..10).map(|k| 0.5 + f64::from(k)) {
                for s in (0..10).map(|k| 0.5 + f64::from(k)) {
                    let whole = at(&a.sections(), l).excludes(&at(&b.sections(), s));
                    assert_eq!(at(&of_a, l).excludes(&at(&of_b, s)), whole, "{l} {s}");
                    excluded += usize::from(whole);
                }
            }
        }
        assert!(excluded > 1000);
    }
}
