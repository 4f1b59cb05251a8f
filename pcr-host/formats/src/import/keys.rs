//! The keys that the objects of a format have, so that one that nobody knows is not passed over.
//!
//! A reader that looks for `trajectory` and finds `trajectorie` would take an edge for straight. So each reader says which keys its
//! objects have. An unknown key that is nearly one of those that are read, or that is read in another object of the format, is an error
//! with the key that was meant. Any other unknown key is a warning, except where the format leaves the keys to its users.

use super::json_access::JsonObject;
use super::{ImportError, WarningCode, Warnings};

/// The keys of an object.
#[derive(Clone, Copy, Debug)]
pub(super) struct Keys {
    /// Keys that are read: they tell a place, a direction, a size, or the name of a thing.
    read: &'static [&'static str],
    /// Keys of the format that are not read.
    passed: &'static [&'static str],
    /// Keys that are read in other objects of the format, and mean nothing in this one.
    elsewhere: &'static [&'static str],
    /// Whether users of the format may add keys of their own.
    free: bool,
}

/// Letters of a key below which only the same letters count as nearly the same.
const SHORT: usize = 3;

impl Keys {
    /// Those that are read, and those that are passed over.
    pub(super) const fn new(read: &'static [&'static str], passed: &'static [&'static str]) -> Self {
        Self { read, passed, elsewhere: &[], free: false }
    }

    /// The same with keys that are read in other objects.
    pub(super) const fn not(self, elsewhere: &'static [&'static str]) -> Self {
        Self { elsewhere, ..self }
    }

    /// The same where users may add keys of their own.
    pub(super) const fn free(self) -> Self {
        Self { free: true, ..self }
    }

    /// Checks the keys of an object, and warns of unknown ones.
    ///
    /// # Errors
    /// [`ImportError`] with a key that is nearly one that is read, or that stands in the wrong object.
    pub(super) fn check(&self, object: &JsonObject<'_>, warnings: &mut Warnings) -> Result<(), ImportError> {
        // What is null counts as missing everywhere.
        let keys = object.members().filter(|(_, value)| !value.is_null()).map(|(key, _)| key);
        self.check_all(&object.name, keys, &|key| object.get(key).is_some(), warnings)
            .map_err(|(key, problem)| object.key_error(key, problem))
    }

    /// Checks the attributes of an element, which has a name in messages, in the same way.
    ///
    /// # Errors
    /// As [`Keys::check`].
    pub(super) fn check_attributes(
        &self,
        element: roxmltree::Node<'_, '_>,
        name: &str,
        warnings: &mut Warnings,
    ) -> Result<(), ImportError> {
        let keys = element.attributes().filter(|attribute| attribute.namespace().is_none());
        let has = |key: &str| element.has_attribute(key);
        self.check_all(name, keys.map(|attribute| attribute.name()), &has, warnings)
            .map_err(|(key, problem)| ImportError::new(format!("{name}: its key {key} {problem}")))
    }

    /// Fails with a key, and what is wrong with it.
    fn check_all<'k>(
        &self,
        name: &str,
        keys: impl Iterator<Item = &'k str>,
        has: &dyn Fn(&str) -> bool,
        warnings: &mut Warnings,
    ) -> Result<(), (&'k str, String)> {
        // Found once: an object may have any number of unknown keys.
        let mut missing = None;
        for key in keys.filter(|key| !self.read.contains(key) && !self.passed.contains(key)) {
            let same = self.read.iter().find(|known| letters(known) == letters(key));
            let missing: &Vec<_> =
                missing.get_or_insert_with(|| self.read.iter().copied().filter(|known| !has(known)).collect());
            if let Some(meant) = same.copied().or_else(|| nearest(key, missing.iter().copied())) {
                return Err((key, format!("is not known here; it may be meant for {meant}")));
            }
            if self.elsewhere.contains(&key) {
                return Err((key, "is read in other objects of the format and not in this one".to_owned()));
            }
            if !self.free {
                warnings.add(WarningCode::UnknownKey, name, format!("its key {key} is not known, and not read"));
            }
        }
        Ok(())
    }
}

/// The letters and digits of a key in lower case.
fn letters(key: &str) -> Vec<char> {
    key.chars().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// The key of which another one is likely to be a misspelling, if there is one.
pub(super) fn nearest<'k>(key: &str, known: impl Iterator<Item = &'k str>) -> Option<&'k str> {
    let near = known.filter(|known| is_near(known, key));
    near.min_by_key(|known| distance(&letters(known), &letters(key)))
}

/// Whether a key may be another one with an error in it: a few letters of it, or a word more or less.
fn is_near(known: &str, key: &str) -> bool {
    let [known, key] = [known, key].map(letters);
    let [shorter, longer] = if known.len() < key.len() { [&known, &key] } else { [&key, &known] };
    if shorter.len() < SHORT || 2 * shorter.len() < longer.len() {
        return false;
    }
    let holds = longer.windows(shorter.len()).any(|part| part == shorter.as_slice());
    holds && 5 * shorter.len() >= 3 * longer.len() || distance(&known, &key) <= (longer.len() / 4).max(1)
}

/// Letters that are put in, left out, replaced or exchanged with their neighbour to make one word of another.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for (i, letter) in a.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, other) in b.iter().enumerate() {
            let replaced = rows[i][j] + usize::from(letter != other);
            let mut least = replaced.min(rows[i][j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && *letter == b[j - 1] && a[i - 1] == *other {
                least = least.min(rows[i - 1][j - 1] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::json::{JsonNode, Position};
    use serde_json::json;

    const KEYS: Keys = Keys::new(&["trajectory", "theta", "x", "nodeId"], &["height"]).not(&["corridor"]);

    fn check(value: serde_json::Value, keys: Keys) -> (Result<(), String>, Vec<String>) {
        let value = JsonNode::from_value(value, Position::START);
        let value = &value;
        let mut warnings = Warnings::default();
        let object = JsonObject::new("edge e", value).unwrap();
        let checked = keys.check(&object, &mut warnings).map_err(|error| error.problem().to_owned());
        (checked, warnings.lines())
    }

    #[test]
    fn a_key_that_is_nearly_one_that_is_read_is_refused() {
        for (key, meant) in [
            ("trajectorie", "trajectory"),
            ("trajectories", "trajectory"),
            ("Trajectory", "trajectory"),
            ("tarjectory", "trajectory"),
            ("trajectory_points", "trajectory"),
            ("theta_deg", "theta"),
            ("node_id", "nodeId"),
            ("X", "x"),
        ] {
            let (checked, _) = check(json!({ key: 1 }), KEYS);
            let expected = format!("edge e: its key {key} is not known here; it may be meant for {meant}");
            assert_eq!(checked, Err(expected));
            // What is null is missing.
            assert_eq!(check(json!({ key: null }), KEYS), (Ok(()), Vec::new()));
        }
    }

    #[test]
    fn other_unknown_keys_are_told_unless_anybody_may_add_some() {
        for key in ["z", "colour", "nodes", "heights", "length"] {
            let (checked, warnings) = check(json!({ key: 1 }), KEYS);
            assert_eq!(checked, Ok(()), "{key}");
            assert_eq!(warnings, [format!("edge e: its key {key} is not known, and not read")]);
            assert_eq!(check(json!({ key: 1 }), KEYS.free()), (Ok(()), Vec::new()));
        }
        assert_eq!(check(json!({ "trajectory": 1, "height": 2 }), KEYS), (Ok(()), Vec::new()));
        // Beside the one that it is near it is another one, unless it is the same in other letters.
        let (checked, warnings) = check(json!({ "trajectory": 1, "trajectory2": 1 }), KEYS);
        assert_eq!((checked, warnings.len()), (Ok(()), 1));
        assert!(check(json!({ "trajectory": 1, "Trajectory": 1 }), KEYS).0.is_err());
    }

    #[test]
    fn a_key_in_the_wrong_object_is_refused() {
        let (checked, _) = check(json!({ "corridor": {} }), KEYS.free());
        assert_eq!(
            checked,
            Err("edge e: its key corridor is read in other objects of the format and not in this one".into())
        );
    }

    #[test]
    fn the_distance_of_words_counts_letters() {
        let between = |a: &str, b: &str| distance(&letters(a), &letters(b));
        assert_eq!(
            [between("abc", "abc"), between("abc", "acb"), between("abc", "abd"), between("abc", "")],
            [0, 1, 1, 3]
        );
        assert_eq!(between("vehicleTypeEdgeProperty", "vehicleTypeEdgeProperties"), 3);
    }
}
