//! SIMD levels by name, and the dispatch of a kernel to one of them.

use fearless_simd::Level as Token;

/// A SIMD level. The image does not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// AVX-512 (Ice Lake and later), 16 lanes.
    Avx512,
    /// AVX2 and FMA, 8 lanes.
    Avx2,
    /// SSE4.2, 4 lanes.
    Sse42,
    /// SSE2, 4 lanes.
    Sse2,
    /// NEON, 4 lanes.
    Neon,
    /// Plain f32, 1 lane.
    Scalar,
}

/// Every level, best first.
pub const LEVELS: [Level; 6] = [Level::Avx512, Level::Avx2, Level::Sse42, Level::Sse2, Level::Neon, Level::Scalar];

impl Level {
    /// Every level that this machine can run, best first; never empty.
    pub fn available() -> Vec<Level> {
        LEVELS.into_iter().filter(|level| *level == Level::Scalar || level.token().is_some()).collect()
    }

    /// The name that users write.
    pub fn name(self) -> &'static str {
        match self {
            Level::Avx512 => "avx512",
            Level::Avx2 => "avx2",
            Level::Sse42 => "sse4.2",
            Level::Sse2 => "sse2",
            Level::Neon => "neon",
            Level::Scalar => "scalar",
        }
    }

    /// Lanes of f32.
    pub fn width(self) -> usize {
        match self {
            Level::Avx512 => 16,
            Level::Avx2 => 8,
            Level::Sse42 | Level::Sse2 | Level::Neon => 4,
            Level::Scalar => 1,
        }
    }

    /// The token of `fearless_simd`; `None` where the machine lacks the level, and for `Scalar`.
    pub(crate) fn token(self) -> Option<Token> {
        let best = Token::new();
        match self {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx512 => best.as_avx512().map(Token::Avx512),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx2 => best.as_avx2().map(Token::Avx2),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Sse42 => best.as_sse4_2().map(Token::Sse4_2),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Sse2 => best.as_sse2().map(Token::Sse2),
            #[cfg(target_arch = "aarch64")]
            Level::Neon => best.as_neon().map(Token::Neon),
            _ => {
                let _ = best;
                None
            }
        }
    }
}

/// A function of its own for a kernel at the levels that need no more of the machine than the rest of the program (plain
/// and, on x86-64, SSE2): all of them inlined into whoever dispatches made one function that took LLVM minutes.
#[inline(never)]
pub(crate) fn apart<R>(kernel: impl FnOnce() -> R) -> R {
    kernel()
}

/// Runs `$body` with `$l` bound to the lanes of a level (its token as [`Level::token`] gives it): one instance a level,
/// chosen at run time.
macro_rules! dispatch {
    ($token:expr, $l:ident => $body:expr) => {
        match $token {
            None => $crate::lanes::level::apart(|| {
                let $l = $crate::lanes::One;
                $body
            }),
            Some(token) => $crate::lanes::level::apart(|| {
                fearless_simd::dispatch!(token, simd => {
                    let $l = $crate::lanes::Native(simd);
                    $body
                })
            }),
        }
    };
}
pub(crate) use dispatch;
