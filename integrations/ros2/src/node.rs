//! The node: topics in and out.

use crate::messages::{FleetState, MarkerArray, PathMessage, Time};
use crate::report::{AuthoritiesReport, ConflictsReport};
use crate::{Answer, Config, Watch};
use ros2_client::dds::rustdds::mio1::{Events, Interest, Poll, Token};
use ros2_client::qos::{History, WhenFull};
use ros2_client::{
    Context, ContextOptions, MessageTypeName, Name, Node, NodeName, NodeOptions, Publisher, QosProfile, Subscription,
};
use std::error::Error;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// The longest time between two answers. There is one also if nothing comes in, because paths grow old.
const PERIOD: Duration = Duration::from_secs(1);

type Failure = Box<dyn Error>;

/// The node with its topics.
pub struct PcrNode {
    watch: Watch,
    // Dropped last: topics belong to it.
    paths: Vec<(usize, Subscription<PathMessage>)>,
    fleets: Option<Subscription<FleetState>>,
    conflicts: Publisher<ConflictsReport>,
    authorities: Publisher<AuthoritiesReport>,
    markers: Publisher<MarkerArray>,
    _node: Node,
}

fn name(of: &str) -> Result<Name, Failure> {
    // The topics of a configuration are absolute, with or without the slash.
    Name::parse(&format!("/{}", of.trim_start_matches('/')))
        .map_err(|error| format!("topic \"{of}\": {error:?}").into())
}

/// Paths and what is published are reliable.
fn reliable(depth: usize) -> QosProfile {
    QosProfile::publisher_default().reliability_reliable(WhenFull::DEFAULT).history(History::KeepLast { depth })
}

impl PcrNode {
    /// Joins a domain (`ROS_DOMAIN_ID`), subscribes to all paths and offers what is published.
    ///
    /// # Errors
    /// Why not.
    pub fn new(config: Config, domain: u16) -> Result<Self, Failure> {
        let context = Context::with_options(ContextOptions::new().domain_id(domain))?;
        let mut node = context.new_node(NodeName::new("/", "pcr")?, NodeOptions::new())?;
        let mut paths = Vec::with_capacity(config.robots.len());
        let path = MessageTypeName::new("nav_msgs", "Path");
        let topics = config.robots.iter().enumerate().filter_map(|(robot, found)| Some((robot, found.path.as_ref()?)));
        for (robot, topic) in topics {
            let topic = node.create_topic(&name(topic)?, path.clone(), &reliable(10))?;
            paths.push((robot, node.create_subscription(&topic, None)?));
        }
        let fleets = match &config.fleet_states {
            Some(topic) => {
                let kind = MessageTypeName::new("rmf_fleet_msgs", "FleetState");
                let topic = node.create_topic(&name(topic)?, kind, &reliable(100))?;
                Some(node.create_subscription(&topic, None)?)
            }
            None => None,
        };
        // Nothing is kept for those who come late: it may be of paths that do not hold any more, and there is an answer at least each second.
        let latest = reliable(1);
        let own = |kind| MessageTypeName::new("pcr_msgs", kind);
        let conflicts = node.create_topic(&name("pcr/conflicts")?, own("Conflicts"), &latest)?;
        let authorities = node.create_topic(&name("pcr/authorities")?, own("Authorities"), &latest)?;
        let markers = MessageTypeName::new("visualization_msgs", "MarkerArray");
        let markers = node.create_topic(&name("pcr/markers")?, markers, &latest)?;
        Ok(Self {
            paths,
            fleets,
            conflicts: node.create_publisher(&conflicts, None)?,
            authorities: node.create_publisher(&authorities, None)?,
            markers: node.create_publisher(&markers, None)?,
            watch: Watch::new(config),
            _node: node,
        })
    }

    /// Answers until something fails.
    ///
    /// # Errors
    /// What failed.
    pub fn run(&mut self) -> Result<(), Failure> {
        let mut poll = Poll::new()?;
        // Whichever is ready, all are read.
        for (_, subscription) in &mut self.paths {
            poll.registry().register(subscription, Token(0), Interest::READABLE)?;
        }
        if let Some(subscription) = &mut self.fleets {
            poll.registry().register(subscription, Token(0), Interest::READABLE)?;
        }
        let mut events = Events::with_capacity(64);
        let mut told = Vec::new();
        loop {
            let due = Instant::now() + PERIOD;
            loop {
                let left = due.saturating_duration_since(Instant::now());
                poll.poll(&mut events, Some(left))?;
                if self.take() || left.is_zero() {
                    break;
                }
            }
            let answer = self.watch.answer(now()?);
            log(&answer, &mut told);
            self.publish(answer);
        }
    }

    /// Takes all messages that are there. Returns whether there was one.
    fn take(&mut self) -> bool {
        let mut any = false;
        for (robot, subscription) in &self.paths {
            loop {
                match subscription.take() {
                    Ok(Some((path, _))) => self.watch.take(*robot, &path),
                    Ok(None) => break,
                    Err(problem) => self.watch.take_unreadable(*robot, format!("{problem:?}")),
                }
                any = true;
            }
        }
        while let Some(subscription) = &self.fleets {
            match subscription.take() {
                Ok(Some((state, _))) => self.watch.take_fleet(&state),
                Ok(None) => break,
                Err(problem) => self.watch.take_unreadable_fleet(&format!("{problem:?}")),
            }
            any = true;
        }
        any
    }

    /// Publishes an answer. One that a reader is too slow for is told, and not kept: the next one comes within a second.
    fn publish(&self, answer: Answer) {
        let sent = [
            ("conflicts", self.conflicts.publish(answer.conflicts).map_err(|problem| format!("{problem:?}"))),
            ("authorities", self.authorities.publish(answer.authorities).map_err(|problem| format!("{problem:?}"))),
            ("markers", self.markers.publish(answer.markers).map_err(|problem| format!("{problem:?}"))),
        ];
        for (topic, problem) in sent.into_iter().filter_map(|(topic, sent)| Some((topic, sent.err()?))) {
            eprintln!("pcr-ros2: {topic} were not sent: {problem}");
        }
    }
}

/// The time of the system's clock.
fn now() -> Result<Time, Failure> {
    let since = SystemTime::now().duration_since(UNIX_EPOCH)?;
    Ok(Time { sec: i32::try_from(since.as_secs())?, nanosec: since.subsec_nanos() })
}

/// Tells refusals when they begin.
fn log(answer: &Answer, told: &mut Vec<(String, String)>) {
    let refusals = answer.conflicts.refusals.iter();
    let refused: Vec<(String, String)> =
        refusals.map(|refusal| (refusal.robot.clone(), refusal.reason.clone())).collect();
    for line in refused.iter().filter(|line| !told.contains(line)) {
        eprintln!("pcr-ros2: {}: {}", line.0, line.1);
    }
    *told = refused;
}
