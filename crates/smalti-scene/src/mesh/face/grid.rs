//! Places in the squares of a grid, so that an ear meets only those near to it.

use robust::Coord;

/// Most squares along a side.
const FINEST: usize = 1024;

/// Indices of places by the square that they are in.
pub struct Grid {
    low: Coord<f64>,
    /// Squares per length.
    scale: Coord<f64>,
    side: usize,
    squares: Vec<Vec<usize>>,
}

impl Grid {
    /// The grid of these places among `points`: about two in a square.
    pub fn new(points: &[Coord<f64>], places: &[usize]) -> Self {
        let [low, high] = bounds(points.iter().copied());
        let side = ((places.len() as f64 / 2.0).sqrt() as usize).clamp(1, FINEST);
        let scale = |low: f64, high: f64| if high > low { side as f64 / (high - low) } else { 0.0 };
        let scale = Coord { x: scale(low.x, high.x), y: scale(low.y, high.y) };
        let mut grid = Self { low, scale, side, squares: vec![Vec::new(); side * side] };
        places.iter().for_each(|&place| grid.insert(place, points[place]));
        grid
    }

    /// Adds a place within the bounds of the others.
    pub fn insert(&mut self, place: usize, point: Coord<f64>) {
        let [column, row] = self.square(point);
        self.squares[row * self.side + column].push(place);
    }

    fn square(&self, point: Coord<f64>) -> [usize; 2] {
        let along = |distance: f64, scale: f64| ((distance * scale) as usize).min(self.side - 1);
        [along(point.x - self.low.x, self.scale.x), along(point.y - self.low.y, self.scale.y)]
    }

    /// The places in the squares that the box around `corners` touches.
    pub fn near(&self, corners: [Coord<f64>; 3]) -> impl Iterator<Item = usize> {
        let [[left, bottom], [right, top]] = bounds(corners.into_iter()).map(|corner| self.square(corner));
        let rows = (bottom..=top).map(move |row| row * self.side);
        rows.flat_map(move |row| self.squares[row + left..=row + right].iter().flatten().copied())
    }
}

/// The least and the greatest coordinates.
fn bounds(points: impl Iterator<Item = Coord<f64>>) -> [Coord<f64>; 2] {
    let start = [f64::INFINITY, f64::NEG_INFINITY].map(|value| Coord { x: value, y: value });
    points.fold(start, |[low, high], point| {
        let low = Coord { x: low.x.min(point.x), y: low.y.min(point.y) };
        [low, Coord { x: high.x.max(point.x), y: high.y.max(point.y) }]
    })
}
