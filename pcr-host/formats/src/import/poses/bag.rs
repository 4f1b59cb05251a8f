//! Bags of ROS 2 in MCAP: the poses that vehicles, localization, odometry and fleet adapters publish.
//!
//! ```text
//! records         the container: chunks, checksums, what was cut
//! message_schema  definitions of messages
//! cdr             messages by their definitions
//! topics          which topics hold poses, and whose they are
//! transforms      frames of tf, composed
//! ```
//!
//! Times are those of the stamps in the messages; a message is named by its number in the file, from 1.

mod cdr;
mod message_schema;
pub(super) mod records;
mod topics;
mod transforms;

use super::super::{ImportError, WarningCode, Warnings};
use super::PoseOptions;
use super::pose_log::{PoseLogBuilder, PoseTime, RawPose};
use crate::scenario::LIMIT;
use cdr::RosValue;
use mcap::records::Record;
use message_schema::MessageSchema;
use std::collections::HashMap;
use std::io::Read;
use topics::{PoseSource, is_chosen, map_name, namespace, or_root};
use transforms::{FrameMotion, TransformTree};

/// A definition as the file has it.
struct FileSchema {
    name: String,
    encoding: String,
    text: Vec<u8>,
}

/// A topic with poses.
struct PoseChannel {
    topic: String,
    source: PoseSource,
    schema: MessageSchema,
}

/// What is read of a bag.
struct BagReader<'a, 'o> {
    options: &'a PoseOptions,
    log: &'a mut PoseLogBuilder<'o>,
    warnings: &'a mut Warnings,
    schemas: HashMap<u16, FileSchema>,
    /// By their numbers; nothing for those that are not read.
    channels: HashMap<u16, Option<PoseChannel>>,
    /// Topics that are not read, with the types of their messages, in the order of the file.
    unread: Vec<String>,
    /// Of which topic the poses of an agent are.
    topics: HashMap<String, String>,
    used: Vec<bool>,
    transforms: TransformTree,
    messages: usize,
}

/// Reads the poses in a bag.
pub(super) fn read(
    source: &mut dyn Read,
    options: &PoseOptions,
    log: &mut PoseLogBuilder<'_>,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    log.counts_messages = true;
    let mut bag = BagReader {
        options,
        log,
        warnings,
        schemas: HashMap::new(),
        channels: HashMap::new(),
        unread: Vec::new(),
        topics: HashMap::new(),
        used: vec![false; options.topics.len()],
        transforms: TransformTree::default(),
        messages: 0,
    };
    records::read(source, &mut |record| bag.record(record))?;
    bag.finish()
}

impl BagReader<'_, '_> {
    fn record(&mut self, record: Record<'_>) -> Result<(), ImportError> {
        match record {
            Record::Header(header) if !matches!(header.profile.as_str(), "ros2" | "") => {
                let problem = format!("a bag with the profile {:?}, and ros2 is read", header.profile);
                Err(ImportError::new(problem))
            }
            Record::Schema { header, data } => {
                let schema = FileSchema { name: header.name, encoding: header.encoding, text: data.into_owned() };
                self.schemas.insert(header.id, schema);
                Ok(())
            }
            Record::Channel(channel) => {
                if !self.channels.contains_key(&channel.id) {
                    let read = self.channel(&channel.topic, channel.schema_id, &channel.message_encoding)?;
                    self.channels.insert(channel.id, read);
                }
                Ok(())
            }
            Record::Message { header, data } => {
                self.messages += 1;
                // For the time of the message, so that it can be asked for what else is in the reader.
                let Some(channel) = self.channels.get_mut(&header.channel_id) else {
                    let problem =
                        format!("message {}: of channel {}, which is not there", self.messages, header.channel_id);
                    return Err(ImportError::new(problem));
                };
                let Some(channel) = channel.take() else { return Ok(()) };
                let read = self.message(&channel, &data);
                self.channels.insert(header.channel_id, Some(channel));
                read
            }
            _ => Ok(()),
        }
    }

    /// The topic of a channel, if it is one of those that are read.
    fn channel(&mut self, topic: &str, schema: u16, encoding: &str) -> Result<Option<PoseChannel>, ImportError> {
        let Some(schema) = self.schemas.get(&schema) else {
            self.unread.push(format!("{topic} (no definition)"));
            return Ok(None);
        };
        let source = PoseSource::of_type(&message_schema::short_name(&schema.name));
        let chosen = self.options.topics.iter().position(|name| is_chosen(topic, name));
        if let Some(place) = chosen {
            self.used[place] = true;
        }
        let is_static = topic.rsplit('/').next() == Some("tf_static");
        // Without what does not change no frame could be found.
        let is_for_frames = source == Some(PoseSource::Transforms) && is_static;
        let is_asked_for = chosen.is_some() || is_for_frames || self.options.topics.is_empty();
        let is_plan = source == Some(PoseSource::Path) && chosen.is_none();
        let Some(source) = source.filter(|_| is_asked_for && !is_plan) else {
            if chosen.is_some() {
                let problem = format!("--topic {topic}: messages of {}, in which no pose is read", schema.name);
                return Err(ImportError::new(problem));
            }
            self.unread.push(format!("{topic} ({})", schema.name));
            return Ok(None);
        };
        let wrong = |why: &dyn std::fmt::Display| ImportError::new(format!("topic {topic}: {why}"));
        if encoding != "cdr" || schema.encoding != "ros2msg" {
            let problem =
                format!("messages in {encoding:?}, defined in {:?}; cdr and ros2msg are read", schema.encoding);
            return Err(wrong(&problem));
        }
        let text = std::str::from_utf8(&schema.text).map_err(|_| wrong(&"a definition that is not UTF-8"))?;
        let schema = MessageSchema::read(&schema.name, text).map_err(|why| wrong(&why))?;
        Ok(Some(PoseChannel { topic: topic.to_owned(), source, schema }))
    }

    fn message(&mut self, channel: &PoseChannel, data: &[u8]) -> Result<(), ImportError> {
        let number = self.messages;
        let wrong = |why: String| ImportError::new(format!("message {number} ({}): {why}", channel.topic));
        let value = RosValue::read(&channel.schema, data).map_err(wrong)?;
        let space = namespace(&channel.topic);
        let read = match channel.source {
            PoseSource::Pose => Pose::of(&value, "header", "pose").map(|pose| vec![(or_root(space), pose)]),
            PoseSource::PoseWithCovariance => {
                Pose::of(&value, "header", "pose/pose").map(|pose| vec![(or_root(space), pose)])
            }
            PoseSource::Path => {
                path(&value).map(|poses| poses.into_iter().map(|pose| (or_root(space), pose)).collect())
            }
            PoseSource::Fleet => fleet(&value),
            PoseSource::Transforms => {
                let is_static = channel.topic.rsplit('/').next() == Some("tf_static");
                self.transforms.add(space, &value, is_static, number).map_err(wrong)?;
                return Ok(());
            }
        };
        if channel.source == PoseSource::Fleet {
            // Several robots in a message, each with a time of its own, and messages by way of others.
            self.log.is_unordered = true;
        }
        for (agent, pose) in read.map_err(wrong)? {
            let map = map_name(space, &pose.frame);
            self.add(&agent, &channel.topic, &map, &pose, number)?;
        }
        Ok(())
    }

    fn add(&mut self, name: &str, topic: &str, map: &str, pose: &Pose, number: usize) -> Result<(), ImportError> {
        let known = self.topics.entry(name.to_owned()).or_insert_with(|| topic.to_owned());
        if known != topic {
            let problem = format!("vehicle {name}: poses in {known} and in {topic}; say by --topic which to read");
            return Err(ImportError::new(problem));
        }
        let (agent, map) = (self.log.agent(name), self.log.map(map));
        let place = (number, None);
        let Pose { time, point, heading, .. } = *pose;
        self.log.add(agent, RawPose { time, point, heading: Some(heading), error: 0.0, map, is_joined: true, place })
    }

    fn finish(mut self) -> Result<(), ImportError> {
        let unused = self.options.topics.iter().zip(&self.used).find(|(_, used)| !**used);
        if let Some((topic, _)) = unused {
            return Err(ImportError::new(format!("--topic {topic}: there is no such topic in it")));
        }
        let motions = std::mem::take(&mut self.transforms).vehicles().map_err(ImportError::new)?;
        for FrameMotion { vehicle, topic, root, poses, missed } in motions {
            if missed > 0 {
                let problem = format!(
                    "{missed} of {} poses in tf are left out: the frames above have no transform at that time",
                    missed + poses.len()
                );
                self.warnings.add(WarningCode::LeftOut, format_args!("vehicle {vehicle}"), problem);
            }
            for (pose, number) in poses {
                self.add(&vehicle, &topic, &root, &pose, number)?;
            }
        }
        if !self.unread.is_empty() {
            let problem = format!("not read: {}", self.unread.join(", "));
            self.warnings.add(WarningCode::UnreadField, "topics", problem);
        }
        Ok(())
    }
}

/// A pose in a message.
#[derive(Clone, Debug, PartialEq)]
struct Pose {
    time: PoseTime,
    point: [f64; 2],
    heading: f64,
    frame: String,
}

impl Pose {
    /// The pose in a field, with the time and the frame of a header.
    fn of(value: &RosValue, header: &str, pose: &str) -> Result<Self, String> {
        let frame = value.text(&format!("{header}/frame_id"))?.to_owned();
        let time = time(value, &format!("{header}/stamp"))?;
        let point = point(value, &format!("{pose}/position"))?;
        let heading = heading(value, &format!("{pose}/orientation"))?;
        Ok(Self { time, point, heading, frame })
    }
}

fn time(value: &RosValue, path: &str) -> Result<PoseTime, String> {
    let [sec, nanosec] = ["sec", "nanosec"].map(|field| value.whole(&format!("{path}/{field}")));
    PoseTime::since_1970(sec?, nanosec?).ok_or_else(|| format!("{path}: a second has no more than 999999999 ns"))
}

fn point(value: &RosValue, path: &str) -> Result<[f64; 2], String> {
    let axis = |name: &str| {
        let number = value.number(&format!("{path}/{name}"))?;
        if number.abs() <= LIMIT { Ok(number) } else { Err(format!("{path}/{name}: {number} is too far")) }
    };
    Ok([axis("x")?, axis("y")?])
}

/// The heading of a quaternion \[rad\].
fn heading(value: &RosValue, path: &str) -> Result<f64, String> {
    let [x, y, z, w] = ["x", "y", "z", "w"].map(|field| value.number(&format!("{path}/{field}")));
    let [x, y, z, w] = [x?, y?, z?, w?];
    let norm = x * x + y * y + z * z + w * w;
    // Senders that know no heading leave all four at 0.
    if !(0.5..=2.0).contains(&norm) {
        return Err(format!("{path}: [{x}, {y}, {z}, {w}] is no orientation"));
    }
    Ok((2.0 * (w * z + x * y)).atan2(norm - 2.0 * (y * y + z * z)))
}

/// The poses of a path, each of which has a time of its own.
fn path(value: &RosValue) -> Result<Vec<Pose>, String> {
    let mut poses: Vec<Pose> = Vec::new();
    for pose in value.list("poses")? {
        let mut pose = Pose::of(pose, "header", "pose")?;
        if pose.frame.is_empty() {
            pose.frame = value.text("header/frame_id")?.to_owned();
        }
        if poses.last().is_some_and(|last| pose.time.since(&last.time) <= 0.0) {
            return Err(
                "the poses of this path have no times that go on, so it does not say when they are reached".into()
            );
        }
        poses.push(pose);
    }
    Ok(poses)
}

/// The robots of a state of an Open-RMF fleet.
fn fleet(value: &RosValue) -> Result<Vec<(String, Pose)>, String> {
    let fleet = value.text("name")?;
    let robot = |robot: &RosValue| {
        let name = format!("{fleet}/{}", robot.text("name")?);
        let frame = robot.text("location/level_name")?.to_owned();
        let pose = Pose {
            time: time(robot, "location/t")?,
            point: point(robot, "location")?,
            heading: robot.number("location/yaw")?,
            frame,
        };
        Ok((name, pose))
    };
    value.list("robots")?.iter().map(robot).collect()
}
