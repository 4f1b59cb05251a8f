//! Robots keep their orders on a bus that loses frames, repeats them and lets them overtake one another.

use pcr_core::{Curve, FleetMotions, Limits, Point, Pose, Radians};
use pcr_supervisor::can::{CanError, Frame, Length, MESSAGES, Message, pack, unpack};
use pcr_supervisor::message::{Edition, Refusal, Terms};
use pcr_supervisor::{Agent, Answer, Briefing, Number, Request, Robot, Service, Step, Traffic};
use std::f32::consts::TAU;

const ROBOTS: usize = 4;
type Supervisor = Service<f32, ROBOTS, 8, 16, 16, Traffic<f32, ROBOTS, 16, 16, 24>>;

/// Each crosses the paths of all others in the middle of its own.
fn agents() -> [Agent<f32>; ROBOTS] {
    core::array::from_fn(|k| {
        let heading = TAU * k as f32 / 8.0;
        let (sin, cos) = heading.sin_cos();
        let start = Pose { position: Point::new(-3.0 * cos, -3.0 * sin), heading: Radians(heading) };
        let path = [Step { curve: Curve::Line, length: 2.0 }, Step { curve: Curve::Line, length: 4.0 }];
        let limits = Limits { speed: 1.0, acceleration: 1.0 };
        Agent { radius: 0.25, start_time: 2.0 * k as f32, limits, start, path: path.into_iter().collect() }
    })
}

fn answers(service: &mut Supervisor, request: Request<f32>) -> Vec<Answer<f32>> {
    let mut answers = Vec::new();
    service.answer(request, 1, |answer| answers.push(answer));
    answers
}

/// Frames under way.
struct Bus {
    random: u32,
    under_way: Vec<Vec<Frame>>,
}

impl Bus {
    fn below(&mut self, count: u32) -> u32 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 17;
        self.random ^= self.random << 5;
        self.random % count
    }

    /// A third of the frames are lost, some are sent twice.
    fn send(&mut self, frames: &[Frame]) {
        for _ in 0..[0, 1, 1, 1, 2, 0][self.below(6) as usize] {
            self.under_way.push(frames.to_vec());
        }
    }

    /// Some of the frames under way, in any order; others wait.
    fn receive(&mut self) -> Vec<Frame> {
        let mut received = Vec::new();
        for _ in 0..self.under_way.len() {
            if self.below(3) > 0 {
                let at = self.below(self.under_way.len() as u32) as usize;
                received.extend(self.under_way.swap_remove(at));
            }
        }
        received
    }
}

/// Sends messages as frames of CAN, or packed into frames of CAN FD.
fn put(bus: &mut Bus, messages: &[Message<f32>], packed: bool) {
    let frames: Vec<_> = messages.iter().map(Message::encode).collect();
    for frames in frames.chunks(if packed { MESSAGES } else { 1 }) {
        if packed {
            let data = pack(frames).expect("at most six");
            assert_eq!(unpack(&data).as_deref(), Ok(frames));
        }
        bus.send(frames);
    }
}

/// Lets all drive to the ends of their paths. How often they moved.
fn drive(seed: u32, packed: bool) -> usize {
    let mut service = Supervisor::with(Traffic::new(), &[]);
    for agent in agents() {
        assert!(matches!(answers(&mut service, Request::Add(agent))[..], [Answer::Fleet { .. }]));
    }
    assert!(matches!(answers(&mut service, Request::Compute)[..], [Answer::Computed { .. }]));
    let terms = Terms { run: 3, horizon: 1.5, width: 0.0 };
    let [Answer::Edition(edition)] = answers(&mut service, Request::Order(terms))[..] else { panic!("orders") };
    let briefings: Vec<_> = (0..ROBOTS as u16)
        .map(|agent| {
            let mut briefing = Briefing::<f32, ROBOTS, 8, 16>::new();
            briefing.begin(agent);
            let told = answers(&mut service, Request::Orders { agent });
            told.iter().for_each(|answer| briefing.take(answer).expect("room"));
            briefing
        })
        .collect();
    let fleets: Vec<_> = briefings
        .iter()
        .map(|briefing| {
            let mut fleet = FleetMotions::new();
            fleet.fill(briefing.paths());
            fleet
        })
        .collect();
    let mut robots: [Robot<f32, ROBOTS, 16, 16>; ROBOTS] = core::array::from_fn(|_| Robot::new());
    for ((robot, briefing), fleet) in robots.iter_mut().zip(&briefings).zip(&fleets) {
        assert_eq!(robot.brief(briefing, fleet, 0.0), Ok(true));
    }
    let mut bus = Bus { random: seed, under_way: Vec::new() };
    let mut at = [0.0_f32; ROBOTS];
    for turn in 0..5000 {
        if at.iter().all(|&at| at >= 6.0) {
            return turn;
        }
        for (agent, &length) in (0..).zip(&at) {
            put(&mut bus, &[Message::Report(Length { agent, edition, length })], packed);
        }
        for frame in bus.receive() {
            let message = Message::<f32>::decode(&frame).expect("a message");
            if let Some(request @ Request::Report { agent, .. }) = message.as_request() {
                let told = answers(&mut service, request);
                let told = told
                    .iter()
                    .map(|answer| Message::of_answer(agent, answer).expect("few robots").expect("its report"));
                put(&mut bus, &told.collect::<Vec<_>>(), packed);
            } else if let Some(answer) = message.as_answer() {
                for (robot, briefing) in robots.iter_mut().zip(&briefings) {
                    robot.hear(briefing, &answer);
                }
            }
        }
        for ((robot, fleet), at) in robots.iter_mut().zip(&fleets).zip(&mut at) {
            *at = robot.hold(fleet).min(*at + 0.1).max(*at);
        }
        let places: Vec<_> = agents()
            .iter()
            .zip(at)
            .map(|(agent, at)| {
                let (sin, cos) = agent.start.heading.0.sin_cos();
                [agent.start.position.x + at * cos, agent.start.position.y + at * sin]
            })
            .collect();
        for (k, [x, y]) in places.iter().enumerate() {
            for [u, v] in &places[..k] {
                assert!((x - u).hypot(y - v) > 0.4999, "seed {seed}, turn {turn}: {at:?}");
            }
        }
    }
    panic!("seed {seed}: they stand at {at:?}")
}

#[test]
fn robots_meet_nobody_on_a_bad_bus_and_arrive() {
    for seed in 1..40 {
        for packed in [false, true] {
            // Alone, a robot would take 60 turns.
            assert!(drive(seed, packed) >= 60);
        }
    }
}

fn comes_back<S: Number>(lengths: &[u32]) {
    let edition = Edition { run: 0x1234, number: 0xFEDC };
    let mut ids = Vec::new();
    for &bits in lengths {
        let length = Length { agent: 200, edition, length: S::of_bits(bits) };
        let messages = [Message::Go(length), Message::Place(length), Message::Report(length)];
        let others = [Message::Edition { agent: 255, edition }, Message::Refused { agent: 0, why: 12 }];
        for message in messages.into_iter().chain(others) {
            let frame = message.encode();
            assert!(frame.id < 1 << 11);
            assert_eq!(Message::<S>::decode(&frame), Ok(message), "{bits:x} in {}", S::NAME);
            ids.push(frame.id >> 8);
        }
    }
    // Authority is sent first where several frames wait.
    assert_eq!(ids[..5], [0, 1, 4, 2, 3]);
}

#[test]
fn messages_come_back_as_they_were() {
    let floats = [0.0, 1.5, 1e-3, 8191.5].map(f32::to_bits);
    comes_back::<f32>(&floats);
    comes_back::<pcr_core::scalar::Micro>(&floats);
    comes_back::<pcr_fixed::Q16>(&[0, 1, 65_536, 0x0123_4567]);
    let [Frame { data, id }] =
        [Message::Go(Length { agent: 7, edition: Edition { run: 1, number: 2 }, length: 1.0_f32 })]
            .map(|message| message.encode());
    assert_eq!((id, data), (7, [1, 0, 2, 0, 0, 0, 0x80, 0x3F]), "the bytes of the document");
}

#[test]
fn what_is_no_message_is_an_error() {
    for bits in [f32::NAN, f32::INFINITY, -1.0, f32::MAX].map(f32::to_bits) {
        let [a, b, c, d] = bits.to_le_bytes();
        for kind in [0, 1, 4] {
            let frame = Frame { id: kind << 8, data: [0, 0, 0, 0, a, b, c, d] };
            assert_eq!(Message::<f32>::decode(&frame), Err(CanError::Length), "{bits:x}");
        }
    }
    assert_eq!(Message::<f32>::decode(&Frame { id: 5 << 8, data: [0; 8] }), Err(CanError::Identifier(5 << 8)));
    assert_eq!(Message::<f32>::decode(&Frame { id: 0xFFFF, data: [0; 8] }), Err(CanError::Identifier(0xFFFF)));
    let go = |agent| Answer::<f32>::Go { agent, edition: Edition::default(), to: 1.0 };
    assert_eq!(Message::of_answer(0, &go(256)), Err(CanError::Agent(256)));
    assert_eq!(Message::of_answer(300, &Answer::<f32>::Refused(Refusal::NotRunning)), Err(CanError::Agent(300)));
    assert_eq!(Message::of_answer(0, &Answer::<f32>::Done), Ok(None));
    // The number of the list in firmware/README.md.
    let refused = Message::of_answer(3, &Answer::<f32>::Refused(Refusal::Beyond { agent: 3 }));
    assert_eq!(refused, Ok(Some(Message::Refused { agent: 3, why: 12 })));
    let other = Edition { run: 2, number: 9 };
    let edition = Message::of_answer(3, &Answer::<f32>::Refused(Refusal::Edition(other)));
    assert_eq!(edition, Ok(Some(Message::Edition { agent: 3, edition: other })));
}

#[test]
fn frames_of_can_fd_hold_whole_messages() {
    let frames: Vec<_> = (0..7).map(|k| Frame { id: k, data: [k as u8; 8] }).collect();
    for count in 1..=MESSAGES {
        let data = pack(&frames[..count]).expect("room");
        assert!([12, 20, 24, 32, 48, 64].contains(&data.len()));
        assert_eq!(unpack(&data).as_deref(), Ok(&frames[..count]));
        // One byte less than the messages have.
        assert!(unpack(&data[..10 * count - 1]).is_err());
    }
    assert_eq!(pack(&frames), Err(CanError::Size(70)));
    assert_eq!(unpack(&[0; 70]), Err(CanError::Size(70)));
    assert_eq!(unpack(&[]).as_deref(), Ok(&[][..]));
}
