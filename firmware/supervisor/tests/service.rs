//! What is not known is refused, and it is said why: before the table is computed, after the fleet has changed, of agents
//! that there are not.

use pcr_core::{Curve, Limits, Point, Pose, Radians, TurnSide};
use pcr_supervisor::message::{Reason, Refusal, Room, text};
use pcr_supervisor::{Agent, Answer, Replies, Request, Service, Step};
use std::f32::consts::{FRAC_PI_2, PI};

type Small = Service<f32, 3, 6, 4, 8>;

const LIMITS: Limits<f32> = Limits { speed: 1.0, acceleration: 1.0 };
const STEPS: [Step<f32>; 1] = [Step { curve: Curve::Line, length: 4.0 }];

const fn built_in(y: f32, radius: f32) -> Agent<f32, &'static [Step<f32>]> {
    let start = Pose { position: Point::new(-2.0, y), heading: Radians(0.0) };
    Agent { radius, start_time: 0.0, limits: LIMITS, start, path: &STEPS }
}

static PARALLEL: [Agent<f32, &[Step<f32>]>; 2] = [built_in(0.0, 0.25), built_in(0.4, 0.25)];
static ONE_IS_FLAT: [Agent<f32, &[Step<f32>]>; 2] = [built_in(0.0, 0.25), built_in(0.4, 0.0)];

/// On a line of 4 m through the origin in its middle.
fn agent(heading: f32) -> Agent<f32> {
    let position = Point::new(-2.0 * heading.cos(), -2.0 * heading.sin());
    let start = Pose { position, heading: Radians(heading) };
    Agent { radius: 0.25, start_time: 0.0, limits: LIMITS, start, path: STEPS.into_iter().collect() }
}

fn answers(service: &mut Small, request: Request<f32>) -> Vec<Answer<f32>> {
    let mut answers = Vec::new();
    service.answer(request, 1, |answer| answers.push(answer));
    answers
}

fn answer(service: &mut Small, request: Request<f32>) -> Answer<f32> {
    let [answer] = &answers(service, request)[..] else { panic!("one answer") };
    answer.clone()
}

fn refused(refusal: Refusal) -> Answer<f32> {
    Answer::Refused(refusal)
}

/// With two agents that cross and their table.
fn crossing() -> Small {
    let mut service = Small::new(&PARALLEL);
    for (agent, agents) in [agent(0.0), agent(FRAC_PI_2)].into_iter().zip(1..) {
        assert_eq!(answer(&mut service, Request::Add(agent)), Answer::Fleet { agents });
    }
    assert_eq!(answer(&mut service, Request::Compute), Answer::Computed { regions: 1, pieces: 1 });
    service
}

fn row(service: &mut Small, ego: u16) -> Vec<Answer<f32>> {
    answers(service, Request::Row { ego })
}

#[test]
fn without_a_table_of_the_fleet_there_are_no_regions_and_no_plan() {
    let asks = [Request::Row { ego: 0 }, Request::Replan { agent: 0 }];
    let mut service = Small::new(&PARALLEL);
    assert_eq!(answer(&mut service, Request::Add(agent(0.0))), Answer::Fleet { agents: 1 });
    for ask in &asks {
        assert_eq!(answer(&mut service, ask.clone()), refused(Refusal::NotComputed), "never computed");
    }
    let changes =
        [(Request::Add(agent(1.0)), Answer::Fleet { agents: 3 }), (Request::Load, Answer::Fleet { agents: 2 })];
    for (change, expected) in changes {
        let mut service = crossing();
        assert_eq!(row(&mut service, 0).len(), 3, "a region, its piece, the end");
        assert_eq!(answer(&mut service, change.clone()), expected);
        for ask in &asks {
            assert_eq!(answer(&mut service, ask.clone()), refused(Refusal::NotComputed), "after {change:?}");
        }
        assert!(matches!(answer(&mut service, Request::Compute), Answer::Computed { .. }));
        assert!(matches!(row(&mut service, 0)[..], [.., Answer::End { .. }]), "after {change:?} and Compute");
    }
}

#[test]
fn what_is_refused_leaves_the_fleet_and_its_table() {
    let mut service = crossing();
    let before = row(&mut service, 0);
    let flat = Agent { radius: 0.0, ..agent(0.0) };
    let long = Agent { path: [STEPS[0]; 7].into_iter().collect(), ..agent(0.0) };
    let invalid = |agent, what, why| refused(Refusal::Agent { agent, what: text(what), why });
    let cases = [
        (Request::Add(flat.clone()), invalid(2, "radius", Reason::NonPositive)),
        (Request::Replace { agent: 1, with: flat }, invalid(1, "radius", Reason::NonPositive)),
        (Request::Add(long.clone()), invalid(2, "segment", Reason::Full)),
        (Request::Replace { agent: 0, with: long }, invalid(0, "segment", Reason::Full)),
        (Request::Replace { agent: 2, with: agent(0.0) }, refused(Refusal::NoSuchAgent { agent: 2 })),
        (Request::Remove { agent: 2 }, refused(Refusal::NoSuchAgent { agent: 2 })),
        (Request::Row { ego: 2 }, refused(Refusal::NoSuchAgent { agent: 2 })),
        (Request::Row { ego: 65535 }, refused(Refusal::NoSuchAgent { agent: 65535 })),
        (Request::Replan { agent: 2 }, refused(Refusal::NoSuchAgent { agent: 2 })),
    ];
    for (request, expected) in cases {
        assert_eq!(answer(&mut service, request.clone()), expected, "{request:?}");
        assert_eq!(row(&mut service, 0), before, "{request:?}");
    }
}

#[test]
fn a_replaced_and_a_removed_agent_leave_the_table_of_those_that_are_there() {
    let table = |service: &mut Small, agents: u16| {
        assert!(matches!(answer(service, Request::Compute), Answer::Computed { .. }));
        (0..agents).flat_map(|ego| row(service, ego)).collect::<Vec<_>>()
    };
    let fleet = |agents: &[Agent<f32>]| {
        let mut service = Small::new(&[]);
        agents.iter().for_each(|agent| drop(answers(&mut service, Request::Add(agent.clone()))));
        service
    };
    let [a, b, c] = [0.0, 0.6, FRAC_PI_2].map(agent);
    let two = Agent { path: [STEPS[0]; 2].into_iter().collect(), ..agent(0.2) };
    let mut service = fleet(&[a.clone(), b.clone(), c.clone()]);
    assert_eq!(answer(&mut service, Request::Replace { agent: 1, with: two.clone() }), Answer::Fleet { agents: 3 });
    assert_eq!(table(&mut service, 3), table(&mut fleet(&[a.clone(), two, c.clone()]), 3), "longer");
    assert_eq!(answer(&mut service, Request::Replace { agent: 1, with: b }), Answer::Fleet { agents: 3 });
    assert_eq!(answer(&mut service, Request::Remove { agent: 1 }), Answer::Fleet { agents: 2 });
    assert_eq!(table(&mut service, 2), table(&mut fleet(&[a, c]), 2), "fewer");
}

#[test]
fn a_table_goes_on_when_an_agent_is_replaced_or_removed() {
    let rows = |service: &mut Small, agents: u16| (0..agents).flat_map(|ego| row(service, ego)).collect::<Vec<_>>();
    let change = |request: Request<f32>, agents: u16, fleet: &[Agent<f32>]| {
        let mut service = crossing();
        assert_eq!(answer(&mut service, request.clone()), Answer::Fleet { agents });
        let mut fresh = Small::new(&[]);
        fleet.iter().for_each(|agent| drop(answers(&mut fresh, Request::Add(agent.clone()))));
        let before = rows(&mut service, agents);
        let computed = answer(&mut service, Request::Compute);
        assert_eq!(answer(&mut fresh, Request::Compute), computed, "{request:?}");
        assert_eq!((rows(&mut service, agents), rows(&mut fresh, agents)), (before.clone(), before), "{request:?}");
    };
    change(Request::Replace { agent: 1, with: agent(1.0) }, 2, &[agent(0.0), agent(1.0)]);
    change(Request::Replace { agent: 0, with: agent(1.0) }, 2, &[agent(1.0), agent(FRAC_PI_2)]);
    change(Request::Remove { agent: 0 }, 1, &[agent(FRAC_PI_2)]);
    // Where the new agent's regions have no room, there is no table, and it is said how much is needed.
    let mut service = Service::<f32, 3, 6, 1, 8>::new(&[]);
    let mut said = Vec::new();
    let aside = Agent { start: Pose { position: Point::new(-2.0, 9.0), heading: Radians(0.0) }, ..agent(0.0) };
    for request in [
        Request::Add(agent(0.0)),
        Request::Add(agent(FRAC_PI_2)),
        Request::Add(aside.clone()),
        Request::Compute,
        Request::Replace { agent: 2, with: agent(1.0) },
        Request::Row { ego: 0 },
        Request::Compute,
        Request::Replace { agent: 2, with: aside.clone() },
        Request::Compute,
        Request::Replace { agent: 2, with: agent(1.0) },
        // The paths are those of the last table again.
        Request::Replace { agent: 2, with: aside },
        Request::Row { ego: 0 },
    ] {
        service.answer(request, 1, |answer| said.push(answer));
    }
    let expected = [
        Answer::Computed { regions: 1, pieces: 1 },
        Answer::Fleet { agents: 3 },
        refused(Refusal::NotComputed),
        refused(Refusal::Needs { regions: 3, pieces: 3 }),
        Answer::Fleet { agents: 3 },
        Answer::Computed { regions: 1, pieces: 1 },
        Answer::Fleet { agents: 3 },
        Answer::Fleet { agents: 3 },
        refused(Refusal::NotComputed),
    ];
    assert_eq!(said[3..], expected);
}

#[test]
fn a_built_in_fleet_is_there_as_a_whole_or_not_at_all() {
    let mut service = Small::new(&ONE_IS_FLAT);
    let flat = Refusal::Agent { agent: 1, what: text("radius"), why: Reason::NonPositive };
    assert_eq!(answer(&mut service, Request::Load), refused(flat));
    assert_eq!(answer(&mut service, Request::Row { ego: 0 }), refused(Refusal::NoSuchAgent { agent: 0 }));
    assert_eq!(answer(&mut Small::new(&[]), Request::Load), Answer::Fleet { agents: 0 });
}

#[test]
fn a_full_table_is_none_and_tells_what_the_fleet_needs() {
    fn said<const R: usize, const P: usize>() -> Vec<Answer<f32>> {
        let mut service = Service::<f32, 3, 6, R, P>::new(&[]);
        let mut said = Vec::new();
        for request in [Request::Add(agent(0.0)), Request::Add(agent(0.6)), Request::Add(agent(FRAC_PI_2))] {
            service.answer(request, 1, drop);
        }
        service.answer(Request::Compute, 1, |answer| said.push(answer));
        service.answer(Request::Row { ego: 0 }, 1, |answer| said.push(answer));
        said
    }
    let none = refused(Refusal::NotComputed);
    let needs = refused(Refusal::Needs { regions: 3, pieces: 3 });
    assert_eq!(said::<2, 8>(), [needs.clone(), none.clone()]);
    assert_eq!(said::<8, 2>(), [needs.clone(), none.clone()]);
    assert_eq!(
        said::<3, 3>().first(),
        Some(&Answer::Computed { regions: 3, pieces: 3 }),
        "as much as was told is enough"
    );
    // They are counted without room for a region, but not without room for the pieces of two agents.
    assert_eq!(said::<0, 8>(), [needs, none.clone()]);
    assert_eq!(said::<8, 0>(), [refused(Refusal::TableFull(Room::Pieces)), none]);
}

/// Who has a watchdog to feed while a long job is done.
#[derive(Default)]
struct Parts {
    answers: usize,
    pauses: usize,
}

impl Replies<f32> for &mut Parts {
    fn send(&mut self, _: Answer<f32>) {
        self.answers += 1;
    }

    fn pause(&mut self) {
        self.pauses += 1;
    }
}

#[test]
fn long_jobs_are_done_in_parts() {
    let mut service = Small::new(&PARALLEL);
    let mut parts = |request: Request<f32>| {
        let mut parts = Parts::default();
        service.answer(request, 1, &mut parts);
        (parts.answers, parts.pauses)
    };
    assert_eq!(parts(Request::Load), (1, 2), "an agent each");
    assert_eq!(parts(Request::Add(agent(FRAC_PI_2))), (1, 0));
    assert_eq!(parts(Request::Compute), (1, 3), "an agent each");
    assert_eq!(parts(Request::Compute), (1, 0), "it is there");
    let (_, pauses) = parts(Request::Conflicts);
    assert_eq!(pauses, 3, "a pair each");
    let (_, pauses) = parts(Request::Replan { agent: 2 });
    assert!(pauses >= 2, "each region that is looked at: {pauses}");
}

/// It passes the standing disc at the sum of the radii, turns round, and drives through it.
#[test]
fn a_touch_does_not_hide_the_overlap_behind_it() {
    let standing = Agent { radius: 0.5, path: [].into_iter().collect(), ..agent(0.0) };
    let standing = Agent { start: Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) }, ..standing };
    let line = Step { curve: Curve::Line, length: 6.0 };
    let back = Step { curve: Curve::Arc { radius: 0.5, turn: TurnSide::Right }, length: 0.5 * PI };
    let start = Pose { position: Point::new(-3.0, 1.0), heading: Radians(0.0) };
    let passing = Agent { radius: 0.5, start, path: [line, back, line].into_iter().collect(), ..agent(0.0) };
    let once = Agent { path: [line].into_iter().collect(), ..passing.clone() };
    for (passing, touching) in [(once, true), (passing, false)] {
        let mut service = Small::new(&[]);
        for agent in [standing.clone(), passing] {
            assert!(matches!(answer(&mut service, Request::Add(agent)), Answer::Fleet { .. }));
        }
        let [Answer::Conflict(conflict), Answer::End { count: 1 }] = &answers(&mut service, Request::Conflicts)[..]
        else {
            panic!("one conflict")
        };
        assert!(conflict.touching == touching && (conflict.depth > 0.99) != touching, "{conflict:?}");
    }
}
