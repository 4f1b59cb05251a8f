//! Makes the names of nodes and edges unique, and that of a file printable.
//!
//! Files may give the same name to two different nodes or edges, and the programs that load them accept that. This
//! reader does, too: the second one is called `name#2`. An exact copy, which differs in nothing, is read once.

use super::layout::{ElementId, LayoutEdge, LayoutNode};
use super::{WarningCode, Warnings};
use crate::scenario::{LONGEST_LABEL, label};
use std::collections::{HashMap, HashSet};
use std::fmt;

/// Makes a label of the name that a file gives itself, and says so if that is another one.
pub(super) fn name_printably(name: &mut String, warnings: &mut Warnings) {
    let called = label(name);
    if called != *name {
        let problem = format!("it becomes {called}: names are printable text of up to {LONGEST_LABEL} characters");
        warnings.add(WarningCode::Renamed, "name", problem);
        *name = called;
    }
}

/// Something with a name.
pub(super) trait HasId: PartialEq + Clone {
    /// The noun for it in messages.
    const WHAT: &'static str;
    fn id(&mut self) -> &mut ElementId;
    /// Numbers that are the same of things that are the same.
    fn numbers(&self) -> Vec<f64>;
}

impl HasId for LayoutNode {
    const WHAT: &'static str = "node";
    fn id(&mut self) -> &mut ElementId {
        &mut self.id
    }
    fn numbers(&self) -> Vec<f64> {
        self.point.to_vec()
    }
}

impl HasId for LayoutEdge {
    const WHAT: &'static str = "edge";
    fn id(&mut self) -> &mut ElementId {
        &mut self.id
    }
    fn numbers(&self) -> Vec<f64> {
        let ends = self.ends.iter().map(|&end| end as f64);
        ends.chain(self.curve.iter().flat_map(|piece| [piece.start[0], piece.start[1], piece.heading])).collect()
    }
}

/// The bits of numbers, those of -0 as of 0, which are equal.
fn bits(numbers: Vec<f64>) -> Vec<u64> {
    numbers.into_iter().map(|number| (number + 0.0).to_bits()).collect()
}

/// Why a name stands for nothing, or not for one thing.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum NameError {
    /// Nothing has the name.
    None(&'static str, ElementId),
    /// Several things have it.
    Several(&'static str, ElementId),
}

impl fmt::Display for NameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None(what, id) => write!(f, "there is no {what} {id}"),
            Self::Several(what, id) => write!(f, "there are several different {what}s {id}"),
        }
    }
}

/// The things of a list by their names in the file.
#[derive(Debug)]
pub(super) struct UniqueNames<T> {
    list: Vec<T>,
    /// What has a name in the file.
    called: HashMap<ElementId, NameUses>,
    /// Names that are taken in the list.
    taken: HashSet<ElementId>,
}

/// What has the same name in the file.
#[derive(Debug, Default)]
struct NameUses {
    count: usize,
    /// Indices of the first one and of the last one.
    first: usize,
    last: usize,
    /// Indices by the bits of numbers, if there are several: files of thousands of one name are read in reasonable time.
    alike: HashMap<Vec<u64>, Vec<usize>>,
}

impl<T: HasId> UniqueNames<T> {
    pub(super) fn new() -> Self {
        Self { list: Vec::new(), called: HashMap::new(), taken: HashSet::new() }
    }

    /// Adds a thing, under another name where its own is taken; a copy is not added. Returns its place.
    pub(super) fn add(&mut self, mut thing: T, warnings: &mut Warnings) -> usize {
        let id = thing.id().clone();
        let name = format!("{} {id}", T::WHAT);
        let called = self.called.entry(id.clone()).or_default();
        let is_copy = |place: &&usize| {
            let mut known = self.list[**place].clone();
            *known.id() = id.clone();
            known == thing
        };
        if called.count == 1 {
            called.alike.insert(bits(self.list[called.first].numbers()), vec![called.first]);
        }
        let alike = if called.count > 0 { Some(called.alike.entry(bits(thing.numbers())).or_default()) } else { None };
        if let Some(&copied) = alike.as_deref().and_then(|alike| alike.iter().find(is_copy)) {
            warnings.add(WarningCode::GivenTwice, name, "given twice, the same each time");
            // It is the last one of its name again.
            called.last = copied;
            return copied;
        }
        let place = self.list.len();
        alike.into_iter().for_each(|alike| alike.push(place));
        called.count += 1;
        called.last = place;
        if called.count == 1 {
            called.first = place;
        }
        let mut count = called.count;
        while self.taken.contains(thing.id()) {
            *thing.id() = ElementId::Text(format!("{id}#{count}"));
            count += 1;
        }
        if *thing.id() != id {
            warnings.add(
                WarningCode::Renamed,
                name,
                format!("several have this name; one of them is called {} here", thing.id()),
            );
        }
        self.taken.insert(thing.id().clone());
        self.list.push(thing);
        place
    }

    /// The place of the only thing of this name in the file.
    pub(super) fn index_of(&self, id: &ElementId) -> Result<usize, NameError> {
        match self.called.get(id) {
            None => Err(NameError::None(T::WHAT, id.clone())),
            Some(NameUses { count: 1, first, .. }) => Ok(*first),
            Some(_) => Err(NameError::Several(T::WHAT, id.clone())),
        }
    }

    /// The place of the last thing of this name in the file.
    pub(super) fn last_place(&self, id: &ElementId) -> Result<usize, NameError> {
        let last = self.called.get(id).map(|called| called.last);
        last.ok_or_else(|| NameError::None(T::WHAT, id.clone()))
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

    fn node(id: &str, x: f64) -> LayoutNode {
        LayoutNode { id: ElementId::Text(id.into()), name: None, level: 0, point: [x, 0.0] }
    }

    #[test]
    fn a_name_that_is_taken_is_passed_over() {
        let (mut names, mut warnings) = (UniqueNames::new(), Warnings::default());
        for (id, x) in [("a", 0.0), ("a", 1.0), ("a#3", 2.0), ("a", 3.0)] {
            names.add(node(id, x), &mut warnings);
        }
        let ids: Vec<String> = names.list().iter().map(|node| node.id.to_string()).collect();
        assert_eq!(ids, ["a", "a#2", "a#3", "a#4"]);
    }

    #[test]
    fn many_of_one_name_are_read_in_reasonable_time() {
        let (mut names, mut warnings) = (UniqueNames::new(), Warnings::default());
        let count = 30_000;
        for k in (0..count).chain(0..count) {
            assert_eq!(names.add(node("a", f64::from(k)), &mut warnings), k as usize);
        }
        assert_eq!(names.list().len(), count as usize);
        let copies = warnings.iter().find(|(_, problem, _)| problem.starts_with("given twice")).unwrap();
        assert_eq!(copies.2.len(), count as usize);
        // 0 and -0 are one place.
        assert_eq!(names.add(node("a", -0.0), &mut warnings), 0);
    }

    #[test]
    fn different_things_of_one_name_are_told_apart() {
        let (mut names, mut warnings) = (UniqueNames::new(), Warnings::default());
        // The third has the name that the second is given, and the fifth is a copy of the second.
        let given = [("a", 0.0), ("a", 1.0), ("a#2", 2.0), ("a", 3.0), ("a", 1.0), ("b", 4.0)];
        let places = given.map(|(id, x)| names.add(node(id, x), &mut warnings));
        assert_eq!(places, [0, 1, 2, 3, 1, 4]);
        let ids: Vec<String> = names.list().iter().map(|node| node.id.to_string()).collect();
        assert_eq!(ids, ["a", "a#2", "a#2#1", "a#3", "b"]);
        let [a, b, c] = ["a", "b", "c"].map(|id| ElementId::Text(id.into()));
        assert_eq!((names.index_of(&b), names.last_place(&a)), (Ok(4), Ok(1)), "the last one is the copy");
        assert_eq!(names.index_of(&a).unwrap_err().to_string(), "there are several different nodes a");
        assert_eq!(names.index_of(&c).unwrap_err().to_string(), "there is no node c");
        assert_eq!(warnings.lines().len(), 4, "{:?}", warnings.lines());
    }
}
