//! Tables of random pairs that the checker has not proved once, by their seeds: those of the long command of `certify.rs`.

use pcr_certify::pair::TableProperty;
use pcr_certify::raw::RawTable;
use pcr_certify::table::{Checker, CoverageMargin};
use pcr_core::scalar::Micro;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::certified::{run, table};
use pcr_tests::generators::certifiable;

fn is_proved_of<S: HostScalar>(seeds: &[u64]) {
    for &seed in seeds {
        let proofs = run::<S>(seed, 1);
        assert_eq!(proofs.proved, 1, "{} of {}: {proofs:?}", seed, S::NAME);
    }
}

/// A disc as large as the circle but for rounding, arcs of half a turn, paths of hundreds of segments, and points opposite to the middle
/// of an arc, in a direction whose part across is a negative zero. From 10 million pairs a format: circles that are covered from both sides,
/// an agent that creeps, and pieces that are joined beside the centre of an arc as large as the disc.
#[test]
fn tables_that_were_not_proved_once_are() {
    is_proved_of::<f64>(&[6, 1362, 451_139, 692_692, 2_843_574, 7_793_789, 9_130_518, 9_625_657]);
    is_proved_of::<f32>(&[
        6, 16, 53, 68, 188, 6825, 12872, 25920, 2_152_914, 2_244_704, 3_507_630, 4_163_925, 5_905_206, 8_817_141,
        9_369_245, 9_625_657, 9_734_389,
    ]);
    is_proved_of::<Micro>(&[
        1_671_629, 2_152_914, 4_163_925, 4_836_374, 5_905_206, 6_383_398, 7_501_974, 7_719_494, 9_369_245, 9_625_657,
        9_863_701,
    ]);
    is_proved_of::<Q20>(&[16, 68, 188, 4698, 59166]);
    is_proved_of::<Q16>(&[35497, 65178, 86630]);
    is_proved_of::<Q12>(&[3285, 13525, 27854, 52685, 66637, 89197, 134_448]);
}

/// The seeds of one format at which a table is proved, but would be refuted if a query could ask at any real length.
fn is_proved_of_lengths_of_the_format<S: HostScalar>(seeds: &[u64]) {
    is_proved_of::<S>(seeds);
    for &seed in seeds {
        let (pair, drives) = certifiable::<S>(seed);
        let mut table = table::<S>(&pair, &drives).expect("it fits");
        // Of the paths alone: motions that are rounded as in fixed point are none of floating point.
        table.agents.iter_mut().for_each(|agent| (agent.path.step, agent.travel) = (0.0, None));
        table.pairs[0].regions.iter_mut().for_each(|region| region.times = None);
        let found = Checker::new(&table).and_then(|checker| checker.check(CoverageMargin::Needed)).expect("a table");
        let is_about_shares = found.refuted.iter().all(|witness| witness.promise == TableProperty::Shared);
        assert!(!found.refuted.is_empty() && is_about_shares, "{seed} of {}: {found:?}", S::NAME);
    }
}

/// A foot may pass the middle of an arc between two lengths of the format, where no query looks. From 10 million pairs a format.
#[test]
fn lengths_that_the_format_does_not_have_do_not_count() {
    is_proved_of_lengths_of_the_format::<Q20>(&[
        1_666_949, 1_753_926, 2_467_158, 3_348_909, 3_928_645, 4_601_742, 5_268_973, 5_825_238, 5_998_477, 6_600_061,
        6_656_222, 7_531_501, 8_864_782,
    ]);
    is_proved_of_lengths_of_the_format::<Q16>(&[
        478_853, 1_488_606, 2_381_446, 2_568_590, 2_632_837, 3_170_253, 3_239_158, 3_484_469, 3_948_765, 6_289_013,
        7_064_677, 7_801_957, 8_760_413, 9_433_014, 9_484_141,
    ]);
    is_proved_of_lengths_of_the_format::<Q12>(&[
        436_727, 1_003_637, 1_770_406, 2_071_694, 4_265_045, 4_424_645, 5_672_077, 7_163_030, 7_164_773, 7_244_885,
        7_747_614, 8_906_877, 9_338_278,
    ]);
}

#[test]
fn numbers_that_the_format_does_not_have_are_refused() {
    let (pair, drives) = certifiable::<Q16>(478_853);
    let table = table::<Q16>(&pair, &drives).expect("it fits");
    let wrong = |change: &dyn Fn(&mut RawTable)| {
        let mut other = table.clone();
        change(&mut other);
        Checker::new(&other)
            .and_then(|checker| checker.check(CoverageMargin::Needed))
            .expect_err("is refused")
            .to_string()
    };
    let finer = 2.0_f64.powi(-17);
    assert!(wrong(&|it| it.pairs[0].pieces[0].lengths[0][1] -= finer).contains("ends that its number format has not"));
    assert!(wrong(&|it| it.agents[0].path.segments[0].length -= finer).contains("off by"));
    assert!(wrong(&|it| it.agents[0].path.step = 0.125).contains("no multiples"));
    for step in [3.0 * finer, -finer, 2.0, f64::NAN, f64::INFINITY] {
        assert!(wrong(&|it| it.agents[0].path.step = step).contains("none of a fixed-point format"));
    }
}
