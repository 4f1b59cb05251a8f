//! Pictures of a scenario and its collision regions: SVG, PNG, and a page to explore them in a browser.
//!
//! ```text
//! region_scene    motions, regions and their outlines, shared by all pictures
//! contour         the exact outline of a region in time and travelled length
//! axis            metres and seconds to pixels, ticks
//! labels          positions of labels
//! palette         colours of the agents
//! workspace       paper Fig. 10: paths and discs
//! map             paper Fig. 11: the extended collision map of an agent
//! overview        both side by side
//! page            the same in a browser, with a time slider
//! audit           result of an audit of exclusions
//! layout          the corridors on the edges of a layout
//! exclusion_page  a page on which the edges of a layout show the lengths that they block
//! replay          a page that replays a simulation
//! record_page     a page about a record of what ran
//! fleet_page      a page that shows a running fleet
//! template        pages that contain everything they need
//! svg             the writer of SVG files
//! png             SVG to PNG (feature `png`)
//! ```

mod audit;
mod axis;
mod contour;
mod exclusion_page;
pub mod fleet_page;
mod labels;
mod layout;
mod map;
mod overlay;
mod overview;
mod page;
mod palette;
pub mod plot;
#[cfg(feature = "png")]
mod png;
pub mod record_page;
mod region_scene;
pub mod replay;
mod svg;
mod template;
mod workspace;

pub use layout::LayoutLevelView;
pub use overlay::{BlockedBar, Overlay};
use pcr_exclusions::{ExclusionAudit, ExclusionRules};
use pcr_formats::import::ImportedLayout;
use pcr_formats::output::{self, OverwriteError};
use pcr_formats::scenario::Scenario;
use pcr_planning::exclusion_table::ExclusionTable;
use pcr_planning::fleet::{Fleet, build_ecm};
use region_scene::RegionScene;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::{io, thread};

/// What was written into a directory.
#[derive(Clone, Debug, Default)]
pub struct WrittenFiles {
    /// The files.
    pub files: Vec<PathBuf>,
    /// Letters that are boxes as PNG, for want of a font of all languages; as SVG they are what they are.
    pub boxes: BTreeSet<char>,
}

impl WrittenFiles {
    fn add(&mut self, directory: &Path, drawn: PendingFiles) -> io::Result<()> {
        self.boxes.extend(drawn.boxes);
        for (name, content) in drawn.files {
            let file = directory.join(&name);
            // The folder is named by who writes into it.
            output::write(&file, content).map_err(|error| match OverwriteError::from_io_error(&error) {
                Some(_) => error,
                None => io::Error::new(error.kind(), format!("{name}: {error}")),
            })?;
            self.files.push(file);
        }
        Ok(())
    }
}

/// Writes all pictures of a scenario into a directory, which is created where it does not exist:
///
/// - `index.html`: the workspace and the map of a selected agent in a browser, in motion, without any other file;
/// - `overview`: the workspace beside the map of the agent with the most regions,
/// - `workspace`: the paths, with the discs at their starts and ends,
/// - `ecm-<id>` for every agent, or for those at the places `egos`: its extended collision map with its trajectory,
///
/// all but the first as `.svg`, with the feature `png` also as `.png`. The workspace is drawn on the `ground`, if there is one.
///
/// `progress` is called with the number of pictures that are done and of all there are, first with 0. The files are
/// in a fixed order; the page is written last, so that none stands beside pictures of before. The same scenario gives the same
/// bytes in every run.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for a scenario without motion (see [`Fleet::new`]) or of more than 65536 agents, and
/// those of writing files.
pub fn write(
    scenario: &Scenario,
    egos: Option<&[usize]>,
    ground: Option<LayoutLevelView<'_>>,
    directory: &Path,
    progress: &mut dyn FnMut(usize, usize),
) -> io::Result<WrittenFiles> {
    with_scene(scenario, egos, ground, |scene| {
        output::folder(directory)?;
        let mut pictures = vec![Picture::Page, Picture::Overview, Picture::Workspace];
        pictures.extend(scene.egos().map(Picture::Map));
        let mut written = vec![WrittenFiles::default(); pictures.len()];
        let (mut done, mut page) = (0, PendingFiles::default());
        progress(done, pictures.len());
        draw_all(scene, &pictures, &mut |place, drawn| {
            match pictures[place] {
                Picture::Page => page = drawn?,
                _ => written[place].add(directory, drawn?)?,
            }
            done += 1;
            progress(done, pictures.len());
            Ok(())
        })?;
        written[0].add(directory, page)?;
        let mut all = WrittenFiles::default();
        for WrittenFiles { files, boxes } in written {
            all.files.extend(files);
            all.boxes.extend(boxes);
        }
        Ok(all)
    })
}

/// Writes the pictures of a layout and its locks into a directory, which is created where it does not exist: `locks.html`,
/// in which an edge shows its corridor and what it blocks, and for each level `layout.svg` (and `layout.png`), from the second
/// level on with its number. Returns the files.
///
/// # Errors
/// Those of writing files.
pub fn write_locks(imported: &ImportedLayout, locks: &ExclusionTable, directory: &Path) -> io::Result<WrittenFiles> {
    let picture = |level: usize| LayoutLevelView { imported, level }.picture();
    write_levels(imported, directory, "layout", picture, ("locks.html", exclusion_page::page(imported, locks)))
}

/// Writes the audit of a layout: a page with groups and gaps as layers, and a picture of each level. Returns the files.
///
/// # Errors
/// Those of writing files.
pub fn write_audit(
    imported: &ImportedLayout,
    locks: &ExclusionTable,
    rules: &ExclusionRules,
    audit: &ExclusionAudit,
    directory: &Path,
) -> io::Result<WrittenFiles> {
    let picture = |level: usize| audit::picture(LayoutLevelView { imported, level }, rules, audit);
    write_levels(
        imported,
        directory,
        "audit",
        picture,
        ("audit.html", exclusion_page::page_of_audit(imported, locks, rules, audit)),
    )
}

/// Writes a picture of each level, from the second level on with its number, and a page with its name.
fn write_levels(
    imported: &ImportedLayout,
    directory: &Path,
    name: &str,
    picture: impl Fn(usize) -> String,
    (page, content): (&str, String),
) -> io::Result<WrittenFiles> {
    let mut drawn = PendingFiles::default();
    for level in 0..imported.layout.levels.len() {
        let name = if level > 0 { format!("{name}-{}", level + 1) } else { name.to_owned() };
        drawn.add_picture(&name, picture(level))?;
    }
    // The page is last: before it is there, nobody looks at the pictures.
    drawn.files.push((page.to_owned(), content.into_bytes()));
    output::folder(directory)?;
    let mut written = WrittenFiles::default();
    written.add(directory, drawn)?;
    Ok(written)
}

/// The collision map of an agent over what a sampled map says, as SVG.
///
/// # Errors
/// As [`write()`], without the files.
pub fn over(scenario: &Scenario, ego: usize, overlay: &Overlay<'_>) -> io::Result<String> {
    with_scene(scenario, None, None, |scene| Ok(overlay::picture(scene, ego, overlay)))
}

/// The workspace, on the ground if there is one, beside the map of the agent with the most regions, as SVG.
///
/// # Errors
/// As [`write()`].
pub fn overview(scenario: &Scenario, ground: Option<LayoutLevelView<'_>>) -> io::Result<String> {
    with_scene(scenario, None, ground, |scene| Ok(overview::picture(scene)))
}

fn with_scene<T>(
    scenario: &Scenario,
    egos: Option<&[usize]>,
    ground: Option<LayoutLevelView<'_>>,
    draw: impl FnOnce(&RegionScene<'_>) -> io::Result<T>,
) -> io::Result<T> {
    let invalid = |why: String| io::Error::new(io::ErrorKind::InvalidInput, why);
    let fleet = Fleet::<f64>::of_bodies(scenario).map_err(|refused| invalid(refused.to_string()))?;
    let motions = fleet.motions();
    let ecm = build_ecm(&motions).map_err(|full| invalid(full.to_string()))?;
    draw(&RegionScene { scenario, motions: &motions, ecm: &ecm, egos, ground })
}

/// One picture of a scenario.
#[derive(Clone, Copy, Debug)]
enum Picture {
    Page,
    Overview,
    Workspace,
    /// Of the agent at this place of the scenario.
    Map(usize),
}

/// Contents of files that are not written yet.
#[derive(Clone, Debug, Default)]
struct PendingFiles {
    /// Names and contents.
    files: Vec<(String, Vec<u8>)>,
    /// Letters that the PNG pictures show as boxes.
    boxes: BTreeSet<char>,
}

impl PendingFiles {
    /// Adds a picture as SVG, with the feature `png` also as PNG.
    fn add_picture(&mut self, name: &str, svg: String) -> io::Result<()> {
        #[cfg(feature = "png")]
        let (boxes, png) = (png::missing_letters(&svg)?, png::png(&svg)?);
        self.files.push((format!("{name}.svg"), svg.into_bytes()));
        #[cfg(feature = "png")]
        {
            self.files.push((format!("{name}.png"), png));
            self.boxes.extend(boxes);
        }
        Ok(())
    }
}

impl Picture {
    fn draw(self, scene: &RegionScene<'_>) -> io::Result<PendingFiles> {
        let mut drawn = PendingFiles::default();
        match self {
            Self::Page => drawn.files.push(("index.html".to_owned(), page::page(scene).into_bytes())),
            Self::Overview => drawn.add_picture("overview", overview::picture(scene))?,
            Self::Workspace => drawn.add_picture("workspace", workspace::picture(scene))?,
            Self::Map(ego) => drawn.add_picture(&format!("ecm-{}", scene.id(ego)), map::picture(scene, ego))?,
        }
        Ok(drawn)
    }
}

/// Draws on all cores; hands over each picture with its place in the list, in the order in which they are done.
fn draw_all(
    scene: &RegionScene<'_>,
    pictures: &[Picture],
    take: &mut dyn FnMut(usize, io::Result<PendingFiles>) -> io::Result<()>,
) -> io::Result<()> {
    let workers = thread::available_parallelism().map_or(1, usize::from).min(pictures.len());
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        let next = &next;
        let draw = |sender: mpsc::Sender<_>| {
            loop {
                let place = next.fetch_add(1, Ordering::Relaxed);
                let Some(picture) = pictures.get(place) else {
                    break;
                };
                // Nobody listens any more after an error.
                if sender.send((place, picture.draw(scene))).is_err() {
                    break;
                }
            }
        };
        let spawned =
            |sender: mpsc::Sender<_>| thread::Builder::new().spawn_scoped(scope, move || draw(sender)).is_ok();
        let threads = (0..workers).take_while(|_| spawned(sender.clone())).count();
        if threads == 0 {
            // Where the system has no thread to give, this one draws.
            draw(sender.clone());
        }
        drop(sender);
        receiver.into_iter().try_for_each(|(place, drawn)| take(place, drawn))
    })
}

#[cfg(all(test, feature = "png"))]
mod tests {
    use super::*;
    use serde_json::{Value, json};
    use std::fs;

    /// Writes the pictures into a directory of its own, checks that all files are well formed, and returns them.
    fn pictures(test: &str, scenario: &Value) -> Vec<(String, Vec<u8>)> {
        let scenario = Scenario::from_json(&scenario.to_string()).unwrap();
        let directory = std::env::temp_dir().join(format!("pcr-pictures-{test}-{}", std::process::id()));
        let mut calls = Vec::new();
        let written = write(&scenario, None, None, &directory, &mut |done, total| calls.push((done, total)));
        let files = written.unwrap().files;
        let total = scenario.agents.len() + 3;
        assert_eq!(calls, (0..=total).map(|done| (done, total)).collect::<Vec<_>>());
        assert_eq!(files.len(), 2 * total - 1);
        let read = files.iter().map(|file| {
            let content = fs::read(file).unwrap();
            match file.extension().and_then(|extension| extension.to_str()) {
                Some("svg") => {
                    let text = std::str::from_utf8(&content).unwrap();
                    let document = roxmltree::Document::parse(text).unwrap();
                    assert!(document.root_element().has_tag_name("svg"));
                    assert!(!text.contains("NaN") && !text.contains("inf"), "{file:?}");
                }
                Some("png") => {
                    let reader = ::png::Decoder::new(io::Cursor::new(&content)).read_info().unwrap();
                    assert!(reader.info().width > 400 && reader.info().height > 200);
                }
                _ => assert!(content.starts_with(b"<!DOCTYPE html>")),
            }
            (file.file_name().unwrap().to_str().unwrap().to_owned(), content)
        });
        let read = read.collect();
        fs::remove_dir_all(directory).unwrap();
        read
    }

    fn agent(id: u64, start: [f64; 3], path: Value) -> Value {
        json!({ "id": id, "radius": 0.3, "v_max": 1.0, "a_max": 0.5,
            "start": { "x": start[0], "y": start[1], "heading": start[2] }, "path": path })
    }

    fn line(length: f64) -> Value {
        json!({ "kind": "line", "length": length })
    }

    fn arc(radius: f64, sweep: f64) -> Value {
        json!({ "kind": "arc", "radius": radius, "sweep": sweep })
    }

    #[test]
    fn two_runs_give_the_same_bytes() {
        let agents = [
            agent(1, [0.0, 0.0, 0.0], json!([line(4.0), arc(1.0, 2.0)])),
            agent(9, [4.0, 0.0, 3.0], json!([line(4.0)])),
        ];
        let scenario = json!({ "name": "a <b> & \"c\"", "agents": agents });
        let once = pictures("once", &scenario);
        let names: Vec<&str> = once.iter().map(|(name, _)| name.as_str()).collect();
        let expected = ["index.html", "overview.svg", "overview.png", "workspace.svg", "workspace.png"];
        assert_eq!(names[..5], expected);
        assert_eq!(names[5..], ["ecm-1.svg", "ecm-1.png", "ecm-9.svg", "ecm-9.png"]);
        assert_eq!(once, pictures("twice", &scenario));
    }

    #[test]
    fn an_empty_fleet_has_pictures() {
        pictures("empty", &json!({ "agents": [] }));
    }

    #[test]
    fn an_agent_alone_has_pictures() {
        pictures("alone", &json!({ "agents": [agent(u64::MAX, [0.0, 0.0, 0.3], json!([arc(2.0, 1.0)]))] }));
    }

    #[test]
    fn agents_that_stand_on_one_point_have_pictures() {
        let agents = [agent(1, [1.0, 1.0, 0.0], json!([])), agent(2, [1.0, 1.0, 0.0], json!([]))];
        pictures("point", &json!({ "agents": agents }));
    }

    #[test]
    fn lanes_and_full_turns_have_pictures() {
        let agents = [
            agent(1, [0.0, 0.0, 0.0], json!([line(6.0)])),
            agent(2, [6.0, 0.0, std::f64::consts::PI], json!([line(6.0)])),
            agent(3, [3.0, 0.0, 0.0], json!([arc(0.2, 13.0)])),
        ];
        pictures("lanes", &json!({ "agents": agents }));
    }

    #[test]
    fn extents_may_be_huge_or_tiny() {
        let mut far = agent(2, [0.0, -1e5, std::f64::consts::FRAC_PI_2], json!([line(9e5)]));
        far["v_max"] = json!(1e3);
        far["t_start"] = json!(-9e5);
        let agents = [
            agent(1, [-9e5, 0.0, 0.0], json!([line(9e5), arc(1e6, 0.01)])),
            far,
            agent(3, [1e6, 1e6, 0.0], json!([line(1e-6)])),
        ];
        pictures("huge", &json!({ "agents": agents }));
    }

    #[test]
    fn paths_are_drawn_with_true_arcs() {
        let scenario = json!({ "agents": [agent(1, [0.0, 0.0, 0.0], json!([line(4.0), arc(1.0, 6.0)]))] });
        let files = pictures("arcs", &scenario);
        let (_, svg) = files.iter().find(|(name, _)| name == "workspace.svg").unwrap();
        let svg = std::str::from_utf8(svg).unwrap();
        let document = roxmltree::Document::parse(svg).unwrap();
        let arcs = document.descendants().filter_map(|node| node.attribute("d")).map(|d| d.matches('A').count());
        // 6 rad in parts of at most 3/4 π.
        assert_eq!(arcs.sum::<usize>(), 3);
    }

    #[test]
    fn a_directory_that_cannot_be_is_an_error() {
        let scenario = Scenario::from_json(r#"{ "agents": [] }"#).unwrap();
        let file = std::env::temp_dir().join(format!("pcr-pictures-file-{}", std::process::id()));
        fs::write(&file, "").unwrap();
        assert!(write(&scenario, None, None, &file.join("below"), &mut |_, _| {}).is_err());
        fs::remove_file(file).unwrap();
    }
}
