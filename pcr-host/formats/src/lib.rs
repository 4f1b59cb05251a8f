//! The files that the tool `pcr` reads and writes: scenarios; layouts, orders and plans in other formats.
//!
//! ```text
//! scenario        scenario files, and their errors                Scenario, Agent
//! footprint       outlines that are polygons, cut into convex parts     Footprint
//! import          layouts, orders and plans in other formats      Layout
//! input           files and JSON Lines, errors with their places
//! json            JSON with the place of every value
//! missions        vehicles, missions, closures and breakdowns     FleetMissions
//! unique_keys     JSON without repeated names
//! output          files that are written completely or not at all
//! paper_example   the embedded scenario and the paper's numbers
//! plane_geometry  points and angles of the plane
//! splitmix64      random numbers that are the same on every machine
//! vda5050         messages of VDA 5050, and the rules for orders  Order, OrderState
//! warning         codes of warnings                               WarningCode
//! yaml            YAML with the place of every value
//! ```

mod answer_files;
mod byte_order_mark;
pub mod footprint;
pub mod import;
pub mod input;
pub mod json;
pub mod missions;
pub mod output;
pub mod paper_example;
pub mod plane_geometry;
pub mod scenario;
pub mod splitmix64;
pub mod unique_keys;
pub mod vda5050;
pub mod warning;
pub mod yaml;
