//! What is printed of a table is proved by the checker that shares nothing with it, and what is damaged is no table.

use pcr_certify::device_dump::decode;
use pcr_certify::error::CertifyError;
use pcr_certify::raw::RawTable;
use pcr_certify::table::{Checker, CoverageMargin};
use pcr_core::{Ecm, EcmEntry, FleetMotions, FleetStorage, MismatchError, Piece};
use pcr_supervisor::scenario::{self, AGENTS, PIECES, REGIONS, SEGMENTS};
use pcr_supervisor::{Agent, Number, Step, dump};

type BuiltIn<S> = &'static [Agent<S, &'static [Step<S>]>];

fn printed<S: Number>(agents: BuiltIn<S>) -> String {
    let mut store = FleetStorage::<S, AGENTS, SEGMENTS>::new();
    agents.iter().for_each(|agent| assert!(agent.add_to(&mut store).is_ok()));
    let mut fleet = FleetMotions::new();
    fleet.fill(&store);
    let ecm = Ecm::build([EcmEntry::EMPTY; REGIONS], [Piece::EMPTY; PIECES], &fleet).unwrap();
    let mut bytes = Vec::new();
    dump::table(&fleet, &ecm, |line| bytes.extend_from_slice(line)).unwrap();
    String::from_utf8(bytes).unwrap()
}

fn verdict(table: &RawTable) -> Result<[usize; 4], CertifyError> {
    let found = Checker::new(table)?.check(CoverageMargin::Needed)?;
    Ok([found.refuted.len(), found.undecided.len(), found.pieces, found.times])
}

fn is_proved<S: Number>(agents: BuiltIn<S>) {
    let table = decode(&printed(agents)).unwrap();
    let [refuted, undecided, pieces, times] = verdict(&table).unwrap();
    assert_eq!([refuted, undecided], [0, 0], "{}", S::NAME);
    assert!(table.agents.len() == AGENTS && pieces > 80 && times > 50, "{}: {pieces} {times}", S::NAME);
}

#[test]
fn the_table_that_is_printed_is_proved_in_every_format() {
    is_proved(&scenario::float::AGENTS);
    is_proved(&scenario::micro::AGENTS);
    is_proved(&scenario::q20::AGENTS);
    is_proved(&scenario::q16::AGENTS);
    is_proved(&scenario::q12::AGENTS);
}

/// The files that the tests of the tool read. `pcr-link table FORMAT` prints them anew.
#[test]
fn what_is_printed_is_in_the_test_data() {
    assert_eq!(printed(&scenario::float::AGENTS), include_str!("../../../tests/data/dumps/paper12-f32.txt"));
    assert_eq!(printed(&scenario::q16::AGENTS), include_str!("../../../tests/data/dumps/paper12-q16.txt"));
    // Small ones, of the first two agents, from which fuzzing begins.
    assert_eq!(printed(&scenario::float::AGENTS[..2]), include_str!("../../../tests/data/dumps/pair-f32.txt"));
    assert_eq!(printed(&scenario::q16::AGENTS[..2]), include_str!("../../../tests/data/dumps/pair-q16.txt"));
}

/// The same lines, with the check of these.
fn sealed(lines: &[&str]) -> String {
    let body: String = lines.iter().flat_map(|line| [line, "\n"]).collect();
    let check = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(body.as_bytes());
    format!("{body}end {check:08x}\n")
}

fn damaged_tables_are_errors<S: Number>(agents: BuiltIn<S>) {
    let text = printed(agents);
    let good: Vec<&str> = text.lines().collect();
    let (_, body) = good.split_last().unwrap();
    assert_eq!(sealed(body), text);
    let refused = |text: &str| decode(text).and_then(|table| Checker::new(&table).map(drop)).unwrap_err().to_string();
    assert!(refused("ego other     from [s]\n").contains("no table"));
    assert!(refused("").contains("no table"));
    assert!(refused(&format!("{text}{text}")).contains("2 tables"));
    // Cut anywhere, with and without a check of what is left.
    for kept in (1..good.len()).step_by(9) {
        refused(&good[..kept].join("\n"));
        refused(&sealed(&good[..kept - 1]));
    }
    refused(&text[..text.len() - 4]);
    // One line less, or one twice.
    for place in (0..body.len()).step_by(9) {
        let mut less = body.to_vec();
        less.remove(place);
        refused(&less.join("\n"));
        refused(&sealed(&less));
        let mut more = body.to_vec();
        more.insert(place, body[place]);
        refused(&sealed(&more));
    }
    // A pair with all that is its own, missing or repeated, or of nobody.
    let begins: Vec<usize> = (0..body.len()).filter(|&place| body[place].starts_with("pair")).collect();
    for (begin, end) in begins.iter().zip(begins.iter().skip(1).chain([&body.len()])).step_by(5) {
        let without = [&body[..*begin], &body[*end..]].concat();
        assert!(refused(&sealed(&without)).contains("missing"));
        let twice = [&body[..*end], &body[*begin..]].concat();
        assert!(refused(&sealed(&twice)).contains("twice"));
    }
    let nobody = body[begins[0]].replacen(" 0 1 ", " 0 99 ", 1);
    let mut other = body.to_vec();
    other[begins[0]] = &nobody;
    assert!(refused(&sealed(&other)).contains("none"));
    // A bit on the line: the check notices.
    let flipped = text.replacen("piece 0", "piece 1", 1);
    assert!(flipped != text && refused(&flipped).contains("check"));
    assert!(refused(&text.replacen("pcr-table 1", "pcr-table 2", 1)).contains("version"));
    // Ends of lines as terminals write them do no harm.
    assert_eq!(decode(&text.replace('\n', "\r\n")), decode(&format!("noise\n{text}more\n")));
}

#[test]
fn what_is_damaged_is_no_table() {
    damaged_tables_are_errors(&scenario::float::AGENTS);
    damaged_tables_are_errors(&scenario::q16::AGENTS);
}

#[test]
fn a_table_of_another_fleet_is_not_printed() {
    let mut store = FleetStorage::<f32, AGENTS, SEGMENTS>::new();
    for agent in &scenario::float::AGENTS[..2] {
        agent.add_to(&mut store).unwrap();
    }
    let mut fleet = FleetMotions::new();
    fleet.fill(&store);
    let ecm = Ecm::build([EcmEntry::EMPTY; REGIONS], [Piece::EMPTY; PIECES], &fleet[..1]).unwrap();
    let said = dump::table(&fleet, &ecm, |line| assert!(!line.starts_with(b"end")));
    assert!(matches!(said, Err(MismatchError::OtherFleet)), "{said:?}");
}
