//! A line that loses, repeats, cuts, damages and reorders frames, between two ends one of which may start anew: whatever
//! comes out at the end is what a perfect line would have brought, or that the other end has started anew.

use pcr_core::{Curve, Limits, Point, Pose, Radians};
use pcr_supervisor::frame::Reads;
use pcr_supervisor::message::Refusal;
use pcr_supervisor::{Agent, Answer, Client, Event, Request, Service, Session, Step};
use std::collections::VecDeque;

type Supervisor = Session<f32, 5, 16, 16, 24>;
type Model = Service<f32, 5, 16, 16, 24>;

const STEPS: [Step<f32>; 1] = [Step { curve: Curve::Line, length: 4.0 }];
const LIMITS: Limits<f32> = Limits { speed: 1.0, acceleration: 1.0 };
static BUILT_IN: [Agent<f32, &[Step<f32>]>; 1] = [Agent {
    radius: 0.25,
    start_time: 1.0,
    limits: LIMITS,
    start: Pose { position: Point::new(-2.0, 0.25), heading: Radians(0.0) },
    path: &STEPS,
}];

/// Weyl sequence with the finalizer of SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }
}

/// One direction of the line.
#[derive(Default)]
struct Way {
    arriving: VecDeque<Vec<u8>>,
    /// Frames that come late: behind so many others.
    late: Vec<(usize, Vec<u8>)>,
}

const KINDS: usize = 7;
/// Most frames by which one may be late.
const LATEST: usize = 30;

impl Way {
    /// Sends a frame; `bad` of 1000 suffer each kind of fault.
    fn send(&mut self, random: &mut Random, bad: usize, frame: &[u8], faults: &mut [usize; KINDS]) {
        let mut copies = vec![frame.to_vec()];
        for (kind, count) in faults.iter_mut().enumerate() {
            if random.below(1000) >= bad || copies.first().is_none_or(Vec::is_empty) {
                continue;
            }
            *count += 1;
            let place = random.below(copies[0].len());
            match kind {
                0 => copies.clear(),
                1 => copies.push(frame.to_vec()),
                2 => copies[0].truncate(place),
                3 => drop(copies[0].drain(..place)),
                // The zeros around it are lost.
                4 => copies[0].retain(|&byte| byte != 0),
                5 => copies[0][place] ^= 1 << random.below(8),
                _ => self.late.extend(copies.pop().map(|frame| (1 + random.below(LATEST), frame))),
            }
        }
        self.arriving.extend(copies);
        for (behind, _) in &mut self.late {
            *behind -= 1;
        }
        let (due, late) = std::mem::take(&mut self.late).into_iter().partition(|(behind, _)| *behind == 0);
        self.late = late;
        self.arriving.extend(Vec::into_iter(due).map(|(_, frame)| frame));
    }
}

/// Both ends and the line between them.
struct Link {
    random: Random,
    bad: usize,
    client: Client,
    supervisor: Supervisor,
    there: Way,
    back: Way,
    faults: [usize; KINDS],
}

impl Link {
    fn new(seed: u64, bad: usize) -> Self {
        let (random, supervisor) = (Random(seed), Supervisor::new(&BUILT_IN));
        let (there, back) = (Way::default(), Way::default());
        Self { random, bad, client: Client::new(), supervisor, there, back, faults: [0; KINDS] }
    }

    /// The supervisor reads what has come to it.
    fn supervise(&mut self) {
        let Self { random, bad, supervisor, back, faults, .. } = self;
        for byte in std::mem::take(&mut self.there.arriving).into_iter().flatten() {
            supervisor.take(byte, &mut |frame: &[u8]| back.send(random, *bad, frame, faults));
        }
    }

    /// Asks until all of the answer is there; `None` where the supervisor has started anew. It does so where it is told
    /// to, after reading that often.
    fn ask(&mut self, request: &Request<f32>, restarts: Option<usize>) -> Option<Vec<Answer<f32>>> {
        let next = self.client.next();
        assert!(self.client.ask(request));
        let mut answers = Vec::new();
        for round in 0..1000 {
            self.there.send(&mut self.random, self.bad, self.client.frame(), &mut self.faults);
            self.supervise();
            if restarts == Some(round) {
                self.supervisor = Supervisor::new(&BUILT_IN);
            }
            for byte in std::mem::take(&mut self.back.arriving).into_iter().flatten() {
                match self.client.take(byte) {
                    Some(Event::Answer(answer)) => answers.push(answer),
                    Some(Event::Last(answer)) => {
                        answers.push(answer);
                        let known = *request != Request::Hello || self.client.next() == next;
                        return known.then_some(answers);
                    }
                    Some(Event::OutOfStep) => return None,
                    // Nothing more comes in this round: it is asked again in the next.
                    Some(Event::Again | Event::Changed) | None => {}
                }
            }
        }
        panic!("no answer to {request:?}");
    }

    /// Waits until nothing is under way, greets, and begins with a fleet that is known: none.
    fn begin(&mut self) {
        (self.there, self.back) = (Way::default(), Way::default());
        self.ask(&Request::Hello, None);
        assert_eq!(self.ask(&Request::Clear, None), Some(vec![Answer::Done]));
    }
}

fn request(random: &mut Random) -> Request<f32> {
    let agent = random.below(6) as u16;
    match random.below(20) {
        0 => Request::Clear,
        1 => Request::Load,
        2..=5 => Request::Add(any(random)),
        6..=9 => Request::Compute,
        10..=14 => Request::Row { ego: agent },
        15 => Request::Conflicts,
        16 => Request::Replan { agent },
        17 => Request::Replace { agent, with: any(random) },
        18 => Request::Remove { agent },
        _ => Request::Hello,
    }
}

/// An agent through the middle, of one line or two; of ten one is refused.
fn any(random: &mut Random) -> Agent<f32> {
    let heading = random.below(64) as f32 / 10.0;
    let start = Pose { position: Point::new(-2.0 * heading.cos(), -2.0 * heading.sin()), heading: Radians(heading) };
    let radius = if random.below(10) == 0 { 0.0 } else { 0.25 };
    let path = (0..=random.below(2)).map(|_| STEPS[0]).collect();
    Agent { radius, start_time: random.below(8) as f32, limits: LIMITS, start, path }
}

/// What a perfect line brings. A greeting tells another number each time.
fn expected(model: &mut Model, request: &Request<f32>, seen: &[Answer<f32>]) -> Vec<Answer<f32>> {
    let mut answers = Vec::new();
    let next = if let [Answer::Hello { next, .. }] = seen { *next } else { 0 };
    model.answer(request.clone(), next, |answer| answers.push(answer));
    answers
}

#[test]
fn no_answer_is_wrong_or_stale_whatever_the_line_does() {
    let (mut faults, mut restarted, mut regions) = ([0; KINDS], 0, 0);
    for seed in 0..300 {
        let mut link = Link::new(seed, [0, 10, 50, 150][seed as usize % 4]);
        let mut model = Model::new(&BUILT_IN);
        let mut fresh = false;
        link.begin();
        for _ in 0..60 {
            let request = request(&mut link.random);
            let restarts = (link.random.below(25) == 0).then(|| link.random.below(2));
            match link.ask(&request, restarts) {
                Some(seen) => {
                    let expected = expected(&mut model, &request, &seen);
                    assert_eq!(seen, expected, "seed {seed}: {request:?}");
                    regions += seen.iter().filter(|answer| matches!(answer, Answer::Region(_))).count();
                }
                None => {
                    assert!(fresh || restarts.is_some(), "seed {seed}: {request:?} out of step");
                    (model, fresh, restarted) = (Model::new(&BUILT_IN), false, restarted + 1);
                    link.begin();
                    continue;
                }
            }
            fresh |= restarts.is_some();
        }
        faults.iter_mut().zip(link.faults).for_each(|(all, these)| *all += these);
    }
    // Faults of each kind, supervisors that started anew, and rows that had something in them.
    assert!(
        faults.iter().all(|&count| count > 500) && restarted > 100 && regions > 400,
        "{faults:?} {restarted} {regions}"
    );
}

/// All frames that a supervisor sends for these bytes, as answers with their numbers.
fn said(supervisor: &mut Supervisor, bytes: &[u8]) -> Vec<(u16, Answer<f32>)> {
    let mut receiver = pcr_supervisor::frame::Receiver::new(Reads::Answers);
    let mut said = Vec::new();
    for &byte in bytes {
        supervisor.take(byte, &mut |frame: &[u8]| {
            for &byte in frame {
                if let Some(frame) = receiver.take::<Answer<f32>>(byte) {
                    let frame = frame.expect("a good frame");
                    said.push((frame.tag.sequence, frame.message));
                }
            }
        });
    }
    said
}

fn frames(client: &mut Client, requests: &[Request<f32>]) -> Vec<Vec<u8>> {
    let mut frame = |request| {
        assert!(client.ask(request));
        client.frame().to_vec()
    };
    requests.iter().map(&mut frame).collect()
}

#[test]
fn an_agent_that_is_sent_twice_is_there_once() {
    let (mut supervisor, mut client) = (Supervisor::new(&BUILT_IN), Client::new());
    let agent = any(&mut Random(5));
    let [first, second] = &frames(&mut client, &[Request::Add(agent.clone()), Request::Add(agent)])[..] else {
        panic!()
    };
    let fleet = |agents| Answer::Fleet { agents };
    assert_eq!(said(&mut supervisor, first), [(1, fleet(1))]);
    assert_eq!(said(&mut supervisor, first), [(1, fleet(1))], "again");
    assert_eq!(said(&mut supervisor, second), [(2, fleet(2))], "another one, though equal");
    let late = Answer::Refused(Refusal::Sequence { next: 3 });
    assert_eq!(said(&mut supervisor, first), [(1, late)], "too late");
    // Another request of a number that is taken, and one that is ahead.
    let other = frames(&mut Client::new(), &vec![Request::Clear; 4]);
    for (clear, sequence) in [(&other[1], 2), (&other[3], 4)] {
        assert_eq!(said(&mut supervisor, clear), [(sequence, Answer::Refused(Refusal::Sequence { next: 3 }))]);
    }
    assert_eq!(said(&mut supervisor, &other[2]), [(3, Answer::Done)]);
}

#[test]
fn a_lost_zero_between_two_requests_loses_neither_and_two_lose_both() {
    let (mut supervisor, mut client) = (Supervisor::new(&BUILT_IN), Client::new());
    let [load, compute] = &frames(&mut client, &[Request::Load, Request::Compute])[..] else { panic!() };
    let both = |drop: usize| [&load[..load.len() - 1], &compute[drop..]].concat();
    let damaged = said(&mut supervisor, &both(1));
    assert!(matches!(damaged[..], [(0, Answer::Refused(Refusal::Frame(_)))]), "nobody's: {damaged:?}");
    let answers = said(&mut supervisor, &both(0));
    let computed = Answer::Computed { regions: 0, pieces: 0 };
    assert_eq!(answers, [(1, Answer::Fleet { agents: 1 }), (2, computed)]);
}

#[test]
fn a_supervisor_does_not_answer_itself() {
    let (mut supervisor, mut client) = (Supervisor::new(&BUILT_IN), Client::new());
    let [load] = &frames(&mut client, &[Request::Load])[..] else { panic!() };
    let mut echo = Vec::new();
    load.iter().for_each(|&byte| supervisor.take(byte, &mut |frame: &[u8]| echo.extend_from_slice(frame)));
    assert_eq!(said(&mut supervisor, &echo), []);
    let hears = |client: &mut Client| load.iter().filter_map(|&byte| client.take::<f32>(byte)).count();
    assert_eq!(hears(&mut client), 0, "nor does one who asks");
}

#[test]
fn after_the_last_number_a_new_supervisor_is_still_told_from_an_old_one() {
    let (mut supervisor, mut client) = (Supervisor::new(&BUILT_IN), Client::new());
    for round in 0..66_000 {
        assert!(client.ask(&Request::<f32>::Clear));
        let frame = client.frame().to_vec();
        let mut events = Vec::new();
        frame.iter().for_each(|&byte| {
            supervisor.take(byte, &mut |bytes: &[u8]| {
                events.extend(bytes.iter().filter_map(|&byte| client.take::<f32>(byte)))
            });
        });
        assert_eq!(events, [Event::Last(Answer::Done)], "round {round}");
        if round == 65_534 {
            let again = said(&mut Supervisor::new(&BUILT_IN), &frames(&mut client, &[Request::Clear])[0]);
            assert_eq!(again, [(2, Answer::Refused(Refusal::Sequence { next: 1 }))]);
            assert_eq!(said(&mut supervisor, client.frame()), [(2, Answer::Done)]);
        }
    }
}
