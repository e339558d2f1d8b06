//! Three-vectors and colours over lanes.

use core::ops::{Add, Mul, Neg, Sub};

use super::Lanes;

/// A point, direction or colour in every lane.
pub struct V3<L: Lanes> {
    /// First component.
    pub x: L::F,
    /// Second component.
    pub y: L::F,
    /// Third component.
    pub z: L::F,
}

/// Linear RGB in every lane.
pub type Rgb<L> = V3<L>;

impl<L: Lanes> Clone for V3<L> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}
impl<L: Lanes> Copy for V3<L> {}

impl<L: Lanes> V3<L> {
    /// From components.
    #[inline(always)]
    pub fn new(x: L::F, y: L::F, z: L::F) -> Self {
        Self { x, y, z }
    }

    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(l: L, v: [f32; 3]) -> Self {
        Self::new(l.f(v[0]), l.f(v[1]), l.f(v[2]))
    }

    /// Scalar product x·x' + (y·y' + z·z').
    #[inline(always)]
    pub fn dot(self, l: L, other: Self) -> L::F {
        l.mul_add(self.x, other.x, l.mul_add(self.y, other.y, self.z * other.z))
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, l: L, other: Self) -> Self {
        Self::new(
            l.mul_add(self.y, other.z, -(self.z * other.y)),
            l.mul_add(self.z, other.x, -(self.x * other.z)),
            l.mul_add(self.x, other.y, -(self.y * other.x)),
        )
    }

    /// self + s·direction.
    #[inline(always)]
    pub fn along(self, l: L, s: L::F, direction: Self) -> Self {
        Self::new(
            l.mul_add(s, direction.x, self.x),
            l.mul_add(s, direction.y, self.y),
            l.mul_add(s, direction.z, self.z),
        )
    }

    /// Scaled by one factor a lane.
    #[inline(always)]
    pub fn scale(self, s: L::F) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }

    /// Unit length (to rounding).
    #[inline(always)]
    pub fn normalised(self, l: L) -> Self {
        self.scale(l.f(1.0) / l.sqrt(self.dot(l, self)))
    }

    /// Its length.
    #[inline(always)]
    pub fn length(self, l: L) -> L::F {
        l.sqrt(self.dot(l, self))
    }

    /// The three, as an array.
    #[inline(always)]
    pub fn components(self) -> [L::F; 3] {
        [self.x, self.y, self.z]
    }

    /// Largest component.
    #[inline(always)]
    pub fn max_component(self, l: L) -> L::F {
        l.max(self.x, l.max(self.y, self.z))
    }

    /// Largest magnitude of a component.
    #[inline(always)]
    pub fn max_abs(self, l: L) -> L::F {
        Self::new(l.abs(self.x), l.abs(self.y), l.abs(self.z)).max_component(l)
    }

    /// `a` where `mask`, else `b`.
    #[inline(always)]
    pub fn select(l: L, mask: L::M, a: Self, b: Self) -> Self {
        Self::new(l.select(mask, a.x, b.x), l.select(mask, a.y, b.y), l.select(mask, a.z, b.z))
    }
}

impl<L: Lanes> Add for V3<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<L: Lanes> Sub for V3<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<L: Lanes> Neg for V3<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

/// Component by component, as colours multiply.
impl<L: Lanes> Mul for V3<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }
}
