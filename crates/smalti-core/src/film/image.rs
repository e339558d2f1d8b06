//! A linear image: what a film develops into.

/// Linear RGB radiance in f32, row 0 on top, left to right.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Image {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width × height` pixels, row by row from the top.
    pub pixels: Vec<[f32; 3]>,
}

impl Image {
    /// A black image.
    pub fn black(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![[0.0; 3]; width as usize * height as usize] }
    }

    /// Mean of each channel over all pixels.
    pub fn mean(&self) -> [f64; 3] {
        let mut sum = [0.0f64; 3];
        for pixel in &self.pixels {
            for (sum, &value) in sum.iter_mut().zip(pixel) {
                *sum += f64::from(value);
            }
        }
        sum.map(|sum| sum / self.pixels.len().max(1) as f64)
    }
}
