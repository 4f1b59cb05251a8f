//! Messages of VDA 5050 (2.0, 2.1 and 3.0), and the rules for orders and their updates. The importer, the supervisor and simulated
//! vehicles all use these.
//!
//! ```text
//! stamp        time stamps, written
//! validate     sizes, counts and numbers of a message               Limits
//! decode       bytes to values                                      Refusal
//! version      which edition of the standard                        Version
//! topics       names of topics                                      Interface, Key, Kind
//! header       header of every message                              Header
//! order        orders                                               Order
//! state        states, positions                                    State
//! messages     the other messages                                   Connection, InstantActions
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
