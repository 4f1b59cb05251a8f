//! Versions of plant models, and which elements and attributes each of them has.
//!
//! These are facts of the schemas that openTCS published with its versions, as far as what is written here is concerned: points, paths,
//! vehicles, blocks, and the visual layout. `plant_models_of_every_version_are_valid` compares them with the schemas themselves.

use pcr_formats::import::ImportError;
use roxmltree::Node;
use std::collections::BTreeSet;
use std::fmt;

/// A version of plant models. Up to the last release of openTCS 4, files have 0.0.1 and 0.0.2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ModelVersion {
    V001,
    V002,
    V003,
    V004,
    V005,
    V600,
    V700,
}

use ModelVersion::{V001, V002, V003, V004, V005, V600, V700};

impl ModelVersion {
    const ALL: [Self; 7] = [V001, V002, V003, V004, V005, V600, V700];

    /// Returns the version of a model.
    ///
    /// # Errors
    /// A model without one, and of one that is not known: nobody knows what its elements are called.
    pub(crate) fn of(model: Node<'_, '_>) -> Result<Self, ImportError> {
        let known = || Self::ALL.map(|version| version.to_string()).join(", ");
        let problem = |what: &str| ImportError::new(format!("model, version: {what}; written is into {}", known()));
        let text = model.attribute("version").ok_or_else(|| problem("missing"))?;
        let found = Self::ALL.into_iter().find(|version| version.to_string() == text.trim());
        found.ok_or_else(|| problem(&format!("{text} is not known")))
    }

    /// Names of the attributes of a point for its place, x, y, z: those of the version, and those of others.
    pub(crate) fn places(self) -> [[&'static str; 3]; 2] {
        let (old, new) = (["xPosition", "yPosition", "zPosition"], ["positionX", "positionY", "positionZ"]);
        if self < V600 { [old, new] } else { [new, old] }
    }

    /// Names of the attributes of a `pointLayout` for the place at which a point is drawn, where the version has such.
    pub(crate) fn drawn(self) -> Option<[&'static str; 2]> {
        match self {
            V001 | V002 | V003 | V700 => None,
            V004 | V005 => Some(["xPosition", "yPosition"]),
            V600 => Some(["positionX", "positionY"]),
        }
    }

    /// Names of the attributes of a `pointLayout` for where the name of a point is drawn.
    pub(crate) fn label(self) -> [&'static str; 2] {
        if self < V600 { ["xLabelOffset", "yLabelOffset"] } else { ["labelOffsetX", "labelOffsetY"] }
    }

    /// Whether a point has to say where it is in height, and which vehicles have room there.
    pub(crate) fn has_boxes(self) -> bool {
        self >= V600
    }

    /// Whether points, paths and blocks have elements of their own that say how they are drawn. Earlier versions say that in the visual
    /// layout.
    pub(crate) fn has_layouts(self) -> bool {
        self >= V004
    }

    /// Whether a block says of which type it is. Those of earlier versions are for one vehicle; of 0.0.2 some releases refuse the attribute.
    pub(crate) fn has_types_of_blocks(self) -> bool {
        self >= V003
    }

    /// Whether points and paths have envelopes.
    pub(crate) fn has_envelopes(self) -> bool {
        self >= V004
    }

    /// Whether a model has properties. Of 0.0.2 some releases refuse them.
    pub(crate) fn has_properties(self) -> bool {
        self >= V003
    }
}

impl fmt::Display for ModelVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            V001 => "0.0.1",
            V002 => "0.0.2",
            V003 => "0.0.3",
            V004 => "0.0.4",
            V005 => "0.0.5",
            V600 => "6.0.0",
            V700 => "7.0.0",
        })
    }
}

/// An attribute or a child of an element, in which versions it may be there, and from which on it has to be.
#[derive(Clone, Copy)]
struct SchemaMember {
    name: &'static str,
    first: ModelVersion,
    last: ModelVersion,
    needed: Option<ModelVersion>,
}

const fn may(name: &'static str) -> SchemaMember {
    SchemaMember { name, first: V001, last: V700, needed: None }
}

const fn must(name: &'static str) -> SchemaMember {
    SchemaMember { needed: Some(V001), ..may(name) }
}

impl SchemaMember {
    const fn since(self, first: ModelVersion) -> Self {
        Self { first, ..self }
    }

    const fn until(self, last: ModelVersion) -> Self {
        Self { last, ..self }
    }

    const fn needed(self, from: ModelVersion) -> Self {
        Self { needed: Some(from), ..self }
    }

    fn is_in(&self, version: ModelVersion) -> bool {
        (self.first..=self.last).contains(&version)
    }

    fn is_needed(&self, version: ModelVersion) -> bool {
        self.is_in(version) && self.needed.is_some_and(|from| from <= version)
    }
}

/// An element: its attributes, and its children in their sequence.
struct SchemaElement {
    name: &'static str,
    attributes: &'static [SchemaMember],
    children: &'static [SchemaMember],
}

const PROPERTY: SchemaMember = may("property");
const ID: SchemaMember = may("id").until(V002);

const ELEMENTS: [SchemaElement; 14] = [
    SchemaElement {
        name: "model",
        attributes: &[must("version"), must("name")],
        children: &[
            may("point"),
            may("path"),
            may("vehicleType").until(V002),
            may("vehicle"),
            may("locationType"),
            may("location"),
            may("block"),
            may("staticRoute").until(V002),
            may("group").since(V002).until(V003),
            may("visualLayout").since(V002),
            PROPERTY.since(V002),
        ],
    },
    SchemaElement {
        name: "point",
        attributes: &[
            ID,
            must("name"),
            must("xPosition").until(V005),
            must("yPosition").until(V005),
            may("zPosition").until(V005),
            must("positionX").since(V600),
            must("positionY").since(V600),
            must("positionZ").since(V600),
            may("vehicleOrientationAngle"),
            must("type"),
        ],
        children: &[
            must("maxVehicleBoundingBox").since(V600),
            may("vehicleEnvelope").since(V004),
            may("outgoingPath"),
            PROPERTY,
            may("pointLayout").since(V004),
        ],
    },
    SchemaElement {
        name: "path",
        attributes: &[
            ID,
            must("name"),
            must("sourcePoint"),
            must("destinationPoint"),
            may("length").needed(V600),
            may("routingCost").until(V002),
            must("maxVelocity"),
            must("maxReverseVelocity"),
            must("locked"),
        ],
        children: &[
            may("typeMaxVelocity").until(V002),
            may("typeMaxReverseVelocity").until(V002),
            may("typeLock").until(V002),
            may("typeActions").until(V002),
            may("peripheralOperation").since(V004),
            may("vehicleEnvelope").since(V004),
            PROPERTY,
            may("pathLayout").since(V004),
        ],
    },
    SchemaElement {
        name: "vehicle",
        attributes: &[
            ID,
            must("name"),
            may("type").until(V002),
            may("length").since(V002).until(V005),
            may("energyLevelCritical").needed(V600),
            may("energyLevelGood").needed(V600),
            may("energyLevelFullyRecharged").since(V002).needed(V600),
            may("energyLevelSufficientlyRecharged").since(V002).needed(V600),
            may("maxVelocity").since(V002).needed(V600),
            may("maxReverseVelocity").since(V002).needed(V600),
            may("envelopeKey").since(V004),
        ],
        children: &[must("boundingBox").since(V600), PROPERTY, may("vehicleLayout").since(V004)],
    },
    SchemaElement {
        name: "block",
        attributes: &[ID, must("name"), may("type").since(V002).needed(V600)],
        children: &[may("member"), PROPERTY, may("blockLayout").since(V004)],
    },
    SchemaElement {
        name: "pointLayout",
        attributes: &[
            must("xPosition").until(V005),
            must("yPosition").until(V005),
            must("xLabelOffset").until(V005),
            must("yLabelOffset").until(V005),
            must("positionX").since(V600).until(V600),
            must("positionY").since(V600).until(V600),
            must("labelOffsetX").since(V600),
            must("labelOffsetY").since(V600),
            must("layerId"),
        ],
        children: &[],
    },
    SchemaElement { name: "blockLayout", attributes: &[must("color")], children: &[] },
    SchemaElement {
        name: "visualLayout",
        attributes: &[ID, must("name"), must("scaleX"), must("scaleY")],
        children: &[
            may("color").until(V002),
            may("shapeLayoutElement").until(V003),
            may("modelLayoutElement").until(V003),
            may("viewBookmark").until(V002),
            must("layer").since(V004),
            must("layerGroup").since(V004),
            PROPERTY,
        ],
    },
    SchemaElement {
        name: "modelLayoutElement",
        attributes: &[must("visualizedObjectName"), must("layer")],
        children: &[PROPERTY],
    },
    SchemaElement { name: "vehicleEnvelope", attributes: &[must("key")], children: &[must("vertex")] },
    SchemaElement { name: "vertex", attributes: &[must("x"), must("y")], children: &[] },
    SchemaElement { name: "outgoingPath", attributes: &[must("name")], children: &[] },
    SchemaElement { name: "member", attributes: &[must("name")], children: &[] },
    SchemaElement { name: "property", attributes: &[must("name"), must("value")], children: &[] },
];

/// Returns what of a model its version does not have, or has elsewhere, each kind once.
pub(super) fn faults(model: Node<'_, '_>, version: ModelVersion) -> BTreeSet<String> {
    let mut faults = BTreeSet::new();
    let mut ids = BTreeSet::new();
    for element in model.descendants().filter(Node::is_element) {
        let own = element.tag_name().name();
        // Ids are those of one thing each.
        if version <= V002 && element.attribute("id").is_some_and(|id| !ids.insert(id)) {
            faults.insert(format!("{own}, id: there is another one of it"));
        }
        let Some(known) = ELEMENTS.iter().find(|known| known.name == own) else { continue };
        let mut fault = |part: &str, what: &str| faults.insert(format!("{own}, {part}: {what}"));
        for attribute in element.attributes().filter(|attribute| attribute.namespace().is_none()) {
            if !known.attributes.iter().any(|part| part.name == attribute.name() && part.is_in(version)) {
                fault(attribute.name(), "not an attribute");
            }
        }
        for needed in known.attributes.iter().filter(|part| part.is_needed(version)) {
            if !element.has_attribute(needed.name) {
                fault(needed.name, "missing");
            }
        }
        let mut before = 0;
        for child in element.children().filter(Node::is_element) {
            let name = child.tag_name().name();
            match known.children.iter().position(|part| part.name == name && part.is_in(version)) {
                None => _ = fault(name, "not an element"),
                Some(place) if place < before => _ = fault(name, "behind what comes after it"),
                Some(place) => before = place,
            }
        }
        for needed in known.children.iter().filter(|part| part.is_needed(version)) {
            if !element.children().any(|child| child.has_tag_name(needed.name)) {
                fault(needed.name, "missing");
            }
        }
    }
    faults
}
