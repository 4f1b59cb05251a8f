//! The page: where it is, and what it shows.

use super::super::CliError;
use super::{ServeArgs, bound, listen};
use pcr_drawing::fleet_page;
use pcr_formats::scenario::{Agent, MotionSpec, PathSegment, Scenario};
use pcr_serve::http::{HttpContent, Readiness, RobotDrawing};
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::owned_path::PathElement;
use std::net::{SocketAddr, TcpListener};

/// Where the page is, if it is wanted.
pub(super) fn place(arguments: &ServeArgs) -> Option<&str> {
    arguments.page.as_deref().or(arguments.demo.is_some().then_some("8080"))
}

/// Listens for the page.
pub(super) fn listener(place: &str, log: LogWriter) -> Result<TcpListener, CliError> {
    let addresses =
        listen::addresses(place).map_err(|error| CliError::arguments(format!("--page: {place}: {error}")))?;
    let listener = bound("--page", place, &addresses, &[], log)?;
    if listener.local_addr().is_ok_and(|address| !address.ip().is_loopback()) {
        let what = "other machines can reach the page: whoever does sees the fleet, and can change nothing";
        log.write(LogLevel::Warn, what, &[("address", &place)]);
    }
    Ok(listener)
}

/// What the page at an address shows.
pub(super) fn content(address: Option<SocketAddr>, unready: Option<Readiness>) -> HttpContent {
    let port = address.map_or(0, |address| address.port());
    let mut hosts: Vec<String> = ["localhost", "127.0.0.1", "[::1]"].map(|host| format!("{host}:{port}")).into();
    hosts.extend(address.map(|address| address.to_string()));
    // Browsers leave out the usual port.
    let short = |host: &String| host.strip_suffix(":80").map(str::to_owned);
    hosts.extend(hosts.iter().filter_map(short).collect::<Vec<_>>());
    // At 0.0.0.0 it is reached by any address of the machine.
    let addresses = address.is_some_and(|address| address.ip().is_unspecified());
    HttpContent { page: fleet_page::page(), draw: Some(draw), hosts, addresses, unready }
}

/// The collision map of a robot, if all set off now.
fn draw(fleet: &[RobotDrawing], ego: usize) -> Result<String, String> {
    let agents = fleet.iter().zip(1..).map(|(robot, id)| {
        // The map is without times, and no motion of the robot stops.
        let turn = |sweep| PathSegment::Kink { sweep };
        let path = robot.course.shapes().iter().flat_map(|shape| match *shape {
            PathElement::Line { length } => vec![PathSegment::Line { length }],
            PathElement::Arc { radius, sweep } => vec![PathSegment::arc(radius, sweep)],
            PathElement::Turn { sweep, .. } => vec![turn(sweep)],
            PathElement::Shift { ahead, left } => {
                let side = left.atan2(ahead);
                vec![turn(side), PathSegment::Line { length: shape.length() }, turn(-side)]
            }
        });
        let shifts = robot.course.shapes().iter().any(|shape| matches!(shape, PathElement::Shift { .. }));
        let start = robot.course.start();
        let motion = MotionSpec::RestToRest { v_max: robot.abilities.speed, a_max: robot.abilities.acceleration };
        let radius = robot.abilities.radius;
        let agent = Agent::disc(id, radius, [start.x, start.y, start.heading], path.collect(), motion);
        // Agents of scenarios face along their paths.
        let footprint = robot.abilities.footprint.clone().filter(|_| !robot.any_heading && !shifts);
        let is_disc = footprint.is_none() && robot.abilities.footprint.is_some();
        let label = if is_disc { format!("{} (drawn as a disc)", robot.name) } else { robot.name.clone() };
        Agent { label, footprint, ..agent }
    });
    let scenario = Scenario::new("fleet", agents.collect());
    fleet_page::map(&scenario, ego).map_err(|error| error.to_string())
}
