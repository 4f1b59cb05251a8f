//! What a run found, as a table, and what no test noticed.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

pub fn print(folder: &Path) {
    let text = fs::read_to_string(folder.join("results")).expect("results");
    // The last result of a mutant counts.
    let results: BTreeMap<u32, Vec<&str>> = text
        .lines()
        .map(|line| line.split('\t').collect::<Vec<_>>())
        .filter_map(|words| Some((words.first()?.parse().ok()?, words)))
        .collect();
    let mut files: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    for words in results.values() {
        let [_, place, _, result, ..] = words.as_slice() else { continue };
        let file = place.split(':').next().unwrap_or(place);
        let counts = files.entry(file).or_default();
        counts[usize::from(!matches!(*result, "noticed" | "endless"))] += 1;
    }
    let total = files.values().fold([0; 2], |sum, counts| [sum[0] + counts[0], sum[1] + counts[1]]);
    println!("| file | mutants | noticed | not |\n|---|---|---|---|");
    for (file, [noticed, not]) in files.iter().chain([(&"all", &total)]) {
        println!("| `{file}` | {} | {noticed} | {not} |", noticed + not);
    }
    println!();
    for words in
        results.values().filter(|words| words.get(3).is_some_and(|word| !matches!(*word, "noticed" | "endless")))
    {
        println!("{}", words.join("\t"));
    }
}
