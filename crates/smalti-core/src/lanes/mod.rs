//! The one place that knows SIMD: lane types, masks, levels and dispatch.
//!
//! Kernels are written once, generic over [`Lanes`], and run on `L::WIDTH` paths (or triangles, or boxes) at a time.
//! Every operation is IEEE-exact and the same at every width: `+ - * /` and [`Lanes::sqrt`] round once, nothing is fused,
//! minimum and maximum are comparisons with a stated answer for NaN, and nothing here estimates. So one kernel gives
//! the same bits on AVX-512 and on plain f32.
//!
//! **Every function that takes lanes must be `#[inline(always)]`**, closures too: a call across the boundary of a
//! `target_feature` function turns each operation into a call, which is ten times slower. `dispatch!` is the only
//! entry.

pub mod level;
pub mod math;
mod one;
mod vec3;
mod wide;

use core::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

pub use level::Level;
pub(crate) use level::dispatch;
pub use one::One;
pub use vec3::{Rgb, V3};
pub use wide::{Native, Octet};

/// A token for a SIMD level and a width; `F`, `U` and `M` are its lanes of f32, u32 and bool.
pub trait Lanes: Copy {
    /// Number of lanes.
    const WIDTH: usize;
    /// f32 lanes.
    type F: Copy
        + Add<Output = Self::F>
        + Sub<Output = Self::F>
        + Mul<Output = Self::F>
        + Div<Output = Self::F>
        + Neg<Output = Self::F>;
    /// u32 lanes.
    type U: Copy + BitAnd<Output = Self::U> + BitOr<Output = Self::U> + BitXor<Output = Self::U> + Not<Output = Self::U>;
    /// One bool a lane.
    type M: Copy + BitAnd<Output = Self::M> + BitOr<Output = Self::M> + Not<Output = Self::M>;
    /// Eight lanes at this level, for one ray against eight boxes or triangles.
    type Eight: Lanes;

    /// The token of the eight lanes.
    fn eight(self) -> Self::Eight;

    /// The same f32 in every lane.
    fn f(self, x: f32) -> Self::F;
    /// The same u32 in every lane.
    fn u(self, x: u32) -> Self::U;
    /// The same bool in every lane.
    fn m(self, x: bool) -> Self::M;
    /// 0, 1, 2, ...
    fn iota(self) -> Self::U;

    /// The first `WIDTH` values of `from`.
    fn load(self, from: &[f32]) -> Self::F;
    /// The first `WIDTH` values of `from`.
    fn load_u(self, from: &[u32]) -> Self::U;
    /// Writes the first `WIDTH` values of `to`.
    fn store(self, x: Self::F, to: &mut [f32]);
    /// Writes the first `WIDTH` values of `to`.
    fn store_u(self, x: Self::U, to: &mut [u32]);
    /// `table[index]` in every lane.
    fn gather(self, table: &[f32], index: Self::U) -> Self::F;
    /// `table[index]` in every lane.
    fn gather_u(self, table: &[u32], index: Self::U) -> Self::U;
    /// One record a lane, transposed: element `k` of every lane's record in the `k`-th result.
    /// `N` is a power of two.
    fn gather_record<const N: usize>(self, table: &[[f32; N]], index: Self::U) -> [Self::F; N];

    /// The bits of `x`.
    fn bits(self, x: Self::F) -> Self::U;
    /// The f32 with these bits.
    fn reinterpret(self, x: Self::U) -> Self::F;
    /// `x` as f32; exact for `x` < 2²⁴, `x` < 2³¹ required.
    fn to_f(self, x: Self::U) -> Self::F;

    /// a·b + c in two roundings: the one place that decides about fused multiply-add.
    ///
    /// Fused with the semantics of `f32::mul_add` it was measured to save 3–5 % of the reference room's time on AVX-512
    /// and 1–2 % on AVX2, and to cost a factor of 2.3 on SSE, where it has to be imitated to keep the bits the same.
    #[inline(always)]
    fn mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F {
        a * b + c
    }
    /// Square root, correctly rounded.
    fn sqrt(self, x: Self::F) -> Self::F;
    /// |x|.
    fn abs(self, x: Self::F) -> Self::F;

    /// a < b; false for NaN.
    fn lt(self, a: Self::F, b: Self::F) -> Self::M;
    /// a ≤ b; false for NaN.
    fn le(self, a: Self::F, b: Self::F) -> Self::M;
    /// a = b; false for NaN.
    fn eq(self, a: Self::F, b: Self::F) -> Self::M;
    /// a = b.
    fn eq_u(self, a: Self::U, b: Self::U) -> Self::M;
    /// a < b.
    fn lt_u(self, a: Self::U, b: Self::U) -> Self::M;

    /// `a` where `mask`, else `b`.
    fn select(self, mask: Self::M, a: Self::F, b: Self::F) -> Self::F;
    /// `a` where `mask`, else `b`.
    fn select_u(self, mask: Self::M, a: Self::U, b: Self::U) -> Self::U;

    /// a + b, wrapping.
    fn add_u(self, a: Self::U, b: Self::U) -> Self::U;
    /// a · b, wrapping.
    fn mul_u(self, a: Self::U, b: Self::U) -> Self::U;
    /// a << N.
    fn shl<const N: u32>(self, a: Self::U) -> Self::U;
    /// a >> N, zeros shifted in.
    fn shr<const N: u32>(self, a: Self::U) -> Self::U;
    /// a >> n, zeros shifted in; n < 32.
    fn shr_by(self, a: Self::U, n: u32) -> Self::U;
    /// a >> n, a shift of its own in every lane, zeros shifted in; n < 32.
    fn shr_each(self, a: Self::U, n: Self::U) -> Self::U;

    /// Whether any lane is set.
    fn any(self, mask: Self::M) -> bool;
    /// Lane `i` in bit `i`.
    fn bitmask(self, mask: Self::M) -> u64;
    /// Mask of the first `n` lanes.
    fn first(self, n: usize) -> Self::M {
        self.lt_u(self.iota(), self.u(n as u32))
    }
    /// Moves the set lanes of `x` to the front, in order, and writes `WIDTH` values to `to` (those behind the set ones
    /// are of no meaning).
    fn compress(self, mask: Self::M, x: Self::U, to: &mut [u32]);

    /// The smaller of two; `b` when either is NaN.
    #[inline(always)]
    fn min(self, a: Self::F, b: Self::F) -> Self::F {
        self.select(self.lt(a, b), a, b)
    }
    /// The larger of two; `b` when either is NaN.
    #[inline(always)]
    fn max(self, a: Self::F, b: Self::F) -> Self::F {
        self.select(self.lt(b, a), a, b)
    }
    /// |magnitude| with the sign bit of `sign`.
    #[inline(always)]
    fn copysign(self, magnitude: Self::F, sign: Self::F) -> Self::F {
        let top = self.u(0x8000_0000);
        self.reinterpret((self.bits(magnitude) & !top) | (self.bits(sign) & top))
    }
    /// `x` where `mask`, else +0.
    #[inline(always)]
    fn keep(self, mask: Self::M, x: Self::F) -> Self::F {
        self.select(mask, x, self.f(0.0))
    }
}
