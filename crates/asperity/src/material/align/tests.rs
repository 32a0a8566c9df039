//! Curves with known distances.

use super::*;

fn curve(first: f64, last: f64, y: impl Fn(f64) -> f64) -> Logs {
    (0..=12).map(|k| first + (last - first) * f64::from(k) / 12.0).map(|x| (x, y(x))).collect()
}

#[test]
fn a_moved_curve_is_found_and_a_flat_one_is_not() {
    let bend = |x: f64| -0.1 * x - 0.02 * x * x;
    let found = distance(&[[curve(0.0, 5.0, bend), curve(0.0, 5.0, |x| bend(x + 2.0))]], Ordinate::Held(0.0));
    // The digits of the values, 1e-5, over a slope of 0.2.
    assert!((found.value - 2.0).abs() < 1e-3 && found.deviation < 1e-3, "{found:?}");
    let flat = distance(&[[curve(0.0, 5.0, |_| 1.0), curve(0.0, 5.0, |_| 1.0)]], Ordinate::Held(0.01));
    assert!(flat.deviation > 10.0, "{flat:?}");
}

#[test]
fn a_gap_and_a_change_of_the_modulus_are_uncertain() {
    let bend = |x: f64| -0.1 * x - 0.02 * x * x;
    let apart = distance(&[[curve(0.0, 2.0, bend), curve(0.0, 2.0, |x| bend(x + 4.0))]], Ordinate::Held(0.0));
    // Exact numbers continue each other; the gap of 2 is most of the standard deviation.
    assert!((apart.value - 4.0).abs() < 0.01 && (2.0..2.2).contains(&apart.deviation), "{apart:?}");
    let line = |x: f64| -0.2 * x;
    let changed =
        distance(&[[curve(0.0, 5.0, bend), curve(0.0, 5.0, |x| bend(x + 1.0))]], Ordinate::Held(0.02));
    assert!(changed.deviation > 0.02, "{changed:?}");
    // On straight lines the distance is still known: the lines have to coincide.
    let lines =
        distance(&[[curve(0.0, 5.0, line), curve(0.0, 5.0, |x| line(x + 1.0))]], Ordinate::Held(0.02));
    assert!((lines.value - 1.0).abs() < 1e-3 && (lines.deviation - 0.1).abs() < 1e-3, "{lines:?}");
}

#[test]
fn a_curve_that_is_moved_and_raised_is_told_by_its_bend_and_a_power_law_is_not() {
    let bend = |x: f64| -0.1 * x - 0.02 * x * x;
    let pair = [curve(0.0, 5.0, bend), curve(0.0, 5.0, |x| bend(x + 2.0) + 0.3)];
    let found = distance(std::slice::from_ref(&pair), Ordinate::Free);
    // Exact except for the digits; one per cent over a slope of 0.2.
    assert!((found.value - 2.0).abs() < 2e-3 && found.deviation < 0.1, "{found:?}");
    let up = raised(&[pair], 2.0);
    // Exact except for the rounding of the polynomials; the standard deviation is that of the digits.
    assert!((up.value + 0.3).abs() < 1e-9 && up.deviation < 1e-4, "{up:?}");
    // One more unit of distance along a slope of -0.1 - 0.04 x is compensated by raising.
    assert!((0.1..0.4).contains(&up.slope.abs()), "{up:?}");
    // A power law that is moved along ln x is equal to one that is raised.
    let line = |x: f64| -0.2 * x;
    let lines = [curve(0.0, 5.0, line), curve(0.0, 5.0, |x| line(x + 1.0) + 0.1)];
    let both = distance(std::slice::from_ref(&lines), Ordinate::Free);
    assert!(both.deviation > 2.3, "a decade: {both:?}");
    // A second quantity with curvature determines the distance of both.
    let tan = [curve(0.0, 5.0, bend), curve(0.0, 5.0, |x| bend(x + 1.0) + 0.1)];
    let both = distance(&[lines, tan], Ordinate::Free);
    assert!((both.value - 1.0).abs() < 1e-2 && both.deviation < 0.1, "{both:?}");
}

#[test]
fn flat_curves_with_scatter_that_do_not_overlap_are_uncertain_by_more_than_a_decade() {
    // A glass: 1 % per unit of ln x, 0.5 % of scatter, values that do not overlap.
    let mut random = crate::material::series::tests::random(5);
    let mut scatter = move || 0.01 * (random() - 0.5);
    let mut glass = |from: f64| -> Logs {
        (0..8).map(|k| f64::from(k) / 3.0).map(|x| (x, from - 0.01 * x + scatter())).collect()
    };
    let found = distance(&[[glass(0.0), glass(-0.08)]], Ordinate::Held(0.004));
    assert!(found.deviation > 2.3, "{found:?}");
}
