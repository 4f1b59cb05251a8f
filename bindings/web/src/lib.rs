//! `pcr-core` for WebAssembly: a fleet of up to 24 agents, its regions, maps, conflicts, plans and holds. The module
//! uses no heap and has no imports, so any host that runs WebAssembly can load it.
//!
//! The caller writes numbers to [`pcr_input`], calls [`pcr_build`], then the queries. Answers are rows of `f64` at
//! [`pcr_output`]; a call returns the number of rows. A negative result means that there is no answer; [`pcr_message`]
//! says why. An answer with 0 rows always means that there is nothing. Agents are counted from 0 in numbers, from 1 in
//! messages. All arguments are `f64`, so that `undefined`, or a number that is not whole, is not taken for another one.
//!
//! ```text
//! pcr_input()                          -> address of 24 rows of pcr_stride() numbers, one for each agent:
//!                                         x, y, heading, radius, start, v_max, a_max, number of legs, then two for each leg:
//!                                         length, 0 for a line; radius, sweep (left is positive) for an arc; behind
//!                                         room for 32 legs the number of corners, then two for each corner: ahead, left
//! pcr_build(agents)                    -> regions      reads them and computes the table
//! pcr_regions()                        -> rows of 10   ego, other, times, lengths of the ego, lengths of the other (from, to);
//!                                                      1 if the other forbids the same while it stands before, after
//! pcr_map(ego, from, step, times)      -> rows of 4    index of the time, other, lengths that are forbidden then (from, to)
//! pcr_conflicts()                      -> rows of 10   both agents, times, depth, 1 if they only touch, lengths of both
//! pcr_places(time)                     -> rows of 6    x, y, heading, travelled length, length of the path, arrival
//! pcr_track(agent, from, step, times)  -> rows of 1    travelled length at these times
//! pcr_plan()                           -> rows of 1    delay of each agent's start so that none collide
//! pcr_holds(time)                      -> rows of 1    how far each agent may go in the order of the motions, if the others stop now
//! pcr_first(), pcr_last()              -> first start, last arrival; NaN without a fleet
//! pcr_output()                         -> address of the answer
//! pcr_message(), pcr_message_length()  -> address and length of the last message, UTF-8
//! ```
//!
//! Units: metres, seconds, radians. `bindings/web/regions.mjs` is an example to begin with. Results have the same bits
//! as those of the library on any other machine: `bindings/web/check.sh` compares them with the tool's.
#![cfg_attr(target_arch = "wasm32", no_std)]

pub mod agents;
pub mod fleet;
pub mod limits;
pub mod message;

use agents::Input;
use core::cell::UnsafeCell;
use core::fmt::Write;
use fleet::{Fleet, Memory, Rows};
use heapless::String;
use limits::{AGENTS, STRIDE};
use message::Fault;

#[cfg(all(target_arch = "wasm32", not(test)))]
#[panic_handler]
fn panicked(_: &core::panic::PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}

/// The state of a module.
struct State {
    input: Input,
    rows: Rows,
    message: String<256>,
}

/// State for one thread: WebAssembly without the threads proposal has only one, and elsewhere (in tests) the exports
/// must not be called from several threads.
struct Single<T>(UnsafeCell<T>);

// SAFETY: see above; no export calls another one while it holds a reference.
unsafe impl<T> Sync for Single<T> {}

static STATE: Single<State> =
    Single(UnsafeCell::new(State { input: [0.0; AGENTS * STRIDE], rows: Rows::EMPTY, message: String::new() }));
static MEMORY: Single<Memory> = Single(UnsafeCell::new(Memory::NEW));
static FLEET: Single<Option<Fleet<'static>>> = Single(UnsafeCell::new(None));

fn with<T>(act: impl FnOnce(&mut Fleet<'static>, &mut Input, &mut Rows, &mut String<256>) -> T) -> T {
    // SAFETY: these are the only references while the export runs.
    let (State { input, rows, message }, fleet) = unsafe { (&mut *STATE.0.get(), &mut *FLEET.0.get()) };
    // SAFETY: the reference is taken once, when there is no fleet yet, and the fleet keeps it for ever.
    let fleet = fleet.get_or_insert_with(|| Fleet::new(unsafe { &mut *MEMORY.0.get() }));
    act(fleet, input, rows, message)
}

/// Returns the number of rows, or -1 and writes a message.
fn answer(ask: impl FnOnce(&mut Fleet<'static>, &Input, &mut Rows) -> Result<usize, Fault>) -> i32 {
    with(|fleet, input, rows, message| {
        message.clear();
        match ask(fleet, input, rows) {
            Ok(rows) => i32::try_from(rows).unwrap_or(i32::MAX),
            Err(fault) => {
                // A message that does not fit would be cut; all are shorter.
                let _ = write!(message, "{fault}");
                -1
            }
        }
    })
}

/// An index or a number of something, which JavaScript has as an `f64`.
fn whole(number: f64, what: &'static str) -> Result<usize, Fault> {
    let cut = number as u32;
    if f64::from(cut) == number { Ok(cut as usize) } else { Err(Fault::Question(what)) }
}

/// Pointer to the input, where the caller writes agents.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_input() -> *mut f64 {
    with(|_, input, _, _| input.as_mut_ptr())
}

/// Number of `f64` for an agent.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_stride() -> u32 {
    STRIDE as u32
}

/// Pointer to the output, where the caller reads answers.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_output() -> *const f64 {
    with(|_, _, rows, _| rows.numbers().as_ptr())
}

/// Pointer to the last message.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_message() -> *const u8 {
    with(|_, _, _, message| message.as_ptr())
}

/// Length of the last message in bytes; 0 after an answer.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_message_length() -> u32 {
    with(|_, _, _, message| message.len() as u32)
}

/// Reads the agents and computes their regions.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_build(agents: f64) -> i32 {
    answer(|fleet, input, _| match whole(agents, "the number of agents") {
        Ok(agents) => fleet.build(input, agents),
        Err(fault) => {
            fleet.clear();
            Err(fault)
        }
    })
}

/// All regions.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_regions() -> i32 {
    answer(|fleet, _, rows| fleet.regions(rows))
}

/// The collision map of an agent.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_map(ego: f64, from: f64, step: f64, times: f64) -> i32 {
    answer(|fleet, _, rows| fleet.map(rows, whole(ego, "the agent")?, from, step, whole(times, "the number of times")?))
}

/// The conflicts of all pairs.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_conflicts() -> i32 {
    answer(|fleet, _, rows| fleet.conflicts(rows))
}

/// The places of all agents at a time.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_places(time: f64) -> i32 {
    answer(|fleet, _, rows| fleet.places(rows, time))
}

/// The travelled length of an agent at these times.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_track(agent: f64, from: f64, step: f64, times: f64) -> i32 {
    answer(|fleet, _, rows| {
        fleet.track(rows, whole(agent, "the agent")?, from, step, whole(times, "the number of times")?)
    })
}

/// Start delays without conflicts.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_plan() -> i32 {
    answer(|fleet, _, rows| fleet.plan(rows))
}

/// How far each agent may go.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_holds(time: f64) -> i32 {
    answer(|fleet, _, rows| fleet.holds(rows, time))
}

/// The first start \[s\]; NaN without a fleet.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_first() -> f64 {
    with(|fleet, _, _, _| fleet.span().map_or(f64::NAN, |span| span.lo))
}

/// The last arrival \[s\]; NaN without a fleet.
#[unsafe(no_mangle)]
pub extern "C" fn pcr_last() -> f64 {
    with(|fleet, _, _, _| fleet.span().map_or(f64::NAN, |span| span.hi))
}
