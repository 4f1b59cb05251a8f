//! A client has so many lines without an answer at most; then nothing more of it is read until it has read answers. So a client that asks
//! and does not read, or asks all the time, does not keep the others waiting.

use std::sync::{Arc, Condvar, Mutex, PoisonError};

/// Lines of a client without an answer at most. Those of all clients are decided together, and a fleet of 1,000 robots that says all
/// positions over one connection needs some tens of them.
pub(crate) const MOST: usize = 64;

/// The lines of a client without an answer.
#[derive(Clone, Debug, Default)]
pub(crate) struct UnansweredLines(Arc<(Mutex<usize>, Condvar)>);

impl UnansweredLines {
    /// Adds a line; waits while there are too many.
    pub(crate) fn add(&self) -> UnansweredLine {
        let (count, fewer) = &*self.0;
        let mut lines = count.lock().unwrap_or_else(PoisonError::into_inner);
        while *lines >= MOST {
            lines = fewer.wait(lines).unwrap_or_else(PoisonError::into_inner);
        }
        *lines += 1;
        UnansweredLine(self.clone())
    }
}

/// A line without an answer. It is none any more when this is dropped: when its answer is on its way to the client, or will never be.
#[derive(Debug)]
pub struct UnansweredLine(UnansweredLines);

impl Drop for UnansweredLine {
    fn drop(&mut self) {
        let (count, fewer) = &*self.0.0;
        *count.lock().unwrap_or_else(PoisonError::into_inner) -= 1;
        fewer.notify_one();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;
    use std::time::Duration;

    #[test]
    fn a_line_waits_until_another_one_has_its_answer() {
        let lines = UnansweredLines::default();
        let mut all: Vec<UnansweredLine> = (0..MOST).map(|_| lines.add()).collect();
        let (sender, added) = channel();
        let own = lines.clone();
        let other = std::thread::spawn(move || sender.send(own.add()).unwrap());
        assert!(added.recv_timeout(Duration::from_millis(50)).is_err());
        all.pop();
        let _line = added.recv().unwrap();
        other.join().unwrap();
    }
}
