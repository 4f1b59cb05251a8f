//! q
use pcr_host::fleet::Fleet;
use pcr_host::scenario::Scenario;
fn main() {
    for f in ["table6-5", "table6-12", "paper12", "table6-30", "table6-50", "table6-100"] {
        let s = Scenario::from_json(&std::fs::read_to_string(format!("tests/data/{f}.json")).unwrap()).unwrap();
        let fleet = Fleet::<f64>::new(&s).unwrap();
        let m = fleet.motions();
        let counts: Vec<usize> = (0..m.len()).map(|i| (0..m.len()).filter(|j| *j != i).map(|j| pcr_core::crossings(&m[i], &m[j]).count()).sum()).collect();
        println!("{f} {} {:?}", counts.iter().sum::<usize>(), &counts[..counts.len().min(12)]);
        if f == "paper12" {
            let mut rows: Vec<_> = (0..12).filter(|j| *j != 2).flat_map(|j| pcr_core::crossings(&m[2], &m[j]).map(move |c| (j, c))).collect();
            rows.sort_by(|a, b| a.1.length.total_cmp(&b.1.length));
            for (j, c) in rows { println!("{} 3,{} T {:.3} L {:.3} r {:.2} v {:.2} th {:.3} {:?} {:?}", c.piece_type, j+1, c.time, c.length, c.combined_radius, c.speed, c.theta.0, c.ego_curve, c.other_curve); }
        }
    }
}
