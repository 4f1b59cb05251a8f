//! Clients of the route servers: requests out, answers in.

use crate::Config;
use crate::connections::{name, reliable};
use crate::edge_requests::EdgeRequests;
use crate::messages::{DynamicEdgesRequest, DynamicEdgesResponse};
use crate::refusal::Refusal;
use ros2_client::dds::rustdds::mio1::{Interest, Registry, Token};
use ros2_client::{Client, Node, RmwRequestId, ServiceMapping, ServiceTypeName};
use std::collections::BTreeSet;
use std::error::Error;
use std::time::{Duration, Instant};

/// The service of one robot's route server.
struct RouteServer {
    robot: usize,
    service: String,
    client: Client<DynamicEdgesRequest, DynamicEdgesResponse>,
    requests: EdgeRequests,
    /// The last request: only its answer counts.
    asked: Option<RmwRequestId>,
    /// The last request and what became of it, as logged: neither is told twice in a row.
    told: [String; 2],
}

/// The route servers of all robots that have one.
pub(crate) struct RouteServers {
    servers: Vec<RouteServer>,
    begin: Instant,
}

impl RouteServers {
    pub(crate) fn new(config: &Config, node: &mut Node, mapping: ServiceMapping) -> Result<Self, Box<dyn Error>> {
        let named = config.robots.iter().enumerate();
        let named = named.filter_map(|(robot, found)| Some((robot, found.route_server.clone()?)));
        let server = |(robot, service): (usize, String)| -> Result<RouteServer, Box<dyn Error>> {
            let kind = ServiceTypeName::new("nav2_msgs", "DynamicEdges");
            let qos = reliable(10);
            let client = node.create_client(mapping, &name(&service)?, &kind, qos.clone(), qos)?;
            Ok(RouteServer {
                robot,
                service,
                client,
                requests: EdgeRequests::default(),
                asked: None,
                told: Default::default(),
            })
        };
        Ok(Self { servers: named.map(server).collect::<Result<_, _>>()?, begin: Instant::now() })
    }

    pub(crate) fn register(&mut self, registry: &Registry) -> std::io::Result<()> {
        self.servers
            .iter_mut()
            .try_for_each(|server| registry.register(&mut server.client, Token(0), Interest::READABLE))
    }

    /// Takes the answers that are there.
    pub(crate) fn take(&mut self) {
        let now = self.begin.elapsed();
        self.servers.iter_mut().for_each(|server| server.take(now));
    }

    /// Asks each server for what is to be closed for its robot, where that is due.
    pub(crate) fn close(&mut self, edges: &[Result<BTreeSet<u16>, Refusal>]) {
        let now = self.begin.elapsed();
        for server in &mut self.servers {
            match edges.get(server.robot) {
                Some(Ok(closed)) => server.close(closed, now),
                // What is closed stays so.
                Some(Err(refusal)) => server.tell(format!("it is not known which edges are blocked: {refusal}")),
                None => {}
            }
        }
    }
}

impl RouteServer {
    fn take(&mut self, now: Duration) {
        loop {
            match self.client.receive_response() {
                // To a request of another client, or to one that a later one has replaced.
                Ok(Some((to, _))) if Some(to) != self.asked => {}
                Ok(Some((_, answer))) => {
                    self.requests.answered(answer, now);
                    let said =
                        if answer.success { "done" } else { "the server says that it could not; it is asked again" };
                    self.tell(said.to_owned());
                }
                Ok(None) => break,
                Err(problem) => self.tell(format!("an answer cannot be read: {problem:?}")),
            }
        }
    }

    fn close(&mut self, closed: &BTreeSet<u16>, now: Duration) {
        if self.requests.is_late(now) {
            self.tell("no answer; the server is asked until there is one".to_owned());
        }
        let Some(request) = self.requests.due(closed, now) else { return };
        self.tell_request(format!("close {:?}, open {:?}", request.closed_edges, request.opened_edges));
        match self.client.send_request(request) {
            Ok(id) => self.asked = Some(id),
            Err(problem) => self.tell(format!("the request was not sent: {problem:?}")),
        }
    }

    /// Logs a request that is not the one before.
    fn tell_request(&mut self, what: String) {
        if self.told[0] != what {
            eprintln!("pcr-ros2: {}: {what}", self.service);
            self.told = [what, String::new()];
        }
    }

    /// Logs what became of it.
    fn tell(&mut self, what: String) {
        if self.told[1] != what {
            eprintln!("pcr-ros2: {}: {what}", self.service);
            self.told[1] = what;
        }
    }
}
