//! Pictures of a scenario and its collision regions: SVG, PNG, and a page to explore them in a browser.
//!
//! ```text
//! scene       motions, regions and their outlines, shared by all pictures
//! contour     the exact outline of a region in time and travelled length
//! axis        metres and seconds to pixels, ticks
//! labels      where labels go
//! palette     colours of the agents
//! workspace   paper Fig. 10: paths and discs
//! map         paper Fig. 11: the extended collision map of an agent
//! overview    both side by side
//! page        the same in a browser, with a time slider
//! svg         the writer of SVG files
//! raster      SVG to PNG
//! ```

mod axis;
mod contour;
mod labels;
mod map;
mod overview;
mod page;
mod palette;
mod raster;
mod scene;
mod svg;
mod workspace;

use crate::fleet::{Fleet, build_ecm};
use crate::scenario::Scenario;
use raster::Raster;
use scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::{fs, io, thread};

/// Writes all pictures of a scenario into a directory, which is created where it does not exist:
///
/// - `index.html`: the workspace and the map of a selected agent in a browser, in motion, without any other file;
/// - `overview`: the workspace beside the map of the agent with the most regions,
/// - `workspace`: the paths, with the discs at their starts and ends,
/// - `ecm-<id>` for every agent: its extended collision map with its trajectory,
///
/// all but the first as `.svg` and `.png`.
///
/// `progress` is called with the number of pictures that are done and of all there are, first with 0. Returns the files
/// in a fixed order. The same scenario gives the same bytes on every machine.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for a scenario without motion (see [`Fleet::new`]) or of more than 65535 agents, and
/// those of writing files.
pub fn write(
    scenario: &Scenario,
    directory: &Path,
    progress: &mut dyn FnMut(usize, usize),
) -> io::Result<Vec<PathBuf>> {
    let invalid = |why: String| io::Error::new(io::ErrorKind::InvalidInput, why);
    let fleet = Fleet::<f64>::new(scenario).map_err(|refused| invalid(refused.to_string()))?;
    let motions = fleet.motions();
    let ecm = build_ecm(&motions).map_err(|full| invalid(full.to_string()))?;
    let scene = Scene { scenario, motions: &motions, ecm: &ecm };
    fs::create_dir_all(directory)?;
    let mut pictures = vec![Picture::Page, Picture::Overview, Picture::Workspace];
    pictures.extend((0..motions.len()).map(Picture::Map));
    let mut files = vec![Vec::new(); pictures.len()];
    let mut done = 0;
    progress(done, pictures.len());
    draw_all(&scene, &pictures, &mut |place, drawn| {
        for (name, content) in drawn? {
            let file = directory.join(name);
            fs::write(&file, content)?;
            files[place].push(file);
        }
        done += 1;
        progress(done, pictures.len());
        Ok(())
    })?;
    Ok(files.concat())
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

/// Files with their names.
type Files = Vec<(String, Vec<u8>)>;

impl Picture {
    fn draw(self, scene: &Scene<'_>, raster: &Raster) -> io::Result<Files> {
        let (name, svg) = match self {
            Self::Page => return Ok(vec![("index.html".to_owned(), page::page(scene).into_bytes())]),
            Self::Overview => ("overview".to_owned(), overview::picture(scene)),
            Self::Workspace => ("workspace".to_owned(), workspace::picture(scene)),
            Self::Map(ego) => (format!("ecm-{}", scene.id(ego)), map::picture(scene, ego)),
        };
        let png = raster.png(&svg)?;
        Ok(vec![(format!("{name}.svg"), svg.into_bytes()), (format!("{name}.png"), png)])
    }
}

/// Draws on all cores; hands over each picture with its place in the list, in the order in which they are done.
fn draw_all(
    scene: &Scene<'_>,
    pictures: &[Picture],
    take: &mut dyn FnMut(usize, io::Result<Files>) -> io::Result<()>,
) -> io::Result<()> {
    let workers = thread::available_parallelism().map_or(1, usize::from).min(pictures.len());
    let next = AtomicUsize::new(0);
    let raster = Raster::new();
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..workers {
            let sender = sender.clone();
            let (next, raster) = (&next, &raster);
            scope.spawn(move || {
                loop {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    let Some(picture) = pictures.get(place) else {
                        break;
                    };
                    // Nobody listens any more after an error.
                    if sender.send((place, picture.draw(scene, raster))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        receiver.into_iter().try_for_each(|(place, drawn)| take(place, drawn))
    })
}
