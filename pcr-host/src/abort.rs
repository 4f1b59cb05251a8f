//! Aborts: the stack is used up, an allocation failed, or a panic came while another one was handled.
//!
//! The standard library prints what happened and raises SIGABRT. Its handler may do hardly anything, so it wakes a thread and then writes
//! into a pipe that is full, which lets it wait until the thread has told what to do.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit status of an abort, the one that shells show for any program.
const ABORTED: i32 = 134;

/// Exit status where memory ran out: the input is too large.
const OUT_OF_MEMORY: i32 = 2;

/// With less memory than this left at the start, an abort is taken for a lack of memory, and no thread is started \[bytes\].
const SCARCE: u64 = 1 << 30;

/// If this cannot be allocated, memory has run out \[bytes\].
const TRIED: usize = 64 << 20;

/// Sets the exit status of aborts, and what is printed with it; `left` is the memory that the process may still use \[bytes\].
#[cfg(unix)]
pub(crate) fn watch(left: Option<u64>) {
    use signal_hook::consts::SIGABRT;
    use signal_hook::flag::register_conditional_shutdown;
    let is_scarce = left.is_some_and(|left| left < SCARCE);
    let out_of_memory = Arc::new(AtomicBool::new(is_scarce));
    if !is_scarce {
        // Without the thread the status has to do.
        let _ = tell(Arc::clone(&out_of_memory));
    }
    // Where a signal cannot be caught, it ends the program as it does others; no file is damaged by that.
    let _ = register_conditional_shutdown(SIGABRT, OUT_OF_MEMORY, out_of_memory);
    let _ = register_conditional_shutdown(SIGABRT, ABORTED, Arc::new(AtomicBool::new(true)));
}

#[cfg(not(unix))]
pub(crate) fn watch(_left: Option<u64>) {}

/// Starts the thread that tells of an abort, and makes the handler wait for it.
#[cfg(unix)]
fn tell(out_of_memory: Arc<AtomicBool>) -> std::io::Result<()> {
    use rustix::fs::{OFlags, fcntl_setfl};
    use signal_hook::consts::SIGABRT;
    use signal_hook::low_level::pipe;
    use std::io::{Read, Write, pipe as new_pipe};
    let (mut woken, wake) = new_pipe()?;
    let (mut full, mut hold) = new_pipe()?;
    fcntl_setfl(&hold, OFlags::NONBLOCK)?;
    while hold.write(&[0; 4096]).is_ok() {}
    let watch = move || {
        if woken.read_exact(&mut [0]).is_err() {
            return;
        }
        let is_out = Vec::<u8>::new().try_reserve_exact(TRIED).is_err();
        out_of_memory.store(is_out, Ordering::SeqCst);
        let text = if is_out { MEMORY } else { FAULT };
        // Not by way of the standard library: whoever aborts may hold its lock.
        let _ = rustix::io::write(rustix::stdio::stderr(), text.as_bytes());
        while full.read(&mut [0; 4096]).is_ok_and(|bytes| bytes > 0) {}
    };
    std::thread::Builder::new().name("abort".into()).stack_size(1 << 16).spawn(watch)?;
    pipe::register(SIGABRT, wake)?;
    pipe::register(SIGABRT, hold.try_clone()?)?;
    // It has been set anew for the handler; both are one pipe.
    fcntl_setfl(&hold, OFlags::empty())?;
    Ok(())
}

#[cfg(unix)]
const MEMORY: &str = "pcr: memory ran out; allow the process more of it (ulimit -v), or give it a smaller file\n";

#[cfg(unix)]
const FAULT: &str = "pcr: this is a fault of pcr, unless the line above says that memory ran out; please report that line with the \
                     command, its files and the answer of pcr --version\n";
