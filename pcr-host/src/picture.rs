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
//! svg         the writer of SVG files
//! raster      SVG to PNG
//! ```

mod axis;
mod contour;
mod labels;
mod map;
mod overview;
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
use std::{fs, io};

/// Writes all pictures of a scenario into a directory, which is created where it does not exist:
///
/// - `overview`: the workspace beside the map of the agent with the most regions,
/// - `workspace`: the paths, with the discs at their starts and ends,
/// - `ecm-<id>` for every agent: its extended collision map with its trajectory,
///
/// each as `.svg` and `.png`.
///
/// `progress` is called with the number of pictures that are done and of all there are, first with 0. Returns the files
/// in the order in which they were written. The same scenario gives the same bytes on every machine.
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
    let raster = Raster::new();
    fs::create_dir_all(directory)?;
    let total = motions.len() + 2;
    let mut files = Vec::new();
    progress(0, total);
    let mut done = 0;
    let mut put = |name: String, svg: String| -> io::Result<()> {
        for (extension, content) in [("png", raster.png(&svg)?), ("svg", svg.into_bytes())] {
            let file = directory.join(format!("{name}.{extension}"));
            fs::write(&file, content)?;
            files.push(file);
        }
        done += 1;
        progress(done, total);
        Ok(())
    };
    put("overview".into(), overview::picture(&scene))?;
    put("workspace".into(), workspace::picture(&scene))?;
    for (place, agent) in scenario.agents.iter().enumerate() {
        put(format!("ecm-{}", agent.id), map::picture(&scene, place))?;
    }
    Ok(files)
}
