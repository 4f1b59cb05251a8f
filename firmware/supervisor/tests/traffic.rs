//! Orders are handed out once, go on as robots do, and whatever belongs to other orders is refused.

use pcr_core::{Curve, FleetMotions, Interval, Limits, PassingState, Point, Pose, Radians};
use pcr_supervisor::frame::{self, Reads, Receiver, Tag};
use pcr_supervisor::message::{Edition, Refusal, Terms};
use pcr_supervisor::robot::Unclear;
use pcr_supervisor::{Agent, Answer, Briefing, Client, Event, Request, Robot, Service, Session, Step, Traffic};
use std::f32::consts::FRAC_PI_2;

type Table = Traffic<f32, 3, 8, 12, 16>;
type Supervisor = Service<f32, 3, 8, 8, 12, Table>;

const STEPS: [Step<f32>; 1] = [Step { curve: Curve::Line, length: 4.0 }];
const TERMS: Terms<f32> = Terms { run: 7, horizon: 2.0, width: 0.0 };
const FIRST: Edition = Edition { run: 7, number: 1 };

/// On a line of 4 m through the origin in its middle, or beside it.
fn agent(heading: f32, aside: f32, start_time: f32) -> Agent<f32> {
    let (sin, cos) = heading.sin_cos();
    let position = Point::new(-2.0 * cos - aside * sin, -2.0 * sin + aside * cos);
    let limits = Limits { speed: 1.0, acceleration: 1.0 };
    let start = Pose { position, heading: Radians(heading) };
    Agent { radius: 0.25, start_time, limits, start, path: STEPS.into_iter().collect() }
}

fn answers(service: &mut Supervisor, request: Request<f32>) -> Vec<Answer<f32>> {
    let mut answers = Vec::new();
    service.answer(request, 1, |answer| answers.push(answer));
    answers
}

fn refused(refusal: Refusal) -> Vec<Answer<f32>> {
    vec![Answer::Refused(refusal)]
}

/// One eastward, one northward 3 s later, one beside the first in the opposite direction.
fn planned() -> Supervisor {
    let mut service = Supervisor::with(Table::new(), &[]);
    for agent in [agent(0.0, 0.0, 0.0), agent(FRAC_PI_2, 0.0, 3.0), agent(FRAC_PI_2 * 2.0, 1.0, 9.0)] {
        assert!(matches!(answers(&mut service, Request::Add(agent))[..], [Answer::Fleet { .. }]));
    }
    assert_eq!(answers(&mut service, Request::Order(TERMS)), refused(Refusal::NotComputed));
    assert!(matches!(answers(&mut service, Request::Compute)[..], [Answer::Computed { .. }]));
    service
}

fn running() -> Supervisor {
    let mut service = planned();
    assert_eq!(answers(&mut service, Request::Order(TERMS)), [Answer::Edition(FIRST)]);
    service
}

fn report(service: &mut Supervisor, agent: u16, edition: Edition, at: f32) -> Vec<Answer<f32>> {
    answers(service, Request::Report { agent, edition, at: Interval::new(at, at) })
}

#[test]
fn robots_get_their_orders_and_go_by_them() {
    let mut service = running();
    let told = answers(&mut service, Request::Orders { agent: 1 });
    let members: Vec<_> = told
        .iter()
        .filter_map(|answer| if let Answer::Member { agent, .. } = answer { Some(*agent) } else { None })
        .collect();
    assert_eq!(members, [0, 1, 2]);
    let passes: Vec<_> = told
        .iter()
        .filter_map(
            |answer| if let Answer::Passing { other, pass, .. } = answer { Some((*other, *pass)) } else { None },
        )
        .collect();
    assert_eq!(passes, [(0, PassingState::Second), (2, PassingState::First)]);
    assert_eq!(told.last(), Some(&Answer::Orders { agent: 1, edition: FIRST, path: 1, at: Interval::new(0.0, 0.0) }));

    let mut briefing = Briefing::<f32, 3, 4, 4>::new();
    briefing.begin(1);
    told.iter().for_each(|answer| briefing.take(answer).expect("room"));
    let mut fleet = FleetMotions::new();
    fleet.fill(briefing.paths());
    let mut robot = Robot::<f32, 3, 4, 8>::new();
    assert_eq!(robot.hold(&fleet), 0.0, "no orders yet");
    assert_eq!(robot.brief(&briefing, &fleet, 0.0), Ok(true));
    assert_eq!(robot.hold(&fleet), 0.0, "not sent anywhere yet");
    for answer in report(&mut service, 1, FIRST, 0.0) {
        robot.hear(&briefing, &answer);
    }
    assert!((robot.hold(&fleet) - 1.5).abs() < 1e-4, "{}", robot.hold(&fleet));
    // The first is sent on as it goes, and what it has passed lets the second go on as far as it was sent.
    for at in [0.0, 2.0, 2.75] {
        assert_eq!(
            report(&mut service, 0, FIRST, at),
            [Answer::Go { agent: 0, edition: FIRST, to: f32::min(at + 2.0, 4.0) }]
        );
    }
    let heard = report(&mut service, 1, FIRST, 1.0);
    assert_eq!(heard[0], Answer::Place { agent: 0, edition: FIRST, at: 2.75 });
    heard.iter().for_each(|answer| robot.hear(&briefing, answer));
    assert_eq!(robot.hold(&fleet), 3.0);
    // Late, repeated, of other orders, for another robot.
    let other = Edition { number: 2, ..FIRST };
    for late in [
        Answer::Go { agent: 1, edition: FIRST, to: 2.0 },
        Answer::Go { agent: 1, edition: other, to: 4.0 },
        Answer::Go { agent: 0, edition: FIRST, to: 4.0 },
        Answer::Place { agent: 0, edition: FIRST, at: 0.0 },
    ] {
        robot.hear(&briefing, &late);
        assert_eq!(robot.hold(&fleet), 3.0, "{late:?}");
    }
}

/// What a controller knows that was switched on just now.
fn fresh(service: &mut Supervisor, agent: u16) -> (Robot<f32, 3, 4, 8>, Briefing<f32, 3, 4, 4>) {
    let mut briefing = Briefing::new();
    briefing.begin(agent);
    for answer in answers(service, Request::Orders { agent }) {
        briefing.take(&answer).expect("room");
    }
    (Robot::new(), briefing)
}

#[test]
fn a_robot_that_was_restarted_on_the_way_does_not_begin_again() {
    let mut service = running();
    for at in [0.0, 2.0, 2.5] {
        report(&mut service, 0, FIRST, at);
    }
    let (mut robot, briefing) = fresh(&mut service, 0);
    let mut fleet = FleetMotions::new();
    fleet.fill(briefing.paths());
    for at in [0.0, 2.5] {
        assert_eq!(robot.brief(&briefing, &fleet, at), Err(Unclear::Begun), "it does not know where it is");
        robot.hear(&briefing, &Answer::Go { agent: 0, edition: FIRST, to: 4.0 });
        assert_eq!(robot.hold(&fleet), 0.0, "it stays");
    }
    // Who takes itself to be behind what it has reported is not sent anywhere.
    assert_eq!(report(&mut service, 0, FIRST, 0.0), refused(Refusal::Behind { agent: 0 }));
    let [lo, hi] = [2.0, 2.75];
    let range = Request::Report { agent: 0, edition: FIRST, at: Interval::new(lo, hi) };
    assert_eq!(answers(&mut service, range), [Answer::Go { agent: 0, edition: FIRST, to: 4.0 }], "it may be at 2.5 m");
    robot.resume(&briefing).expect("a path");
    assert_eq!(robot.brief(&briefing, &fleet, 2.5), Ok(false));
    assert_eq!(robot.hold(&fleet), 2.5, "it stays where it is");
    for answer in report(&mut service, 0, FIRST, 2.5) {
        robot.hear(&briefing, &answer);
    }
    assert_eq!(robot.hold(&fleet), 4.0);
    assert_eq!(Robot::<f32, 3, 4, 8>::new().resume(&Briefing::<f32, 3, 4, 4>::new()), Err(Unclear::Disagreement));

    // Sent, and not heard of since then: it may have set off.
    report(&mut service, 2, FIRST, 0.0);
    let (mut robot, briefing) = fresh(&mut service, 2);
    let mut fleet = FleetMotions::new();
    fleet.fill(briefing.paths());
    assert_eq!(robot.brief(&briefing, &fleet, 0.0), Err(Unclear::Begun));
    // Never sent anywhere: it stands at the start.
    let (mut robot, briefing) = fresh(&mut service, 1);
    let mut fleet = FleetMotions::new();
    fleet.fill(briefing.paths());
    assert_eq!((robot.brief(&briefing, &fleet, 3.0), robot.hold(&fleet)), (Ok(true), 0.0));
}

#[test]
fn a_report_may_be_behind_by_the_width_and_no_further() {
    let mut service = planned();
    let terms = Terms { width: 0.25, ..TERMS };
    assert_eq!(answers(&mut service, Request::Order(terms)), [Answer::Edition(FIRST)]);
    report(&mut service, 0, FIRST, 0.0);
    report(&mut service, 0, FIRST, 1.0);
    assert_eq!(report(&mut service, 0, FIRST, 0.75), [Answer::Go { agent: 0, edition: FIRST, to: 3.0 }]);
    assert_eq!(report(&mut service, 0, FIRST, 0.5), refused(Refusal::Behind { agent: 0 }));
}

#[test]
fn a_robot_speaks_for_itself_only() {
    let mut session = Session::of(running());
    let mut say = |who, request: &Request<f32>| {
        let frame = frame::encode(Tag { who, sequence: 1, place: Tag::REQUEST }, request).expect("a short request");
        let mut receiver = Receiver::new(Reads::Answers);
        let mut said = Vec::new();
        frame.iter().for_each(|&byte| session.take(byte, &mut |frame: &[u8]| said.extend_from_slice(frame)));
        let heard = said.into_iter().filter_map(|byte| receiver.take::<Answer<f32>>(byte));
        heard.map(|frame| frame.expect("a whole frame").message).collect::<Vec<_>>()
    };
    let report = Request::Report { agent: 0, edition: FIRST, at: Interval::new(0.0, 0.0) };
    assert_eq!(say(2, &report), refused(Refusal::Robot), "robot 1 says where robot 0 is");
    assert_eq!(say(2, &Request::Orders { agent: 0 }), refused(Refusal::Robot));
    assert_eq!(say(1, &report), [Answer::Go { agent: 0, edition: FIRST, to: 2.0 }]);
    assert!(matches!(say(2, &Request::Hello)[..], [Answer::Hello { .. }]));
}

#[test]
fn an_exchanged_agent_needs_no_room_for_orders_that_it_has_not() {
    let mut service = Service::<f32, 2, 3, 1, 12, Traffic<f32, 2, 1, 12, 1>>::with(Traffic::new(), &[]);
    let mut ask = |request| {
        let mut last = None;
        service.answer(request, 1, |answer| last = Some(answer));
        last.expect("an answer")
    };
    ask(Request::Add(agent(0.0, 0.0, 0.0)));
    ask(Request::Add(agent(FRAC_PI_2, 0.0, 3.0)));
    assert!(matches!(ask(Request::Compute), Answer::Computed { regions: 1, .. }));
    assert_eq!(ask(Request::Replace { agent: 0, with: agent(0.0, 0.1, 0.0) }), Answer::Fleet { agents: 2 });
    assert_eq!(ask(Request::Row { ego: 1 }), Answer::End { count: 1 });
}

#[test]
fn what_a_robot_was_not_told_of_is_no_order() {
    let mut service = running();
    let told = answers(&mut service, Request::Orders { agent: 1 });
    let fleet_of = |told: &[Answer<f32>]| {
        let mut briefing = Briefing::<f32, 3, 4, 4>::new();
        briefing.begin(1);
        told.iter().for_each(|answer| briefing.take(answer).expect("room"));
        briefing
    };
    let brief = |told: &[Answer<f32>]| {
        let briefing = fleet_of(told);
        let mut fleet = FleetMotions::new();
        fleet.fill(briefing.paths());
        let mut robot = Robot::<f32, 3, 4, 8>::new();
        let briefed = robot.brief(&briefing, &fleet, 0.0).is_ok();
        robot.hear(&briefing, &Answer::Go { agent: 1, edition: FIRST, to: 4.0 });
        (briefed, robot.hold(&fleet) > 0.0)
    };
    assert_eq!(brief(&told), (true, true));
    for missing in 0..told.len() {
        let mut less = told.clone();
        less.remove(missing);
        assert_eq!(brief(&less), (false, false), "without {:?}", told[missing]);
    }
    let mut twice = told.clone();
    twice.insert(3, told[3].clone());
    assert_eq!(brief(&twice), (false, false));
    // Orders that have changed while they were sent.
    let mut mixed = Briefing::<f32, 3, 4, 4>::new();
    mixed.begin(1);
    for (place, answer) in told.iter().enumerate() {
        let mut answer = answer.clone();
        if let (4, Answer::Passing { edition, .. }) = (place, &mut answer) {
            edition.number += 1;
        }
        assert_eq!(mixed.take(&answer).is_err(), place == 4, "{answer:?}");
    }
    let mut small = Briefing::<f32, 2, 4, 1>::new();
    small.begin(1);
    assert!(told.iter().any(|answer| small.take(answer).is_err()), "what does not fit is told");
}

#[test]
fn rights_are_given_once_and_the_fleet_stays_while_robots_go() {
    let mut service = planned();
    let bad = [Terms { run: 0, ..TERMS }, Terms { horizon: 0.0, ..TERMS }, Terms { width: f32::NAN, ..TERMS }];
    for terms in bad {
        assert_eq!(answers(&mut service, Request::Order(terms)), refused(Refusal::Terms));
    }
    assert_eq!(report(&mut service, 0, FIRST, 0.0), refused(Refusal::NotRunning));
    assert_eq!(answers(&mut service, Request::Orders { agent: 0 }), refused(Refusal::NotRunning));
    let mut service = running();
    for change in [
        Request::Order(Terms { run: 8, ..TERMS }),
        Request::Add(agent(0.0, 0.0, 0.0)),
        Request::Load,
        Request::Replan { agent: 0 },
        Request::Remove { agent: 0 },
        Request::Replace { agent: 0, with: agent(0.0, 0.0, 0.0) },
    ] {
        assert_eq!(answers(&mut service, change.clone()), refused(Refusal::Running), "{change:?}");
    }
    assert!(matches!(answers(&mut service, Request::Compute)[..], [Answer::Computed { .. }]));
    assert_eq!(report(&mut service, 3, FIRST, 0.0), refused(Refusal::NoSuchAgent { agent: 3 }));
    let old = Edition { run: 6, number: 1 };
    assert_eq!(report(&mut service, 0, old, 0.0), refused(Refusal::Edition(FIRST)));
    for at in [-1.0, f32::NAN, 0.5] {
        assert_eq!(report(&mut service, 0, FIRST, at), refused(Refusal::Beyond { agent: 0 }), "{at}: not sent there");
    }
    assert_eq!(answers(&mut service, Request::Clear), [Answer::Done]);
    assert_eq!(report(&mut service, 0, FIRST, 0.0), refused(Refusal::NotRunning));
    for agent in [agent(0.0, 0.0, 0.0), agent(FRAC_PI_2, 0.0, 3.0)] {
        answers(&mut service, Request::Add(agent));
    }
    answers(&mut service, Request::Compute);
    for (run, why) in [(TERMS.run, "the number of the last run"), (0, "no number")] {
        assert_eq!(answers(&mut service, Request::Order(Terms { run, ..TERMS })), refused(Refusal::Terms), "{why}");
    }
    assert!(matches!(answers(&mut service, Request::Order(Terms { run: 8, ..TERMS }))[..], [Answer::Edition(_)]));
    let mut meeting = Supervisor::with(Table::new(), &[]);
    for agent in [agent(0.0, 0.0, 0.0), agent(FRAC_PI_2, 0.0, 0.0)] {
        answers(&mut meeting, Request::Add(agent));
    }
    answers(&mut meeting, Request::Compute);
    assert_eq!(answers(&mut meeting, Request::Order(TERMS)), refused(Refusal::Meeting([0, 1])));
    assert_eq!(report(&mut meeting, 0, FIRST, 0.0), refused(Refusal::NotRunning));
}

#[test]
fn a_new_path_begins_where_the_old_one_ends_and_yields_to_whoever_may_be_on_the_way() {
    let mut service = running();
    let admit = |heading| Request::Admit {
        agent: 0,
        heading: Radians(heading),
        limits: Limits { speed: 1.0, acceleration: 1.0 },
        path: STEPS.into_iter().collect(),
    };
    assert_eq!(answers(&mut service, admit(0.0)), refused(Refusal::NotThere { agent: 0 }));
    for at in [0.0, 2.0, 4.0] {
        report(&mut service, 0, FIRST, at);
    }
    let second = Edition { number: 2, ..FIRST };
    assert_eq!(answers(&mut service, admit(0.0)), [Answer::Edition(second)]);
    assert_eq!(report(&mut service, 1, FIRST, 0.0), refused(Refusal::Edition(second)));
    let told = answers(&mut service, Request::Orders { agent: 0 });
    let [Answer::Member { with: own, .. }, Answer::Orders { edition, path: 2, .. }] = &told[..] else {
        panic!("{told:?}")
    };
    assert!(own.start.position == Point::new(2.0, 0.0) && *edition == second);
    assert_eq!(report(&mut service, 0, second, 0.5), refused(Refusal::Beyond { agent: 0 }), "not sent anywhere");
    // Back over the crossing: the other one was sent 2 m far, into the crossing, and keeps its right.
    for at in [0.0, 2.0, 4.0] {
        report(&mut service, 0, second, at);
    }
    report(&mut service, 1, second, 0.0);
    let Agent { path, .. } = agent(0.0, 0.0, 0.0);
    let back = Request::Admit {
        agent: 0,
        heading: Radians(FRAC_PI_2 * 2.0),
        limits: Limits { speed: 1.0, acceleration: 1.0 },
        path: path.iter().chain(&path).copied().collect(),
    };
    assert_eq!(answers(&mut service, back), [Answer::Edition(Edition { number: 3, ..FIRST })]);
    let told = answers(&mut service, Request::Orders { agent: 0 });
    let passing =
        |answer: &&Answer<f32>| matches!(answer, Answer::Passing { other: 1, pass: PassingState::Second, .. });
    assert_eq!(told.iter().filter(passing).count(), 1, "{told:?}");
}

#[test]
fn a_list_that_has_become_shorter_while_it_was_sent_is_asked_for_anew() {
    let mut client = Client::robot(1);
    assert!(client.ask(&Request::<f32>::Orders { agent: 1 }));
    let mut hear = |place, answer: &Answer<f32>| {
        let frame = frame::encode(Tag { who: 2, sequence: 1, place }, answer).expect("a short answer");
        frame.iter().filter_map(|&byte| client.take::<f32>(byte)).collect::<Vec<_>>()
    };
    let passing = Answer::Passing { other: 0, edition: FIRST, pass: PassingState::First, from: 1.0 };
    let end =
        Answer::Orders { agent: 1, edition: Edition { number: 2, ..FIRST }, path: 1, at: Interval::new(0.0, 0.0) };
    for place in 0..3 {
        assert_eq!(hear(place, &passing), [Event::Answer(passing.clone())]);
    }
    // Of the same question, asked again, but for a region less.
    assert_eq!(hear(0, &passing), []);
    assert_eq!(hear(1, &end), [Event::Changed]);
    assert_eq!(hear(3, &end), [], "nothing is waited for");
}

/// On a line that loses a quarter of all frames, an answer of five in one piece came once in a thousand reports.
#[test]
fn how_far_to_go_is_heard_whatever_else_is_lost() {
    let mut client = Client::robot(1);
    let at = Interval::new(0.0, 0.0);
    assert!(client.ask(&Request::<f32>::Report { agent: 1, edition: FIRST, at }));
    let mut hear = |place, answer: &Answer<f32>| {
        let frame = frame::encode(Tag { who: 2, sequence: 1, place }, answer).expect("a short answer");
        frame.iter().filter_map(|&byte| client.take::<f32>(byte)).collect::<Vec<_>>()
    };
    let place = Answer::Place { agent: 0, edition: FIRST, at: 2.0 };
    let go = Answer::Go { agent: 1, edition: FIRST, to: 1.0 };
    assert_eq!(hear(3, &place), [Event::Answer(place.clone())], "the ones before are lost");
    assert_eq!(hear(5, &go), [Event::Last(go.clone())]);
    assert_eq!(hear(5, &go), [], "nothing is waited for");
}
