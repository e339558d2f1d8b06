//! Scenes built of bytes: every one is a scene file that could be meant, with numbers from the whole of their ranges.

use std::fmt::Write;

use arbitrary::{Result, Unstructured};

/// The file that these bytes are taken for.
pub fn text(bytes: &[u8]) -> String {
    let mut text = String::new();
    // Bytes that end early leave a shorter scene.
    let _ = Builder { bytes: Unstructured::new(bytes), text: &mut text }.scene();
    text
}

/// Loads and renders it.
pub fn ask(bytes: &[u8]) {
    super::scene::ask(text(bytes).as_bytes());
}

/// Lengths from far below to far above what anyone models, and those at which something may break.
const LENGTHS: [f64; 20] = [
    0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    -0.25,
    1e-3,
    1e3,
    1e-6,
    1e6,
    1e-9,
    -1e9,
    1e-20,
    1e20,
    1e-40,
    1e37,
    1e-300,
    1e300,
    0.999_999_9,
    1.000_000_1,
];

struct Builder<'a, 'b> {
    bytes: Unstructured<'b>,
    text: &'a mut String,
}

impl Builder<'_, '_> {
    fn scene(&mut self) -> Result<()> {
        self.cameras()?;
        let materials = self.bytes.int_in_range(1..=4)?;
        for number in 0..materials {
            self.material(number)?;
        }
        if self.bytes.ratio(1, 3)? {
            let radiance = self.colour(1e30)?;
            self.line(&format!("[environment]\nradiance = {radiance}"));
        }
        while !self.bytes.is_empty() {
            self.thing(materials)?;
        }
        Ok(())
    }

    fn cameras(&mut self) -> Result<()> {
        let [eye, look_at, up] = [self.point()?, self.point()?, self.point()?];
        let fov = self.choice(&[60.0, 1e-3, 179.0, 90.0])?;
        self.line(&format!("[camera]\neye = {eye}\nlook_at = {look_at}\nup = {up}\nfov = {fov:?}"));
        Ok(())
    }

    fn material(&mut self, number: u32) -> Result<()> {
        let kind = match self.bytes.int_in_range(0..=3)? {
            0 => format!("lambert = {{ albedo = {} }}", self.colour(1.0)?),
            1 => format!("mirror = {{ reflectance = {} }}", self.colour(1.0)?),
            2 => format!("dielectric = {{ ior = {:?} }}", self.index()?),
            _ => format!("dielectric = {{ ior = {:?}, absorption = {} }}", self.index()?, self.colour(1e6)?),
        };
        self.line(&format!("[material.m{number}]\n{kind}"));
        Ok(())
    }

    fn index(&mut self) -> Result<f64> {
        self.choice(&[1.5, 1.0, 1.000_000_1, 0.999_999, 0.5, 100.0, 2.4])
    }

    fn thing(&mut self, materials: u32) -> Result<()> {
        let material = format!("material = \"m{}\"", self.bytes.int_in_range(0..=materials - 1)?);
        let radiance =
            if self.bytes.ratio(1, 4)? { format!("\nradiance = {}", self.colour(1e30)?) } else { String::new() };
        let text = match self.bytes.int_in_range(0..=5)? {
            0 => format!(
                "[[sphere]]\n{material}\ncentre = {}\nradius = {:?}{radiance}",
                self.point()?,
                self.length()?.abs()
            ),
            1 => format!("[[triangle]]\n{material}\nvertices = {}{radiance}", self.points(3)?),
            2 => format!("[[quad]]\n{material}\nvertices = {}{radiance}", self.parallelogram()?),
            3 => format!("[[light.point]]\nposition = {}\nintensity = {}", self.point()?, self.colour(1e30)?),
            4 => {
                let centre = self.point()?;
                format!(
                    "[[light.sphere]]\ncentre = {centre}\nradius = {:?}\nradiance = {}",
                    self.length()?.abs(),
                    self.colour(1e3)?
                )
            }
            _ => {
                let vertices = self.points(4)?;
                format!(
                    "[[mesh]]\n{material}\nvertices = {vertices}\nfaces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]{radiance}"
                )
            }
        };
        self.line(&text);
        Ok(())
    }

    fn points(&mut self, count: usize) -> Result<String> {
        let points = (0..count).map(|_| self.point()).collect::<Result<Vec<_>>>()?;
        Ok(format!("[{}]", points.join(", ")))
    }

    /// Corners of a parallelogram, as a quad must be plane.
    fn parallelogram(&mut self) -> Result<String> {
        let mut corner = || -> Result<[f64; 3]> { Ok([self.length()?, self.length()?, self.length()?]) };
        let [a, u, v] = [corner()?, corner()?, corner()?];
        let at = |x: f64, y: f64| {
            let [p, q, r] = [0, 1, 2].map(|k| a[k] + x * u[k] + y * v[k]);
            format!("[{p:?}, {q:?}, {r:?}]")
        };
        Ok(format!("[{}, {}, {}, {}]", at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)))
    }

    fn point(&mut self) -> Result<String> {
        Ok(format!("[{:?}, {:?}, {:?}]", self.length()?, self.length()?, self.length()?))
    }

    /// An ordinary length, or one of the others.
    fn length(&mut self) -> Result<f64> {
        match self.bytes.int_in_range(0..=3)? {
            0 => self.choice(&LENGTHS),
            _ => Ok(f64::from(self.bytes.arbitrary::<i16>()?) / 4096.0),
        }
    }

    fn colour(&mut self, most: f64) -> Result<String> {
        let mut channel = || -> Result<f64> { Ok(most * self.choice(&[0.5, 0.0, 1.0, 1e-3, 1e-6, 0.999])?) };
        let [r, g, b] = [channel()?, channel()?, channel()?];
        Ok(format!("[{r:?}, {g:?}, {b:?}]"))
    }

    fn choice(&mut self, of: &[f64]) -> Result<f64> {
        self.bytes.choose(of).copied()
    }

    fn line(&mut self, text: &str) {
        let _ = writeln!(self.text, "{text}");
    }
}
