//! Lanes over `fearless_simd`: the native width of a level, and eight lanes at any level.

use fearless_simd::{
    Bytes, Select, Simd, SimdBase, SimdCvtFloat, SimdFloat, SimdMask, f32x8, i32x8, mask32x8, prelude::*, u32x8,
};

use super::Lanes;

/// As many lanes as the level's registers hold: 16 on AVX-512, 8 on AVX2, 4 on SSE and NEON.
#[derive(Clone, Copy, Debug)]
pub struct Native<S>(pub S);

/// Eight lanes at any level.
#[derive(Clone, Copy, Debug)]
pub struct Octet<S>(pub S);

macro_rules! lanes {
    ($token:ident, $f:ty, $u:ty, $i:ty, $m:ty) => {
        impl<S: Simd> Lanes for $token<S> {
            const WIDTH: usize = <$f as SimdBase<S>>::LEN;
            type F = $f;
            type U = $u;
            type M = $m;
            type Eight = Octet<S>;

            #[inline(always)]
            fn eight(self) -> Octet<S> {
                Octet(self.0)
            }
            #[inline(always)]
            fn f(self, x: f32) -> Self::F {
                <$f>::simd_from(self.0, x)
            }
            #[inline(always)]
            fn u(self, x: u32) -> Self::U {
                <$u>::simd_from(self.0, x)
            }
            #[inline(always)]
            fn m(self, x: bool) -> Self::M {
                <$m as SimdMask<S>>::splat(self.0, x)
            }
            #[inline(always)]
            fn iota(self) -> Self::U {
                const COUNT: [u32; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
                self.load_u(&COUNT)
            }
            #[inline(always)]
            fn load(self, from: &[f32]) -> Self::F {
                <$f>::from_slice(self.0, &from[..Self::WIDTH])
            }
            #[inline(always)]
            fn load_u(self, from: &[u32]) -> Self::U {
                <$u>::from_slice(self.0, &from[..Self::WIDTH])
            }
            #[inline(always)]
            fn store(self, x: Self::F, to: &mut [f32]) {
                x.store_slice(&mut to[..Self::WIDTH]);
            }
            #[inline(always)]
            fn store_u(self, x: Self::U, to: &mut [u32]) {
                x.store_slice(&mut to[..Self::WIDTH]);
            }
            #[inline(always)]
            fn gather(self, table: &[f32], index: Self::U) -> Self::F {
                <$f>::from_fn(
                    self.0,
                    #[inline(always)]
                    |i| table[index[i] as usize],
                )
            }
            #[inline(always)]
            fn gather_u(self, table: &[u32], index: Self::U) -> Self::U {
                <$u>::from_fn(
                    self.0,
                    #[inline(always)]
                    |i| table[index[i] as usize],
                )
            }
            #[inline(always)]
            fn gather_record<const N: usize>(self, table: &[[f32; N]], index: Self::U) -> [Self::F; N] {
                const { assert!(N.is_power_of_two()) }
                let mut rows = [[0.0f32; N]; 16];
                for i in 0..Self::WIDTH {
                    rows[i] = table[index[i] as usize];
                }
                let mut columns = [self.f(0.0); N];
                for (k, column) in columns.iter_mut().enumerate() {
                    *column = self.load(&rows.as_flattened()[k * Self::WIDTH..]);
                }
                // Each round takes the elements at even places to the front half: a rotation of the place's bits.
                for _ in 0..N.ilog2() {
                    let mixed = columns;
                    for k in 0..N / 2 {
                        (columns[k], columns[N / 2 + k]) = mixed[2 * k].deinterleave(mixed[2 * k + 1]);
                    }
                }
                columns
            }
            #[inline(always)]
            fn bits(self, x: Self::F) -> Self::U {
                x.bitcast()
            }
            #[inline(always)]
            fn reinterpret(self, x: Self::U) -> Self::F {
                x.bitcast()
            }
            #[inline(always)]
            fn to_f(self, x: Self::U) -> Self::F {
                let signed: $i = x.bitcast();
                <$f as SimdCvtFloat<$i>>::float_from(signed)
            }
            #[inline(always)]
            fn sqrt(self, x: Self::F) -> Self::F {
                SimdFloat::sqrt(x)
            }
            #[inline(always)]
            fn abs(self, x: Self::F) -> Self::F {
                self.reinterpret(self.bits(x) & self.u(0x7fff_ffff))
            }
            #[inline(always)]
            fn lt(self, a: Self::F, b: Self::F) -> Self::M {
                a.simd_lt(b)
            }
            #[inline(always)]
            fn le(self, a: Self::F, b: Self::F) -> Self::M {
                a.simd_le(b)
            }
            #[inline(always)]
            fn eq(self, a: Self::F, b: Self::F) -> Self::M {
                a.simd_eq(b)
            }
            #[inline(always)]
            fn eq_u(self, a: Self::U, b: Self::U) -> Self::M {
                a.simd_eq(b)
            }
            #[inline(always)]
            fn lt_u(self, a: Self::U, b: Self::U) -> Self::M {
                a.simd_lt(b)
            }
            #[inline(always)]
            fn select(self, mask: Self::M, a: Self::F, b: Self::F) -> Self::F {
                mask.select(a, b)
            }
            #[inline(always)]
            fn select_u(self, mask: Self::M, a: Self::U, b: Self::U) -> Self::U {
                mask.select(a, b)
            }
            #[inline(always)]
            fn add_u(self, a: Self::U, b: Self::U) -> Self::U {
                a + b
            }
            #[inline(always)]
            fn mul_u(self, a: Self::U, b: Self::U) -> Self::U {
                a * b
            }
            #[inline(always)]
            fn shl<const N: u32>(self, a: Self::U) -> Self::U {
                a << N
            }
            #[inline(always)]
            fn shr<const N: u32>(self, a: Self::U) -> Self::U {
                a >> N
            }
            #[inline(always)]
            fn shr_by(self, a: Self::U, n: u32) -> Self::U {
                a >> n
            }
            #[inline(always)]
            fn shr_each(self, a: Self::U, n: Self::U) -> Self::U {
                a >> n
            }
            #[inline(always)]
            fn any(self, mask: Self::M) -> bool {
                mask.any_true()
            }
            #[inline(always)]
            fn bitmask(self, mask: Self::M) -> u64 {
                mask.to_bitmask()
            }
            #[inline(always)]
            fn compress(self, mask: Self::M, x: Self::U, to: &mut [u32]) {
                x.compress(mask).store_slice(&mut to[..Self::WIDTH]);
            }
        }
    };
}

lanes!(Native, S::f32s, S::u32s, S::i32s, S::mask32s);
lanes!(Octet, f32x8<S>, u32x8<S>, i32x8<S>, mask32x8<S>);
