//! Finds the regions of pairs of single segments again and again, for profilers: `segments KINDS BODY TIMES`.
//!
//! KINDS are `lines` (2 m), `arcs` (quarters with radii of 0.5 to 2 m) or `both` (a line and an arc), at positions of up to 1.5 m. BODY is a
//! `rectangle` of 1.2 m x 0.8 m, or the `disc` around it. Prints the number of pairs and of pieces of both directions.

use pcr_core::{Ecm, EcmEntry, Motion, Outline, Path, Piece, Point, Pose, Profile, Radians, TurnSide, Vector};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::hint::black_box;
use std::process::ExitCode;

const PAIRS: usize = 200;

/// Numbers from 0 to 1 that are the same in each run.
struct Random(u64);

impl Random {
    fn within(&mut self, lo: f64, hi: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        lo + (hi - lo) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn segment(&mut self, arc: bool) -> Result<Path<f64, 1>, pcr_core::InvalidInput> {
        let position = Point::new(self.within(-1.5, 1.5), self.within(-1.5, 1.5));
        let path = Path::starting_at(Pose { position, heading: Radians(self.within(0.0, TAU)) })?;
        if !arc {
            return path.line(2.0);
        }
        let (radius, side) = (self.within(0.5, 2.0), [TurnSide::Left, TurnSide::Right]);
        path.arc(radius, side[usize::from(self.within(0.0, 1.0) < 0.5)], radius * FRAC_PI_2)
    }
}

fn run(kinds: [bool; 2], rectangle: bool, times: u32) -> Result<(), Box<dyn std::error::Error>> {
    let mut random = Random(1);
    let corners = [(-0.6, -0.4), (0.6, -0.4), (0.6, 0.4), (-0.6, 0.4)].map(|(x, y)| Vector { x, y });
    let outline = Outline::<f64, 4>::polygon(corners, 0.0)?;
    let paths: Result<Vec<_>, _> =
        (0..PAIRS).map(|_| Ok([random.segment(kinds[0])?, random.segment(kinds[1])?])).collect();
    let paths: Vec<[Path<f64, 1>; 2]> = paths.map_err(|error: pcr_core::InvalidInput| error)?;
    let profiles = paths
        .iter()
        .map(|pair| pair.each_ref().map(|path| Profile::<f64, 1>::from_pieces(1.0, [(path.as_path().length(), 0.0)])));
    let profiles: Vec<_> = profiles.map(|[a, b]| Ok([a?, b?])).collect::<Result<_, pcr_core::InvalidInput>>()?;
    let motion = |k: usize, of: usize| {
        let (path, profile) = (paths[k][of].as_path(), profiles[k][of].as_profile());
        if rectangle {
            Motion::with_outline(path, profile, &outline, 0.0)
        } else {
            Motion::new(path, profile, 0.52_f64.sqrt(), 0.0)
        }
    };
    let fleets: Vec<[Motion<'_, f64>; 2]> =
        (0..PAIRS).map(|k| Ok([motion(k, 0)?, motion(k, 1)?])).collect::<Result<_, pcr_core::InvalidInput>>()?;
    // Kept from pair to pair: to make it takes longer than the regions of two lines.
    let (mut entries, mut pieces) = ([EcmEntry::EMPTY; 32], [Piece::EMPTY; 128]);
    let mut count = 0;
    for round in 0..=times {
        for fleet in &fleets {
            let ecm = Ecm::build(&mut entries[..], &mut pieces[..], black_box(fleet))?;
            count += usize::from(round == 0) * black_box(ecm.pieces());
        }
    }
    println!("{PAIRS} {count}");
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let asked = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [kinds @ ("lines" | "both" | "arcs"), body @ ("disc" | "rectangle"), times] => {
            times.parse().ok().map(|times| ([kinds == "arcs", kinds != "lines"], body == "rectangle", times))
        }
        _ => None,
    };
    let Some((kinds, rectangle, times)) = asked else {
        eprintln!("segments lines|both|arcs disc|rectangle TIMES");
        return ExitCode::from(2);
    };
    match run(kinds, rectangle, times) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
