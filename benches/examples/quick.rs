//! q
use pcr_host::fleet::{Fleet, build_ecm};
use pcr_host::scenario::Scenario;
use std::time::Instant;
fn main() {
    for (n, f) in [(12, "paper12"), (100, "table6-100")] {
        let text = std::fs::read_to_string(format!("tests/data/{f}.json")).unwrap();
        let s = Scenario::from_json(&text).unwrap();
        let fleet = Fleet::<f64>::new(&s).unwrap();
        let m = fleet.motions();
        let ecm = build_ecm(&m).unwrap();
        let mut best = f64::MAX;
        let (mut r, mut p) = (vec![pcr_core::Region::EMPTY; ecm.len()], vec![pcr_core::Piece::EMPTY; ecm.pieces()]);
        for _ in 0..std::env::args().nth(1).map_or(200, |a| a.parse().unwrap()) {
            let t = Instant::now();
            let e = pcr_core::Ecm::build(&mut r[..], &mut p[..], &m).unwrap();
            let d = t.elapsed().as_secs_f64();
            assert_eq!(e.len(), ecm.len());
            best = best.min(d);
        }
        println!("{n}: {} regions (x2), {} pieces, {:.1} us", ecm.len(), ecm.pieces(), best * 1e6);
    }
}
