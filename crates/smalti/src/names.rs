//! Names that users write on the command line, and what they stand for in the core.

use clap::ValueEnum;
use smalti_core::photon::{Kind, Quantity};
use smalti_core::render::Level;
use smalti_core::settings::{Fresnel, Integrator, SamplerKind};

/// Names of integrators.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum IntegratorArg {
    Auto,
    Path,
    Photon,
    Whitted,
}

impl From<IntegratorArg> for Integrator {
    fn from(typed: IntegratorArg) -> Self {
        match typed {
            IntegratorArg::Auto => Integrator::Auto,
            IntegratorArg::Photon => Integrator::Photon,
            IntegratorArg::Path => Integrator::Path,
            IntegratorArg::Whitted => Integrator::Whitted,
        }
    }
}

/// Names of samplers.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum SamplerArg {
    Sobol,
    Independent,
}

impl From<SamplerArg> for SamplerKind {
    fn from(typed: SamplerArg) -> Self {
        match typed {
            SamplerArg::Sobol => SamplerKind::Sobol,
            SamplerArg::Independent => SamplerKind::Independent,
        }
    }
}

/// Names of reflectance formulas.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum FresnelArg {
    Exact,
    Schlick,
}

impl From<FresnelArg> for Fresnel {
    fn from(typed: FresnelArg) -> Self {
        match typed {
            FresnelArg::Exact => Fresnel::Exact,
            FresnelArg::Schlick => Fresnel::Schlick,
        }
    }
}

/// How good an image is to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum QualityArg {
    /// A relative error of 10 %
    Draft,
    /// A relative error of 3 %
    Good,
    /// A relative error of 1 %
    Final,
}

impl QualityArg {
    /// The name that users write.
    pub fn name(self) -> &'static str {
        match self {
            QualityArg::Draft => "draft",
            QualityArg::Good => "good",
            QualityArg::Final => "final",
        }
    }

    /// The relative error that it stands for.
    pub fn error(self) -> f64 {
        match self {
            QualityArg::Draft => 0.1,
            QualityArg::Good => 0.03,
            QualityArg::Final => 0.01,
        }
    }
}

/// Names of photon maps.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum MapArg {
    /// Light that came by way of specular surfaces
    Caustic,
    /// All light
    Global,
}

impl MapArg {
    /// The name that users write.
    pub fn name(self) -> &'static str {
        match self {
            MapArg::Caustic => "caustic",
            MapArg::Global => "global",
        }
    }
}

impl From<MapArg> for Kind {
    fn from(typed: MapArg) -> Self {
        match typed {
            MapArg::Caustic => Kind::Caustic,
            MapArg::Global => Kind::Global,
        }
    }
}

/// What is shown of photons.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum ColourArg {
    /// Radiance that diffuse surfaces send back by the map alone
    Flux,
    /// Photons by square metre, in false colours
    Density,
    /// Scattering events before a photon was stored, in false colours
    Bounces,
}

impl ColourArg {
    /// The name that users write.
    pub fn name(self) -> &'static str {
        match self {
            ColourArg::Flux => "flux",
            ColourArg::Density => "density",
            ColourArg::Bounces => "bounces",
        }
    }

    /// What the core is to find out for it.
    pub fn quantity(self) -> Quantity {
        match self {
            ColourArg::Flux => Quantity::Radiance,
            ColourArg::Density | ColourArg::Bounces => Quantity::Count,
        }
    }
}

/// Names of SIMD levels.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub enum SimdArg {
    Auto,
    Avx512,
    Avx2,
    #[value(name = "sse4.2")]
    Sse42,
    Sse2,
    Neon,
    Scalar,
}

impl SimdArg {
    /// The level that was named; `None` for auto.
    pub fn level(self) -> Option<Level> {
        match self {
            SimdArg::Auto => None,
            SimdArg::Avx512 => Some(Level::Avx512),
            SimdArg::Avx2 => Some(Level::Avx2),
            SimdArg::Sse42 => Some(Level::Sse42),
            SimdArg::Sse2 => Some(Level::Sse2),
            SimdArg::Neon => Some(Level::Neon),
            SimdArg::Scalar => Some(Level::Scalar),
        }
    }
}

/// Whether something is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SwitchArg {
    On,
    Off,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_core() {
        for level in SimdArg::value_variants() {
            let typed = level.to_possible_value().unwrap();
            assert_eq!(typed.get_name(), level.level().map_or("auto", Level::name));
        }
        for name in MapArg::value_variants() {
            assert_eq!(name.to_possible_value().unwrap().get_name(), name.name());
        }
        for name in QualityArg::value_variants() {
            assert_eq!(name.to_possible_value().unwrap().get_name(), name.name());
        }
        for name in ColourArg::value_variants() {
            assert_eq!(name.to_possible_value().unwrap().get_name(), name.name());
        }
        for name in IntegratorArg::value_variants() {
            assert_eq!(name.to_possible_value().unwrap().get_name(), Integrator::from(*name).name());
        }
        for name in SamplerArg::value_variants() {
            assert_eq!(name.to_possible_value().unwrap().get_name(), SamplerKind::from(*name).name());
        }
        for name in FresnelArg::value_variants() {
            assert_eq!(name.to_possible_value().unwrap().get_name(), Fresnel::from(*name).name());
        }
    }
}
