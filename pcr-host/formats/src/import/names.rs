//! Makes the names of nodes and edges unique.
//!
//! Files may give the same name to two different nodes or edges, and the programs that load them accept that. This
//! reader does, too: the second one is called `name#2`. An exact copy, which differs in nothing, is read once.

use super::Warnings;
use super::layout::{Edge, Id, Node};
use std::collections::{HashMap, HashSet};
use std::fmt;

/// Something with a name.
pub(super) trait Named: PartialEq + Clone {
    /// The noun for it in messages.
    const WHAT: &'static str;
    fn id(&mut self) -> &mut Id;
}

impl Named for Node {
    const WHAT: &'static str = "node";
    fn id(&mut self) -> &mut Id {
        &mut self.id
    }
}

impl Named for Edge {
    const WHAT: &'static str = "edge";
    fn id(&mut self) -> &mut Id {
        &mut self.id
    }
}

/// Why a name stands for nothing, or not for one thing.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Unclear {
    /// Nothing has the name.
    None(&'static str, Id),
    /// Several things have it.
    Several(&'static str, Id),
}

impl fmt::Display for Unclear {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None(what, id) => write!(f, "there is no {what} {id}"),
            Self::Several(what, id) => write!(f, "there are several different {what}s {id}"),
        }
    }
}

/// The things of a list by their names in the file.
#[derive(Debug)]
pub(super) struct Names<T> {
    list: Vec<T>,
    /// Indices by the name in the file.
    places: HashMap<Id, Vec<usize>>,
    /// Names that are taken in the list.
    taken: HashSet<Id>,
}

impl<T: Named> Names<T> {
    pub(super) fn new() -> Self {
        Self { list: Vec::new(), places: HashMap::new(), taken: HashSet::new() }
    }

    /// Adds a thing, under another name where its own is taken; a copy is not added. Returns its place.
    pub(super) fn add(&mut self, mut thing: T, warnings: &mut Warnings) -> usize {
        let id = thing.id().clone();
        let called = format!("{} {id}", T::WHAT);
        let places = self.places.entry(id.clone()).or_default();
        let is_copy = |place: &usize| {
            let mut known = self.list[*place].clone();
            *known.id() = id.clone();
            known == thing
        };
        if let Some(copied) = places.iter().position(is_copy) {
            warnings.add(called, "given twice, the same each time");
            // It is the last one of its name again.
            places[copied..].rotate_left(1);
            return places[places.len() - 1];
        }
        let mut count = places.len() + 1;
        while self.taken.contains(thing.id()) {
            *thing.id() = Id::Text(format!("{id}#{count}"));
            count += 1;
        }
        if *thing.id() != id {
            warnings.add(called, format!("several have this name; one of them is called {} here", thing.id()));
        }
        self.taken.insert(thing.id().clone());
        let place = self.list.len();
        places.push(place);
        self.list.push(thing);
        place
    }

    /// The place of the only thing of this name in the file.
    pub(super) fn place(&self, id: &Id) -> Result<usize, Unclear> {
        match self.places.get(id).map(Vec::as_slice) {
            None | Some([]) => Err(Unclear::None(T::WHAT, id.clone())),
            Some([place]) => Ok(*place),
            Some(_) => Err(Unclear::Several(T::WHAT, id.clone())),
        }
    }

    /// The place of the last thing of this name in the file.
    pub(super) fn last_place(&self, id: &Id) -> Result<usize, Unclear> {
        let last = self.places.get(id).and_then(|places| places.last().copied());
        last.ok_or_else(|| Unclear::None(T::WHAT, id.clone()))
    }

    pub(super) fn list(&self) -> &[T] {
        &self.list
    }

    pub(super) fn into_list(self) -> Vec<T> {
        self.list
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(id: &str, x: f64) -> Node {
        Node { id: Id::Text(id.into()), name: None, level: 0, at: [x, 0.0] }
    }

    #[test]
    fn a_name_that_is_taken_is_passed_over() {
        let (mut names, mut warnings) = (Names::new(), Warnings::default());
        for (id, x) in [("a", 0.0), ("a", 1.0), ("a#3", 2.0), ("a", 3.0)] {
            names.add(node(id, x), &mut warnings);
        }
        let ids: Vec<String> = names.list().iter().map(|node| node.id.to_string()).collect();
        assert_eq!(ids, ["a", "a#2", "a#3", "a#4"]);
    }

    #[test]
    fn different_things_of_one_name_are_told_apart() {
        let (mut names, mut warnings) = (Names::new(), Warnings::default());
        // The third has the name that the second is given, and the fifth is a copy of the second.
        let given = [("a", 0.0), ("a", 1.0), ("a#2", 2.0), ("a", 3.0), ("a", 1.0), ("b", 4.0)];
        let places = given.map(|(id, x)| names.add(node(id, x), &mut warnings));
        assert_eq!(places, [0, 1, 2, 3, 1, 4]);
        let ids: Vec<String> = names.list().iter().map(|node| node.id.to_string()).collect();
        assert_eq!(ids, ["a", "a#2", "a#2#1", "a#3", "b"]);
        let [a, b, c] = ["a", "b", "c"].map(|id| Id::Text(id.into()));
        assert_eq!((names.place(&b), names.last_place(&a)), (Ok(4), Ok(1)), "the last one is the copy");
        assert_eq!(names.place(&a).unwrap_err().to_string(), "there are several different nodes a");
        assert_eq!(names.place(&c).unwrap_err().to_string(), "there is no node c");
        assert_eq!(warnings.lines().len(), 4, "{:?}", warnings.lines());
    }
}
