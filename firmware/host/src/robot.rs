//! The other end of the line of one robot: the supervisor of 30, and the 29 others, which go first. Every report is where the same
//! robot would be here, bit by bit.

use crate::passing::{Rounded, motions};
use pcr_core::scalar::Angle;
use pcr_core::{Curve, Limits, Point, Pose, TurnSide};
use pcr_supervisor::frame::{Reads, Receiver};
use pcr_supervisor::message::{Edition, Terms};
use pcr_supervisor::scenario::crowd::{OWN, PIECES, REGIONS, ROBOTS, SEGMENTS};
use pcr_supervisor::{Agent, Answer, Briefing, Client, Event, Request, Robot, Service, Session, Step, Traffic};
use std::error::Error;
use std::io::{BufReader, Read, Write};
use std::process::{Command, Stdio};

type Supervisor<S> = Session<S, ROBOTS, SEGMENTS, 512, 1024, Traffic<S, ROBOTS, 512, 1024, 512>>;

/// The robot goes 31 m along a line; the others cross it one after the other, each a metre further on, every third in a bend. All
/// set off so that it comes last.
fn agent<S: Rounded>(index: usize) -> Agent<S> {
    let number = S::from_f64;
    let heading = |x: f64, y: f64| S::Angle::atan2(number(y), number(x));
    let at = |x: f64, y: f64, heading: S::Angle| Pose { position: Point::new(number(x), number(y)), heading };
    let line = |length| Step { curve: Curve::Line, length: number(length) };
    // A quarter of a metre beside the line between its ends.
    let bend = Step { curve: Curve::Arc { radius: number(8.0), turn: TurnSide::Left }, length: number(4.0) };
    let x = index as f64 + 1.0;
    let (start, step, start_time) = match index {
        _ if index == usize::from(OWN) => (at(0.0, 0.0, heading(1.0, 0.0)), line(31.0), 600.0),
        _ if index.is_multiple_of(3) => (at(x, -2.0, heading(0.25, 1.0)), bend, 20.0 * x),
        _ => (at(x, -2.0, heading(0.0, 1.0)), line(4.0), 20.0 * x),
    };
    Agent {
        radius: number(0.25),
        start_time: number(start_time),
        limits: Limits { speed: number(1.0), acceleration: number(1.0) },
        start,
        path: [step].into_iter().collect(),
    }
}

/// The last answer to a request.
fn ask<S: Rounded>(
    supervisor: &mut Supervisor<S>,
    client: &mut Client,
    request: &Request<S>,
    mut hear: impl FnMut(&Answer<S>),
) -> Result<Answer<S>, Box<dyn Error>> {
    assert!(client.ask(request), "a request fits a frame");
    let (mut said, mut last) = (Vec::new(), None);
    client.frame().iter().for_each(|&byte| supervisor.take(byte, &mut |frame: &[u8]| said.extend_from_slice(frame)));
    for byte in said {
        if let Some(Event::Answer(answer) | Event::Last(answer)) = client.take(byte) {
            hear(&answer);
            last = Some(answer);
        }
    }
    last.ok_or_else(|| format!("no answer to {request:?}").into())
}

/// Runs the robot behind a command, and the same one here.
pub(crate) fn check<S: Rounded>(command: &[&str]) -> Result<(), Box<dyn Error>> {
    let mut supervisor = Box::new(Supervisor::<S>::of(Service::with(Traffic::new(), &[])));
    let mut planner = Client::new();
    for index in 0..ROBOTS {
        match ask(&mut supervisor, &mut planner, &Request::Add(agent::<S>(index)), |_| {})? {
            Answer::Fleet { .. } => {}
            other => return Err(format!("{other:?}").into()),
        }
    }
    let computed = ask(&mut supervisor, &mut planner, &Request::Compute, |_| {})?;
    let terms = Terms { run: 1, horizon: S::from_f64(40.0), width: S::from_f64(0.0) };
    let ordered = ask(&mut supervisor, &mut planner, &Request::Order(terms), |_| {})?;
    let Answer::Edition(edition) = ordered else { return Err(format!("{computed:?}, {ordered:?}").into()) };

    let mut own = Here::new(&mut supervisor, edition)?;
    let (program, arguments) = command.split_first().ok_or("no command")?;
    let mut child = Command::new(program).args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
    let (mut to, from) = (child.stdin.take().ok_or("no line")?, child.stdout.take().ok_or("no line")?);
    let mut requests = Receiver::new(Reads::Requests);
    let (mut reports, mut places) = (0_usize, [0.0; ROBOTS]);
    let mut frame = Vec::new();
    for byte in BufReader::new(from).bytes() {
        let byte = byte?;
        frame.push(byte);
        let Some(request) = requests.take::<Request<S>>(byte) else { continue };
        if let Request::Report { at, .. } = request.map_err(|damage| format!("{damage:?}"))?.message {
            let here = own.report(&mut supervisor, reports, &mut places)?;
            if at.lo.bits() != here.bits() {
                let (there, here) = (at.lo.to_f64(), here.to_f64());
                return Err(format!("report {reports}: the robot is at {there} m, not at {here} m").into());
            }
            reports += 1;
        }
        // Behind what the others have said.
        let mut said = Vec::new();
        frame.drain(..).for_each(|byte| supervisor.take(byte, &mut |frame: &[u8]| said.extend_from_slice(frame)));
        to.write_all(&said)?;
        to.flush()?;
    }
    if !child.wait()?.success() {
        return Err("the robot has given up".into());
    }
    println!("{reports} reports of a robot that lets 29 others go first, equal to those computed here bit by bit");
    if reports > 60 { Ok(()) } else { Err("the robot did not wait".into()) }
}

/// The same robot on the host.
struct Here<S: Rounded> {
    told: Box<Briefing<S, ROBOTS, SEGMENTS, REGIONS>>,
    robot: Box<Robot<S, ROBOTS, REGIONS, PIECES>>,
    client: Client,
    others: Vec<Client>,
    edition: Edition,
    at: S,
}

impl<S: Rounded> Here<S> {
    fn new(supervisor: &mut Supervisor<S>, edition: Edition) -> Result<Self, Box<dyn Error>> {
        let (mut told, mut robot) = (Box::new(Briefing::new()), Box::new(Robot::new()));
        told.begin(OWN);
        let (mut client, zero) = (Client::robot(OWN), S::from_f64(0.0));
        let mut clear = Ok(());
        let last = ask(supervisor, &mut client, &Request::Orders { agent: OWN }, |answer| {
            clear = clear.and_then(|()| told.take(answer));
        })?;
        if !matches!(last, Answer::Orders { .. }) {
            return Err(format!("{last:?}").into());
        }
        clear.map_err(|unclear| format!("{unclear:?}"))?;
        let fleet = motions(&told);
        robot.brief(&told, &fleet, zero).map_err(|unclear| format!("{unclear:?}"))?;
        drop(fleet);
        let others = (0..OWN).map(Client::robot).collect();
        Ok(Self { told, robot, client, others, edition, at: zero })
    }

    /// The others go on, one after the other, a part of their ways at a time; where the robot says then that it is, and where it
    /// is afterwards.
    fn report(
        &mut self,
        supervisor: &mut Supervisor<S>,
        reports: usize,
        places: &mut [f64; ROBOTS],
    ) -> Result<S, Box<dyn Error>> {
        let edition = self.edition;
        let other = (reports / 3).min(usize::from(OWN) - 1);
        let before = places[other];
        places[other] = (before + 4.0 / 3.0).min(4.0);
        // At the end of its way where that is reached, whatever the rounding.
        let to = if reports % 3 == 2 { 4.0 } else { places[other] };
        for at in [before, to] {
            let at = S::from_f64(at);
            let report = Request::Report { agent: other as u16, edition, at: pcr_core::Interval::new(at, at) };
            ask(supervisor, &mut self.others[other], &report, |_| {})?;
        }
        let said = self.at;
        let report = Request::Report { agent: OWN, edition, at: pcr_core::Interval::new(said, said) };
        let (told, robot) = (&self.told, &mut self.robot);
        ask(supervisor, &mut self.client, &report, |answer| robot.hear(told, answer))?;
        let fleet = motions(&self.told);
        self.at = self.robot.hold(&fleet);
        Ok(said)
    }
}
