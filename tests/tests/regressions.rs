//! Pairs that the library once got wrong, without what does not matter: found by the campaign
//! (`cargo run --release -p pcr-tests --example campaign`), named by its seeds. Here those that went wrong at ends and joints, and in
//! fixed point; `regressions_shared.rs` has those on one line or circle, `regressions_tangent.rs` those that touch a circle.

use pcr_fixed::Q12;
use pcr_tests::audit::{Audit, Seen, Violation};
use pcr_tests::disc::Leg::{Left, Line, Right};
use pcr_tests::disc::{Disc, Leg};
use pcr_tests::oracle::plane::Effort;

const EFFORT: Effort = Effort { resolution: 1e-2, boxes: 10_000, range: 1e-4 };
const SAMPLES: usize = 24;

pub(crate) fn audited(radius: [f64; 2], start: [[f64; 3]; 2], legs: [&[Leg]; 2]) {
    let disc = |k: usize| Disc { radius: radius[k], start: start[k], legs: legs[k].to_vec() };
    let (ego, other) = (disc(0), disc(1));
    let mut seen = Seen::default();
    let exact = Audit::<f64>::new(&ego, &other).and_then(|audit| audit.all(EFFORT, SAMPLES, &mut seen));
    assert_eq!(exact, Ok::<(), Violation>(()), "in f64");
    let (ego, other) = (ego.rounded::<f32>(), other.rounded::<f32>());
    let rounded = Audit::<f32>::new(&ego, &other).and_then(|audit| audit.all(EFFORT, SAMPLES, &mut seen));
    assert_eq!(rounded, Ok::<(), Violation>(()), "in f32");
}

#[test]
fn touching_end_1639() {
    audited(
        [0.3896052120459262, 0.49262781553182394],
        [
            [64.45330774916772, -34.333819529866304, -4.1803603634956055],
            [65.31215154884812, -34.422326325330395, 0.6659394818931714],
        ],
        [&[], &[Left { radius: 0.05830462227867224, length: 0.04979074342408858 }]],
    );
}

#[test]
fn common_end_1317() {
    audited(
        [0.049872265294765454, 0.11902249688845346],
        [
            [1.1001001120173317, 1.7877713842735259, 7.838215635552645],
            [1.100100112017333, 1.787771384273526, 1.0727961878057783],
        ],
        [
            &[Left { radius: 2.623415473668812, length: 16.483405558783453 }],
            &[Left { radius: 1.0235038253118363, length: 6.430864197041432 }],
        ],
    );
}

#[test]
fn lattice_2158() {
    audited(
        [0.026783618761720758, 0.03065395155856055],
        [[0.028718785160140654, 0.0, 0.0], [-1.0408340855860843e-17, -0.028718785160140665, std::f64::consts::TAU]],
        [
            &[Right { radius: 0.05743757032028131, length: 0.1804454489582429 }],
            &[Right { radius: 0.028718785160140654, length: 0.04511136223956073 }],
        ],
    );
}

#[test]
fn common_end_2217() {
    audited(
        [0.0619369950041474, 0.08061355476870835],
        [
            [3.8643911123373513, -1.7149199934733312, 6.09396900344363],
            [4.7220594346839615, -2.9698232602750405, 8.453516189403155],
        ],
        [&[Right { radius: 1.9990784541881905, length: 12.560580371254519 }], &[Line(1.5199924868848707)]],
    );
}

#[test]
fn spiral_2335() {
    audited(
        [0.7193881074537652, 0.6184189901535658],
        [
            [-0.19432764713428707, 0.7438770194130656, -3.540480121483264],
            [0.11413584762426576, 0.4978895600019595, -2.093082615401693],
        ],
        [
            &[Right { radius: 0.2972508620734416, length: 1.8068861265206773 }],
            &[Left { radius: 0.4572207563238118, length: 2.337591720449587 }],
        ],
    );
}

#[test]
fn touching_end_259() {
    audited(
        [0.2337030605539745, 1.2636176316354182],
        [
            [-2.212053105435436, -0.07972649725308378, 4.441023423832247],
            [-2.0484557013567866, -1.6332895130548928, 1.6425380158346914],
        ],
        [
            &[Left { radius: 2.750324438937983, length: 17.2790700249016 }],
            &[Left { radius: 1.9211859175365862, length: 6.0355835647131055 }],
        ],
    );
}

#[test]
fn spiral_315() {
    audited(
        [0.4086833875420253, 0.43911909677092614],
        [
            [2.7881885185894313, -2.3030864017273442, 0.05825910042854754],
            [2.0241036630958797, -3.0249948819924173, 1.6357410436577053],
        ],
        [
            &[Left { radius: 0.4926949238618744, length: 1.9112988235893273 }],
            &[Right { radius: 0.8160504532743504, length: 3.3526987979098277 }],
        ],
    );
}

#[test]
fn touching_end_219() {
    audited(
        [0.19359611482581285, 0.7566999967045652],
        [
            [-35.11118820586899, 15.768999562484677, 2.0503663041451086],
            [-34.06043204978365, 15.713615557872858, 7.270806064045468],
        ],
        [
            &[Right { radius: 2.5361156355436645, length: 15.934884498556372 }],
            &[Left { radius: 0.4939711917964022, length: 2.0783773885711394 }],
        ],
    );
}

#[test]
fn touching_end_3039() {
    audited(
        [0.02039121232600102, 0.11375984368911779],
        [
            [-6.600881175766446, 0.49070268336220746, 1.9811705753496929],
            [-6.6553591919566895, 0.44810525376454197, 2.801489140429084],
        ],
        [&[Left { radius: 0.09831650447011672, length: 0.25944084325330685 }], &[]],
    );
}

/// In fixed point: a slice that rounding takes off the end of the segment that it is at.
#[test]
fn through_centre_34628() {
    let ego = Disc {
        radius: 0.058349609375,
        start: [2.692138671875, -3.323974609375, -1.3929055088368631],
        legs: vec![Left { radius: 0.149169921875, length: 0.937255859375 }],
    };
    let other = Disc {
        radius: 0.091064453125,
        start: [3.01025390625, -2.4921875, -1.7802315440523486],
        legs: vec![Line(0.8232421875), Right { radius: 1.364990234375, length: 0.33349609375 }],
    };
    audited_in_q12(&ego, &other);
}

fn audited_in_q12(ego: &Disc, other: &Disc) {
    let (ego, other) = (ego.rounded::<Q12>(), other.rounded::<Q12>());
    let audit = Audit::<Q12>::new(&ego, &other).and_then(|audit| audit.all(EFFORT, SAMPLES, &mut Seen::default()));
    assert_eq!(audit, Ok::<(), Violation>(()), "in Q12");
}

/// In fixed point: a turning point just beyond the start of a segment, which itself is just out of reach.
#[test]
fn spiral_521795() {
    let ego = Disc {
        radius: 0.039794921875,
        start: [0.475341796875, -0.97314453125, 2.1170197224832448],
        legs: vec![
            Left { radius: 0.964111328125, length: 3.551513671875 },
            Left { radius: 1.44775390625, length: 4.422607421875 },
            Left { radius: 1.44775390625, length: 0.910400390625 },
        ],
    };
    let other = Disc {
        radius: 0.052001953125,
        start: [0.366943359375, 0.32373046875, 2.711891345616964],
        legs: vec![
            Right { radius: 0.639404296875, length: 3.51416015625 },
            Right { radius: 0.596435546875, length: 3.277099609375 },
        ],
    };
    audited_in_q12(&ego, &other);
}

/// In fixed point: at the end of an arc, rounding alone shows a second slice of a piece that has one, three steps wide.
#[test]
fn opposite_511412() {
    let ego = Disc {
        radius: 0.058349609375,
        start: [-0.972900390625, 8.781005859375, -2.1005554908990565],
        legs: vec![
            Right { radius: 0.181640625, length: 0.902099609375 },
            Line(3.89404296875),
            Right { radius: 0.98828125, length: 3.104736328125 },
            Line(1.086181640625),
        ],
    };
    let other = Disc {
        radius: 0.16259765625,
        start: [-0.41845703125, 5.616943359375, -0.7870086226166818],
        legs: vec![
            Line(1.086181640625),
            Left { radius: 0.98828125, length: 3.104736328125 },
            Line(3.89404296875),
            Left { radius: 0.181640625, length: 0.902099609375 },
            Left { radius: 2.73095703125, length: 4.289794921875 },
        ],
    };
    audited_in_q12(&ego, &other);
}
