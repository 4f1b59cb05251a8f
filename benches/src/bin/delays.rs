//! Unsafe delays of every pair of some edges: `delays ROUNDS REACH < edges`, `x y u v` an edge. Prints nanoseconds a pair on one core (the
//! shortest of so many rounds), how many pairs have an interval, and the sum of their lengths. `benches/delays.sh` compares it with the
//! published equations.

use pcr_planning::exclusion_table::StraightEdge;
use std::hint::black_box;
use std::io::{Read, stdin};
use std::time::Instant;

fn main() {
    let mut arguments = std::env::args().skip(1).map(|argument| argument.parse::<f64>().expect("a number"));
    let (Some(rounds), Some(reach)) = (arguments.next(), arguments.next()) else { panic!("ROUNDS REACH < edges") };
    let mut text = String::new();
    stdin().read_to_string(&mut text).expect("edges");
    let numbers: Vec<f64> = text.split_whitespace().map(|number| number.parse().expect("a number")).collect();
    let edges: Vec<StraightEdge> = numbers
        .chunks_exact(4)
        .map(|edge| StraightEdge::new([edge[0], edge[1]], [edge[2], edge[3]], 1.0).expect("an edge"))
        .collect();
    let pairs = 0.5 * edges.len() as f64 * (edges.len() + 1) as f64;
    let (mut least, mut met, mut sum) = (f64::INFINITY, 0, 0.0);
    for _ in 0..rounds as u32 {
        (met, sum) = (0, 0.0);
        let start = Instant::now();
        for (place, a) in edges.iter().enumerate() {
            for b in &edges[place..] {
                if let Some([lo, hi]) = black_box(a).delays(b, reach) {
                    met += 1;
                    sum += hi - lo;
                }
            }
        }
        least = least.min(1e9 * start.elapsed().as_secs_f64() / pairs);
    }
    println!("{least:.1} {met} {sum:.9}");
}
