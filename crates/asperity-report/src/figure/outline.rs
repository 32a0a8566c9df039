//! Outlines of shapes as moves, lines and cubic Bézier curves, for forms that have no circles.

use super::drawing::Shape;

/// A step of an outline \[points\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    Move([f64; 2]),
    Line([f64; 2]),
    /// A cubic curve: two control points and its end.
    Cubic([[f64; 2]; 3]),
    Close,
}

/// Distance of the control points of a quarter of a circle from its ends, per radius: 4 (√2 - 1)/3.
const QUARTER: f64 = 0.552_284_749_830_793_4;

impl Shape {
    /// The outline in steps.
    pub(super) fn outline(&self) -> Vec<Step> {
        match self {
            Shape::Rect { corner, size, round } => rect(*corner, *size, *round),
            Shape::Circle { at: [x, y], radius } => {
                rect([x - radius, y - radius], [2.0 * radius; 2], *radius)
            }
            Shape::Lines(lines) => {
                let step =
                    |(n, at): (usize, &[f64; 2])| if n == 0 { Step::Move(*at) } else { Step::Line(*at) };
                lines.iter().flat_map(|line| line.iter().enumerate().map(step)).collect()
            }
        }
    }
}

/// A rectangle, with quarters of a circle at its corners where these are round.
fn rect([x, y]: [f64; 2], [w, h]: [f64; 2], round: f64) -> Vec<Step> {
    let r = round.min(0.5 * w).min(0.5 * h).max(0.0);
    let corners = [[x + w, y], [x + w, y + h], [x, y + h], [x, y]];
    // The directions of the edges that lead to the corners.
    let along = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let from =
        |corner: [f64; 2], [u, v]: [f64; 2], length: f64| [corner[0] + u * length, corner[1] + v * length];
    let mut steps = vec![Step::Move([x + r, y])];
    for (n, corner) in corners.into_iter().enumerate() {
        let (before, after) = (along[n], along[(n + 1) % 4]);
        steps.push(Step::Line(from(corner, before, -r)));
        if r > 0.0 {
            let near = r * (1.0 - QUARTER);
            steps.push(Step::Cubic([
                from(corner, before, -near),
                from(corner, after, near),
                from(corner, after, r),
            ]));
        }
    }
    steps.push(Step::Close);
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_keeps_its_distance_from_its_centre() {
        let mut now = [0.0; 2];
        let steps = Shape::Circle { at: [3.0, 4.0], radius: 2.0 }.outline();
        let mut arcs = 0;
        for step in &steps {
            match *step {
                Step::Cubic([a, b, end]) => {
                    arcs += 1;
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
                Step::Move(at) | Step::Line(at) => now = at,
                Step::Close => {}
            }
        }
        assert_eq!(arcs, 4);
    }

    #[test]
    fn a_rectangle_has_four_corners_and_no_curve() {
        let steps = Shape::Rect { corner: [1.0, 2.0], size: [3.0, 4.0], round: 0.0 }.outline();
        let corners = [[4.0, 2.0], [4.0, 6.0], [1.0, 6.0], [1.0, 2.0]].map(Step::Line);
        assert_eq!(steps[0], Step::Move([1.0, 2.0]));
        assert_eq!(steps[1..5], corners);
        assert_eq!(steps[5..], [Step::Close]);
    }
}
