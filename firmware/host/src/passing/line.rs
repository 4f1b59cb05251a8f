//! The line between the robots and the supervisor, and its faults.

use super::drawn::Random;
use super::tally::Tally;

/// One direction of the line.
#[derive(Default)]
pub(super) struct Way {
    arriving: Vec<Vec<u8>>,
    /// Frames that come late: so many steps.
    late: Vec<(usize, Vec<u8>)>,
}

impl Way {
    /// Sends a frame; `bad` of 1000 suffer each kind of fault.
    pub(super) fn send(&mut self, frame: &[u8], random: &mut Random, bad: usize, tally: &mut Tally) {
        tally.frames += 1;
        let mut frame = frame.to_vec();
        let before = (frame.clone(), self.late.len());
        if random.chance(bad) {
            tally.faults += 1;
            return;
        }
        if random.chance(bad) {
            self.late.push((1 + random.below(40), frame.clone()));
        }
        if random.chance(bad) {
            frame.truncate(random.below(frame.len()));
        }
        if random.chance(bad) && !frame.is_empty() {
            let at = random.below(frame.len());
            frame[at] ^= 1 << random.below(8);
        }
        tally.faults += usize::from((&frame, self.late.len()) != (&before.0, before.1));
        if random.chance(bad) {
            tally.faults += 1;
            self.late.push((1 + random.below(8), frame));
        } else {
            // Before one of those that are under way, or behind all.
            let place = if random.chance(bad) { random.below(self.arriving.len() + 1) } else { self.arriving.len() };
            self.arriving.insert(place, frame);
        }
    }

    /// Takes the frames that arrive now.
    pub(super) fn arrive(&mut self) -> Vec<u8> {
        self.late.iter_mut().for_each(|(steps, _)| *steps -= 1);
        let (due, late) = std::mem::take(&mut self.late).into_iter().partition(|(steps, _)| *steps == 0);
        self.late = late;
        let due: Vec<(usize, Vec<u8>)> = due;
        let arriving = std::mem::take(&mut self.arriving);
        arriving.into_iter().chain(due.into_iter().map(|(_, frame)| frame)).flatten().collect()
    }
}
