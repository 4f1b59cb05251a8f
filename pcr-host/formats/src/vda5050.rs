//! Messages of VDA 5050 (2.0, 2.1 and 3.0), and the rules for orders and their updates. The importer, the supervisor and simulated
//! vehicles all use these.
//!
//! ```text
//! timestamp    time stamps, written
//! validate     sizes, counts and numbers of a message
//! decode       bytes to values
//! version      which edition of the standard
//! topics       names of topics
//! header       header of every message
//! order        orders
//! state        states, positions
//! zone_set     zones
//! messages     the other messages
//! order_state  an order as its receiver keeps it, updates stitched  OrderState
//! ```

pub mod decode;
pub mod header;
pub mod messages;
pub mod order;
pub mod order_state;
pub mod state;
pub mod timestamp;
pub mod topics;
mod validate;
pub mod version;
pub mod zone_set;
