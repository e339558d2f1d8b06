//! Rays from the camera along chains of specular vertices, many at a time.

use glam::{DVec2, DVec3};

use crate::accel::MISS;
use crate::lanes::dispatch;
use crate::lanes::{Lanes, V3};
use crate::light::table::NO_SURFACE;
use crate::render::Renderer;
use crate::scene::{Class, Scene, View};
use crate::settings::Fresnel;
use crate::stream::dielectric::{Crossing, FORK};
use crate::stream::{
    Columns, DIRECTION, ETA, LEAVES, MEDIUM, ORIGIN, PRIM, SLOT, Stream, THROUGHPUT, generate, intersect,
};

/// What a chain does at its specular vertices, one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// It is reflected, by a mirror or a dielectric.
    Reflect,
    /// It is refracted.
    Refract,
}

/// A ray of a chain.
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// Where it starts, in the frame.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    /// The primitive that it hits, [`MISS`] for none.
    pub hit: u32,
    /// Stands for the turns that the chain has taken, and where: unlike ways have unlike numbers, but for rare chance.
    pub way: u64,
    /// Whether the chain has met spheres alone, one at least.
    pub round: bool,
}

/// Chains that have taken the same turns, and hit something or nothing after the last.
pub struct Front {
    rays: Stream,
    /// For each place of the picture that chains began at, the last ray; `None` where the chain cannot take those turns.
    pub links: Vec<Option<Link>>,
}

impl Front {
    /// The camera rays through these places of the picture, in pixels.
    pub fn begin(renderer: &Renderer, places: impl Iterator<Item = DVec2>) -> Self {
        let places: Vec<DVec2> = places.collect();
        let rays = camera_rays(renderer, &places);
        Self::traced(renderer, rays, (Turn::Refract, &vec![None; places.len()]))
    }

    /// The chains that begin at these places, after all these turns.
    pub fn after(renderer: &Renderer, places: impl Iterator<Item = DVec2>, turns: &[Turn]) -> Self {
        turns.iter().fold(Self::begin(renderer, places), |front, turn| front.turned(renderer, *turn))
    }

    /// The chains one turn later.
    pub fn turned(&self, renderer: &Renderer, turn: Turn) -> Self {
        let mut rays = self.rays.clone();
        let mut next = Stream::new(rays.len(), rays.columns_used());
        let (scene, fresnel) = (renderer.scene(), renderer.settings().fresnel);
        dispatch!(renderer.token(), l => scatter(l, scene, (fresnel, turn), &mut rays, &mut next));
        Self::traced(renderer, next, (turn, &self.links))
    }

    /// Whether no chain is left.
    pub fn is_empty(&self) -> bool {
        self.rays.is_empty()
    }

    /// Finds what the rays hit, that have come from these links by a turn.
    fn traced(renderer: &Renderer, mut rays: Stream, (turn, before): (Turn, &[Option<Link>])) -> Self {
        dispatch!(renderer.token(), l => intersect::run(l, &renderer.plan().everything, &mut rays));
        let mut links = vec![None; before.len()];
        for at in 0..rays.len() {
            let place = rays.value(SLOT, at) as usize;
            let [origin, direction] = [ORIGIN, DIRECTION].map(|k| DVec3::from_array(rays.triple(k, at).map(f64::from)));
            let (way, round) = before[place].map_or((0, false), |link| {
                let scene = renderer.scene();
                let round = scene.surface(link.hit) >= scene.planes && (link.round || link.way == 0);
                (mixed(link.way, (turn, link.hit)), round)
            });
            links[place] = Some(Link { origin, direction, hit: rays.value(PRIM, at), way, round });
        }
        Self { rays, links }
    }
}

/// A way's number with one more turn at a primitive (the steps of SplitMix64: Steele, Lea and Flood 2014).
fn mixed(way: u64, (turn, hit): (Turn, u32)) -> u64 {
    let mixed = (way ^ (u64::from(hit) << 1 | turn as u64)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb)
}

/// Rays of the camera through these places.
fn camera_rays(renderer: &Renderer, places: &[DVec2]) -> Stream {
    let (scene, settings) = (renderer.scene(), renderer.settings());
    let view: &View = &scene.views[settings.camera];
    let medium = renderer.plan().columns.medium;
    let used = Columns { pdf: false, eta: true, medium, marks: false };
    let mut rays = Stream::new(places.len(), used);
    rays.set_len(places.len());
    for (at, place) in places.iter().enumerate() {
        let direction = generate::direction(view, settings, place.to_array());
        rays.set_triple(ORIGIN, at, view.eye);
        rays.set_triple(DIRECTION, at, direction);
        rays.set_triple(THROUGHPUT, at, [1.0; 3]);
        rays.set_value(LEAVES, at, NO_SURFACE);
        rays.set_value(SLOT, at, at as u32);
        rays.set_value(ETA, at, 1.0f32.to_bits());
        if medium {
            rays.set_value(MEDIUM, at, renderer.medium_of_camera());
        }
    }
    rays
}

/// Sends on what can take this turn where it hit: a dielectric only if that way carries enough for paths to follow it
/// whatever chance says.
#[inline(always)]
fn scatter<L: Lanes>(l: L, scene: &Scene, (fresnel, turn): (Fresnel, Turn), rays: &mut Stream, next: &mut Stream) {
    let reflects = turn == Turn::Reflect;
    for at in (0..rays.len()).step_by(L::WIDTH) {
        let prim = rays.u(l, PRIM, at);
        let hit = rays.active(l, at) & !l.eq_u(prim, l.u(MISS));
        let prim = l.select_u(hit, prim, l.u(0));
        let class = l.gather_u(&scene.classes, prim) & l.u((1 << Class::BITS) - 1);
        let of = |class_of: Class| hit & l.eq_u(class, l.u(class_of as u32));
        let (mirror, glass) = (of(Class::Mirror) & l.m(reflects), of(Class::Dielectric));
        if !l.any(mirror | glass) {
            continue;
        }
        // Lanes that hit nothing are computed as if they had hit the first primitive, and dropped.
        rays.set_u(l, PRIM, at, prim);
        let crossing = Crossing::at(l, scene, fresnel, rays, at);
        let share = crossing.shares(l)[usize::from(!reflects)];
        let goes = mirror | (glass & l.le(l.f(FORK), share));
        let throughput = V3::splat(l, [1.0; 3]);
        let sent = crossing.rays(l, mirror | l.m(reflects), rays, at, throughput);
        let mut push = next.push(l, goes);
        push.v3(ORIGIN, sent.origin).v3(DIRECTION, sent.direction).v3(THROUGHPUT, throughput);
        push.u(LEAVES, sent.leaves).u(SLOT, rays.u(l, SLOT, at)).f(ETA, sent.eta);
        if rays.columns_used().medium {
            push.u(MEDIUM, sent.medium);
        }
    }
}
