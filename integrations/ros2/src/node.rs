//! The node: topics in and out.

use crate::connections::{name, reliable};
use crate::messages::{Clock, FleetState, MarkerArray, PathMessage, Time};
use crate::report::{AuthoritiesReport, ConflictsReport};
use crate::route_servers::RouteServers;
use crate::{Answer, Closures, Config, RouteGraph, Watch};
use ros2_client::dds::rustdds::mio1::{Events, Interest, Poll, Token};
use ros2_client::qos::History;
use ros2_client::{
    Context, ContextOptions, MessageTypeName, Node, NodeName, NodeOptions, Publisher, QosProfile, ServiceMapping,
    Subscription,
};
use std::error::Error;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// The longest time between two answers. There is one also if nothing comes in, because paths grow old.
const PERIOD: Duration = Duration::from_secs(1);

type Failure = Box<dyn Error>;

/// The node with its topics.
pub struct PcrNode {
    watch: Watch,
    closures: Option<Closures>,
    /// The time of `/clock`, where that is used.
    simulated: Option<Time>,
    // Dropped last: topics belong to it.
    paths: Vec<(usize, Subscription<PathMessage>)>,
    fleets: Option<Subscription<FleetState>>,
    clock: Option<Subscription<Clock>>,
    servers: RouteServers,
    conflicts: Publisher<ConflictsReport>,
    authorities: Publisher<AuthoritiesReport>,
    markers: Publisher<MarkerArray>,
    _node: Node,
}

impl PcrNode {
    /// Joins a domain (`ROS_DOMAIN_ID`), subscribes to all paths and offers what is published. `graph` is that of the configuration, if it has one;
    /// `mapping` is how the middleware of the route servers tells to which request an answer belongs.
    ///
    /// # Errors
    /// Why not.
    pub fn new(
        config: Config,
        graph: Option<RouteGraph>,
        domain: u16,
        mapping: ServiceMapping,
    ) -> Result<Self, Failure> {
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
        let clock = if config.use_sim_time {
            // As it is published: only the latest one counts, and none is sent again.
            let latest =
                QosProfile::subscription_default().reliability_best_effort().history(History::KeepLast { depth: 1 });
            let topic = node.create_topic(&name("clock")?, MessageTypeName::new("rosgraph_msgs", "Clock"), &latest)?;
            Some(node.create_subscription(&topic, None)?)
        } else {
            None
        };
        let servers = RouteServers::new(&config, &mut node, mapping)?;
        let stands = config.route_graph.as_ref().map(|graph| graph.stands);
        let closures = graph.zip(stands).map(|(graph, stands)| Closures::new(graph, stands, config.robots.len()));
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
            clock,
            servers,
            closures,
            simulated: None,
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
        if let Some(subscription) = &mut self.clock {
            poll.registry().register(subscription, Token(0), Interest::READABLE)?;
        }
        self.servers.register(poll.registry())?;
        let mut events = Events::with_capacity(64);
        let mut told = Vec::new();
        loop {
            let due = Instant::now() + PERIOD;
            loop {
                let left = due.saturating_duration_since(Instant::now());
                poll.poll(&mut events, Some(left))?;
                self.servers.take();
                self.take_clock();
                if self.take() || left.is_zero() {
                    break;
                }
            }
            // Before the first time of a simulation nothing is claimed.
            let Some(now) = self.now()? else { continue };
            if let Some(closures) = &mut self.closures {
                self.servers.close(self.watch.closed_edges(closures, now));
            }
            let answer = self.watch.answer(now);
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

    /// Takes the time of a simulation.
    fn take_clock(&mut self) {
        while let Some(subscription) = &self.clock {
            match subscription.take() {
                Ok(Some((Clock { clock }, _))) => self.simulated = Some(clock),
                Ok(None) => break,
                Err(problem) => eprintln!("pcr-ros2: /clock cannot be read: {problem:?}"),
            }
        }
    }

    /// The time of the simulation, if there is one yet, or of the system's clock.
    fn now(&self) -> Result<Option<Time>, Failure> {
        if self.clock.is_some() {
            return Ok(self.simulated);
        }
        let since = SystemTime::now().duration_since(UNIX_EPOCH)?;
        Ok(Some(Time { sec: i32::try_from(since.as_secs())?, nanosec: since.subsec_nanos() }))
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
