//! Where two dielectrics touch: one boundary, from the one into the other, and no vacuum between them.
//!
//! A ray that goes through several boundaries at once has the index divided by that of each medium that it leaves, and
//! multiplied by that of each that it enters. Where faces overlap only in part, each hit finds out which are there.

use super::{DIRECTION, LEAVES, ORIGIN, PRIM, Stream};
use crate::geometry::Lone;
use crate::lanes::{Lanes, V3};
use crate::scene::media::CLEAR;
use crate::scene::{Joints, Media, Scene};

/// The boundaries in the places of a packet's hits.
pub struct Joined<L: Lanes> {
    /// Index of what lies behind the normal by that before it, its inverse and (n − 1)(n + 1): as a shade's colour.
    pub index: V3<L>,
    /// The medium beyond.
    pub beyond: L::U,
}

/// The boundaries of the hits at `at`, in the lanes that come from outside of their primitives or not; `alone` are those
/// of the primitives that were hit.
#[inline(always)]
pub fn joined<L: Lanes>(
    l: L,
    (scene, joints): (&Scene, &Joints),
    (hits, at): (&Stream, usize),
    outside: L::M,
    alone: Joined<L>,
) -> Joined<L> {
    let active = l.bitmask(hits.active(l, at));
    let is_joined = |lane: usize| !joints.partners(hits.value(PRIM, at + lane)).is_empty();
    let joined = (0..L::WIDTH).filter(|lane| active >> lane & 1 == 1 && is_joined(*lane));
    let (outside, mut columns, mut beyond) = (l.bitmask(outside), [[0.0; 16]; 3], [0; 16]);
    let V3 { x, y, z } = alone.index;
    [x, y, z].into_iter().zip(&mut columns).for_each(|(value, column)| l.store(value, column));
    l.store_u(alone.beyond, &mut beyond);
    for lane in joined {
        let passage = Passage::new((scene, joints), (hits, at + lane), outside >> lane & 1 == 1);
        let index = passage.index(scene);
        columns.iter_mut().zip(index).for_each(|(column, value)| column[lane] = value);
        beyond[lane] = scene.media.as_ref().map_or(CLEAR, |media| passage.beyond(media));
    }
    let [x, y, z] = columns.map(
        #[inline(always)]
        |column| l.load(&column),
    );
    Joined { index: V3::new(x, y, z), beyond: l.load_u(&beyond) }
}

/// A ray through what lies in one place.
struct Passage {
    /// Whether the ray comes from outside of the primitive that it hit.
    outside: bool,
    /// The boundaries, each of another material or side: the primitive, and whether the ray enters it.
    through: Vec<(u32, bool)>,
}

impl Passage {
    #[inline(never)]
    fn new((scene, joints): (&Scene, &Joints), (hits, at): (&Stream, usize), outside: bool) -> Self {
        let ray = Lone {
            origin: hits.triple(ORIGIN, at),
            direction: hits.triple(DIRECTION, at),
            leaves: hits.value(LEAVES, at),
        };
        let hit = hits.value(PRIM, at);
        let (mut through, mut kinds) = (vec![(hit, outside)], vec![(joints.material(hit), true)]);
        for partner in joints.partners(hit) {
            let kind = (joints.material(partner.prim), partner.same_way);
            if !kinds.contains(&kind) && scene.lies_there(partner.prim, &ray) {
                kinds.push(kind);
                through.push((partner.prim, partner.same_way == outside));
            }
        }
        Self { outside, through }
    }

    /// As the shade of the primitive that was hit would have it, were there nothing else.
    fn index(&self, scene: &Scene) -> [f32; 3] {
        let product = |enters: bool| {
            let these = self.through.iter().filter(|boundary| boundary.1 == enters);
            these.map(|(prim, _)| scene.shades[*prim as usize][4]).product::<f32>()
        };
        let (entered, left) = (product(true), product(false));
        let (n, inverse) = (entered / left, left / entered);
        let (n, inverse) = if self.outside { (n, inverse) } else { (inverse, n) };
        [n, inverse, (n - 1.0) * (n + 1.0)]
    }

    /// The medium beyond: of all that is entered the innermost, else what is around all that is left.
    fn beyond(&self, media: &Media) -> u32 {
        let enters = self.through.iter().any(|boundary| boundary.1);
        let of_these = || self.through.iter().filter(|boundary| boundary.1 == enters).map(|boundary| boundary.0);
        // From its one side to its other one.
        let sides = |prim: u32| {
            if enters { [media.outside(prim), media.inside(prim)] } else { [media.inside(prim), media.outside(prim)] }
        };
        let is_last = |prim: &u32| of_these().all(|other| other == *prim || sides(other)[0] != sides(*prim)[1]);
        of_these().find(is_last).or(of_these().next()).map_or(CLEAR, |prim| sides(prim)[1])
    }
}
