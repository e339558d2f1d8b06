//! Whether a face crosses itself.

use robust::{Coord, orient2d};

/// Whether two edges of the closed boundary pass through each other. To touch is not to cross.
pub fn crosses(points: &[Coord<f64>]) -> bool {
    let mut edges: Vec<[Coord<f64>; 2]> =
        points.iter().zip(points.iter().cycle().skip(1)).map(|(from, to)| [*from, *to]).collect();
    if reach(&edges, |point| point.y) < reach(&edges, |point| point.x) {
        edges.iter_mut().flatten().for_each(|point| *point = Coord { x: point.y, y: point.x });
    }
    // Edges that overlap along the axis in which edges are shorter are few.
    edges.sort_by(|a, b| low(a).total_cmp(&low(b)));
    edges.iter().enumerate().any(|(index, edge)| {
        let rest = edges[index + 1..].iter().take_while(|other| low(other) <= edge[0].x.max(edge[1].x));
        rest.into_iter().any(|other| pass(edge, other))
    })
}

fn low(edge: &[Coord<f64>; 2]) -> f64 {
    edge[0].x.min(edge[1].x)
}

/// How long edges are along an axis, by the extent of all.
fn reach(edges: &[[Coord<f64>; 2]], along: impl Fn(&Coord<f64>) -> f64) -> f64 {
    let ends = edges.iter().flatten().map(&along);
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    edges.iter().map(|[from, to]| (along(to) - along(from)).abs()).sum::<f64>() / (high - low)
}

/// Whether each edge has its ends strictly on both sides of the other.
fn pass([a, b]: &[Coord<f64>; 2], [c, d]: &[Coord<f64>; 2]) -> bool {
    let apart = a.y.max(b.y) < c.y.min(d.y) || c.y.max(d.y) < a.y.min(b.y);
    !apart && parts([*a, *b], [*c, *d]) && parts([*c, *d], [*a, *b])
}

fn parts([from, to]: [Coord<f64>; 2], ends: [Coord<f64>; 2]) -> bool {
    let [one, other] = ends.map(|end| orient2d(from, to, end));
    (one < 0.0 && other > 0.0) || (one > 0.0 && other < 0.0)
}
