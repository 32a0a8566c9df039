//! Outlines of shapes, for formats that have no circles: moves, lines and cubic Bézier curves.

use tiny_skia::{Path, PathBuilder};

use super::drawing::Shape;

/// Distance of the control points of a quarter of a circle from its ends, per radius: 4 (√2 - 1)/3.
const QUARTER: f64 = 0.552_284_749_830_793_4;

impl Shape {
    /// The outline \[points\]; `None` where it is empty.
    pub(super) fn outline(&self) -> Option<Path> {
        let mut path = PathBuilder::new();
        match self {
            Shape::Rect { corner, size, round } => rect(&mut path, *corner, *size, *round),
            Shape::Circle { at: [x, y], radius } => {
                rect(&mut path, [x - radius, y - radius], [2.0 * radius; 2], *radius);
            }
            Shape::Lines(lines) => {
                for (n, [x, y]) in lines.iter().flat_map(|line| line.iter().enumerate()) {
                    let [x, y] = [*x, *y].map(|v| v as f32);
                    if n == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
                }
            }
        }
        path.finish()
    }
}

/// A rectangle, with quarters of a circle at its corners where these are round.
fn rect(path: &mut PathBuilder, [x, y]: [f64; 2], [w, h]: [f64; 2], round: f64) {
    let r = round.min(0.5 * w).min(0.5 * h).max(0.0);
    let corners = [[x + w, y], [x + w, y + h], [x, y + h], [x, y]];
    // The directions of the edges that lead to the corners.
    let along = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let from =
        |corner: [f64; 2], [u, v]: [f64; 2], length: f64| [corner[0] + u * length, corner[1] + v * length];
    path.move_to((x + r) as f32, y as f32);
    for (n, corner) in corners.into_iter().enumerate() {
        let (before, after) = (along[n], along[(n + 1) % 4]);
        let [x, y] = from(corner, before, -r).map(|v| v as f32);
        path.line_to(x, y);
        if r > 0.0 {
            let near = r * (1.0 - QUARTER);
            let points = [from(corner, before, -near), from(corner, after, near), from(corner, after, r)];
            let [[x1, y1], [x2, y2], [x, y]] = points.map(|point| point.map(|v| v as f32));
            path.cubic_to(x1, y1, x2, y2, x, y);
        }
    }
    path.close();
}

#[cfg(test)]
mod tests {
    use tiny_skia::PathSegment;

    use super::*;

    #[test]
    fn a_circle_keeps_its_distance_from_its_centre() {
        let mut now = [0.0; 2];
        let mut arcs = 0;
        let circle = Shape::Circle { at: [3.0, 4.0], radius: 2.0 };
        for segment in circle.outline().unwrap().segments() {
            match segment {
                PathSegment::CubicTo(a, b, end) => {
                    arcs += 1;
                    let [a, b, end] = [a, b, end].map(|point| [f64::from(point.x), f64::from(point.y)]);
                    for k in 0..=10 {
                        let t = f64::from(k) / 10.0;
                        let s = 1.0 - t;
                        let place = [0, 1].map(|i| {
                            s * s * s * now[i]
                                + 3.0 * s * s * t * a[i]
                                + 3.0 * s * t * t * b[i]
                                + t * t * t * end[i]
                        });
                        let far = f64::hypot(place[0] - 3.0, place[1] - 4.0);
                        // A cubic differs from a quarter of a circle by 2.7e-4 of its radius.
                        assert!((far / 2.0 - 1.0).abs() < 3e-4, "{far}");
                    }
                    now = end;
                }
                PathSegment::MoveTo(at) | PathSegment::LineTo(at) => {
                    now = [f64::from(at.x), f64::from(at.y)];
                }
                PathSegment::Close | PathSegment::QuadTo(..) => {}
            }
        }
        assert_eq!(arcs, 4);
    }

    #[test]
    fn a_rectangle_has_four_corners_and_no_curve() {
        let path = Shape::Rect { corner: [1.0, 2.0], size: [3.0, 4.0], round: 0.0 }.outline().unwrap();
        let segments: Vec<_> = path.segments().collect();
        let corners = [(4.0, 2.0), (4.0, 6.0), (1.0, 6.0), (1.0, 2.0)];
        assert_eq!(segments[0], PathSegment::MoveTo((1.0, 2.0).into()));
        assert_eq!(segments[1..5], corners.map(|corner| PathSegment::LineTo(corner.into())));
        assert_eq!(segments[5..], [PathSegment::Close]);
    }
}
