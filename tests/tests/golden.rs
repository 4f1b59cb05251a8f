//! golden
use pcr_host::fleet::{Fleet, build_ecm};
use pcr_host::scenario::Scenario;
use serde_json::{Value, json};

#[test]
fn golden() {
    let text = include_str!("../data/golden-public.json");
    let golden: Value = serde_json::from_str(text).unwrap();
    let mut bad = 0;
    let mut worst = 0.0f64;
    let mut worst_slice = 0.0f64;
    for case in golden["cases"].as_array().unwrap() {
        let mut i = case["i"].clone();
        let mut j = case["j"].clone();
        i["id"] = json!(1);
        j["id"] = json!(2);
        let scenario = Scenario::from_value(&json!({"agents":[i, j]}));
        let scenario = match scenario {
            Ok(s) => s,
            Err(e) => {
                println!("{} {e}", case["name"]);
                bad += 1;
                continue;
            }
        };
        let fleet = Fleet::<f64>::new(&scenario).unwrap();
        let motions = fleet.motions();
        let ecm = build_ecm(&motions).unwrap();
        for swap in [false] {
            let _ = swap;
            let mut got: Vec<_> = ecm.pair(&motions, 0, 1).collect();
            got.sort_by(|a, b| (a.time().lo, a.length().lo).partial_cmp(&(b.time().lo, b.length().lo)).unwrap());
            let want = case["components"].as_array().unwrap();
            if case["uncertain"] == json!(true) {
                continue;
            }
            if got.len() != want.len() {
                println!("{}: {} regions, want {}", case["name"], got.len(), want.len());
                bad += 1;
                for g in &got {
                    println!("   {:?} {:?}", g.time(), g.length());
                }
                for w in want {
                    println!("   want {} {}", w["t"], w["l"]);
                }
                continue;
            }
            // match
            let mut used = vec![false; got.len()];
            for w in want {
                let wv: Vec<f64> = ["t", "l"]
                    .iter()
                    .flat_map(|k| w[k].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()))
                    .collect();
                let err = |g: &pcr_core::RegionRef<f64>| {
                    let (t, l) = (g.time(), g.length());
                    [t.lo - wv[0], t.hi - wv[1], l.lo - wv[2], l.hi - wv[3]].iter().fold(0.0f64, |m, x| m.max(x.abs()))
                };
                let (k, e) = (0..got.len())
                    .filter(|k| !used[*k])
                    .map(|k| (k, err(&got[k])))
                    .min_by(|a, b| a.1.partial_cmp(&b.1).unwrap())
                    .unwrap();
                used[k] = true;
                worst = worst.max(e);
                if e > 1e-9 {
                    println!("{}: err {e:e}  got {:?} {:?} want {wv:?}", case["name"], got[k].time(), got[k].length());
                    bad += 1;
                    continue;
                }
                for sec in w["sections"].as_array().unwrap() {
                    let t = sec["t"].as_f64().unwrap();
                    let ls: Vec<[f64; 2]> = serde_json::from_value(sec["l"].clone()).unwrap();
                    let gs: Vec<_> = got[k].slice_at(t).collect();
                    let ok = gs.len() == ls.len()
                        && gs.iter().zip(&ls).all(|(g, l)| {
                            let e = (g.lo - l[0]).abs().max((g.hi - l[1]).abs());
                            worst_slice = worst_slice.max(e);
                            e < 1e-9
                        });
                    if !ok {
                        println!("{} slice t={t} got {gs:?} want {ls:?}", case["name"]);
                        bad += 1;
                    }
                }
            }
        }
    }
    println!("worst {worst:e} slices {worst_slice:e}");
    assert_eq!(bad, 0);
}
