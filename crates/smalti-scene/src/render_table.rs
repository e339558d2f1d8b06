//! `[render]`: settings that a scene file may suggest and the command line may override.

use smalti_core::settings::{Fresnel, Integrator, MOST_PHOTONS, MOST_SHADOW_RAYS, Rect, SamplerKind, Settings};

use crate::document::{Bounds, Key, Node, Section, key};
use crate::error::Result;

/// The largest width and height of an image, pixels.
const MAX_SIDE: u32 = 65_536;

const KEYS: &[Key] = &[
    key("integrator", "\"path\""),
    key("size", "[800, 600]"),
    key("crop", "[0, 0, 100, 100]"),
    key("spp", "64"),
    key("shadow_rays", "1"),
    key("max_bounces", "16"),
    key("sampler", "\"sobol\""),
    key("seed", "0"),
    key("fresnel", "\"exact\""),
    key("jitter", "true"),
    key("adaptive", "true"),
    key("exposure", "0.0"),
    key("tile", "32"),
    key("photons", "262144"),
    key("radius", "0.1"),
];

const SAMPLERS: [SamplerKind; 2] = [SamplerKind::Sobol, SamplerKind::Independent];
const FRESNELS: [Fresnel; 2] = [Fresnel::Exact, Fresnel::Schlick];

/// The `[render]` table; what is not there is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RenderTable {
    /// `integrator = "path"`.
    pub integrator: Option<Integrator>,
    /// `size = [width, height]`, pixels, each from 1 to 65,536.
    pub size: Option<[u32; 2]>,
    /// `crop = [x, y, width, height]`, pixels; inside of `size` if that is there.
    pub crop: Option<Rect>,
    /// `spp`, samples a pixel, at least 1.
    pub spp: Option<u32>,
    /// `shadow_rays` at each diffuse vertex, at most [`MOST_SHADOW_RAYS`].
    pub shadow_rays: Option<u32>,
    /// `max_bounces`, scattering events.
    pub max_bounces: Option<u32>,
    /// `sampler = "sobol"`.
    pub sampler: Option<SamplerKind>,
    /// `seed` of the noise.
    pub seed: Option<u64>,
    /// `fresnel = "exact"`.
    pub fresnel: Option<Fresnel>,
    /// `jitter`: whether a sample's place in its pixel is random.
    pub jitter: Option<bool>,
    /// `adaptive`: whether samples go where the noise is.
    pub adaptive: Option<bool>,
    /// `exposure` of the tone-mapped image, in stops, from -100 to 100.
    pub exposure: Option<f64>,
    /// `tile`, side of a tile in pixels, at least 1.
    pub tile: Option<u32>,
    /// `photons` that are emitted for each round of samples.
    pub photons: Option<u32>,
    /// `radius` of the first round, metres, > 0.
    pub radius: Option<f64>,
}

impl RenderTable {
    /// Reads `[render]`, which may be missing.
    pub(crate) fn read(root: &Section) -> Result<Self> {
        let Some(node) = root.find("render") else { return Ok(Self::default()) };
        let section = Section::open(node, "`[render]`", KEYS)?;
        let size = section.read("size", size)?;
        Ok(Self {
            integrator: section.read("integrator", |node| node.choice(&Integrator::ALL.map(|x| (x.name(), x))))?,
            size,
            crop: section.read("crop", |node| crop(node, size))?,
            spp: section.read("spp", |node| node.count(1))?,
            shadow_rays: section
                .read("shadow_rays", |node| node.whole(0, MOST_SHADOW_RAYS.into()))?
                .map(|rays| rays as u32),
            max_bounces: section.read("max_bounces", |node| node.count(0))?,
            sampler: section.read("sampler", |node| node.choice(&SAMPLERS.map(|x| (x.name(), x))))?,
            seed: section.read("seed", |node| node.whole(0, u64::MAX))?,
            fresnel: section.read("fresnel", |node| node.choice(&FRESNELS.map(|x| (x.name(), x))))?,
            jitter: section.read("jitter", Node::truth)?,
            adaptive: section.read("adaptive", Node::truth)?,
            exposure: section.read("exposure", |node| node.number(Bounds::STOPS))?,
            tile: section.read("tile", |node| node.count(1))?,
            photons: section.read("photons", |node| node.whole(0, MOST_PHOTONS.into()))?.map(|photons| photons as u32),
            radius: section.read("radius", |node| node.number(Bounds::POSITIVE))?,
        })
    }

    /// The settings that the table asks for, with the defaults where it says nothing.
    pub fn settings(&self) -> Settings {
        let default = Settings::default();
        let [width, height] = self.size.unwrap_or([default.width, default.height]);
        Settings {
            integrator: self.integrator.unwrap_or(Integrator::Auto),
            width,
            height,
            crop: self.crop,
            spp: self.spp.unwrap_or(default.spp),
            shadow_rays: self.shadow_rays.unwrap_or(default.shadow_rays),
            max_bounces: self.max_bounces,
            sampler: self.sampler.unwrap_or(default.sampler),
            seed: self.seed.unwrap_or(default.seed),
            fresnel: self.fresnel.unwrap_or(default.fresnel),
            jitter: self.jitter.unwrap_or(default.jitter),
            adaptive: self.adaptive.unwrap_or(default.adaptive),
            camera: default.camera,
            photons: self.photons,
            radius: self.radius,
        }
    }
}

fn size(node: Node) -> Result<[u32; 2]> {
    let mut size = [0; 2];
    for (side, item) in size.iter_mut().zip(node.exactly(2, "numbers, width and height")?) {
        *side = item.whole(1, MAX_SIDE.into())? as u32;
    }
    Ok(size)
}

fn crop(node: Node, size: Option<[u32; 2]>) -> Result<Rect> {
    let mut numbers = [0u32; 4];
    for (index, item) in node.exactly(4, "numbers: x, y, width and height")?.enumerate() {
        let least = if index < 2 { 0 } else { 1 };
        numbers[index] = item.whole(least, MAX_SIDE.into())? as u32;
    }
    let [x, y, width, height] = numbers;
    let [columns, rows] = size.unwrap_or([2 * MAX_SIDE; 2]);
    if x + width > columns || y + height > rows {
        let reach = format!("reaches to column {} and row {}", x + width, y + height);
        return Err(node.fault(&format!("is not inside of the image of {columns} × {rows} pixels"), reach));
    }
    Ok(Rect { x, y, width, height })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<RenderTable> {
        let document = crate::document::parse(text)?;
        RenderTable::read(&crate::world::root(&document)?)
    }

    #[test]
    fn every_setting_arrives() {
        let table = read(
            "[render]\nintegrator = 'whitted'\nsize = [4, 3]\ncrop = [1, 0, 3, 3]\nspp = 7\nshadow_rays = 0\nmax_bounces = 2\n\
             sampler = 'independent'\nseed = 18446744073709551615\nfresnel = 'schlick'\njitter = false\nadaptive = true\nexposure = -1\ntile = 8\n\
             photons = 10000000\nradius = 0.25\n",
        );
        let expected = RenderTable {
            integrator: Some(Integrator::Whitted),
            size: Some([4, 3]),
            crop: Some(Rect { x: 1, y: 0, width: 3, height: 3 }),
            spp: Some(7),
            shadow_rays: Some(0),
            max_bounces: Some(2),
            sampler: Some(SamplerKind::Independent),
            seed: Some(u64::MAX),
            fresnel: Some(Fresnel::Schlick),
            jitter: Some(false),
            adaptive: Some(true),
            exposure: Some(-1.0),
            tile: Some(8),
            photons: Some(10_000_000),
            radius: Some(0.25),
        };
        assert_eq!(table.unwrap(), expected);
        assert_eq!(read("").unwrap(), RenderTable::default());
    }

    #[test]
    fn a_crop_must_be_inside_of_the_image() {
        assert!(read("[render]\nsize = [4, 3]\ncrop = [2, 0, 3, 1]\n").is_err());
        assert!(read("[render]\ncrop = [65536, 0, 65536, 1]\n").is_ok());
    }
}
