//! Answers that are known in closed form: what a render of a simple scene must give.

mod dielectric;
mod exact;
mod furnace;
mod glints;
mod lambert;
mod photons;
mod progressive;
