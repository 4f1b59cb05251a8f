//! Frames of tf: where a vehicle was in the frame at the root, by all transforms between them.
//!
//! Between two transforms of a frame, tf2 goes straight and turns steadily; before the first one and after the last one it knows nothing,
//! and so does this reader. Only what is in the plane is read.

use super::cdr::RosValue;
use super::topics::{map_name, vehicle};
use super::{Pose, heading, point, time};
use crate::import::poses::pose_log::PoseTime;
use std::collections::BTreeMap;

/// A frame in the tf of a namespace.
type FrameKey = (String, String);

/// Where a frame is in its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Placement {
    point: [f64; 2],
    heading: f64,
}

impl Placement {
    /// Where something in this frame is, in its parent.
    fn of(self, inner: Self) -> Self {
        let (sin, cos) = self.heading.sin_cos();
        let [x, y] = inner.point;
        let point = [self.point[0] + cos * x - sin * y, self.point[1] + sin * x + cos * y];
        Self { point, heading: self.heading + inner.heading }
    }

    /// A part of the way from here to there, turning the shorter way.
    fn towards(self, other: Self, part: f64) -> Self {
        let point = [0, 1].map(|axis| self.point[axis] + part * (other.point[axis] - self.point[axis]));
        let turn = other.heading - self.heading;
        let turn = turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round();
        Self { point, heading: self.heading + part * turn }
    }
}

/// The transforms of a frame.
struct FrameLink {
    topic: String,
    parent: String,
    is_static: bool,
    /// With the numbers of their messages; by time once all are read.
    placements: Vec<(PoseTime, Placement, usize)>,
}

impl FrameLink {
    /// Where the frame was at a time, if anything is known of that.
    fn at(&self, time: &PoseTime) -> Option<Placement> {
        if self.is_static {
            return self.placements.last().map(|(_, placement, _)| *placement);
        }
        let next = self.placements.partition_point(|(other, ..)| other.since(time) < 0.0);
        let (after, placement, _) = self.placements.get(next)?;
        if after.since(time) == 0.0 {
            return Some(*placement);
        }
        let (before, from, _) = self.placements.get(next.checked_sub(1)?)?;
        Some(from.towards(*placement, time.since(before) / after.since(before)))
    }
}

/// Where a vehicle was in the frame at the root of its tf.
pub(super) struct FrameMotion {
    pub(super) vehicle: String,
    pub(super) topic: String,
    pub(super) root: String,
    /// With the numbers of their messages.
    pub(super) poses: Vec<(Pose, usize)>,
    /// Poses at times for which a frame above has no transform.
    pub(super) missed: usize,
}

/// All transforms of a bag.
#[derive(Default)]
pub(super) struct TransformTree {
    links: BTreeMap<FrameKey, FrameLink>,
}

impl TransformTree {
    /// Adds the transforms of a message.
    pub(super) fn add(&mut self, space: &str, value: &RosValue, is_static: bool, number: usize) -> Result<(), String> {
        for transform in value.list("transforms")? {
            let [parent, child] = ["header/frame_id", "child_frame_id"]
                .map(|path| transform.text(path).map(|frame| frame.trim_start_matches('/').to_owned()));
            let (parent, child) = (parent?, child?);
            let placement = Placement {
                point: point(transform, "transform/translation")?,
                heading: heading(transform, "transform/rotation")?,
            };
            let topic = if space.is_empty() { "/tf".to_owned() } else { format!("/{space}/tf") };
            let key = (space.to_owned(), child.clone());
            let new = || FrameLink { topic, parent: parent.clone(), is_static, placements: Vec::new() };
            let link = self.links.entry(key).or_insert_with(new);
            if link.parent != parent {
                return Err(format!("frame {child} is in {parent}, and was in {} before", link.parent));
            }
            link.is_static &= is_static;
            link.placements.push((time(transform, "header/stamp")?, placement, number));
        }
        Ok(())
    }

    /// Where the vehicles were, by the frames of their bodies.
    pub(super) fn vehicles(mut self) -> Result<Vec<FrameMotion>, String> {
        for link in self.links.values_mut() {
            link.placements.sort_by(|(a, ..), (b, ..)| a.since(b).total_cmp(&0.0));
            link.placements
                .dedup_by(|(next, placement, _), (time, before, _)| next.since(time) == 0.0 && placement == before);
        }
        let mut motions = Vec::new();
        for key in self.links.keys() {
            let Some(vehicle) = vehicle(&key.0, &key.1) else { continue };
            let chain = self.chain(key)?;
            // One body may have several such frames: the one nearest to the root.
            if chain.iter().skip(1).any(|link| self::vehicle(&key.0, link.0).is_some()) {
                continue;
            }
            motions.extend(motion(&chain.iter().map(|(_, link)| *link).collect::<Vec<_>>(), &key.0, vehicle));
        }
        Ok(motions)
    }

    /// A frame and all above it but the root, each with its transforms.
    fn chain(&self, key: &FrameKey) -> Result<Vec<(&str, &FrameLink)>, String> {
        let mut chain: Vec<(&str, &FrameLink)> = Vec::new();
        let mut frame = key.clone();
        while let Some(((_, name), link)) = self.links.get_key_value(&frame) {
            if chain.len() > self.links.len() {
                return Err(format!("frame {} is above itself", key.1));
            }
            chain.push((name, link));
            frame.1.clone_from(&link.parent);
        }
        Ok(chain)
    }
}

/// The motion of the first frame of a chain; nothing where it never moves.
fn motion(chain: &[&FrameLink], space: &str, vehicle: String) -> Option<FrameMotion> {
    let moving = chain.iter().find(|link| !link.is_static)?;
    let root = map_name(space, &chain.last()?.parent);
    let (mut poses, mut missed) = (Vec::new(), 0);
    for (time, _, number) in &moving.placements {
        let placed = chain.iter().try_fold(Placement { point: [0.0; 2], heading: 0.0 }, |inner, link| {
            link.at(time).map(|outer| outer.of(inner))
        });
        match placed {
            Some(Placement { point, heading }) => {
                poses.push((Pose { time: *time, point, heading, frame: root.clone() }, *number));
            }
            None => missed += 1,
        }
    }
    Some(FrameMotion { vehicle, topic: moving.topic.clone(), root, poses, missed })
}
