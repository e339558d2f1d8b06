//! Settings of a render: what a user chooses, apart from the scene. Everything here changes the image;
//! what must not (threads, tiles, SIMD level, display) is not here.

/// Most light samples at a vertex: their numbers and those of a round's samples share 32 bits.
pub const MOST_SHADOW_RAYS: u32 = 1 << 16;

/// Most photons of a round.
pub const MOST_PHOTONS: u32 = 1 << 28;

/// Where nothing is said, photons of a round by pixels: 2 in 5. With the reference room at 400 × 400, half as many and
/// twice as many are about as good for their time, four times as many 15 % worse.
const PHOTONS_PER_PIXEL: f64 = 0.4;

/// Settings of a render, after the scene file and the command line have been merged.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Which light transport algorithm.
    pub integrator: Integrator,
    /// Image width in pixels, at least 1.
    pub width: u32,
    /// Image height in pixels, at least 1.
    pub height: u32,
    /// The part of the image that is rendered; `None` is all of it.
    pub crop: Option<Rect>,
    /// Samples (camera paths) a pixel, at least 1.
    pub spp: u32,
    /// Light samples at each diffuse vertex in all, over all lights, at most [`MOST_SHADOW_RAYS`]; 0: the BSDF
    /// sample alone finds light.
    pub shadow_rays: u32,
    /// Scattering events after which a path ends; `None`: roulette alone ends it, with a counted cap.
    pub max_bounces: Option<u32>,
    /// Where the random numbers come from.
    pub sampler: SamplerKind,
    /// Names one realisation of the noise.
    pub seed: u64,
    /// Reflectance of dielectrics.
    pub fresnel: Fresnel,
    /// Whether a sample's place in its pixel is random (the report's 'ray noise'); else the pixel's centre.
    pub jitter: bool,
    /// Whether tiles take more or fewer samples than [`Settings::spp`], as their noise asks for, and that is the mean.
    pub adaptive: bool,
    /// Index into the world's cameras.
    pub camera: usize,
    /// Photons that are emitted for each round of samples and each map, at most [`MOST_PHOTONS`]; 0: none, and light
    /// that only photons find is left to chance. `None`: as suits the size of the image.
    pub photons: Option<u32>,
    /// How far photons count in the first round, metres, > 0; `None`: by their density.
    pub radius: Option<f64>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            integrator: Integrator::Path,
            width: 400,
            height: 400,
            crop: None,
            spp: 64,
            shadow_rays: 1,
            max_bounces: None,
            sampler: SamplerKind::Sobol,
            seed: 0,
            fresnel: Fresnel::Exact,
            jitter: true,
            adaptive: false,
            camera: 0,
            photons: None,
            radius: None,
        }
    }
}

impl Settings {
    /// Photons of a round and map: what was asked for, or a power of two that suits the size of the whole image.
    pub fn photons_of_round(&self) -> u32 {
        let pixels = f64::from(self.width) * f64::from(self.height);
        let fitting = (pixels * PHOTONS_PER_PIXEL).clamp(32_768.0, 1_048_576.0) as u32;
        self.photons.unwrap_or(fitting.next_power_of_two())
    }

    /// The part of the image that is rendered.
    pub fn area(&self) -> Rect {
        self.crop.unwrap_or(Rect { x: 0, y: 0, width: self.width, height: self.height })
    }
}

/// Light transport algorithms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Monte Carlo path tracing with next event estimation (report §1.2, 2.5–2.7, corrected).
    Path,
    /// Path tracing, with a photon map for the caustics of lights that paths hardly find.
    Auto,
    /// Photon mapping in two passes (Jensen 1996; report §1.3): direct light by shadow rays, caustics and, behind one
    /// diffuse bounce, all light from photon maps.
    Photon,
    /// Whitted (1980): perfect reflection and refraction as a tree, direct light at diffuse surfaces (report §1.1).
    Whitted,
}

impl Integrator {
    /// All of them, the default first.
    pub const ALL: [Self; 4] = [Self::Auto, Self::Path, Self::Photon, Self::Whitted];

    /// Whether it may use photon maps.
    pub fn asks_photons(self) -> bool {
        matches!(self, Integrator::Auto | Integrator::Photon)
    }

    /// The name that users write.
    pub fn name(self) -> &'static str {
        match self {
            Integrator::Path => "path",
            Integrator::Auto => "auto",
            Integrator::Photon => "photon",
            Integrator::Whitted => "whitted",
        }
    }
}

/// Sources of random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplerKind {
    /// Owen-scrambled Sobol points, padded, by purpose.
    Sobol,
    /// Independent numbers from Xoshiro128++.
    Independent,
}

impl SamplerKind {
    /// The name that users write.
    pub fn name(self) -> &'static str {
        match self {
            SamplerKind::Sobol => "sobol",
            SamplerKind::Independent => "independent",
        }
    }
}

/// Reflectance of a smooth dielectric boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fresnel {
    /// Fresnel's equations, unpolarised.
    Exact,
    /// Schlick's approximation (report eq. 7 and 8, corrected).
    Schlick,
}

impl Fresnel {
    /// The name that users write.
    pub fn name(self) -> &'static str {
        match self {
            Fresnel::Exact => "exact",
            Fresnel::Schlick => "schlick",
        }
    }
}

/// A rectangle of pixels; (0, 0) is the top left pixel of the whole image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Rect {
    /// Leftmost column.
    pub x: u32,
    /// Topmost row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Rect {
    /// Number of pixels.
    pub fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Column and row, in the whole image, of its pixel `number`, counted row by row.
    pub fn pixel(self, number: usize) -> (u32, u32) {
        (self.x + number as u32 % self.width, self.y + number as u32 / self.width)
    }
}
