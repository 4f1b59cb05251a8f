//! Dashboard and alert rules in `deploy` name metrics that there are.

use pcr_serve::http::{self, HttpContent, Readiness};
use pcr_serve::journal_writer::WriteProgress;
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::server::{ServerInput, queue, serve};
use serde_json::Value;
use std::collections::BTreeSet;

fn file(name: &str) -> String {
    std::fs::read_to_string(format!("{}/deploy/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// Names of metrics in a text.
fn named(text: &str) -> BTreeSet<String> {
    let words = text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
    words.filter(|word| word.starts_with("pcr_")).map(str::to_owned).collect()
}

/// Names of the metrics of a supervisor with a bridge.
fn metrics() -> BTreeSet<String> {
    let mut supervisor = crate::lines::supervisor();
    let (handle, inputs) = queue();
    let server = std::thread::spawn(move || {
        serve(&mut supervisor, &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error)).unwrap();
    });
    let hosts = vec!["here".into()];
    let unready = Some(Readiness::default());
    let site = HttpContent { page: String::new(), draw: None, hosts, addresses: false, unready };
    let (status, _, text) = http::answer(&handle, &site, b"GET /metrics HTTP/1.1\r\nHost: here\r\n\r\n");
    assert_eq!(status, "200 OK");
    handle.send(ServerInput::Stop);
    server.join().unwrap();
    let types = text.lines().filter_map(|line| line.strip_prefix("# TYPE ")?.split_once(' '));
    let names = types.flat_map(|(name, kind)| match kind {
        "histogram" => ["_bucket", "_sum", "_count"].map(|end| format!("{name}{end}")).to_vec(),
        _ => vec![name.to_owned()],
    });
    names.collect()
}

#[test]
fn dashboard_and_alert_rules_name_metrics_that_there_are() {
    let metrics = metrics();
    assert!(metrics.contains("pcr_broker_connected") && metrics.contains("pcr_robot_waiting"), "{metrics:?}");
    let dashboard: Value = serde_json::from_str(&file("dashboard.json")).unwrap();
    let panels = dashboard["panels"].as_array().unwrap();
    let targets = panels.iter().flat_map(|panel| panel["targets"].as_array().unwrap());
    let shown: Vec<String> = targets.map(|target| target["expr"].as_str().unwrap().to_owned()).collect();
    let rules = file("alerts.yml");
    let alerts: Vec<String> =
        rules.lines().filter_map(|line| line.trim().strip_prefix("expr: ")).map(str::to_owned).collect();
    assert_eq!(alerts.len(), rules.matches("- alert: ").count());
    assert!(shown.len() > 10 && alerts.len() > 5);
    for expression in shown.iter().chain(&alerts) {
        let names = named(expression);
        assert!(!names.is_empty() && names.is_subset(&metrics), "{expression}: {names:?}");
    }
    // In texts, too.
    for text in ["dashboard.json", "alerts.yml", "README.md"].map(file) {
        let unknown: Vec<String> = named(&text).difference(&metrics).cloned().collect();
        assert!(unknown.is_empty(), "{unknown:?}");
    }
}
