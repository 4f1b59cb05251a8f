//! The storage of a fleet, changed at random, holds the agents of a list that is changed in the same way.

use pcr_core::{
    Curve, FleetMotions, FleetStorage, InvalidInput, Limits, Motion, Path, Point, Pose, Profile, Radians, StagedAgent,
    TurnSide,
};
use pcr_fixed::Q16;
use pcr_formats::splitmix64::SplitMix64;

const AGENTS: usize = 5;
const SEGMENTS: usize = 24;
const LIMITS: Limits<f64> = Limits { speed: 1.0, acceleration: 0.5 };

type Storage = FleetStorage<'static, f64, AGENTS, SEGMENTS>;

/// What an agent is built of.
#[derive(Clone, Debug)]
struct Description {
    pose: Pose<f64>,
    steps: Vec<(Curve<f64>, f64)>,
    start: f64,
}

impl Description {
    fn random(random: &mut SplitMix64) -> Self {
        let mut below = |count: usize| (random.unit() * count as f64) as usize;
        let pose = Pose { position: Point::new(below(9) as f64, below(9) as f64), heading: Radians(below(7) as f64) };
        let steps = (0..below(9)).map(|_| {
            let turn = if below(2) == 0 { TurnSide::Left } else { TurnSide::Right };
            let curve = match below(3) {
                0 => Curve::Line,
                1 => Curve::Arc { radius: 1.0, turn },
                _ => Curve::Pivot { lever: 0.5, turn },
            };
            // Some of no length, and some that no constructor takes.
            (curve, [0.0, 0.5, 1.0, 2.0, 3.0, -1.0][below(6).max(below(5))])
        });
        let steps = steps.collect();
        Self { pose, steps, start: below(5) as f64 }
    }

    fn stage<'f>(
        &self,
        storage: &'f mut Storage,
    ) -> Result<StagedAgent<'f, 'static, f64, AGENTS, SEGMENTS, 3>, InvalidInput> {
        let mut path = storage.start_at(self.pose)?;
        for &(curve, length) in &self.steps {
            path = path.segment(curve, length)?;
        }
        path.rest_to_rest(LIMITS)?.disc(0.25, self.start)
    }

    /// The same agent, in storage of its own; `None` if no constructor takes it.
    fn of_its_own(&self) -> Option<(Path<f64, 16>, Profile<f64, 3>)> {
        let path =
            self.steps.iter().try_fold(Path::starting_at(self.pose).ok()?, |path, &(curve, length)| match curve {
                Curve::Line => path.line(length),
                Curve::Arc { radius, turn } => path.arc(radius, turn, length),
                // A negative length would make a sweep to the other side.
                Curve::Pivot { .. } if length < 0.0 => path.line(length),
                Curve::Pivot { lever, turn } => {
                    path.pivot(lever, if turn == TurnSide::Left { length / lever } else { -length / lever })
                }
            });
        let path = path.ok()?;
        let profile = Profile::rest_to_rest(path.as_path().length(), LIMITS).ok()?;
        Some((path, profile))
    }

    fn segments(&self) -> usize {
        self.steps.iter().filter(|(_, length)| *length > 0.0).count().max(1)
    }
}

fn agree(storage: &Storage, list: &[Description]) {
    let mut fleet = FleetMotions::new();
    fleet.fill(storage);
    assert_eq!((fleet.len(), storage.len()), (list.len(), list.len()));
    for (k, (motion, description)) in fleet.iter().zip(list).enumerate() {
        let (path, profile) = description.of_its_own().expect("valid");
        let own = Motion::new(path.as_path(), profile.as_profile(), 0.25, description.start).expect("valid");
        assert_eq!(motion.path().segments(), own.path().segments());
        assert_eq!(motion.profile().phases(), own.profile().phases());
        assert_eq!((motion.time(), motion.radius(), motion.lag()), (own.time(), own.radius(), own.lag()));
        assert_eq!(storage.motion(k).expect("there").path().segments(), own.path().segments());
    }
}

#[test]
fn a_storage_is_changed_as_a_list_is() {
    let mut done = [0_usize; 6];
    for seed in 0..300 {
        let mut random = SplitMix64(seed);
        let (mut storage, mut list) = (Storage::new(), Vec::<Description>::new());
        for _ in 0..60 {
            let choice = (random.unit() * 6.0) as usize;
            let agent = (random.unit() * (AGENTS + 1) as f64) as usize;
            let description = Description::random(&mut random);
            let used: usize = list.iter().map(Description::segments).sum();
            // A path begins with a segment, also if the first line that is not empty takes its place.
            let fits = description.segments() + used <= SEGMENTS;
            let valid = description.of_its_own().is_some();
            match choice {
                0 | 1 => {
                    let added = description.stage(&mut storage).and_then(StagedAgent::add);
                    assert_eq!(added.is_ok(), valid && fits && list.len() < AGENTS, "{description:?}: {added:?}");
                    if let Ok(index) = added {
                        assert_eq!(index, list.len());
                        list.push(description);
                        done[0] += 1;
                    }
                }
                2 | 3 => {
                    let staged = description.stage(&mut storage);
                    assert_eq!(staged.is_ok(), valid && fits, "{description:?}");
                    if let Ok(staged) = staged {
                        let replaced = staged.replace(agent).is_ok();
                        assert_eq!(replaced, agent < list.len());
                        if replaced {
                            list[agent] = description;
                            done[1] += 1;
                        }
                    }
                }
                4 => {
                    let removed = storage.remove(agent).is_ok();
                    assert_eq!(removed, agent < list.len());
                    if removed {
                        list.remove(agent);
                        done[2] += 1;
                    }
                }
                _ => {
                    let delayed = storage.delay(agent, 1.5);
                    assert_eq!(delayed.is_ok(), agent < list.len());
                    if let (Ok(time), Some(description)) = (delayed, list.get_mut(agent)) {
                        description.start += 1.5;
                        assert_eq!(time.lo, description.start);
                        done[3] += 1;
                    }
                    // Tried, and not added.
                    if let Ok(staged) = description.stage(&mut storage) {
                        assert_eq!(staged.motion().time().lo, description.start);
                        done[4] += 1;
                    }
                }
            }
            agree(&storage, &list);
        }
        done[5] = done[5].max(list.len());
    }
    assert!(done[..5].iter().all(|&count| count > 300) && done[5] == AGENTS, "{done:?}");
}

/// Fixed point has no spare digits: what is stored is what was given.
#[test]
fn agents_in_fixed_point_are_stored_bit_by_bit() {
    let q = |value: f64| Q16::from_f64(value).expect("in range");
    let limits = Limits { speed: q(1.0), acceleration: q(0.3) };
    let pose = Pose { position: Point::new(q(1.1), q(-2.3)), heading: pcr_fixed::Turns::QUARTER };
    let mut storage = FleetStorage::<Q16, 1, 2>::new();
    let path = storage.start_at(pose).and_then(|path| path.line(q(1.7))?.arc_by(q(0.9), q(-1.3))).expect("room");
    path.rest_to_rest(limits).and_then(|path| path.disc(q(0.3), q(0.1))?.add()).expect("room");
    let path =
        Path::<Q16, 2>::starting_at(pose).and_then(|path| path.line(q(1.7))?.arc_by(q(0.9), q(-1.3))).expect("room");
    let profile = Profile::rest_to_rest(path.as_path().length(), limits).expect("valid");
    let motion = storage.motion(0).expect("there");
    assert_eq!(motion.path().segments(), path.as_path().segments());
    assert_eq!(motion.profile().phases(), profile.as_profile().phases());
}
