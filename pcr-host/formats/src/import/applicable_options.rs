//! Which options have an effect on which files. An option without effect is refused, because its user expects one.

use super::{ImportOptions, InputFormat, Warnings, xml};

/// The kind of a file, with respect to options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputKind {
    /// A scenario file: agents with everything they need.
    Scenario,
    /// Nodes and edges, on which routes are asked for.
    Layout(InputFormat),
    /// Orders and states of VDA 5050.
    Orders,
    /// Points of paths.
    Paths,
    /// Points with times, of Continuous-CBS or on a grid.
    Plan,
    /// Records of what ran, and plans, as poses with times.
    Poses,
}

impl InputKind {
    /// The kind of a text in this format; without a format it is a scenario.
    pub fn detect(format: Option<InputFormat>, text: &str) -> Self {
        match format {
            None => Self::Scenario,
            Some(InputFormat::Vda5050) => Self::Orders,
            Some(InputFormat::Path) => Self::Paths,
            Some(InputFormat::Grid) => Self::Plan,
            Some(InputFormat::Poses) => Self::Poses,
            Some(InputFormat::Ccbs) if xml::root_of(text) != Some("graphml") => Self::Plan,
            Some(format) => Self::Layout(format),
        }
    }
}

impl ImportOptions {
    /// The fields that are given, with the names that they have on the command line. The margin is not among them: the agents of any kind of
    /// file may take it.
    fn all(&self) -> [(&'static str, &'static str, bool); 14] {
        [
            ("from", "--from", self.from.is_some()),
            ("routes", "--route", !self.routes.is_empty()),
            ("radius", "--radius", self.radius.is_some()),
            ("speed", "--speed", self.speed.is_some()),
            ("acceleration", "--acceleration", self.acceleration.is_some()),
            ("rotation", "--rotation", self.rotation.is_some()),
            ("rotation_acceleration", "--rotation-acceleration", self.rotation_acceleration.is_some()),
            ("vehicle", "--vehicle", self.vehicle.is_some()),
            ("fleet", "--fleet", self.fleet.is_some()),
            ("corner_radius", "--corner-radius", self.corner_radius.is_some()),
            ("tolerance", "--tolerance", self.tolerance.is_some()),
            ("graph", "--graph", self.graph.is_some()),
            ("horizon", "--horizon", self.horizon),
            ("partial", "--partial", self.partial),
        ]
    }

    /// The options that are given, as on the command line.
    pub fn given(&self) -> Vec<&'static str> {
        let margin = self.margin.map(|_| "--margin");
        self.all().into_iter().filter(|(.., given)| *given).map(|(_, option, _)| option).chain(margin).collect()
    }

    /// One of these fields that is given, as on the command line.
    pub fn one_of(&self, fields: &[&str]) -> Option<&'static str> {
        let all = self.all().into_iter().chain([("margin", "--margin", self.margin.is_some())]);
        all.into_iter().find(|(field, _, given)| *given && fields.contains(field)).map(|(_, option, _)| option)
    }

    /// An option that is given and does nothing with such a file, and why.
    pub(crate) fn without_effect(&self, kind: InputKind) -> Option<(&'static str, &'static str)> {
        let given = self.all().into_iter().filter(|(.., given)| *given);
        given.into_iter().find_map(|(field, option, _)| Some((option, without_effect(field, kind)?)))
    }

    /// An option that is given and had no effect on any of the files that were read with these warnings, and why.
    pub fn unused(&self, files: &[&Warnings]) -> Option<(&'static str, &'static str)> {
        let used = |field: &str| files.iter().any(|warnings| warnings.has_used(field));
        let mut given = self.all().into_iter().filter(|(field, _, given)| *given && !used(field));
        given.find_map(|(field, option, _)| Some((option, unused(field)?)))
    }
}

/// Why an option had no effect on a file on which it may have one. Nothing for those that say what the vehicle is, which holds whether or
/// not it drives in this file. Nothing for `--partial`, either, which is a permission: whoever gives it for many files does not know which
/// of them need it.
fn unused(field: &str) -> Option<&'static str> {
    match field {
        "fleet" => Some("other options say all that is in it, or it says nothing"),
        "tolerance" => Some("there is no curve in what is read but lines and arcs"),
        "horizon" => Some("it is for orders that end in edges that are not released, and there is none"),
        "corner_radius" => Some("no corner of a route is rounded with it"),
        _ => None,
    }
}

/// Why an option does nothing with such a file; nothing where it does something.
fn without_effect(field: &str, kind: InputKind) -> Option<&'static str> {
    match (field, kind) {
        ("from", _) => None,
        ("horizon", InputKind::Orders) => None,
        ("horizon", _) => Some("only orders of VDA 5050 have a horizon"),
        ("graph", InputKind::Layout(InputFormat::Rmf)) => None,
        ("graph", _) => Some("only buildings of Open-RMF have several graphs"),
        (_, InputKind::Scenario) => Some("a scenario has its own vehicles and paths"),
        ("routes", InputKind::Orders | InputKind::Paths | InputKind::Plan | InputKind::Poses) => {
            Some("the file has paths of its own, and is no layout")
        }
        ("vehicle", InputKind::Layout(InputFormat::Lif)) => None,
        ("vehicle", _) => Some("only layouts in LIF tell types of vehicles apart"),
        ("speed" | "acceleration" | "rotation" | "rotation_acceleration", InputKind::Plan | InputKind::Poses) => {
            Some("a plan has its own times")
        }
        ("corner_radius", InputKind::Orders | InputKind::Paths | InputKind::Plan | InputKind::Poses) => {
            Some("only routes on layouts have corners to round")
        }
        ("partial", InputKind::Paths | InputKind::Plan | InputKind::Poses) => Some("it is read whole or refused"),
        (
            "tolerance",
            InputKind::Plan
            | InputKind::Poses
            | InputKind::Layout(InputFormat::Rmf | InputFormat::OpenDrive | InputFormat::Ccbs | InputFormat::Nav2),
        ) => Some("there is no curve in the file but lines and arcs"),
        _ => None,
    }
}
