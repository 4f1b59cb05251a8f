//! Agents that are built, tried, added, replaced and removed.

use super::*;
use crate::geometry::Point;
use crate::outline::Outline;
use crate::path::Path;
use crate::scalar::Radians;
use core::f64::consts::FRAC_PI_2;

type Storage<'o> = FleetStorage<'o, f64, 3, 8>;
const LIMITS: Limits<f64> = Limits { speed: 1.0, acceleration: 0.5 };

fn pose(x: f64, y: f64) -> Pose<f64> {
    Pose { position: Point::new(x, y), heading: Radians(0.25) }
}

/// What regions and queries depend on.
fn same(motion: &Motion<'_, f64>, other: &Motion<'_, f64>) -> bool {
    motion.path().segments() == other.path().segments()
        && motion.profile().phases() == other.profile().phases()
        && motion.outline().corners() == other.outline().corners()
        && (motion.digest(0), motion.time(), motion.radius(), motion.lag())
            == (other.digest(0), other.time(), other.radius(), other.lag())
}

/// A line of `length`, at this `y`.
fn add(storage: &mut Storage<'_>, y: f64, length: f64) -> Result<usize, InvalidInput> {
    storage.start_at(pose(0.0, y))?.line(length)?.rest_to_rest(LIMITS)?.disc(0.25, y)?.add()
}

fn places<const A: usize>(storage: &FleetStorage<'_, f64, A, 8>) -> Vec<(f64, f64), 3> {
    let mut fleet = FleetMotions::new();
    fleet.fill(storage);
    fleet.iter().map(|motion| (motion.time().lo, motion.path().length())).collect()
}

#[test]
fn agents_are_those_of_paths_with_storage_of_their_own() {
    let truck = Outline::<f64, 4>::rectangle(0.6, 0.3, 0.4, 0.4, 0.0).unwrap();
    let mut storage = Storage::new();
    let start = storage.start_at(pose(1.0, 2.0)).unwrap();
    let path = start.line(0.0).unwrap().line(2.0).unwrap().reverse().unwrap().line(1.0).unwrap();
    let path = path.arc_by(1.5, -FRAC_PI_2).unwrap().pivot(0.5, FRAC_PI_2).unwrap();
    let staged = path.rest_to_rest(LIMITS).unwrap().outline(&truck, 3.0).unwrap();

    let path = Path::<f64, 5>::starting_at(pose(1.0, 2.0)).unwrap().line(2.0).unwrap().reverse().unwrap();
    let path = path.line(1.0).unwrap().arc_by(1.5, -FRAC_PI_2).unwrap().pivot(0.5, FRAC_PI_2).unwrap();
    let profile = Profile::rest_to_rest(path.as_path().length(), LIMITS).unwrap();
    let own = Motion::with_outline(path.as_path(), profile.as_profile(), &truck, 3.0).unwrap();
    assert!(same(&staged.motion(), &own));
    assert_eq!(staged.add(), Ok(0));
    assert!(same(&storage.motion(0).unwrap(), &own));

    // One that stands, sideways, and one of segments from a list.
    let stands = storage.start_at(pose(9.0, 9.0)).unwrap().facing(Radians(1.0)).unwrap();
    assert_eq!(stands.outline(&truck, 0.0).unwrap().add(), Ok(1));
    let path = Path::<f64, 1>::starting_at(pose(9.0, 9.0)).unwrap().facing(Radians(1.0)).unwrap();
    let stands = Profile::<f64, 1>::standing();
    let own = Motion::with_outline(path.as_path(), stands.as_profile(), &truck, 0.0).unwrap();
    assert!(same(&storage.motion(1).unwrap(), &own));
    let steps = [(Curve::Line, 1.0), (Curve::Arc { radius: 2.0, turn: TurnSide::Left }, 1.0)];
    let start = storage.start_at(pose(0.0, 0.0)).unwrap();
    let path = steps.iter().try_fold(start, |path, &(curve, length)| path.segment(curve, length)).unwrap();
    let profile = Profile::<f64, 1>::from_pieces(1.0, [(2.0, 0.0)]).unwrap();
    assert_eq!(path.profile(profile.as_profile()).unwrap().disc(0.5, 0.0).unwrap().add(), Ok(2));
    assert_eq!(storage.motion(2).unwrap().path().segments().len(), 2);
}

#[test]
fn agents_that_are_not_added_leave_nothing_behind() {
    let mut storage = Storage::new();
    add(&mut storage, 0.0, 1.0).unwrap();
    for _ in 0..20 {
        let built = storage.start_at(pose(0.0, 5.0)).unwrap().line(1.0).unwrap().turn(Radians(1.0)).unwrap();
        let built = built.line(1.0).unwrap().line(1.0).unwrap();
        assert!(built.line(f64::NAN).is_err());
        // A path that has no profile, and a profile that has no path.
        let built = storage.start_at(pose(0.0, 5.0)).unwrap().line(1.0).unwrap();
        assert!(matches!(built.disc(0.5, 0.0).err(), Some(InvalidInput::LengthMismatch { .. })));
        let built = storage.start_at(pose(0.0, 5.0)).unwrap().rest_to_rest(LIMITS).unwrap();
        assert!(built.line(1.0).unwrap().disc(0.5, 0.0).is_err());
        let built = storage.start_at(pose(0.0, 5.0)).unwrap();
        let _ = built.disc(0.5, 0.0).unwrap();
    }
    assert_eq!(places(&storage)[..], [(0.0, 1.0)]);
    add(&mut storage, 1.0, 2.0).unwrap();
    assert_eq!(places(&storage)[..], [(0.0, 1.0), (1.0, 2.0)]);
}

#[test]
fn agents_are_replaced_removed_and_delayed() {
    let mut storage = Storage::new();
    for (y, length) in [(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)] {
        add(&mut storage, y, length).unwrap();
    }
    let long = |storage: &mut Storage<'_>, agent| {
        let path = storage.start_at(pose(0.0, 7.0))?.line(2.0)?.arc_by(1.0, 1.0)?.line(3.0)?;
        path.rest_to_rest(LIMITS)?.disc(0.25, 7.0)?.replace(agent)
    };
    assert_eq!(long(&mut storage, 3), Err(FleetStorageError::NoSuchAgent(3)));
    assert_eq!(places(&storage)[..], [(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)]);
    long(&mut storage, 0).unwrap();
    assert_eq!(places(&storage)[..], [(7.0, 6.0), (1.0, 2.0), (2.0, 3.0)]);
    assert_eq!(storage.delay(1, 0.5), Ok(Interval::new(1.5, 5.5)));
    assert_eq!(storage.delay(3, 0.5), Err(FleetStorageError::NoSuchAgent(3)));
    assert!(matches!(storage.delay(1, f64::MAX), Err(FleetStorageError::Invalid(_))));
    storage.remove(1).unwrap();
    assert_eq!(storage.remove(2), Err(FleetStorageError::NoSuchAgent(2)));
    assert_eq!(places(&storage)[..], [(7.0, 6.0), (2.0, 3.0)]);
    long(&mut storage, 1).unwrap();
    storage.remove(0).unwrap();
    assert_eq!(places(&storage)[..], [(7.0, 6.0)]);
    storage.clear();
    assert!(storage.is_empty() && places(&storage).is_empty());
}

#[test]
fn what_does_not_fit_is_refused_and_changes_nothing() {
    let mut storage = FleetStorage::<f64, 1, 8, 2>::new();
    let path = storage.start_at(pose(0.0, 0.0)).unwrap().line(4.0).unwrap();
    assert_eq!(path.rest_to_rest(LIMITS).err(), Some(InvalidInput::Full("phase")));
    let mut storage = FleetStorage::<f64, 1, 8>::new();
    let fits = |storage: &mut FleetStorage<'_, f64, 1, 8>, segments: usize| {
        let start = storage.start_at(pose(0.0, 0.0))?;
        let path = (0..segments).try_fold(start, |path, _| path.line(1.0))?;
        path.rest_to_rest(LIMITS)?.disc(0.25, 0.0)?.add()
    };
    assert_eq!(fits(&mut storage, 9), Err(InvalidInput::Full("segment")));
    assert!(storage.is_empty());
    assert_eq!(fits(&mut storage, 7), Ok(0));
    assert_eq!(fits(&mut storage, 1), Err(InvalidInput::Full("agent")));
    assert_eq!(fits(&mut storage, 2), Err(InvalidInput::Full("segment")));
    assert_eq!(places(&storage)[..], [(0.0, 7.0)]);
}

#[test]
fn motions_may_have_margins_and_are_filled_again() {
    let mut storage = Storage::new();
    add(&mut storage, 0.0, 1.0).unwrap();
    let mut fleet = FleetMotions::new();
    fleet.fill(&storage);
    for motion in &mut *fleet {
        *motion = motion.with_margin(0.1).unwrap();
    }
    assert_eq!(fleet[0].margin(), 0.1);
    fleet.fill(&storage);
    assert_eq!((fleet.len(), fleet[0].margin()), (1, 0.0));
}
