//! Paths as columns, and the stages that a stream of them passes through, one file each.
//!
//! A unit's paths are held as a structure of arrays and go through **intersect → absorb → sort → emission, environment
//! → surface → direct → diffuse, mirror, dielectric**, bounce by bounce, until none is left. Each stage is a short
//! function over lanes that handles one material or one task for all its paths and pushes survivors to the next
//! stream, in order. Radiance is added to the path's own slot, so no order of work can change a bit.

pub mod absorb;
pub mod dielectric;
pub mod diffuse;
pub mod direct;
pub mod emission;
pub mod environment;
pub mod gather;
pub mod generate;
pub mod intersect;
pub mod joined;
pub mod mirror;
pub mod roulette;
pub mod slots;
pub mod sort;
pub mod surface;

pub use slots::Slots;

use crate::lanes::{Lanes, V3};
use crate::mutant::mutant;
use crate::sampling::Keys;

/// Three columns: where the ray starts; after [`surface`] the point it hit, moved off the surface.
pub const ORIGIN: usize = 0;
/// Three columns: where the ray goes; after [`surface`] the normal on the side it came from.
pub const DIRECTION: usize = 3;
/// Three columns: what a radiance at the end of the ray counts for in the slot.
pub const THROUGHPUT: usize = 6;
/// Surface that the ray leaves; after [`surface`] the one it hit.
pub const LEAVES: usize = 9;
/// Hash of (seed, pixel, round).
pub const KEY: usize = 10;
/// Sample number in the round with its 32 bits reversed (upper half), slot (lower half).
pub const SLOT: usize = 11;
/// Distance to the hit.
pub const DISTANCE: usize = 12;
/// Primitive that was hit.
pub const PRIM: usize = 13;
/// Solid-angle density with which the last scattering chose the direction; 0 after a specular one or the camera, or −1
/// after a diffuse and then only specular ones where the plan wants it marked. Only where light can be found in two ways.
pub const PDF: usize = 14;
/// Product of (n_i / n_t)² over the refractions so far, and 1 / the density of the place in the pixel. Only where something
/// refracts, or pixels have glints.
pub const ETA: usize = 15;
/// Number of the medium that the ray travels in. Only where something absorbs.
pub const MEDIUM: usize = 16;
const COLUMNS: usize = 17;

/// Slots of one batch: their numbers fit the lower half of [`SLOT`].
pub const MOST_SLOTS: usize = 1 << 16;

/// Widest level; columns are padded by as much.
const PADDING: usize = 16;

/// A stream of paths.
#[derive(Clone, Debug, Default)]
pub struct Stream {
    columns: Vec<u32>,
    stride: usize,
    len: usize,
    /// Columns that this plan uses; the others are neither moved nor allocated.
    used: Columns,
}

/// Which of the optional columns a plan allocates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Columns {
    /// [`PDF`].
    pub pdf: bool,
    /// [`ETA`].
    pub eta: bool,
    /// [`MEDIUM`].
    pub medium: bool,
    /// Whether [`PDF`] is negative after specular bounces that follow on a diffuse one.
    pub marks: bool,
}

impl Columns {
    /// Number of columns up to the last one used.
    pub fn count(self) -> usize {
        if self.medium {
            COLUMNS
        } else if self.eta {
            ETA + 1
        } else if self.pdf {
            PDF + 1
        } else {
            PRIM + 1
        }
    }
}

impl Stream {
    /// An empty stream for `capacity` paths.
    pub fn new(capacity: usize, used: Columns) -> Self {
        // One packet of padding more than needed keeps the columns off one another's cache sets.
        let stride = capacity + 2 * PADDING;
        Self { columns: vec![0; stride * used.count()], stride, len: 0, used }
    }

    /// Number of paths.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether no path is left.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The optional columns that it has.
    pub fn columns_used(&self) -> Columns {
        self.used
    }

    /// Forgets all paths.
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Makes room for `more` paths behind those that are there.
    pub fn reserve(&mut self, more: usize) {
        if self.len + more + 2 * PADDING <= self.stride {
            return;
        }
        let mut larger = Stream::new((self.len + more).next_power_of_two(), self.used);
        for column in 0..self.used.count() {
            let (from, to) = (column * self.stride, column * larger.stride);
            larger.columns[to..to + self.len].copy_from_slice(&self.columns[from..from + self.len]);
        }
        larger.len = self.len;
        *self = larger;
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> u64 {
        (self.columns.len() * size_of::<u32>()) as u64
    }

    /// Lanes of the packet at `at` that are paths.
    #[inline(always)]
    pub fn active<L: Lanes>(&self, l: L, at: usize) -> L::M {
        let lost = usize::from(mutant!("last_lane_lost") && at > 0);
        l.first((self.len - at - lost).min(L::WIDTH))
    }

    /// A packet of a column.
    #[inline(always)]
    pub fn u<L: Lanes>(&self, l: L, column: usize, at: usize) -> L::U {
        l.load_u(&self.columns[column * self.stride + at..])
    }

    /// A packet of a column as f32.
    #[inline(always)]
    pub fn f<L: Lanes>(&self, l: L, column: usize, at: usize) -> L::F {
        l.reinterpret(self.u(l, column, at))
    }

    /// A packet of three columns.
    #[inline(always)]
    pub fn v3<L: Lanes>(&self, l: L, column: usize, at: usize) -> V3<L> {
        V3::new(self.f(l, column, at), self.f(l, column + 1, at), self.f(l, column + 2, at))
    }

    /// What the sampler needs to know of a packet.
    #[inline(always)]
    pub fn keys<L: Lanes>(&self, l: L, at: usize) -> Keys<L> {
        Keys { key: self.u(l, KEY, at), index: self.u(l, SLOT, at) & l.u(0xffff_0000) }
    }

    /// Overwrites a packet of a column.
    #[inline(always)]
    pub fn set_u<L: Lanes>(&mut self, l: L, column: usize, at: usize, value: L::U) {
        l.store_u(value, &mut self.columns[column * self.stride + at..]);
    }

    /// Overwrites a packet of a column.
    #[inline(always)]
    pub fn set_f<L: Lanes>(&mut self, l: L, column: usize, at: usize, value: L::F) {
        self.set_u(l, column, at, l.bits(value));
    }

    /// Overwrites a packet of three columns.
    #[inline(always)]
    pub fn set_v3<L: Lanes>(&mut self, l: L, column: usize, at: usize, value: V3<L>) {
        self.set_f(l, column, at, value.x);
        self.set_f(l, column + 1, at, value.y);
        self.set_f(l, column + 2, at, value.z);
    }

    /// Starts to push the lanes `mask` behind the last path; columns are given one by one.
    #[inline(always)]
    pub fn push<L: Lanes>(&mut self, l: L, mask: L::M) -> Push<'_, L> {
        let at = self.len;
        self.len += l.bitmask(mask).count_ones() as usize;
        Push { stream: self, at, mask, l }
    }

    /// Sets the number of paths after packets have been written in place.
    pub fn set_len(&mut self, len: usize) {
        self.len = len;
    }

    /// Column `column` of path `at`.
    pub fn value(&self, column: usize, at: usize) -> u32 {
        self.columns[column * self.stride + at]
    }

    /// Overwrites column `column` of path `at`.
    pub fn set_value(&mut self, column: usize, at: usize, value: u32) {
        self.columns[column * self.stride + at] = value;
    }

    /// Overwrites columns `column`, `column + 1`, `column + 2` of path `at`.
    pub fn set_triple(&mut self, column: usize, at: usize, values: [f32; 3]) {
        for (k, value) in values.into_iter().enumerate() {
            self.set_value(column + k, at, value.to_bits());
        }
    }

    /// Slot of path `at`.
    pub fn slot(&self, at: usize) -> usize {
        self.value(SLOT, at) as usize & 0xffff
    }

    /// Columns `column`, `column + 1`, `column + 2` of path `at`.
    pub fn triple(&self, column: usize, at: usize) -> [f32; 3] {
        [0, 1, 2].map(|k| f32::from_bits(self.value(column + k, at)))
    }

    /// Pushes the lanes `mask` of the packet `at` of `from`, every column in use.
    #[inline(always)]
    pub fn push_from<L: Lanes>(&mut self, l: L, from: &Stream, at: usize, mask: L::M) {
        let mut to = self.len;
        for column in 0..self.used.count() {
            l.compress(mask, from.u(l, column, at), &mut self.columns[column * self.stride + to..]);
        }
        to += l.bitmask(mask).count_ones() as usize;
        self.len = to;
    }
}

/// Lanes on their way to the end of a stream.
pub struct Push<'s, L: Lanes> {
    stream: &'s mut Stream,
    at: usize,
    mask: L::M,
    l: L,
}

impl<L: Lanes> Push<'_, L> {
    /// Gives one column.
    #[inline(always)]
    pub fn u(&mut self, column: usize, value: L::U) -> &mut Self {
        self.l.compress(self.mask, value, &mut self.stream.columns[column * self.stream.stride + self.at..]);
        self
    }

    /// Gives one column.
    #[inline(always)]
    pub fn f(&mut self, column: usize, value: L::F) -> &mut Self {
        self.u(column, self.l.bits(value))
    }

    /// Gives three columns.
    #[inline(always)]
    pub fn v3(&mut self, column: usize, value: V3<L>) -> &mut Self {
        self.f(column, value.x).f(column + 1, value.y).f(column + 2, value.z)
    }
}

/// A packet of a stream and the rays that leave it.
pub struct Scattered<L: Lanes> {
    /// Where they start.
    pub origin: V3<L>,
    /// Where they go.
    pub direction: V3<L>,
    /// Their throughput.
    pub throughput: V3<L>,
    /// Surface that they leave.
    pub leaves: L::U,
    /// Solid-angle density of the direction, 0 if specular.
    pub pdf: L::F,
    /// Product of (n_i / n_t)² so far.
    pub eta: L::F,
    /// What they travel in.
    pub medium: L::U,
}

impl Stream {
    /// Pushes scattered rays: the lanes `mask` of the packet at `at` of `from`.
    #[inline(always)]
    pub fn scatter<L: Lanes>(&mut self, l: L, from: &Stream, at: usize, mask: L::M, rays: &Scattered<L>) {
        let used = self.used;
        let mut push = self.push(l, mask);
        push.v3(ORIGIN, rays.origin).v3(DIRECTION, rays.direction).v3(THROUGHPUT, rays.throughput);
        push.u(LEAVES, rays.leaves).u(KEY, from.u(l, KEY, at)).u(SLOT, from.u(l, SLOT, at));
        if used.pdf {
            push.f(PDF, rays.pdf);
        }
        if used.eta {
            push.f(ETA, rays.eta);
        }
        if used.medium {
            push.u(MEDIUM, rays.medium);
        }
    }

    /// What a packet travels in; 0 where nothing absorbs.
    #[inline(always)]
    pub fn medium<L: Lanes>(&self, l: L, at: usize) -> L::U {
        if self.used.medium { self.u(l, MEDIUM, at) } else { l.u(0) }
    }

    /// The product of (n_i / n_t)² of a packet; 1 where nothing refracts.
    #[inline(always)]
    pub fn eta<L: Lanes>(&self, l: L, at: usize) -> L::F {
        if self.used.eta { self.f(l, ETA, at) } else { l.f(1.0) }
    }

    /// What [`PDF`] becomes by a specular bounce.
    #[inline(always)]
    pub fn specular_pdf<L: Lanes>(&self, l: L, at: usize) -> L::F {
        // What a lamp is weighed by after a mirror is then the density of the diffuse bounce before it.
        if mutant!("specular_flag_not_set") && self.used.pdf {
            return self.f(l, PDF, at);
        }
        if !self.used.marks {
            return l.f(0.0);
        }
        l.select(l.eq(self.f(l, PDF, at), l.f(0.0)), l.f(0.0), l.f(-1.0))
    }

    /// Lanes whose paths came from the camera by specular bounces alone; all where the plan does not mark the others.
    #[inline(always)]
    pub fn comes_from_camera<L: Lanes>(&self, l: L, at: usize) -> L::M {
        if self.used.marks { l.eq(self.f(l, PDF, at), l.f(0.0)) } else { l.m(true) }
    }

    /// The scattering density of a packet; 0 where light is found in one way only.
    #[inline(always)]
    pub fn pdf<L: Lanes>(&self, l: L, at: usize) -> L::F {
        if self.used.pdf { self.f(l, PDF, at) } else { l.f(0.0) }
    }
}
