//! Methods of other libraries, beside those that `pcr compare` has.
//!
//! ```text
//! shape_casts   generic continuous collision detection
//! peer_program  libraries in C++, as programs beside this
//! fcl           proximity of meshes by FCL
//! box2d         the time of impact of Box2D
//! ```

mod box2d;
mod fcl;
mod peer_program;
mod shape_casts;

use pcr_comparing::compare::{self, CollisionMethod};

/// Returns all methods: those of `pcr compare`, and those of other libraries, also where the library is missing.
pub fn methods() -> Vec<Box<dyn CollisionMethod>> {
    let mut methods = compare::methods();
    methods.extend(shape_casts::methods());
    methods.extend(box2d::methods());
    methods.extend(fcl::methods());
    methods
}

/// Returns the libraries in C++ that methods use, with their versions, or that they are left out.
pub(crate) fn libraries() -> Vec<String> {
    [peer_program::PeerProgram::FCL, peer_program::PeerProgram::BOX2D].map(peer_program::PeerProgram::library).into()
}
