//! Known mistakes, put in on purpose: some test must fail with each of them (`just mutants` tries them all, docs/mutants.md
//! says what was found).
//!
//! Built with `SMALTI_MUTANTS=1`, the variable `SMALTI_MUTANT` of the running process names the mistake that is made. In
//! every other build the conditions are constants and leave no trace.
//!
//! Many are the mistakes of the report as printed; each is described where it stands.

/// Whether this mistake is made.
macro_rules! mutant {
    ($name:literal) => {{
        #[cfg(mutants)]
        let made = {
            const NUMBER: u64 = $crate::mutant::number($name);
            $crate::mutant::made() == NUMBER
        };
        #[cfg(not(mutants))]
        let made = false;
        made
    }};
}
pub(crate) use mutant;

/// The number of the mistake that this process makes.
#[cfg(mutants)]
#[inline(always)]
pub fn made() -> u64 {
    static MADE: std::sync::LazyLock<u64> =
        std::sync::LazyLock::new(|| number(&std::env::var("SMALTI_MUTANT").unwrap_or_default()));
    *MADE
}

/// A number for a name (FNV-1a).
#[cfg(mutants)]
pub const fn number(name: &str) -> u64 {
    let (bytes, mut hash, mut k) = (name.as_bytes(), 0xcbf2_9ce4_8422_2325, 0);
    while k < bytes.len() {
        hash = (hash ^ bytes[k] as u64).wrapping_mul(0x0100_0000_01b3);
        k += 1;
    }
    hash
}
