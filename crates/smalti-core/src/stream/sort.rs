//! Sorts hits by what comes next: emission, the environment, and one stream a material.

use super::{PRIM, Stream};
use crate::accel::MISS;
use crate::lanes::Lanes;
use crate::mutant::mutant;
use crate::scene::{Class, Scene};

/// Where hits are sorted to; a stream that the plan has no stage for is `None`.
pub struct Bins<'w> {
    /// Hits on emitters.
    pub emitters: Option<&'w mut Stream>,
    /// Misses.
    pub escaped: Option<&'w mut Stream>,
    /// Hits by material, in the order of [`Class`] from `Lambert` on.
    pub materials: [Option<&'w mut Stream>; 3],
}

/// Sorts the stream; with `ends` paths scatter no more and only emission is sorted out.
#[inline(always)]
pub fn run<L: Lanes>(l: L, scene: &Scene, ends: bool, rays: &Stream, bins: &mut Bins<'_>) {
    for at in (0..rays.len()).step_by(L::WIDTH) {
        let active = rays.active(l, at);
        let prim = rays.u(l, PRIM, at);
        let missed = l.eq_u(prim, l.u(MISS));
        let hit = active & !missed;
        push(l, bins.escaped.as_deref_mut(), rays, at, active & missed);
        if !l.any(hit) || (ends && mutant!("paths_dropped_at_the_depth_cap")) {
            continue;
        }
        let code = l.gather_u(&scene.classes, l.select_u(hit, prim, l.u(0)));
        let emits = hit & !l.eq_u(l.shr::<{ Class::BITS }>(code), l.u(0));
        push(l, bins.emitters.as_deref_mut(), rays, at, emits);
        if ends {
            continue;
        }
        let class = code & l.u((1 << Class::BITS) - 1);
        for (number, bin) in bins.materials.iter_mut().enumerate() {
            let of_this = hit & l.eq_u(class, l.u(number as u32 + Class::Lambert as u32));
            push(l, bin.as_deref_mut(), rays, at, of_this);
        }
    }
}

#[inline(always)]
fn push<L: Lanes>(l: L, bin: Option<&mut Stream>, rays: &Stream, at: usize, mask: L::M) {
    if let Some(bin) = bin
        && l.any(mask)
    {
        bin.push_from(l, rays, at, mask);
    }
}
