//! The time in each tile as a heat map.

use maud::{Markup, html};

use super::ink::svg;
use crate::findings::runs_of;
use crate::numbers::significant;
use crate::record::{Study, TileTime};

/// Colours from no time to the slowest tile's (of the scale viridis), at equal distances.
const HEAT: [[f64; 3]; 6] = [
    [68.0, 1.0, 84.0],
    [65.0, 68.0, 135.0],
    [42.0, 120.0, 142.0],
    [34.0, 168.0, 132.0],
    [122.0, 209.0, 81.0],
    [253.0, 231.0, 37.0],
];

/// What the tiles of an arm's first repetition say together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Balance {
    pub least: f64,
    pub median: f64,
    pub slowest: TileTime,
    pub count: usize,
}

/// Tiles of an arm's first repetition; empty where they were not kept.
pub(crate) fn tiles_of(study: &Study, arm: usize) -> &[TileTime] {
    let kept = runs_of(study, arm).into_iter().find(|run| !run.tiles.is_empty());
    kept.map_or(&[], |run| &run.tiles)
}

/// The balance of tiles; `None` without any.
pub(crate) fn balance(tiles: &[TileTime]) -> Option<Balance> {
    let times: Vec<f64> = tiles.iter().map(|tile| tile.seconds).collect();
    let slowest = *tiles.iter().max_by(|a, b| a.seconds.total_cmp(&b.seconds))?;
    let least = times.iter().copied().fold(f64::INFINITY, f64::min);
    Some(Balance { least, median: smalti_measure::median(&times)?, slowest, count: tiles.len() })
}

/// The tiles of an arm in the colours of their times; `None` where they were not kept.
pub(crate) fn tile_map(study: &Study, arm: usize) -> Option<Markup> {
    let tiles = tiles_of(study, arm);
    let slowest = balance(tiles)?.slowest;
    let [width, height] = extent(tiles);
    let content = html! {
        @for tile in tiles { (rectangle(tile, slowest.seconds)) }
        (outline(&slowest, width))
    };
    let label = format!("Time in each tile of {}", study.arms[arm].label);
    Some(svg(width, height, &label, "heat", &content))
}

/// Width and height of what the tiles cover.
fn extent(tiles: &[TileTime]) -> [f64; 2] {
    let end = |of: fn(&TileTime) -> u32| f64::from(tiles.iter().map(of).max().unwrap_or(0));
    [end(|tile| tile.area[0] + tile.area[2]), end(|tile| tile.area[1] + tile.area[3])]
}

fn rectangle(tile: &TileTime, slowest: f64) -> Markup {
    let [x, y, width, height] = tile.area;
    html! {
        rect x=(x) y=(y) width=(width) height=(height) fill=(heat(tile.seconds / slowest)) shape-rendering="crispEdges" {
            title { "column " (x) ", row " (y) ": " (milliseconds(tile.seconds)) }
        }
    }
}

fn outline(tile: &TileTime, width: f64) -> Markup {
    let [x, y, tile_width, height] = tile.area;
    html! {
        rect class="slowest" x=(x) y=(y) width=(tile_width) height=(height) fill="none" stroke="#e0218a"
            stroke-width=(significant(width / 160.0, 2)) {}
    }
}

/// The colour of a share of the slowest tile's time.
pub(crate) fn heat(share: f64) -> String {
    let place = if share > 0.0 { share.min(1.0) * (HEAT.len() - 1) as f64 } else { 0.0 };
    let index = (place as usize).min(HEAT.len() - 2);
    let part = place - index as f64;
    let level = |c: usize| (HEAT[index][c] + part * (HEAT[index + 1][c] - HEAT[index][c])).round() as u8;
    format!("#{:02x}{:02x}{:02x}", level(0), level(1), level(2))
}

/// `12.3 ms`.
pub(crate) fn milliseconds(seconds: f64) -> String {
    significant(1e3 * seconds, 3) + " ms"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn the_slowest_tile_is_found() {
        let study = fixture::sweep();
        let found = balance(tiles_of(&study, 1)).unwrap();
        assert_eq!((found.slowest.area, found.count), ([40, 30, 40, 30], 4));
        let share = |part: f64| part / found.slowest.seconds;
        assert!((share(found.least) - 0.25).abs() < 1e-12 && (share(found.median) - 0.625).abs() < 1e-12);
        assert_eq!(balance(&[]), None);
    }

    #[test]
    fn the_map_has_every_tile_and_the_slowest_outlined() {
        let mut study = fixture::sweep();
        let drawn = tile_map(&study, 0).unwrap().into_string();
        assert_eq!((drawn.matches("<title>").count(), drawn.matches("slowest").count()), (4, 1));
        assert!(drawn.contains("viewBox=\"0 0 80 60\"") && drawn.contains("#fde725"), "{drawn}");
        study.runs.clear();
        assert!(tile_map(&study, 0).is_none());
    }

    #[test]
    fn heat_goes_from_dark_to_bright() {
        assert_eq!([0.0, 1.0, 2.0, f64::NAN].map(heat), ["#440154", "#fde725", "#fde725", "#440154"]);
        assert_eq!(heat(0.4), "#2a788e");
    }
}
