//! A program for a controller without an FPU: all memory is static, and every number is in fixed point. The same
//! program runs on a desktop:
//!
//! ```text
//! cargo run -p pcr-fixed --example no_fpu
//! ```

use pcr_core::{
    Ecm, EcmEntry, InvalidInput, Limits, Motion, Path, Piece, Point, Pose, Profile, TurnSide, earliest_start,
};
use pcr_fixed::{Q16, Turns};

/// The decision of the controller; it outputs nothing else.
#[derive(Debug)]
enum Decision {
    /// Set off later by this time \[s\].
    Start(Q16),
    /// No start is late enough.
    Never,
    /// The table is too small, or a path is invalid: stop and report it.
    Fault,
}

/// Conversion from `f64` is for tests and tables only; a controller receives the bits.
fn q(metres: f64) -> Q16 {
    Q16::from_f64(metres).expect("within 32768 m")
}

fn path(x: f64, y: f64, heading: Turns) -> Result<Path<Q16, 2>, InvalidInput> {
    let start = Pose { position: Point::new(q(x), q(y)), heading };
    Path::starting_at(start)?.line(q(3.0))?.arc(q(2.0), TurnSide::Right, q(2.5))
}

fn decide(table: &mut Ecm<Q16, [EcmEntry; 8], [Piece<Q16>; 16]>) -> Result<Decision, InvalidInput> {
    let quarter = Turns::from_bits(1 << 30);
    let paths = [path(-4.0, 0.0, Turns::from_bits(0))?, path(0.0, -4.0, quarter)?];
    let limits = Limits { speed: q(1.0), acceleration: q(0.5) };
    let profile = Profile::rest_to_rest(paths[0].as_path().length(), limits)?;
    let motion = |path| Motion::new(path, profile.as_profile(), q(0.4), q(0.0));
    let fleet = [motion(paths[0].as_path())?.for_plan()?, motion(paths[1].as_path())?.for_plan()?];
    // A table that is full, or that of another fleet, is a fault and never an empty answer.
    if table.fill(&fleet).is_err() {
        return Ok(Decision::Fault);
    }
    let Ok(row) = table.row(&fleet, 1) else {
        return Ok(Decision::Fault);
    };
    Ok(earliest_start(row, q(0.0)).map_or(Decision::Never, Decision::Start))
}

fn main() {
    // On a controller this would be a `static`, to keep it off the stack.
    let mut table = Ecm::new([EcmEntry::EMPTY; 8], [Piece::EMPTY; 16]);
    match decide(&mut table).unwrap_or(Decision::Fault) {
        Decision::Start(delay) => {
            println!("set off {:.3} s later ({} bytes of table)", delay.to_f64(), size_of_val(&table))
        }
        other => println!("{other:?}"),
    }
}
