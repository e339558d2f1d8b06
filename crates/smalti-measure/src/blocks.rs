//! Blocks of pixels that are taken as independent of each other.

/// Side of a block; small images are cut in four by their width.
const SIDE: usize = 32;

/// The blocks of an image.
#[derive(Clone, Copy, Debug)]
pub struct Blocks {
    width: usize,
    side: usize,
    columns: usize,
    /// Number of blocks.
    pub count: usize,
}

impl Blocks {
    /// Those of an image of `pixels` pixels in rows of `width`.
    pub fn new(pixels: usize, width: u32) -> Self {
        let width = width.max(1) as usize;
        let side = SIDE.min(width.div_ceil(4));
        let columns = width.div_ceil(side);
        Self { width, side, columns, count: columns * pixels.div_ceil(width).div_ceil(side) }
    }

    /// The block of the pixel at this index of the image.
    pub fn of(&self, index: usize) -> usize {
        index / self.width / self.side * self.columns + index % self.width / self.side
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_squares_of_the_image() {
        let blocks = Blocks::new(100 * 70, 100);
        assert_eq!(blocks.count, 4 * 3);
        assert_eq!([0, 24, 25, 99, 100 * 25].map(|index| blocks.of(index)), [0, 0, 1, 3, 4]);
        let blocks = Blocks::new(400 * 33, 400);
        assert_eq!((blocks.count, blocks.of(400 * 33 - 1)), (13 * 2, 25));
        assert_eq!(Blocks::new(1, 1).count, 1);
    }
}
