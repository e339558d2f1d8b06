//! Shadow photons (Jensen 1996, report §1.3): where a light is seen, where it is not, and where a shadow ray must tell.
//!
//! Photons leave every light. Where one first lands the light is seen; it is followed on through everything that it
//! meets, and where it lands then the light is hidden. A leaf of the tree of all of them in which a light has only
//! photons of one kind, all on one side of one primitive, is **decided** for that light; the others are not.
//!
//! Jensen leaves the shadow rays out where photons decide, and lives with the error. Here one in [`ONE_IN`] is asked all
//! the same and counts for the difference of what it finds and what the photons said: the saving is almost as large, and
//! the mean is that of asking all.

use serde::{Deserialize, Serialize};

use super::kd_tree::{BLOCK, Tree};
use super::{Surfaces, Tag};
use crate::lanes::{Lanes, V3};

/// Photons that leave the lights.
pub const PHOTONS: u32 = 1 << 17;

/// Where photons decide, one shadow ray in so many is asked.
pub const ONE_IN: u32 = 16;

/// Photons of a light that decide a leaf for it.
const ENOUGH: u32 = 4;

/// Lights that are told apart: those of higher numbers are never decided. (Their bits are those of an f32 that is a
/// number.)
const LIGHTS: u32 = 23;

/// Mark of a photon that went through something, among its scattering events.
pub const HIDDEN: u32 = 1 << 31;

/// What photons say of the lights.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Visibility {
    tree: Tree,
    /// For each leaf the tag of its photons ([`MIXED`] if they differ), and one bit a light that is seen, that is hidden.
    leaves: Vec<[f32; 4]>,
}

/// No tag: photons of a leaf lie on several primitives or sides.
const MIXED: u32 = 1 << Tag::BITS;

/// What is decided at a packet of points.
#[derive(Clone, Copy)]
pub struct Decided<L: Lanes> {
    seen: L::U,
    hidden: L::U,
}

impl Visibility {
    /// From photons whose number of scattering events is that of their light, with [`HIDDEN`] where they went through
    /// something.
    pub fn new(tree: Tree) -> Self {
        let leaves = (0..tree.blocks.len()).map(|leaf| of_leaf(&tree, leaf)).collect();
        Self { tree, leaves }
    }

    /// Whether it can be asked: see [`Tree::is_sound`].
    pub fn is_sound(&self, prims: u32) -> bool {
        self.tree.is_sound(prims) && self.leaves.len() == self.tree.blocks.len()
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        self.tree.bytes() + size_of_val(&self.leaves[..]) as u64
    }

    /// What is decided at the points of a packet, on the side of their normals.
    #[inline(always)]
    pub fn at<L: Lanes>(&self, l: L, surfaces: &Surfaces, prim: L::U, place: (V3<L>, V3<L>)) -> Decided<L> {
        let nothing = l.u(0);
        if self.leaves.is_empty() {
            return Decided { seen: nothing, hidden: nothing };
        }
        let [tag, seen, hidden, _] = l.gather_record(&self.leaves, self.tree.leaf(l, place.0));
        let (_, own) = surfaces.side(l, prim, place);
        let same = l.eq_u(own, l.bits(tag));
        Decided { seen: l.select_u(same, l.bits(seen), nothing), hidden: l.select_u(same, l.bits(hidden), nothing) }
    }
}

impl<L: Lanes> Decided<L> {
    /// Lanes in which the light of row `row` is known to be seen, and to be hidden.
    #[inline(always)]
    pub fn of(&self, l: L, row: L::U) -> (L::M, L::M) {
        let known = l.lt_u(row, l.u(LIGHTS));
        let shift = l.select_u(known, row, l.u(0));
        let bit = |bits: L::U| known & !l.eq_u(l.shr_each(bits, shift) & l.u(1), l.u(0));
        (bit(self.seen), bit(self.hidden))
    }
}

fn of_leaf(tree: &Tree, leaf: usize) -> [f32; 4] {
    let mut tag = None;
    let mut counts = [[0u32; LIGHTS as usize]; 2];
    for (place, flux) in (leaf * BLOCK..(leaf + 1) * BLOCK).filter_map(|number| tree.photon(number)) {
        let own = place[3].to_bits();
        tag = Some(if tag.is_none_or(|other| other == own) { own } else { MIXED });
        let light = flux[3].to_bits();
        if let Some(count) = counts[usize::from(light & HIDDEN != 0)].get_mut((light & !HIDDEN) as usize) {
            *count += 1;
        }
    }
    let bits = |kind: usize| {
        let decided = |light: &u32| {
            let [of_kind, others] = [counts[kind], counts[1 - kind]].map(|counts| counts[*light as usize]);
            of_kind >= ENOUGH && others == 0
        };
        (0..LIGHTS).filter(decided).fold(0, |bits, light| bits | 1 << light)
    };
    [tag.unwrap_or(MIXED), bits(0), bits(1), 0].map(f32::from_bits)
}
