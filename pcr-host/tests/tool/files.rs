//! Files are written whole or stay as they are, whatever goes wrong.
#![cfg(unix)]

use crate::fixture::{PAPER, crossing, directory, pcr, run};
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// An empty folder of a test.
fn folder(test: &str) -> PathBuf {
    let folder = directory("files").join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Runs with files of at most some blocks of 512 or 1024 bytes.
fn limited(blocks: u32, arguments: &[&str]) -> (i32, String) {
    let script = format!("ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let output =
        Command::new("bash").args(["-c", &script, env!("CARGO_BIN_EXE_pcr")]).args(arguments).output().unwrap();
    (output.status.code().unwrap_or(-1), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_scenario_that_is_planned_onto_itself_is_never_lost() {
    let folder = folder("itself");
    let same = folder.join("same.json");
    let before = fs::read(PAPER).unwrap();
    fs::write(&same, &before).unwrap();
    let name = same.to_str().unwrap();
    let (status, message) = limited(1, &["plan", name, "-o", name, "-q"]);
    assert_eq!(status, 3, "{message}");
    assert!(message.starts_with(&format!("pcr: {name}: cannot be written: ")), "{message}");
    assert_eq!((fs::read(&same).unwrap(), names(&folder)), (before, vec!["same.json".to_owned()]));
    run(&["plan", name, "-o", name, "-q"]).ok();
    assert_eq!((run(&["check", name]).ok().as_str(), names(&folder).len()), ("paper12: no conflicts, 12 agents\n", 1));
}

#[test]
fn every_output_is_whole_or_not_there() {
    let folder = folder("limited");
    let scenario = folder.join("scenario.json");
    fs::write(&scenario, crossing().to_string()).unwrap();
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/warehouse_graph.geojson");
    let name = scenario.to_str().unwrap();
    let out = folder.join("out");
    let target = out.to_str().unwrap();
    for arguments in [
        &["map", name, "-o", target][..],
        &["simulate", name, "-o", target],
        &["import", "nav2", layout, "--route", "0:50", "--route", "50:0", "--route", "3:4", "-o", target],
        &["locks", layout, "--radius", "0.4", "-o", target],
        &["locks", layout, "--radius", "0.4", "--write", "nav2", "-o", target],
        &["traffic", layout, "--agents", "3", "--radius", "0.4", "-o", target],
        &["compare", name, "--method", "polyline", "--rounds", "1", "-o", target],
        &["demo", "-o", target],
    ] {
        let (status, message) = limited(1, &[arguments, &["-q"]].concat());
        assert_eq!(status, 3, "{arguments:?}: {message}");
        assert!(message.contains("cannot be written: "), "{arguments:?}: {message}");
        // What fits is there and whole; nothing is left of what does not.
        let left = if out.is_dir() { names(&out) } else { Vec::new() };
        assert!(left.iter().all(|name| !name.starts_with('.')), "{arguments:?}: {left:?}");
        assert!(left.iter().all(|name| !name.ends_with(".html")), "{arguments:?}: {left:?}");
        assert!(!out.is_file(), "{arguments:?}");
        let _ = fs::remove_dir_all(&out);
    }
}

/// A run that stops on its way leaves no new page over old pictures.
#[test]
fn pages_are_written_after_their_pictures() {
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/aws_graph.geojson");
    let options = ["locks", layout, "--radius", "0.3", "-q", "-o"];
    for (picture, page, arguments) in [
        ("ecm-12.svg", "index.html", &["map", PAPER, "-q", "-o"][..]),
        ("layout.svg", "locks.html", &options),
        ("audit.svg", "audit.html", &[&options[..], &["--audit"]].concat()),
    ] {
        let folder = folder("page");
        fs::create_dir(folder.join(picture)).unwrap();
        let mut words = arguments.to_vec();
        words.insert(words.iter().position(|word| *word == "-o").unwrap() + 1, folder.to_str().unwrap());
        assert_eq!(run(&words).status, 3, "{words:?}");
        assert!(!folder.join(page).exists(), "{:?}", names(&folder));
    }
}

#[test]
fn pictures_of_an_earlier_run_are_told() {
    let folder = folder("earlier");
    let (scenario, maps) = (folder.join("two.json"), folder.join("maps"));
    fs::write(&scenario, crossing().to_string()).unwrap();
    let draw = |scenario: &str| run(&["map", scenario, "-o", maps.to_str().unwrap()]);
    draw(PAPER).ok();
    draw(PAPER).ok();
    let told = draw(scenario.to_str().unwrap());
    let each = if cfg!(feature = "png") { 2 } else { 1 };
    let (count, first) = (10 * each, if each == 2 { "png" } else { "svg" });
    let expected = format!(
        "pcr: warning: {}: of an earlier run, with other agents: {count} pictures, such as ecm-10.{first} [earlier-pictures]\n",
        maps.display()
    );
    assert_eq!((told.status, told.err), (0, expected));
}

#[cfg(target_os = "linux")]
#[test]
fn full_devices_and_folders_that_take_no_file_are_errors() {
    for output in ["/dev/full", "/proc/plan.json"] {
        let message = run(&["plan", PAPER, "-q", "-o", output]).failed(3);
        assert!(message.starts_with(&format!("pcr: {output}: cannot be written: ")), "{message}");
    }
    run(&["plan", PAPER, "-q", "-o", "/dev/null"]).ok();
    assert!(fs::metadata("/dev/null").is_ok_and(|null| !null.is_file()), "a device is no file to be replaced");
    // A pipe, as the shell gives one for `>(gzip)`, whose name is a link to no file.
    let through = run(&["plan", PAPER, "-q", "-o", "/dev/stdout"]).ok();
    assert!(through.starts_with("{ \"format\": \"pcr-scenario\"") && through.ends_with("] }\n"), "{through}");
    let folder = folder("read-only");
    let file = folder.join("plan.json");
    fs::write(&file, "before").unwrap();
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o555)).unwrap();
    // The superuser may do all the same.
    let may = fs::write(folder.join("probe"), "").is_ok();
    let output = run(&["plan", PAPER, "-q", "-o", file.to_str().unwrap()]);
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o755)).unwrap();
    assert_eq!(output.status, if may { 0 } else { 3 }, "{}", output.err);
    assert_eq!(fs::read_to_string(&file).unwrap() == "before", !may);
}

#[test]
fn modes_and_links_stay_as_they_are() {
    let folder = folder("modes");
    let [file, link] = ["plan.json", "link.json"].map(|name| folder.join(name));
    fs::write(&file, "").unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o604)).unwrap();
    symlink("plan.json", &link).unwrap();
    run(&["plan", PAPER, "-q", "-o", link.to_str().unwrap()]).ok();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o604);
    assert!(run(&["check", file.to_str().unwrap()]).ok().starts_with("paper12: no conflicts"));
}

#[test]
fn whatever_is_killed_in_the_middle_leaves_the_old_files_or_the_new_ones() {
    let folder = folder("killed");
    let out = folder.join("maps");
    run(&["map", PAPER, "-q", "-o", out.to_str().unwrap()]).ok();
    let whole: Vec<(PathBuf, Vec<u8>)> = names(&out)
        .into_iter()
        .map(|name| out.join(name))
        .map(|file| (file.clone(), fs::read(file).unwrap()))
        .collect();
    for milliseconds in [60, 150, 300, 600, 1200] {
        let mut child = pcr().args(["map", PAPER, "-q", "-o"]).arg(&out).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(milliseconds));
        child.kill().unwrap();
        child.wait().unwrap();
        // The same scenario gives the same bytes: what is there is what was there.
        for (file, content) in &whole {
            assert!(fs::read(file).unwrap() == *content, "{}", file.display());
        }
    }
}

#[test]
fn files_where_folders_have_to_be_are_named() {
    let folder = folder("kinds");
    let file = folder.join("file");
    fs::write(&file, "keep").unwrap();
    let name = file.to_str().unwrap();
    for arguments in [
        &["map", PAPER, "-o", name][..],
        &["demo", "-o", name],
        &["compare", PAPER, "-o", name, "--rounds", "1", "--method", "polyline"],
    ] {
        let message = run(arguments).failed(3);
        assert_eq!(message, format!("pcr: {name}: cannot be written: it is there and not a folder\n"));
    }
    let message = run(&["plan", PAPER, "-q", "-o", folder.to_str().unwrap()]).failed(3);
    assert!(message.ends_with(": cannot be written: a folder\n"), "{message}");
    assert_eq!(fs::read_to_string(&file).unwrap(), "keep");
    let slash = format!("{}/new/", folder.display());
    let message = run(&["plan", PAPER, "-q", "-o", &slash]).failed(3);
    assert_eq!(message, format!("pcr: {slash}: cannot be written: the name of a folder, and a file is written\n"));
    let nowhere = format!("{}/nowhere", folder.display());
    let message = run(&["plan", PAPER, "-q", "-o", &format!("{nowhere}/plan.json")]).failed(3);
    assert!(
        message.contains(&format!("plan.json: cannot be written: its folder {nowhere} takes no file: ")),
        "{message}"
    );
}

#[test]
fn a_run_that_fails_leaves_no_empty_folder() {
    let folder = folder("left");
    let out = folder.join("deep/maps");
    let out = out.to_str().unwrap();
    let (status, message) = limited(1, &["map", PAPER, "-o", out]);
    assert_eq!((status, names(&folder)), (3, Vec::new()), "{message}");
}

#[test]
fn what_is_read_is_not_lost_to_something_of_another_kind() {
    let folder = folder("inputs");
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/warehouse_graph.geojson");
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let [scenario, graph, link] = ["s.json", "g.geojson", "link"].map(path);
    let [page, chart, plan, sheet] = ["index.html", "regions-1.svg", "plan.json", "sheet.json"].map(path);
    let out = folder.to_str().unwrap();
    for name in [&scenario, &page, &chart] {
        fs::write(name, crossing().to_string()).unwrap();
    }
    for name in [&graph, &plan] {
        fs::copy(layout, name).unwrap();
    }
    fs::copy(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/small/factsheet.json"), &sheet).unwrap();
    symlink("s.json", &link).unwrap();
    let vehicle = ["--radius", "0.4", "-q"];
    for (arguments, file) in [
        (vec!["simulate", &scenario, "--controller", "pcr", "-o", &scenario], &scenario),
        (vec!["simulate", &scenario, "--controller", "pcr", "-o", &link], &link),
        (vec!["simulate", &link, "--controller", "pcr", "-o", &scenario], &scenario),
        ([&["locks", &graph, "--index", &graph], &vehicle[..]].concat(), &graph),
        ([&["locks", &graph, "--write", "pcr", "-o", &graph], &vehicle[..]].concat(), &graph),
        // What is written is made of the layout, and of no other file that was read.
        (vec!["locks", &graph, "--fleet", &sheet, "--write", "nav2", "-o", &sheet, "-q"], &sheet),
        (vec!["import", "nav2", &graph, "--route", "0:50", "-o", &graph], &graph),
        (vec!["plan", &graph, "--route", "0:50", "-o", &graph], &graph),
        (vec!["map", &page, "-o", out], &page),
        (vec!["compare", &chart, "--method", "polyline", "--rounds", "1", "-o", out], &chart),
        (vec!["compare", &scenario, &chart, "--method", "polyline", "--rounds", "1", "-o", out], &chart),
        ([&["traffic", &plan, "--from", "nav2", "--agents", "3", "-o", out], &vehicle[..]].concat(), &plan),
        (vec!["fleet", &graph, "--vehicles", "2", "--alone", "supervisor", "--time", "5", "--record", &graph], &graph),
    ] {
        let before = fs::read(file).unwrap();
        let run = run(&arguments);
        let expected = "this is read, and something of another kind would be written over it; give another name";
        assert!(run.err.contains(&format!("{file}: {expected}\n")), "{arguments:?}: {}", run.err);
        assert_eq!((run.status, fs::read(file).unwrap() == before), (2, true), "{arguments:?}: {}", run.err);
    }
    // What is of the same kind may take its place.
    let run = run(&[&["locks", &graph, "--write", "nav2", "-o", &graph], &vehicle[..]].concat());
    assert_eq!(run.status, 0, "{}", run.err);
    assert_ne!(fs::read(&graph).unwrap(), fs::read(layout).unwrap());
    let mut through = pcr();
    through.args(["plan", "-q", "-o", &scenario]).stdin(fs::File::open(&scenario).unwrap());
    assert!(through.status().unwrap().success());
    let mut through = pcr();
    through.args(["simulate", "--controller", "pcr", "-q", "-o", &scenario]);
    let refused = through.stdin(fs::File::open(&scenario).unwrap()).output().unwrap();
    assert_eq!(refused.status.code(), Some(if cfg!(target_os = "linux") { 2 } else { 0 }));
}

#[test]
fn folders_have_names() {
    let data = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data");
    let layout = format!("{data}/real/nav2/warehouse_graph.geojson");
    for arguments in [
        &["map", PAPER, "-o", ""][..],
        &["compare", PAPER, "-o", ""],
        &["traffic", &layout, "--radius", "0.4", "-o", ""],
        &["demo", "-o", ""],
        &["plan", PAPER, "--pictures", ""],
    ] {
        let run = run(arguments);
        assert_eq!((run.status, run.out.as_str()), (2, ""), "{arguments:?}");
        assert!(run.err.starts_with("error: a value is required for '"), "{arguments:?}: {}", run.err);
    }
}

/// The file behind it was replaced: what was in it was lost, and what others wrote to it later, too.
#[test]
fn a_descriptor_that_a_shell_has_opened_is_written_to_as_it_is() {
    let folder = folder("descriptors");
    let scenario = folder.join("scenario.json");
    fs::write(&scenario, crossing().to_string()).unwrap();
    let log = folder.join("log");
    for (output, redirected) in
        [("/dev/stdout", ">>"), ("/dev/stdout", ">"), ("/dev/stderr", "2>>"), ("/dev/fd/3", "3>>")]
    {
        let script = format!(
            "{{ echo before >&9; \"$0\" plan \"$1\" -o {output} -q; echo after >&9; }} {redirected}\"$2\" 9>>\"$2\""
        );
        fs::write(&log, if redirected == ">" { "" } else { "precious\n" }).unwrap();
        let shell = Command::new("bash")
            .args(["-c", &script, env!("CARGO_BIN_EXE_pcr")])
            .args([&scenario, &log])
            .output()
            .unwrap();
        let text = fs::read_to_string(&log).unwrap();
        let message = String::from_utf8(shell.stderr).unwrap();
        assert!(shell.status.success(), "{output}: {message}");
        assert!(text.contains("\"pcr-scenario\"") && text.ends_with("after\n"), "{output} {redirected}: {text}");
        assert!(redirected == ">" || text.starts_with("precious\nbefore\n"), "{output}: {text}");
    }
    // As `-`: what is for people goes to standard error.
    let script = "\"$0\" plan \"$1\" -o /dev/stdout | \"$0\" check";
    let shell = Command::new("bash").args(["-c", script, env!("CARGO_BIN_EXE_pcr")]).arg(&scenario).output().unwrap();
    assert_eq!(String::from_utf8(shell.stdout).unwrap(), "crossing: no conflicts, 2 agents\n");
}
