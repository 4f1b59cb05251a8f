//! Files of XML that were changed on purpose, as in `import_generated`: an attribute or element left out, misspelt, renamed, added or in
//! another element. For each format, a small reader that shares nothing with the importer says what a file means.

use crate::import_generated::{Meaning, is_same, misspelt};

/// An element of XML, with children or with text.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    name: String,
    attributes: Vec<(String, String)>,
    pub(crate) children: Vec<Element>,
    content: String,
}

impl Element {
    pub(crate) fn new(name: &str, attributes: &[(&str, &str)], children: Vec<Self>) -> Self {
        let attributes = attributes.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        Self { name: name.to_owned(), attributes, children, content: String::new() }
    }

    /// An element with text.
    pub(crate) fn with_content(name: &str, attributes: &[(&str, &str)], content: &str) -> Self {
        Self { content: content.to_owned(), ..Self::new(name, attributes, Vec::new()) }
    }

    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    pub(crate) fn content(&self) -> &str {
        &self.content
    }

    pub(crate) fn get(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(own, _)| own == name).map(|(_, value)| value.as_str())
    }

    pub(crate) fn all(&self, name: &str) -> impl Iterator<Item = &Self> {
        self.children.iter().filter(move |child| child.name == name)
    }

    pub(crate) fn text(&self) -> String {
        let attributes: String = self.attributes.iter().map(|(name, value)| format!(" {name}=\"{value}\"")).collect();
        let children: String = self.children.iter().map(Self::text).collect();
        let Self { name, content, .. } = self;
        format!("<{name}{attributes}>{content}{children}</{name}>")
    }

    /// The element at a place: the index of a child of the root, of a child of that, and so on.
    fn at(&mut self, place: &[usize]) -> &mut Self {
        place.iter().fold(self, |element, &child| &mut element.children[child])
    }

    /// Places of all elements.
    fn places(&self) -> Vec<Vec<usize>> {
        let below = self.children.iter().enumerate().flat_map(|(k, child)| {
            child.places().into_iter().map(move |place| std::iter::once(k).chain(place).collect())
        });
        std::iter::once(Vec::new()).chain(below).collect()
    }
}

/// What an importer makes of a file, with its warnings, or why it refuses it.
type Imported = Result<(Meaning, Vec<String>), String>;

/// A format of files, and both of its readers.
pub(crate) struct Format {
    /// What a file means; `None` if it does not say what it has to.
    pub(crate) meaning: fn(&Element) -> Option<Meaning>,
    pub(crate) imported: fn(&Element) -> Imported,
}

#[derive(Default)]
pub(crate) struct Tally {
    pub(crate) same: usize,
    pub(crate) told: usize,
    pub(crate) refused: usize,
    pub(crate) wrong: Vec<String>,
}

impl Tally {
    /// What a change makes of a model: it is refused, or means the same as before, or it means what the reader says, and a warning has one
    /// of these words. Without words no warning is needed: what is not there says nothing.
    fn judge(&mut self, format: &Format, what: &str, model: &Element, before: &Meaning, words: &[&str]) {
        let Ok((ways, warnings)) = (format.imported)(model) else {
            self.refused += 1;
            return;
        };
        let is_told = words.is_empty() || warnings.iter().any(|line| words.iter().any(|word| line.contains(word)));
        let expected = (format.meaning)(model);
        if is_same(&ways, before) {
            self.same += 1;
        } else {
            let agrees = expected.as_ref().is_none_or(|expected| is_same(&ways, expected));
            if !is_told || !agrees {
                self.wrong.push(format!("{what}: told {is_told}, as it stands {agrees}: {warnings:?}"));
            }
            self.told += 1;
        }
    }
}

/// Makes every change of a file.
pub(crate) fn change(format: &Format, version: &str, base: &Element, tally: &mut Tally) {
    let meant = (format.meaning)(base).expect("the model says what it has to");
    let (own, warnings) = (format.imported)(base).unwrap();
    assert!(is_same(&own, &meant), "{version}: {warnings:?}\n{own:?}\n{meant:?}");
    for place in base.places() {
        let element = base.clone().at(&place).clone();
        let changed = |change: &dyn Fn(&mut Element)| {
            let mut model = base.clone();
            change(model.at(&place));
            model
        };
        for (k, (attribute, value)) in element.attributes.iter().enumerate() {
            let what = |change: &str| format!("{version}, {} {place:?}, {attribute}: {change}", element.name);
            tally.judge(format, &what("left out"), &changed(&|it| drop(it.attributes.remove(k))), &meant, &[]);
            for new in misspelt(attribute).into_iter().chain(["zzzzzz".to_owned()]) {
                if element.get(&new).is_some() {
                    continue;
                }
                let model = changed(&|it| it.attributes[k].0.clone_from(&new));
                tally.judge(format, &what(&new), &model, &meant, &[attribute, &new]);
            }
            // In the element around it.
            if let Some((_, around)) = place.split_last() {
                let mut model = changed(&|it| drop(it.attributes.remove(k)));
                let parent = model.at(around);
                if parent.get(attribute).is_none() {
                    parent.attributes.push((attribute.clone(), value.clone()));
                    tally.judge(format, &what("moved"), &model, &meant, &[attribute]);
                }
            }
        }
        // An unknown attribute, or element, changes nothing.
        let model = changed(&|it| it.attributes.push(("zzzzzz".to_owned(), "1".to_owned())));
        assert!(is_same(&(format.imported)(&model).unwrap().0, &meant), "{version}, {place:?}");
        let model = changed(&|it| it.children.push(Element::new("zzzzzz", &[("x", "1.0")], Vec::new())));
        if let Ok((ways, _)) = (format.imported)(&model) {
            assert!(is_same(&ways, &meant), "{version}, {place:?}");
        }
        let Some((&last, around)) = place.split_last() else { continue };
        let what = |change: &str| format!("{version}, {} {place:?}: {change}", element.name);
        for new in misspelt(&element.name).into_iter().chain(["zzzzzz".to_owned()]) {
            let model = changed(&|it| it.name.clone_from(&new));
            tally.judge(format, &what(&new), &model, &meant, &[&element.name, &new]);
        }
        // In the root, if it was below something else; below the first element that is left, if it was in the root.
        let mut model = base.clone();
        let moved = model.at(around).children.remove(last);
        let to = match (around.is_empty(), model.children.first_mut()) {
            (true, Some(first)) => first,
            _ => &mut model,
        };
        to.children.push(moved);
        tally.judge(format, &what("moved"), &model, &meant, &[&element.name]);
    }
}
