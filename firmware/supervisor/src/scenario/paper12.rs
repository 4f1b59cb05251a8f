// Generated: `cargo run -p pcr-tests --example constants`.
/// The agents of the scenario.
pub static AGENTS: [Agent<Number, &[Step<Number>]>; 12] = [
    Agent {
        radius: number(0.11),
        start_time: number(0.0),
        limits: Limits { speed: number(0.58), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(5.92274), number(6.57071)), heading: angle(-2.970407) },
        path: &[
            Step { curve: Curve::Line, length: number(4.37681) },
            Step { curve: Curve::Arc { radius: number(0.8485), turn: TurnSide::Left }, length: number(1.8110630065) },
            Step { curve: Curve::Line, length: number(4.97438) },
        ],
    },
    Agent {
        radius: number(0.12),
        start_time: number(0.0),
        limits: Limits { speed: number(0.56), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(5.8341), number(6.84647)), heading: angle(-2.717452) },
        path: &[
            Step { curve: Curve::Line, length: number(2.32768) },
            Step { curve: Curve::Arc { radius: number(0.74102), turn: TurnSide::Left }, length: number(0.37896800228000005) },
            Step { curve: Curve::Line, length: number(4.66475) },
            Step { curve: Curve::Arc { radius: number(0.60023), turn: TurnSide::Right }, length: number(0.38224927274000003) },
        ],
    },
    Agent {
        radius: number(0.13),
        start_time: number(0.0),
        limits: Limits { speed: number(0.54), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(1.88635), number(0.80107)), heading: angle(0.264201) },
        path: &[
            Step { curve: Curve::Line, length: number(3.42087) },
            Step { curve: Curve::Arc { radius: number(1.15), turn: TurnSide::Left }, length: number(2.8866932) },
            Step { curve: Curve::Line, length: number(5.36065) },
        ],
    },
    Agent {
        radius: number(0.14),
        start_time: number(0.0),
        limits: Limits { speed: number(0.52), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(6.40849), number(0.71573)), heading: angle(2.792536) },
        path: &[
            Step { curve: Curve::Arc { radius: number(3.95881), turn: TurnSide::Right }, length: number(2.87997093404) },
            Step { curve: Curve::Line, length: number(4.63443) },
        ],
    },
    Agent {
        radius: number(0.15),
        start_time: number(0.0),
        limits: Limits { speed: number(0.5), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(0.96698), number(0.93126)), heading: angle(0.476138) },
        path: &[
            Step { curve: Curve::Line, length: number(5.71202) },
            Step { curve: Curve::Arc { radius: number(0.72817), turn: TurnSide::Left }, length: number(1.81026994118) },
            Step { curve: Curve::Line, length: number(3.84438) },
        ],
    },
    Agent {
        radius: number(0.16),
        start_time: number(0.0),
        limits: Limits { speed: number(0.48), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(0.30334), number(4.49779)), heading: angle(-1.086511) },
        path: &[
            Step { curve: Curve::Arc { radius: number(2.7485), turn: TurnSide::Left }, length: number(7.253813715000001) },
        ],
    },
    Agent {
        radius: number(0.17),
        start_time: number(0.0),
        limits: Limits { speed: number(0.46), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(3.86675), number(0.58111)), heading: angle(-1.524098) },
        path: &[
            Step { curve: Curve::Arc { radius: number(0.42671), turn: TurnSide::Left }, length: number(1.51818169467) },
            Step { curve: Curve::Arc { radius: number(1.54237), turn: TurnSide::Left }, length: number(2.56264004315) },
            Step { curve: Curve::Arc { radius: number(0.59587), turn: TurnSide::Right }, length: number(2.70593385876) },
        ],
    },
    Agent {
        radius: number(0.18),
        start_time: number(0.0),
        limits: Limits { speed: number(0.44), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(4.90484), number(6.0204)), heading: angle(-2.205778) },
        path: &[
            Step { curve: Curve::Arc { radius: number(2.2485), turn: TurnSide::Left }, length: number(4.995735288) },
        ],
    },
    Agent {
        radius: number(0.19),
        start_time: number(0.0),
        limits: Limits { speed: number(0.42), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(1.2028), number(3.01868)), heading: angle(-0.707771) },
        path: &[
            Step { curve: Curve::Line, length: number(2.92553) },
            Step { curve: Curve::Arc { radius: number(0.53723), turn: TurnSide::Left }, length: number(1.4977445914599998) },
            Step { curve: Curve::Line, length: number(1.07833) },
            Step { curve: Curve::Arc { radius: number(2.33025), turn: TurnSide::Right }, length: number(1.9606933222499998) },
            Step { curve: Curve::Line, length: number(0.3091) },
        ],
    },
    Agent {
        radius: number(0.2),
        start_time: number(0.0),
        limits: Limits { speed: number(0.4), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(0.40471), number(6.72177)), heading: angle(-0.124483) },
        path: &[
            Step { curve: Curve::Arc { radius: number(1.63456), turn: TurnSide::Right }, length: number(3.6489034777600002) },
            Step { curve: Curve::Arc { radius: number(1.28334), turn: TurnSide::Left }, length: number(2.1870744447) },
            Step { curve: Curve::Line, length: number(2.23812) },
        ],
    },
    Agent {
        radius: number(0.21),
        start_time: number(0.0),
        limits: Limits { speed: number(0.38), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(3.81988), number(6.66962)), heading: angle(-2.512731) },
        path: &[
            Step { curve: Curve::Line, length: number(1.15762) },
            Step { curve: Curve::Arc { radius: number(0.82352), turn: TurnSide::Left }, length: number(0.89967995312) },
            Step { curve: Curve::Line, length: number(1.77697) },
            Step { curve: Curve::Arc { radius: number(0.59489), turn: TurnSide::Right }, length: number(2.2452873781) },
            Step { curve: Curve::Line, length: number(1.13771) },
        ],
    },
    Agent {
        radius: number(0.22),
        start_time: number(0.0),
        limits: Limits { speed: number(0.36), acceleration: number(0.3) },
        start: Pose { position: Point::new(number(6.5298), number(5.08316)), heading: angle(-2.416771) },
        path: &[
            Step { curve: Curve::Line, length: number(2.56363) },
            Step { curve: Curve::Arc { radius: number(0.5797), turn: TurnSide::Left }, length: number(1.2512024514) },
            Step { curve: Curve::Line, length: number(1.96504) },
        ],
    },
];
