//! One lane on plain f32: the level `scalar`, and the code that looks at one primitive at a time.

use fearless_simd::Fallback;

use super::{Lanes, Octet};

/// The token of the single lane.
#[derive(Clone, Copy, Debug)]
pub struct One;

impl Lanes for One {
    const WIDTH: usize = 1;
    type F = f32;
    type U = u32;
    type M = bool;
    type Eight = Octet<Fallback>;

    #[inline(always)]
    fn eight(self) -> Self::Eight {
        Octet(Fallback::new())
    }
    #[inline(always)]
    fn f(self, x: f32) -> f32 {
        x
    }
    #[inline(always)]
    fn u(self, x: u32) -> u32 {
        x
    }
    #[inline(always)]
    fn m(self, x: bool) -> bool {
        x
    }
    #[inline(always)]
    fn iota(self) -> u32 {
        0
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> f32 {
        from[0]
    }
    #[inline(always)]
    fn load_u(self, from: &[u32]) -> u32 {
        from[0]
    }
    #[inline(always)]
    fn store(self, x: f32, to: &mut [f32]) {
        to[0] = x;
    }
    #[inline(always)]
    fn store_u(self, x: u32, to: &mut [u32]) {
        to[0] = x;
    }
    #[inline(always)]
    fn gather(self, table: &[f32], index: u32) -> f32 {
        table[index as usize]
    }
    #[inline(always)]
    fn gather_u(self, table: &[u32], index: u32) -> u32 {
        table[index as usize]
    }
    #[inline(always)]
    fn gather_record<const N: usize>(self, table: &[[f32; N]], index: u32) -> [f32; N] {
        table[index as usize]
    }
    #[inline(always)]
    fn bits(self, x: f32) -> u32 {
        x.to_bits()
    }
    #[inline(always)]
    fn reinterpret(self, x: u32) -> f32 {
        f32::from_bits(x)
    }
    #[inline(always)]
    fn to_f(self, x: u32) -> f32 {
        x as f32
    }
    #[inline(always)]
    fn sqrt(self, x: f32) -> f32 {
        x.sqrt()
    }
    #[inline(always)]
    fn abs(self, x: f32) -> f32 {
        x.abs()
    }
    #[inline(always)]
    fn lt(self, a: f32, b: f32) -> bool {
        a < b
    }
    #[inline(always)]
    fn le(self, a: f32, b: f32) -> bool {
        a <= b
    }
    #[inline(always)]
    fn eq(self, a: f32, b: f32) -> bool {
        a == b
    }
    #[inline(always)]
    fn eq_u(self, a: u32, b: u32) -> bool {
        a == b
    }
    #[inline(always)]
    fn lt_u(self, a: u32, b: u32) -> bool {
        a < b
    }
    #[inline(always)]
    fn select(self, mask: bool, a: f32, b: f32) -> f32 {
        if mask { a } else { b }
    }
    #[inline(always)]
    fn select_u(self, mask: bool, a: u32, b: u32) -> u32 {
        if mask { a } else { b }
    }
    #[inline(always)]
    fn add_u(self, a: u32, b: u32) -> u32 {
        a.wrapping_add(b)
    }
    #[inline(always)]
    fn mul_u(self, a: u32, b: u32) -> u32 {
        a.wrapping_mul(b)
    }
    #[inline(always)]
    fn shl<const N: u32>(self, a: u32) -> u32 {
        a << N
    }
    #[inline(always)]
    fn shr<const N: u32>(self, a: u32) -> u32 {
        a >> N
    }
    #[inline(always)]
    fn shr_by(self, a: u32, n: u32) -> u32 {
        a >> n
    }
    #[inline(always)]
    fn shr_each(self, a: u32, n: u32) -> u32 {
        a >> n
    }
    #[inline(always)]
    fn any(self, mask: bool) -> bool {
        mask
    }
    #[inline(always)]
    fn bitmask(self, mask: bool) -> u64 {
        u64::from(mask)
    }
    #[inline(always)]
    fn compress(self, _mask: bool, x: u32, to: &mut [u32]) {
        to[0] = x;
    }
}
