//! Where photon maps are kept from one render to the next.

use smalti_core::photon::Maps;
use smalti_core::photon::maps::{Kept, Pilots};

/// A place for the photon maps of a scene, which do not depend on the camera. Asked between passes; nobody renders
/// meanwhile.
pub trait Shelf: Sync {
    /// The maps of a round, if they are there.
    fn take(&self, round: u32) -> Option<(Kept, Pilots)>;
    /// Keeps the maps of a round that was not there.
    fn put(&self, maps: &Maps);
}
