//! Certified connected components of `{ (s, l) : clearance <= 0 }`.
//!
//! The rectangle is halved until boxes are wholly inside, wholly outside, or small. Boxes that touch are joined: those
//! inside make the *inner* components, which are connected for sure; those that are not outside make the *outer* ones,
//! which are apart for sure. Where an outer component does not hold exactly one inner one, its boxes in doubt are halved
//! further, up to a budget; a contact that is critical stays in doubt for ever. What remains unknown are components
//! shallower than the boxes in doubt.

use super::Pair;

/// A range in both coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lengths of the other \[m\].
    pub s: (f64, f64),
    /// Lengths of the ego \[m\].
    pub l: (f64, f64),
}

impl Bounds {
    fn hull(self, other: Self) -> Self {
        let hull = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        Self { s: hull(self.s, other.s), l: hull(self.l, other.l) }
    }

    fn touches(self, other: Self) -> bool {
        let meet = |a: (f64, f64), b: (f64, f64)| a.0 <= b.1 && b.0 <= a.1;
        meet(self.s, other.s) && meet(self.l, other.l)
    }

    fn within(self, other: Self) -> bool {
        let inside = |a: (f64, f64), b: (f64, f64)| b.0 <= a.0 && a.1 <= b.1;
        inside(self.s, other.s) && inside(self.l, other.l)
    }

    fn size(self) -> f64 {
        (self.s.1 - self.s.0).max(self.l.1 - self.l.0)
    }
}

/// Points of the plane that are connected for sure.
#[derive(Clone, Debug)]
pub struct Inner {
    /// Their range: the component reaches at least this far.
    pub bounds: Bounds,
    /// The middles `(s, l)` of its boxes.
    pub points: Vec<(f64, f64)>,
}

/// A part of the plane that is apart from all others for sure.
#[derive(Clone, Debug)]
pub struct Outer {
    /// Its range: the components in it reach no further.
    pub bounds: Bounds,
    /// What is known to be in it: nothing, then it may be empty; one component; or several, which may be connected.
    pub inner: Vec<Inner>,
}

/// What is known of the components of a pair.
#[derive(Clone, Debug)]
pub struct Components {
    /// Parts that are apart.
    pub outer: Vec<Outer>,
}

impl Components {
    /// Whether the number of components is known, but for some that are shallower than the smallest boxes.
    pub fn certain(&self) -> bool {
        self.outer.iter().all(|outer| outer.inner.len() == 1)
    }
}

/// How much work the oracle may spend.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Size of the smallest boxes of the first pass, as a fraction of the larger length.
    pub resolution: f64,
    /// Most boxes.
    pub boxes: usize,
    /// The ranges of components are narrowed down to this \[m\] if the boxes suffice.
    pub range: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Outside,
    Doubtful,
    Inside,
    /// Halved: the first of two consecutive boxes.
    Halved(usize),
}

struct Cell {
    bounds: Bounds,
    state: State,
}

struct Tree<'a> {
    pair: &'a Pair,
    margin: f64,
    boxes: Vec<Cell>,
}

/// The components of a pair. Points with a clearance of at most `margin` \[m\] count as possible.
pub fn components(pair: &Pair, margin: f64, effort: Effort) -> Components {
    let all = Bounds { s: (0.0, pair.other.length()), l: (0.0, pair.ego.length()) };
    let mut tree = Tree { pair, margin, boxes: Vec::new() };
    tree.add(all);
    tree.halve(|bounds| bounds.size() > effort.resolution * all.size(), effort.boxes);
    loop {
        let (components, owner) = tree.components();
        let wanting: Vec<bool> = components.outer.iter().map(|outer| outer.inner.len() != 1).collect();
        let narrow = |outer: &Outer, bounds: Bounds| match &outer.inner[..] {
            [inner] => bounds.size() > effort.range && !bounds.within(inner.bounds),
            _ => bounds.size() > f64::EPSILON * all.size(),
        };
        let before = tree.boxes.len();
        let room = effort.boxes.saturating_sub(before);
        if room == 0 {
            return components;
        }
        // One level only: what is known then decides what is halved next.
        for (index, &outer) in owner.iter().enumerate() {
            let Cell { bounds, state } = tree.boxes[index];
            if state == State::Doubtful
                && tree.boxes.len() < effort.boxes
                && (narrow(&components.outer[outer], bounds) || wanting[outer] && bounds.size() > 0.0)
            {
                tree.split(index);
            }
        }
        if tree.boxes.len() == before {
            return components;
        }
    }
}

impl Tree<'_> {
    fn add(&mut self, bounds: Bounds) {
        let half = (0.5 * (bounds.s.1 - bounds.s.0), 0.5 * (bounds.l.1 - bounds.l.0));
        let clearance = self.pair.clearance(bounds.s.0 + half.0, bounds.l.0 + half.1);
        let state = if clearance - half.0 - half.1 > self.margin {
            State::Outside
        } else if clearance + half.0 + half.1 <= 0.0 {
            State::Inside
        } else {
            State::Doubtful
        };
        self.boxes.push(Cell { bounds, state });
    }

    fn split(&mut self, index: usize) {
        let Bounds { s, l } = self.boxes[index].bounds;
        self.boxes[index].state = State::Halved(self.boxes.len());
        if s.1 - s.0 >= l.1 - l.0 {
            let middle = 0.5 * (s.0 + s.1);
            self.add(Bounds { s: (s.0, middle), l });
            self.add(Bounds { s: (middle, s.1), l });
        } else {
            let middle = 0.5 * (l.0 + l.1);
            self.add(Bounds { s, l: (l.0, middle) });
            self.add(Bounds { s, l: (middle, l.1) });
        }
    }

    fn halve(&mut self, wanted: impl Fn(Bounds) -> bool, budget: usize) {
        let mut index = 0;
        while index < self.boxes.len() && self.boxes.len() < budget {
            let Cell { bounds, state } = self.boxes[index];
            if state == State::Doubtful && wanted(bounds) {
                self.split(index);
            }
            index += 1;
        }
    }

    /// The components, and for each box in doubt the number of its outer component.
    fn components(&self) -> (Components, Vec<usize>) {
        let (mut inner, mut outer) = (Classes::new(self.boxes.len()), Classes::new(self.boxes.len()));
        for b in &self.boxes {
            if let State::Halved(first) = b.state {
                self.join(first, first + 1, &mut inner, &mut outer);
            }
        }
        let mut found = Components { outer: Vec::new() };
        let mut place_of_outer = vec![usize::MAX; self.boxes.len()];
        let mut place_of_inner = vec![usize::MAX; self.boxes.len()];
        let mut owner = vec![usize::MAX; self.boxes.len()];
        for (index, b) in self.boxes.iter().enumerate() {
            if !matches!(b.state, State::Doubtful | State::Inside) {
                continue;
            }
            let place = &mut place_of_outer[outer.root(index)];
            if *place == usize::MAX {
                *place = found.outer.len();
                found.outer.push(Outer { bounds: b.bounds, inner: Vec::new() });
            }
            owner[index] = *place;
            let component = &mut found.outer[*place];
            component.bounds = component.bounds.hull(b.bounds);
            if b.state == State::Inside {
                let Bounds { s, l } = b.bounds;
                let point = (0.5 * (s.0 + s.1), 0.5 * (l.0 + l.1));
                let place = &mut place_of_inner[inner.root(index)];
                if *place == usize::MAX {
                    *place = component.inner.len();
                    component.inner.push(Inner { bounds: b.bounds, points: Vec::new() });
                }
                let inner = &mut component.inner[*place];
                inner.bounds = inner.bounds.hull(b.bounds);
                inner.points.push(point);
            }
        }
        (found, owner)
    }

    /// Joins all boxes in `a` with those in `b` that they touch.
    fn join(&self, a: usize, b: usize, inner: &mut Classes, outer: &mut Classes) {
        let mut stack = vec![(a, b)];
        while let Some((a, b)) = stack.pop() {
            let (x, y) = (&self.boxes[a], &self.boxes[b]);
            if x.state == State::Outside || y.state == State::Outside || !x.bounds.touches(y.bounds) {
                continue;
            }
            match (x.state, y.state) {
                (State::Halved(first), State::Halved(_)) if x.bounds.size() >= y.bounds.size() => {
                    stack.extend([(first, b), (first + 1, b)]);
                }
                (_, State::Halved(first)) => stack.extend([(a, first), (a, first + 1)]),
                (State::Halved(first), _) => stack.extend([(first, b), (first + 1, b)]),
                (x, y) => {
                    outer.join(a, b);
                    if x == State::Inside && y == State::Inside {
                        inner.join(a, b);
                    }
                }
            }
        }
    }
}

/// Union-find.
struct Classes(Vec<usize>);

impl Classes {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn root(&mut self, mut index: usize) -> usize {
        while self.0[index] != index {
            self.0[index] = self.0[self.0[index]];
            index = self.0[index];
        }
        index
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[b] = a;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disc::{Disc, Leg};

    const EFFORT: Effort = Effort { resolution: 1e-2, boxes: 200_000, range: 1e-6 };

    #[test]
    fn a_crossing_at_right_angles_is_one_circle() {
        let ego = Disc { radius: 0.3, start: [-2.0, 0.0, 0.0], legs: vec![Leg::Line(4.0)] };
        let other = Disc { radius: 0.2, start: [0.0, -1.0, std::f64::consts::FRAC_PI_2], legs: vec![Leg::Line(3.0)] };
        let found = components(&Pair::new(&ego, &other), 0.0, EFFORT);
        assert!(found.certain() && found.outer.len() == 1);
        let (outer, inner) = (&found.outer[0].bounds, &found.outer[0].inner[0].bounds);
        for (got, want) in [
            (outer.s.0, 0.5),
            (outer.s.1, 1.5),
            (outer.l.0, 1.5),
            (outer.l.1, 2.5),
            (inner.s.0, 0.5),
            (inner.s.1, 1.5),
            (inner.l.0, 1.5),
            (inner.l.1, 2.5),
        ] {
            assert!((got - want).abs() < 2e-6, "{got} for {want}");
        }
    }

    #[test]
    fn a_full_circle_crosses_a_line_twice() {
        let ego = Disc { radius: 0.1, start: [0.0, -1.0, 0.0], legs: vec![Leg::arc(1.0, 6.2)] };
        let other = Disc { radius: 0.1, start: [-3.0, 0.5, 0.0], legs: vec![Leg::Line(6.0)] };
        let found = components(&Pair::new(&ego, &other), 0.0, EFFORT);
        assert!(found.certain() && found.outer.len() == 2);
    }
}
