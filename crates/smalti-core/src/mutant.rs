//! Known mistakes, put in on purpose: `SMALTI_MUTANT=NAME cargo test` compiles one of them in, and some test must then
//! fail (`just mutants` tries them all). Without the switch the conditions are constants and leave no trace.
//!
//! Most are the mistakes of the report as printed; each is described where it stands.

/// Whether this mistake is compiled in.
macro_rules! mutant {
    ($name:literal) => {
        cfg!(mutant = $name)
    };
}
pub(crate) use mutant;
