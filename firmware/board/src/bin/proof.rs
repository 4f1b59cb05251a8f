//! Calls every public function of the library with values that the compiler knows nothing of. That this links proves
//! that none of them can panic, in this number format on this target: see `pcr_board::can_panic`.
//!
//! `tools/covered.py` fails where a public function is missing here. `Debug` is left out: it is for tests. The proof of
//! the proof is `control`, which must not link.
#![no_std]
#![no_main]

use core::fmt::{Display, Write};
use core::hint::black_box as any;
use core::ops::{Add, Deref, DerefMut, Neg, Sub};
use pcr_board::{Number, entry};
use pcr_core::scalar::{AccelerationRamp, Angle, AngleSector, Unit, Wide};
use pcr_core::{
    Aabb, AdmissionError, BrakingModel, BroadPhase, CapacityError, CheckState, CheckTolerances, Conflict, Conflicts,
    Constraint, Contacts, Corner, Crossing, Curve, Direction, Ecm, EcmEntry, EcmError, Encounter, FleetMotions,
    FleetStorage, FleetStorageError, Gaps, Interval, InvalidInput, Limits, MismatchError, Motion, MovementAuthority,
    NewAgent, Outline, OutlineRef, PassingState, Path, PathProposal, PathRef, Phase, Piece, PieceRef, PieceType,
    PlanError, Point, Pose, PrecedenceDecision, PrecedenceTable, Profile, ProfileRef, Progress, RegionPrecedence,
    RegionRef, Scalar, SearchNode, Segment, SpeedPlan, SpeedPlanError, SpeedPlanLimits, StagedAgent, TurnSide, Union,
    Vector, crossings, earliest_departure, earliest_start, excess, first_conflict, first_overlap, gaps, least_duration,
    overlaps, plan_delays, plan_speed, plan_speed_below, plan_speeds, safe_intervals, safe_lengths, union,
};

#[entry]
fn main() -> ! {
    arithmetic::<Number>();
    operators::<Number>();
    plane::<Number>();
    let _ = constructors::<Number>();
    let _ = outlines::<Number>();
    let _ = storage::<Number>();
    motions::<Number>(any(&[]));
    queries::<Number>(any(&[]));
    table::<Number>(any(&mut []), any(&[]));
    orders::<Number>(any(&mut []), any(&mut []), any(&mut []));
    let _ = brakes::<Number>();
    messages::<Number>();
    #[cfg(any(feature = "q12", feature = "q16", feature = "q20"))]
    fixed();
    semihosting::process::exit(0)
}

/// Any number.
#[inline(never)]
fn number<S: Scalar>() -> S {
    any(S::ZERO)
}

#[inline(never)]
fn angle<S: Scalar>() -> S::Angle {
    any(S::Angle::ZERO)
}

#[inline(never)]
fn unit<S: Scalar>() -> S::Unit {
    any(S::Unit::ZERO)
}

#[inline(never)]
fn wide<S: Scalar>() -> S::Wide {
    any(S::Wide::ZERO)
}

#[inline(never)]
fn point<S: Scalar>() -> Point<S> {
    Point::new(number(), number())
}

#[inline(never)]
fn interval<S: Scalar>() -> Interval<S> {
    Interval::new(number(), number())
}

#[inline(never)]
fn arithmetic<S: Scalar>() {
    let (a, b) = (number::<S>(), number::<S>());
    any((a + b, a - b, -a, a < b, a == b, any(S::LIMIT)));
    any((
        Scalar::is_finite(a),
        Scalar::times(a, b),
        Scalar::scale(a, unit::<S>()),
        S::combine(a, unit::<S>(), b, unit::<S>()),
        Scalar::half(a),
        Scalar::double(a),
    ));
    any((Scalar::abs(a), Scalar::min(a, b), Scalar::max(a, b), Scalar::clamp(number(), a, b), Scalar::quotient(a, b)));
    any(Scalar::negate_if(a, any(true)));
    any((Scalar::quotient_unit(a, unit::<S>()), S::unit_vector(a, b, number()), Scalar::difference(a, b, wide::<S>())));
    any((Scalar::slack(a), Scalar::millimetres(a), S::quadratic_roots(a, wide::<S>(), wide::<S>())));
    let ramp =
        AccelerationRamp { slow: a, fast: number(), acceleration: number(), duration: number(), length: number() };
    any((S::ramp_length(any(ramp), a), S::ramp_time(any(ramp), a)));
    any((S::ramp_bulge(any(ramp), a), S::ramps_alike(any(ramp), any(ramp))));
    let [from, middle] = [[unit::<S>(), unit::<S>()], [unit::<S>(), unit::<S>()]];
    let equations = [[wide::<S>(); 4], [wide::<S>(); 4]];
    S::half_tangent_roots(equations.into_iter(), any(AngleSector { from, middle, least: unit::<S>() }), |angle| {
        any(angle);
    });
    any(AngleSector::<S::Unit>::all(from));
    any((Scalar::portion(a, b, number()), S::tolerance(a)));
    any((Scalar::sum(a, b), Scalar::advance(a, b, number(), unit::<S>()), Scalar::sum_up(a, b)));
    any((S::drift(any(0), a), S::lag(a, b), Scalar::rounding(a)));
    any(S::chord(a, angle::<S>(), any(false), [unit::<S>(), unit::<S>()]));
    let (v, w) = (wide::<S>(), wide::<S>());
    any((v + w, v - w, -v, v < w, Wide::sqrt(v), Wide::narrow(v), Wide::half(v), Wide::double(v)));
    let (u, t) = (unit::<S>(), unit::<S>());
    any((
        u + t,
        u - t,
        -u,
        u < t,
        Unit::times(u, t),
        S::Unit::combine(u, t, unit::<S>(), t),
        Unit::abs(u),
        any(S::Unit::ONE),
    ));
    let (p, q) = (angle::<S>(), angle::<S>());
    any((p + q, p - q, -p, p < q, Angle::is_finite(p), Angle::sin_cos(p), Angle::arc_length(p, a)));
    any((Angle::subtended_rest(p, a, b), Angle::sum(p, q), Angle::is_in_range(p), Angle::digest(p)));
    any((S::Angle::subtended(a, b), S::Angle::half_subtended(a, b)));
    any((S::Angle::atan2(a, b), S::Angle::atan2_each([a, b], [b, a]), S::Angle::circumference(a)));
}

#[inline(never)]
fn operators<S: Scalar>() {
    let (a, b) = (number::<S>(), number::<S>());
    any((<S as Add>::add(a, b), <S as Sub>::sub(a, b), <S as Neg>::neg(a), Scalar::digest(a)));
    let (a, b) = (angle::<S>(), angle::<S>());
    any((<S::Angle as Add>::add(a, b), <S::Angle as Sub>::sub(a, b), <S::Angle as Neg>::neg(a)));
    let (a, b) = (wide::<S>(), wide::<S>());
    any((<S::Wide as Add>::add(a, b), <S::Wide as Sub>::sub(a, b), <S::Wide as Neg>::neg(a)));
    let (a, b) = (unit::<S>(), unit::<S>());
    any((<S::Unit as Add>::add(a, b), <S::Unit as Sub>::sub(a, b), <S::Unit as Neg>::neg(a)));
    let vector = <Point<S> as Sub>::sub(point(), point());
    any(<Point<S> as Add<Vector<S>>>::add(point(), vector));
    any((<Piece<S> as Default>::default(), <EcmEntry as Default>::default(), <SearchNode<S> as Default>::default()));
    any((<RegionPrecedence<S> as Default>::default(), <CheckState<S> as Default>::default()));
}

#[inline(never)]
fn plane<S: Scalar>() {
    let vector: Vector<S> = point::<S>() - point();
    let direction = Direction::<S>::at(angle::<S>());
    any((point::<S>() + vector, Vector::along(vector, direction), Vector::across(vector, direction)));
    any((Vector::norm_squared(vector), any(Direction::<S>::X)));
    any((Direction::dot(direction, direction), Direction::cross(direction, direction)));
    any(Direction::vector(direction, number(), number()));
    let (i, j) = (interval::<S>(), interval::<S>());
    any((Interval::contains(i, number()), Interval::meets(i, j), Interval::hull(i, j), Interval::length(i)));
    any(Interval::middle(i));
    let (a, b) = (Aabb::around(point::<S>(), point()), any(Aabb::around(point::<S>(), point())));
    any((Aabb::hull(a, b), Aabb::expanded(a, number()), Aabb::meets(a, b), Aabb::extent(a)));
}

#[inline(never)]
fn constructors<S: Scalar>() -> Result<(), InvalidInput> {
    let pose: Pose<S> = Pose { position: point(), heading: angle::<S>() };
    let path = Path::<S, 2>::starting_at(any(pose))?;
    let path = Path::line(path, number())?;
    let path = Path::arc(path, number(), any(TurnSide::Left), number())?;
    let path = Path::arc_by(path, number(), number())?;
    let path = Path::steady_arc(path, number(), any(TurnSide::Left), number())?;
    let path = Path::pivot(path, number(), number())?;
    let path = Path::reverse(Path::facing(path, angle::<S>())?)?;
    let path = Path::turn(any(path), angle::<S>())?;
    any(Path::as_path(&path));
    any(PathRef::<S>::new(any(&[])).is_ok());
    let segment = Segment::standing(any(pose))?;
    let segment = Segment::then_line(&segment, number())?;
    let segment = any(Segment::then_arc(&segment, number(), any(TurnSide::Right), number())?);
    let segment = any(Segment::then_steady_arc(&segment, number(), any(TurnSide::Left), number())?);
    any(Segment::is_steady(&segment));
    let segment = any(Segment::then_pivot(&segment, number(), any(TurnSide::Right), number())?);
    let segment = any(Segment::turned(segment, angle::<S>())?);
    let segment = any(Segment::facing(segment, angle::<S>())?);
    let segment = any(Segment::facing_opposite(segment)?);
    let curve: Curve<S> = Segment::curve(&segment);
    any((curve, Segment::length(&segment), Segment::from(&segment), Segment::bounds(&segment)));
    any((Segment::point_at(&segment, number()), Segment::heading_at(&segment, number())));
    let phase = Phase::<S>::starting_at(number(), number(), number())?;
    let phase = any(Phase::then(&phase, number(), number())?);
    let phase = any(Phase::then_to(&phase, number(), number())?);
    any((Phase::time(&phase), Phase::length(&phase), Phase::speed(&phase), Phase::speed_at(&phase, number())));
    any(Phase::acceleration(&phase));
    let limits = Limits { speed: number(), acceleration: number() };
    any(Profile::<S, 3>::rest_to_rest(number(), limits)?);
    let pieces: &[(S, S)] = any(&[]);
    let profile = any(Profile::<S, 4>::from_pieces(number(), pieces.iter().copied())?);
    any(Profile::as_profile(&profile));
    any(Profile::<S, 4>::copied(Profile::as_profile(&profile)).is_ok());
    any((Phase::acceleration(&phase), ProfileRef::top_speed(profile.as_profile())));
    any(ProfileRef::<S>::new(any(&[])).is_ok());
    any(Profile::<S, 1>::standing());
    Ok(())
}

#[inline(never)]
fn outlines<S: Scalar>() -> Result<(), InvalidInput> {
    any(Outline::<S, 0>::disc(number())?);
    let vector: Vector<S> = any(Vector { x: number(), y: number() });
    any(Outline::<S, 2>::capsule(vector, vector, number())?);
    any(Outline::<S, 4>::rectangle(number(), number(), number(), number(), number())?);
    let corners: &[Vector<S>] = any(&[]);
    let outline = any(Outline::<S, 16>::polygon(corners.iter().copied(), number())?);
    any(Outline::as_outline(&outline));
    let outline = any(<OutlineRef<'_, S> as From<&Outline<S, 16>>>::from(&outline));
    any((OutlineRef::radius(outline), OutlineRef::reach(outline)));
    any(OutlineRef::new(any(OutlineRef::corners(outline)), number())?.reach());
    if let [corner, ..] = OutlineRef::corners(outline) {
        any(Corner::at(corner));
    }
    Ok(())
}

#[inline(never)]
fn storage<S: Scalar>() -> Result<(), FleetStorageError> {
    type New<'f, S> = NewAgent<'f, 'static, S, 2, 6, 3>;
    let mut storage = any(FleetStorage::<'static, S, 2, 6>::new());
    any((FleetStorage::len(&storage), FleetStorage::is_empty(&storage)));
    let pose: Pose<S> = Pose { position: point(), heading: angle::<S>() };
    let path: New<'_, S> = FleetStorage::start_at(&mut storage, any(pose))?;
    let path = NewAgent::segment(path, any(Curve::Line), number())?;
    let path = NewAgent::line(path, number())?;
    let path = NewAgent::arc(path, number(), any(TurnSide::Left), number())?;
    let path = NewAgent::arc_by(path, number(), number())?;
    let path = NewAgent::steady_arc(path, number(), any(TurnSide::Left), number())?;
    let path = NewAgent::pivot(path, number(), number())?;
    let path = NewAgent::reverse(NewAgent::facing(path, angle::<S>())?)?;
    let path = NewAgent::turn(path, angle::<S>())?;
    let limits = Limits { speed: number(), acceleration: number() };
    let path = NewAgent::profile(NewAgent::rest_to_rest(path, limits)?, Profile::<S, 3>::standing().as_profile())?;
    let staged = NewAgent::disc(path, number(), number())?;
    any((StagedAgent::storage(&staged).len(), StagedAgent::motion(&staged).radius()));
    any(StagedAgent::add(staged).is_ok());
    let outline: OutlineRef<'static, S> = OutlineRef::new(any(&[]), number())?;
    let staged = NewAgent::outline(FleetStorage::start_at(&mut storage, any(pose))?, outline, number())?;
    any(StagedAgent::replace(staged, any(0)).is_ok());
    any(FleetStorage::motion(&storage, any(0)).is_ok());
    any(FleetStorage::delay(&mut storage, any(0), number()).is_ok());
    any(FleetStorage::remove(&mut storage, any(0)).is_ok());
    let mut fleet = any(FleetMotions::<'_, S, 2>::new());
    FleetMotions::fill(&mut fleet, &storage);
    any((
        <FleetMotions<'_, S, 2> as Deref>::deref(&fleet).len(),
        <FleetMotions<'_, S, 2> as DerefMut>::deref_mut(&mut fleet).len(),
    ));
    any(<FleetMotions<'_, S, 2> as Default>::default());
    drop(fleet);
    FleetStorage::clear(&mut storage);
    any(<FleetStorage<'static, S, 2, 6> as Default>::default());
    any(<FleetStorageError as From<InvalidInput>>::from(any(InvalidInput::NotConvex)));
    Ok(())
}

#[inline(never)]
fn motions<S: Scalar>(fleet: &[Motion<'_, S>]) {
    for motion in fleet {
        let path: PathRef<'_, S> = Motion::path(motion);
        any((PathRef::segments(path), PathRef::length(path), PathRef::pose_at(path, number()), PathRef::bounds(path)));
        any((PathRef::point_at(path, number()), PathRef::curve_at(path, number())));
        let profile: ProfileRef<'_, S> = Motion::profile(motion);
        any((ProfileRef::phases(profile), ProfileRef::duration(profile), ProfileRef::length(profile)));
        any(ProfileRef::top_speed(profile));
        any((ProfileRef::length_at(profile, number()), ProfileRef::speed_at(profile, number())));
        any((ProfileRef::first_time_at(profile, number()), ProfileRef::last_time_at(profile, number())));
        any(Motion::new(path, profile, number(), number()).is_ok());
        let outline: OutlineRef<'_, S> = Motion::outline(motion);
        any(Motion::with_outline(path, profile, outline, number()).is_ok());
        any(Motion::delayed(*motion, number()).is_ok());
        any(Motion::with_profile(*motion, profile, number()).is_ok());
        any(Motion::with_longest(*motion, number()).is_ok());
        any((Motion::with_lateness(*motion, number()).is_ok(), Motion::lateness(motion)));
        any(Profile::<S, 4>::stretched(profile, number()).is_ok());
        any((Motion::time_excess(motion), Motion::lag(motion), excess(motion, motion)));
        any((Motion::radius(motion), Motion::time(motion), Motion::bounds(motion), Motion::extent(motion)));
        any((Motion::length_at(motion, number()), Motion::speed_at(motion, number())));
        any((Motion::position_at(motion, number()), Motion::time_in(motion, interval())));
        any((Motion::with_margin(*motion, number()).is_ok(), Motion::inflated(*motion), Motion::margin(motion)));
        any((Motion::for_plan(*motion).is_ok(), Motion::span(fleet)));
        for other in fleet {
            let found: Option<Crossing<S>> = crossings(motion, other).last();
            any(found);
        }
    }
}

#[inline(never)]
fn queries<S: Scalar>(fleet: &[Motion<'_, S>]) {
    let intervals: &[Interval<S>] = any(&[]);
    let mut union = union(intervals.iter().copied());
    any(<Union<S, _> as Iterator>::next(&mut union));
    any(<Gaps<S, _> as Iterator>::next(&mut gaps(union, interval())));
    if let [ego, other, ..] = fleet {
        let pair: Encounter<'_, S> = Encounter::new(ego, other);
        any((Encounter::time(&pair), Encounter::radius(&pair), Encounter::tolerance(&pair)));
        let mut contacts = Encounter::contacts(&pair, interval());
        any((
            <Contacts<'_, S> as Iterator>::next(&mut contacts),
            Contacts::steps(&contacts),
            Encounter::closest(&pair, interval()),
        ));
        let conflict: Option<Conflict<S>> =
            <Conflicts<'_, S> as Iterator>::next(&mut Encounter::conflicts(&pair, interval()));
        any(conflict);
        any(Encounter::blocked(&pair, interval(), interval()).last());
        any(Encounter::blocked_lengths(&pair, interval()).last());
    }
    if let Ok(broad_phase) = BroadPhase::new(any(&mut [][..]), fleet, interval()) {
        any((BroadPhase::parts(&broad_phase), BroadPhase::candidates(&broad_phase).last()));
        any(BroadPhase::contacts(&broad_phase).last());
        any(BroadPhase::contacts_of(&broad_phase, any([0; 2]), interval())).into_iter().flatten().for_each(drop);
    }
    any(safe_intervals(fleet, any(0), interval(), interval())).into_iter().flatten().for_each(drop);
    any(safe_lengths(fleet, any(0), interval())).into_iter().flatten().for_each(drop);
}

#[inline(never)]
fn table<S: Scalar>(fleet: &mut [Motion<'_, S>], agents: &[usize]) {
    any(Ecm::build(any(&mut [][..]), any(&mut [][..]), fleet).is_ok());
    if let [first, second, ..] = &*fleet {
        any(overlaps(first, second, any(&mut [][..]), |region| {
            any(region.length());
        })
        .is_ok());
    }
    let mut ecm = any(Ecm::<S, _, _>::new([EcmEntry::EMPTY; 4], [Piece::EMPTY; 8]));
    for &agent in agents {
        any(Ecm::insert(&mut ecm, fleet, agent).is_ok());
        any(Ecm::remove(&mut ecm, fleet, agent).is_ok());
        any(Ecm::erase(&mut ecm, fleet, agent).is_ok());
        any(Ecm::fill_row(&mut ecm, fleet, agent).is_ok());
        any(Ecm::fill(&mut ecm, fleet).is_ok());
        Ecm::begin_fill(&mut ecm, fleet);
        any(Ecm::fill_pairs(&mut ecm, fleet, any(1)).is_ok());
        let mut copy = any(Ecm::<S, _, _>::new([EcmEntry::EMPTY; 4], [Piece::EMPTY; 8]));
        any(Ecm::copy_from(&mut copy, &ecm).is_ok());
        any(Ecm::needed(&mut copy, fleet).is_ok());
        any(copy.len());
        Ecm::clear(any(&mut ecm));
        if let Some(&motion) = any(fleet.first()) {
            any(Ecm::replace(&mut ecm, fleet, agent, motion).is_ok());
        }
        plans(&ecm, fleet, agent);
        any((Ecm::len(&ecm), Ecm::is_empty(&ecm), Ecm::pieces(&ecm)));
        any(Ecm::regions(&ecm, fleet)).into_iter().flatten().for_each(|region| regions(&region));
        any(Ecm::regions_once(&ecm, fleet)).into_iter().flatten().for_each(|region| regions(&region));
        any(Ecm::row(&ecm, fleet, agent)).into_iter().flatten().for_each(|region| regions(&region));
        any(Ecm::pair(&ecm, fleet, agent, any(agent))).into_iter().flatten().for_each(|region| regions(&region));
    }
}

#[inline(never)]
fn plans<S: Scalar>(ecm: &Ecm<S, [EcmEntry; 4], [Piece<S>; 8]>, fleet: &[Motion<'_, S>], agent: usize) {
    let Ok(row) = Ecm::row(ecm, fleet, agent) else { return };
    let Some(motion) = any(fleet.first()) else { return };
    any(first_conflict(motion, row.clone(), interval()).is_ok());
    any(first_overlap(motion, row.clone(), interval()).is_ok());
    let limits = Limits { speed: number(), acceleration: number() };
    let drive = SpeedPlanLimits { start: number(), goal: number(), ..SpeedPlanLimits::rest_to_rest(limits) };
    any((drive, SpeedPlanLimits::of(motion)));
    let stations: &mut [SearchNode<S>] = any(&mut [][..]);
    let constraints: &[Constraint<S>] = any(&[][..]);
    any(row.clone().map(|region| [Constraint::before(&region), Constraint::after(&region)]).next());
    if let Ok(plan) = any(plan_speed::<S, 8>(motion, any(drive), row.clone(), constraints, stations)) {
        any((SpeedPlan::end(&plan), plan));
    }
    any(plan_speed_below::<S, 8>(motion, row, constraints, stations).is_ok());
    any(plan_delays(ecm, fleet, any(&mut [][..]), any(&mut [][..])).is_ok());
    let profiles: &mut [Profile<S, 8>] = any(&mut [][..]);
    any(plan_speeds(ecm, fleet, any(&mut [][..]), any(&mut [][..]), profiles, stations).is_ok());
}

#[inline(never)]
fn regions<S: Scalar>(region: &RegionRef<'_, S>) {
    any((RegionRef::ego(region), RegionRef::other(region), RegionRef::length(region), RegionRef::other_length(region)));
    any((RegionRef::time(region), RegionRef::is_open_at_start(region), RegionRef::is_open_at_end(region)));
    any(RegionRef::excess(region));
    any((RegionRef::contains(region, number(), number()), RegionRef::other_motion(region)));
    any((RegionRef::ego_motion(region), RegionRef::forbidden_delays(region), RegionRef::passing_delays(region)));
    any(RegionRef::blocked(region, interval(), interval()).last());
    any(RegionRef::forbidden_durations::<4>(region).is_ok());
    any((RegionRef::swapped(region.clone()), RegionRef::hold(region, number(), number())));
    any(earliest_start(core::iter::once(region.clone()), number()));
    any(earliest_departure(core::iter::once(region.clone()), number(), number()));
    any(least_duration::<S, 4>(core::iter::once(region.clone()), number()).is_ok());
    any(RegionRef::slice_at(region, number()).last());
    for piece in RegionRef::pieces(region) {
        any((PieceRef::piece_type(&piece), PieceType::of(piece.ego.curve(), piece.other.curve())));
    }
}

#[inline(never)]
fn orders<S: Scalar>(fleet: &mut [Motion<'_, S>], progress: &mut [Progress<S>], reaches: &mut [CheckState<S>]) {
    any(PrecedenceTable::build(any(&mut [][..]), any(&mut [][..]), any(&mut [][..]), fleet).is_ok());
    let mut orders =
        any(PrecedenceTable::<S, _, _, _>::new([EcmEntry::EMPTY; 4], [Piece::EMPTY; 8], [RegionPrecedence::EMPTY; 8]));
    let (agent, other, place) = any((0, 0, 0));
    any(PrecedenceTable::fill_row(&mut orders, fleet, agent).is_ok());
    any(PrecedenceTable::insert(&mut orders, fleet, agent).is_ok());
    any(PrecedenceTable::decide(&mut orders, fleet, agent, other, any(PassingState::First), number()).is_ok());
    any(PrecedenceTable::decide_at(
        &mut orders,
        fleet,
        place,
        agent,
        any(PassingState::swapped(PassingState::Second)),
        number(),
    )
    .is_ok());
    any(PrecedenceTable::as_planned(&mut orders, fleet).is_ok());
    let tolerances = CheckTolerances { width: number(), gain: number() };
    any(PrecedenceTable::check(&mut orders, fleet, progress, any(tolerances), reaches).is_ok());
    if let Some(&motion) = any(fleet.first()) {
        let mission = PathProposal { agent, motion, progress: any(Progress::at_rest(number())) };
        any(PrecedenceTable::admit(&mut orders, fleet, progress, any(mission), tolerances, reaches, |_| {
            any(PassingState::First)
        })
        .is_ok());
        any(PrecedenceTable::admit_all(
            &mut orders,
            fleet,
            progress,
            any(&mut [mission; 2]),
            tolerances,
            reaches,
            |_| any(PassingState::First),
        )
        .is_ok());
        any(PrecedenceTable::admit_longest(
            &mut orders,
            fleet,
            progress,
            any(mission),
            any(&[motion; 2]),
            tolerances,
            reaches,
            |_| any(PassingState::First),
        )
        .is_ok());
    }
    let Ok::<MovementAuthority<S>, MismatchError>(hold) = PrecedenceTable::hold(&orders, fleet, agent, progress) else {
        return;
    };
    any(PrecedenceTable::hold_before(&orders, fleet, agent, progress, any(hold)).is_ok());
    any((
        MovementAuthority::allows(hold, number()),
        MovementAuthority::min(hold, any(hold)),
        MovementAuthority::length(hold, number()),
    ));
    any(PrecedenceTable::row(&orders, fleet, agent)).into_iter().flatten().for_each(|(place, region, pass)| {
        any((place, pass));
        regions(&region);
    });
    any(PrecedenceTable::wait(&orders, fleet, agent, progress).is_ok());
    any(PrecedenceTable::decisions(&orders).map(|decision: PrecedenceDecision<S>| decision.since).reduce(S::max));
    any(PrecedenceTable::ecm(&orders).len());
    any(PrecedenceTable::passed(&mut orders, progress));
    any(PrecedenceTable::remove(&mut orders, fleet, agent).is_ok());
    any(PrecedenceTable::erase(&mut orders, fleet, agent).is_ok());
    any(PrecedenceTable::fill(&mut orders, fleet).is_ok());
    PrecedenceTable::begin_fill(&mut orders, fleet);
    any(PrecedenceTable::fill_pairs(&mut orders, fleet, any(1)).is_ok());
    let mut copy = any(PrecedenceTable::new([EcmEntry::EMPTY; 4], [Piece::EMPTY; 8], [RegionPrecedence::EMPTY; 4]));
    any(PrecedenceTable::copy_from(&mut copy, &orders).is_ok());
    any(PrecedenceTable::needed(&mut copy, fleet).is_ok());
    any(PrecedenceTable::ecm(&copy).len());
    if let Some(&motion) = any(fleet.first()) {
        any(PrecedenceTable::replace(&mut orders, fleet, agent, motion).is_ok());
    }
    PrecedenceTable::clear(any(&mut orders));
}

#[inline(never)]
fn brakes<S: Scalar>() -> Result<(), InvalidInput> {
    let brakes = any(BrakingModel::<S>::new(number(), number())?);
    any((BrakingModel::distance(&brakes, number()), BrakingModel::speed(&brakes, number())));
    Ok(())
}

/// Functions that only the formats of pcr-fixed have.
#[cfg(any(feature = "q12", feature = "q16", feature = "q20"))]
#[inline(never)]
fn fixed() {
    type Product = <Number as Scalar>::Wide;
    type Sine = <Number as Scalar>::Unit;
    type Turns = <Number as Scalar>::Angle;
    any((Number::to_bits(Number::from_bits(any(0))), Product::to_bits(Product::from_bits(any(0)))));
    any((Sine::to_bits(Sine::from_bits(any(0))), Turns::to_bits(Turns::from_bits(any(0)))));
    shown::<Number>(number());
    shown::<pcr_fixed::OutOfRange>(any(pcr_fixed::OutOfRange));
}

/// Takes text and forgets it.
struct Nowhere;

impl Write for Nowhere {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        any(text);
        Ok(())
    }
}

#[inline(never)]
fn messages<S: Scalar>() {
    shown::<InvalidInput>(any(InvalidInput::Full("")));
    shown::<CapacityError>(any(CapacityError::Pair([0, 0])));
    shown::<MismatchError>(any(MismatchError::OtherFleet));
    shown::<EcmError>(any(<EcmError as From<CapacityError>>::from(any(CapacityError::Agents))));
    shown::<FleetStorageError>(any(FleetStorageError::NoSuchAgent(0)));
    shown::<PlanError>(any(<PlanError as From<MismatchError>>::from(any(MismatchError::NoSuchAgent(0)))));
    shown::<SpeedPlanError<S>>(any(<SpeedPlanError<S> as From<InvalidInput>>::from(any(
        InvalidInput::SweepOverOneTurn,
    ))));
    shown::<AdmissionError>(any(<AdmissionError as From<EcmError>>::from(any(EcmError::Full(
        CapacityError::Orders { needed: any(1), capacity: any(0) },
    )))));
    shown::<PieceType>(any(PieceType::SS));
}

#[inline(never)]
fn shown<T: Display>(value: T) {
    any(write!(Nowhere, "{value}").is_ok());
}
