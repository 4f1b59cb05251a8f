//! What goes over the line: every kind of message comes back as it was, and so many bytes does a region take.

use pcr_core::{Curve, Interval, Limits, PassingState, Point, Pose, TurnSide};
use pcr_supervisor::agent::MAX_STEPS;
use pcr_supervisor::frame::{self, Damage, Frame, Reads, Receiver, Tag};
use pcr_supervisor::message::{ConflictRecord, Edition, PieceRecord, Reason, Refusal, RegionRecord, Room, Terms, text};
use pcr_supervisor::{Agent, Answer, Number, Request, Step};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;

const TAG: Tag = Tag { who: 3, sequence: 900, place: 9 };

fn there_and_back<T: Serialize + DeserializeOwned + PartialEq + Debug>(message: T) -> usize {
    let bytes = frame::encode(TAG, &message).expect("a message fits a frame");
    let mut receiver = Receiver::new(Reads::Answers);
    let (last, before) = bytes.split_last().expect("not empty");
    assert!(before.iter().all(|&byte| receiver.take::<T>(byte).is_none()));
    assert!(bytes[1..bytes.len() - 1].iter().all(|&byte| byte != 0));
    let Some(Ok(Frame { tag, message: seen, .. })) = receiver.take::<T>(*last) else { panic!("a frame") };
    assert_eq!((tag, seen), (TAG, message));
    bytes.len()
}

fn region<S: Number>(number: impl Fn(f64) -> S) -> RegionRecord<S> {
    let range = |lo, hi| Interval::new(number(lo), number(hi));
    RegionRecord {
        ego: 3,
        other: 11,
        time: range(12.25, 17.5),
        length: range(4.125, 5.0625),
        other_length: range(0.75, 2.375),
        open_at_start: false,
        open_at_end: true,
        pieces: 2,
    }
}

fn piece<S: Number>(number: impl Fn(f64) -> S) -> PieceRecord<S> {
    let range = |lo, hi| Interval::new(number(lo), number(hi));
    PieceRecord { segments: [1, 2], length: range(4.125, 5.0625), other_length: range(0.75, 2.375) }
}

/// The bytes that firmware/README.md tells: header, check and delimiters included.
#[test]
fn a_region_takes_so_many_bytes_on_the_wire() {
    let float = |value: f64| value as f32;
    assert_eq!(there_and_back(Answer::Region(region(float))), 44);
    assert_eq!(there_and_back(Answer::Piece(piece(float))), 33);
    let fixed = |value: f64| pcr_fixed::Q16::from_f64(value).expect("in range");
    assert_eq!(there_and_back(Answer::Region(region(fixed))), 39);
    assert_eq!(there_and_back(Answer::Piece(piece(fixed))), 29);
}

#[test]
fn every_message_comes_back_as_it_was() {
    let agent = Agent {
        radius: 0.11_f32,
        start_time: 1.5,
        limits: Limits { speed: 0.58, acceleration: 0.3 },
        start: Pose { position: Point::new(5.9, -6.5), heading: pcr_core::Radians(-2.97) },
        path: (0..8)
            .map(|k| Step { curve: Curve::Arc { radius: 0.5, turn: TurnSide::Right }, length: 1.0 + k as f32 })
            .collect(),
    };
    there_and_back(Request::Add(agent.clone()));
    there_and_back(Request::Replace { agent: 65535, with: agent });
    there_and_back(Request::<f32>::Remove { agent: 65535 });
    largest_agent();
    for request in [Request::<f32>::Hello, Request::Clear, Request::Load, Request::Compute, Request::Conflicts] {
        there_and_back(request);
    }
    there_and_back(Request::<f32>::Row { ego: 65535 });
    there_and_back(Request::<f32>::Replan { agent: 3 });
    let edition = Edition { run: 65535, number: 65535 };
    there_and_back(Request::Order(Terms { run: 65535, horizon: 2.5_f32, width: 0.0 }));
    there_and_back(Request::<f32>::Orders { agent: 65535 });
    there_and_back(Request::Report { agent: 65535, edition, at: Interval::new(0.5_f32, 1.5) });
    for answer in [
        Answer::Edition(edition),
        Answer::Place { agent: 65535, edition, at: 2.5_f32 },
        Answer::Go { agent: 65535, edition, to: 2.5 },
        Answer::Passing { other: 65535, edition, pass: PassingState::Second, from: 2.5 },
        Answer::Orders { agent: 65535, edition, path: 65535, at: Interval::new(0.5, 1.5) },
    ] {
        there_and_back(answer);
    }
    let range = Interval::new(0.0, 1.0);
    there_and_back(Answer::Replanned { agent: 3, time: Interval::new(2.5_f32, 20.25) });
    let conflict =
        ConflictRecord { agents: [0, 1], time: range, lengths: [range; 2], depth: 0.25_f32, touching: false };
    there_and_back(Answer::Conflict(conflict));
    there_and_back(Answer::<f32>::Hello {
        format: text("f32"),
        agents: 12,
        segments: 36,
        regions: 80,
        pieces: 112,
        next: 65535,
    });
    there_and_back(Answer::<f32>::Fleet { agents: 65535 });
    for refusal in [
        Refusal::Frame(Damage::Version(2)),
        Refusal::Sequence { next: 65535 },
        Refusal::Agent { agent: 65535, what: text("duration of the profile"), why: Reason::OutOfRange },
        Refusal::TableFull(Room::Pair([65535; 2])),
        Refusal::NoSuchAgent { agent: 65535 },
        Refusal::NotComputed,
        Refusal::NoPlan,
        Refusal::NoOrders,
        Refusal::Running,
        Refusal::NotRunning,
        Refusal::Terms,
        Refusal::Edition(edition),
        Refusal::Beyond { agent: 65535 },
        Refusal::NotThere { agent: 65535 },
        Refusal::Meeting([65535; 2]),
        Refusal::Stuck([65535; 2]),
        Refusal::Blocked([65535; 2]),
        Refusal::Robot,
        Refusal::Needs { regions: 65535, pieces: 65535 },
        Refusal::Behind { agent: 65535 },
    ] {
        there_and_back(Answer::<f32>::Refused(refusal));
    }
}

/// The request that takes most bytes: every number of fixed point its five.
fn largest_agent() {
    let most = pcr_fixed::Q16::from_bits(i32::MIN);
    let step = Step { curve: Curve::Arc { radius: most, turn: TurnSide::Right }, length: most };
    let agent: Agent<pcr_fixed::Q16> = Agent {
        radius: most,
        start_time: most,
        limits: Limits { speed: most, acceleration: most },
        start: Pose { position: Point::new(most, most), heading: pcr_fixed::Turns::from_bits(-(1 << 30)) },
        path: [step; MAX_STEPS].into_iter().collect(),
    };
    there_and_back(Answer::Member {
        agent: 65535,
        edition: Edition { run: 65535, number: 65535 },
        with: agent.clone(),
    });
    let (heading, limits, path) = (agent.start.heading, agent.limits, agent.path.clone());
    there_and_back(Request::Admit { agent: 65535, heading, limits, path });
    there_and_back(Request::Replace { agent: 65535, with: agent });
    let range = Interval::new(most, most);
    let record = RegionRecord {
        ego: 65535,
        other: 65535,
        time: range,
        length: range,
        other_length: range,
        open_at_start: true,
        open_at_end: true,
        pieces: 65535,
    };
    there_and_back(Answer::Region(record));
    let conflict = ConflictRecord { agents: [65535; 2], time: range, lengths: [range; 2], depth: most, touching: true };
    there_and_back(Answer::Conflict(conflict));
}

#[test]
fn no_damage_of_one_byte_goes_unnoticed() {
    let message = Answer::Region(region(|value: f64| value as f32));
    let frame = frame::encode(TAG, &message).expect("a message fits a frame");
    // Of the two zeros around it, each may be lost.
    for at in 1..frame.len() - 1 {
        for bit in 0..8 {
            let mut damaged = frame.clone();
            damaged[at] ^= 1 << bit;
            let mut receiver = Receiver::new(Reads::Answers);
            for &byte in &damaged {
                if let Some(seen) = receiver.take::<Answer<f32>>(byte) {
                    assert!(seen.is_err(), "byte {at}, bit {bit}");
                }
            }
        }
    }
}
