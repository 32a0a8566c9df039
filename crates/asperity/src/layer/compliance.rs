//! C(q) of a stack, computed layer by layer from the base upwards.
//!
//! In plane strain, along a wave cos(q x) and with z down, the displacements u sin(q x), w cos(q x) and the stresses
//! s_xz = tau sin(q x), s_zz = sigma cos(q x) obey, with y = (q u, q w, tau, sigma) and ' = d/d(q z),
//!
//! ```text
//! y' = A y,   A = |    0        1    1/mu             0          |
//!                 | -nu/m       0     0     (1 - 2 nu)/(2 m mu)  |     m = 1 - nu
//!                 | 2 mu/m      0     0           nu/m           |
//!                 |    0        0    -1             0            |
//! ```
//!
//! (equilibrium and Hooke's law). A^2 = 1 + N with N^2 = 0, so that across a layer of thickness d, x = q d,
//!
//! ```text
//! y(top) = exp(-A x) y(bottom),   exp(-A x) = cosh x - A sinh x + N (x/2) sinh x - A N g,   g = (x cosh x - sinh x)/2.
//! ```
//!
//! The layers below a face are represented by F, (q u, q w) = F (tau, sigma) on it, which is a 2 x 2 compliance. Two columns span
//! the possible states of the lower face of a layer,
//!
//! ```text
//! bonded: (F, 1)      slip: (1, 0, 0, 0) and (0, F_22, 0, 1)      F = 0 on a rigid base
//! ```
//!
//! exp(-A x) transfers them to the upper face, (U, S), and there F = U S^-1. At the surface q C(q) = -F_22. If the entries of
//! exp(-A x) are divided by e^x, nothing overflows. Each entry keeps its digits for thin layers, and therefore so does C(q),
//! however small it is (an incompressible layer has C ~ q^2). Layered half-spaces: O'Sullivan & King, J. Tribol. 110 (1988) 235.

use super::{Base, Interface, Layer, Stack};

/// Thickness times q from which on the material below a layer has no effect: it reflects 4 x^2 e^(-2x) < 2e-16.
const DEEP: f64 = 22.0;

/// (q u, q w) = F (tau, sigma).
type Compliance = [[f64; 2]; 2];

impl Stack {
    /// C(q) \[m/Pa\]: the surface displacement under a wave of pressure of unit amplitude and wave number q > 0 \[rad/m\].
    ///
    /// ```
    /// use asperity::layer::{Base, Interface, Layer, Stack};
    /// // An incompressible layer that slips on a rigid base, q d = 1 (Johnson, Contact Mechanics, 1985, section 5.8).
    /// let layer = Layer { thickness: 1.0, shear: 1.0, poisson: 0.5, interface: Interface::Slip };
    /// let x = 1f64;
    /// let exact = 0.5 * ((2.0 * x).cosh() - 1.0) / ((2.0 * x).sinh() + 2.0 * x);
    /// assert!((Stack::new(vec![layer], Base::Rigid)?.compliance(1.0) / exact - 1.0).abs() < 1e-14);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn compliance(&self, q: f64) -> f64 {
        // The material below a deep layer has no effect.
        let deep = self.layers.iter().position(|layer| q * layer.thickness > DEEP);
        let (above, below) = match deep {
            Some(n) => (&self.layers[..n], Some(half_space(self.layers[n].shear, self.layers[n].poisson))),
            None => (&self.layers[..], base(self.base)),
        };
        let surface = above.iter().rev().fold(below, |below, layer| Some(on_top(layer, q, below)));
        surface.map_or(0.0, |f| -f[1][1] / q)
    }
}

/// F of the base; `None` if it is rigid.
fn base(base: Base) -> Option<Compliance> {
    match base {
        Base::Rigid => None,
        Base::HalfSpace { shear, poisson } => Some(half_space(shear, poisson)),
    }
}

/// F of a half-space, from the two states that decay downwards.
fn half_space(shear: f64, poisson: f64) -> Compliance {
    let (own, cross) = ((1.0 - poisson) / shear, (0.5 - poisson) / shear);
    [[-own, cross], [cross, -own]]
}

/// F on top of a layer, from F below it.
fn on_top(layer: &Layer, q: f64, below: Option<Compliance>) -> Compliance {
    let f = below.unwrap_or_default();
    let bottom = match layer.interface {
        Interface::Bonded => [f[0], f[1], [1.0, 0.0], [0.0, 1.0]],
        Interface::Slip => [[1.0, 0.0], [0.0, f[1][1]], [0.0, 0.0], [0.0, 1.0]],
    };
    let across = across(layer, q * layer.thickness);
    let top = across.map(|row| [0, 1].map(|n| (0..4).map(|k| row[k] * bottom[k][n]).sum::<f64>()));
    let [u, w, [a, b], [c, d]] = top;
    let determinant = a * d - b * c;
    let over_stress = |[x, y]: [f64; 2]| [(x * d - y * c) / determinant, (y * a - x * b) / determinant];
    [over_stress(u), over_stress(w)]
}

/// exp(-A x) e^(-x).
fn across(layer: &Layer, x: f64) -> [[f64; 4]; 4] {
    let Layer { shear: mu, poisson: nu, .. } = *layer;
    let m = 1.0 - nu;
    let decayed = libm::expm1(-2.0 * x);
    let (cosh, sinh) = (1.0 + 0.5 * decayed, -0.5 * decayed);
    let h = 0.5 * x * sinh / m;
    let g = if x < 1.0 { short(x) * libm::exp(-x) } else { 0.5 * (x * cosh - sinh) } / m;
    [
        [cosh + h, -sinh - g, -(sinh + 0.5 * g) / mu, 0.5 * h / mu],
        [sinh * nu / m + g, cosh - h, -0.5 * h / mu, 0.5 * (g - sinh * (1.0 - 2.0 * nu) / m) / mu],
        [-2.0 * mu * (sinh / m + g), 2.0 * mu * h, cosh + h, -(sinh * nu / m + g)],
        [-2.0 * mu * h, 2.0 * mu * g, sinh + g, cosh - h],
    ]
}

/// (x cosh x - sinh x)/2 by its series, the sum of k x^(2k+1)/(2k+1)!.
fn short(x: f64) -> f64 {
    let (mut power, mut sum) = (x, 0.0);
    for k in 1..=9 {
        power *= x * x / f64::from(2 * k * (2 * k + 1));
        sum += f64::from(k) * power;
    }
    sum
}

/// Whether the material below a layer with x = q d has no effect.
pub(super) fn is_short(x: f64) -> bool {
    x > DEEP
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(thickness: f64, shear: f64, poisson: f64, interface: Interface) -> Layer {
        Layer { thickness, shear, poisson, interface }
    }

    fn stack(layers: &[Layer], base: Base) -> Stack {
        Stack::new(layers.to_vec(), base).unwrap()
    }

    use Interface::{Bonded, Slip};

    const BONDED: [(f64, f64); 9] = [
        (0.001, 0.28571430612241805),
        (0.01, 0.28571632622160875),
        (0.1, 0.28591531096612877),
        (0.3, 0.2873233572076807),
        (1.0, 0.29102625891954276),
        (2.0, 0.26643097478307964),
        (4.0, 0.17228702496347745),
        (10.0, 0.0699999643915265),
        (30.0, 0.023333333333333334),
    ];
    const INCOMPRESSIBLE: [(f64, f64); 9] = [
        (0.001, 3.3333273333442856e-07),
        (0.01, 3.332733442837097e-05),
        (0.1, 0.0032744088824891568),
        (0.3, 0.025825492215774966),
        (1.0, 0.12029084059132847),
        (2.0, 0.16036250856875203),
        (4.0, 0.121635961906682),
        (10.0, 0.04999995444854269),
        (30.0, 0.016666666666666666),
    ];
    const SLIPPING: [(f64, f64); 9] = [
        (0.001, 0.24999999999999445),
        (0.01, 0.2499999999444455),
        (0.1, 0.2499994455022902),
        (0.3, 0.24995576896601948),
        (1.0, 0.2454473268282586),
        (2.0, 0.21019736701661393),
        (4.0, 0.12424926662438572),
        (10.0, 0.04999999567157775),
        (30.0, 0.016666666666666666),
    ];
    const COATED: [(f64, f64); 9] = [
        (0.001, 699.52584696806),
        (0.01, 69.54688711095504),
        (0.1, 6.664703314829222),
        (0.3, 2.0602564326356707),
        (1.0, 0.4077420147119119),
        (2.0, 0.12080613467418881),
        (4.0, 0.0475290937221993),
        (10.0, 0.01875000854609317),
        (30.0, 0.00625),
    ];
    const SLIPPING_COATING: [(f64, f64); 9] = [
        (0.001, 550.1749998559065),
        (0.01, 55.17498554965867),
        (0.1, 5.673516661241902),
        (0.3, 1.9944514850872852),
        (1.0, 0.5951328726707548),
        (2.0, 0.21992455135451316),
        (4.0, 0.08878008316680364),
        (10.0, 0.03500001830763319),
        (30.0, 0.011666666666666667),
    ];
    const THREE: [(f64, f64); 9] = [
        (0.001, 0.32580666306163714),
        (0.01, 0.32582759488339597),
        (0.1, 0.3279047255118621),
        (0.3, 0.3435112527300522),
        (1.0, 0.3941763937010829),
        (2.0, 0.22737585357551746),
        (4.0, 0.08036132343645892),
        (10.0, 0.026723351754235555),
        (30.0, 0.008888888889196497),
    ];

    #[test]
    fn c_equals_forty_digit_boundary_systems() {
        for (stack, rows) in [
            (stack(&[layer(1.0, 1.0, 0.3, Bonded)], Base::Rigid), BONDED),
            (stack(&[layer(1.0, 1.0, 0.5, Bonded)], Base::Rigid), INCOMPRESSIBLE),
            (stack(&[layer(1.0, 1.0, 0.5, Slip)], Base::Rigid), SLIPPING),
            (stack(&[layer(1.0, 4.0, 0.25, Bonded)], Base::HalfSpace { shear: 1.0, poisson: 0.3 }), COATED),
            (
                stack(&[layer(1.0, 2.0, 0.3, Slip)], Base::HalfSpace { shear: 1.0, poisson: 0.45 }),
                SLIPPING_COATING,
            ),
            (
                stack(
                    &[layer(0.5, 3.0, 0.2, Bonded), layer(1.0, 1.0, 0.5, Slip), layer(0.7, 2.0, 0.3, Bonded)],
                    Base::Rigid,
                ),
                THREE,
            ),
        ] {
            for (q, exact) in rows {
                // Roundings of 2 x 2 systems whose determinant cancels by x^2.
                let error = stack.compliance(q) / exact - 1.0;
                assert!(error.abs() < 4e-13, "{stack:?} at {q}: {error:e}");
            }
        }
    }

    const WAVES: [f64; 10] = [1e-6, 1e-3, 0.03, 0.3, 1.0, 3.0, 9.0, 21.9, 22.1, 1e3];

    #[test]
    fn c_equals_the_closed_forms_of_one_layer() {
        for nu in [-0.5, 0.0, 0.3, 0.49, 0.5] {
            for q in WAVES {
                let (mu, d): (f64, f64) = (3.0, 0.7);
                let (x, k) = (q * d, 3.0 - 4.0 * nu);
                let half = (1.0 - nu) / (mu * q);
                // k sinh 2x - 2x, by its series if it cancels.
                let excess = if x < 0.3 {
                    let y = 4.0 * x * x;
                    2.0 * x * y / 6.0
                        * (1.0 + y / 20.0 * (1.0 + y / 42.0 * (1.0 + y / 72.0 * (1.0 + y / 110.0))))
                } else {
                    (2.0 * x).sinh() - 2.0 * x
                };
                let t = (-2.0 * x).exp();
                let bonded = match x < 20.0 {
                    true => {
                        ((k - 1.0) * (2.0 * x).sinh() + excess)
                            / (k * (2.0 * x).cosh() + 0.5 * (4.0 * x * x + 1.0 + k * k))
                    }
                    false => 1.0,
                };
                let slip = if x < 0.3 {
                    x.sinh() * x.sinh() / (2.0 * x + 0.5 * excess)
                } else {
                    (1.0 - t) * (1.0 - t) / (1.0 - t * t + 4.0 * x * t)
                };
                for (interface, exact) in [(Bonded, bonded), (Slip, slip)] {
                    let c = stack(&[layer(d, mu, nu, interface)], Base::Rigid).compliance(q);
                    let error = c / (half * exact) - 1.0;
                    assert!(error.abs() < 4e-13, "{interface:?} nu = {nu}, x = {x}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn c_equals_the_closed_form_of_a_coated_half_space() {
        // O'Sullivan & King (1988).
        for (mu1, nu1, mu2, nu2) in
            [(4.0, 0.3, 1.0, 0.3), (0.1, 0.5, 1.0, 0.2), (1e4, 0.2, 1.0, 0.5), (1.0, 0.0, 1e4, 0.4)]
        {
            let stack = stack(&[layer(1.0, mu1, nu1, Bonded)], Base::HalfSpace { shear: mu2, poisson: nu2 });
            let g: f64 = mu1 / mu2;
            let l = 1.0 - 4.0 * (1.0 - nu1) / (1.0 + g * (3.0 - 4.0 * nu2));
            let k = (g - 1.0) / (g + 3.0 - 4.0 * nu1);
            for x in [0.3f64, 1.0, 3.0, 10.0, 30.0] {
                let t = (-2.0 * x).exp();
                let exact = (1.0 - nu1) / (mu1 * x) * (1.0 + 4.0 * k * x * t - l * k * t * t)
                    / (1.0 - (l + k + 4.0 * k * x * x) * t + l * k * t * t);
                // The closed form itself cancels for stiff layers at long waves.
                let error = stack.compliance(x) / exact - 1.0;
                assert!(error.abs() < 1e-11, "{g} {x}: {error:e}");
            }
        }
    }

    #[test]
    fn layers_of_one_material_are_one_layer() {
        for base in [Base::Rigid, Base::HalfSpace { shear: 1.0, poisson: 0.4 }] {
            for nu in [0.0, 0.3, 0.5] {
                let whole = stack(&[layer(1.0, 5.0, nu, Bonded)], base);
                let slices =
                    |parts: usize| stack(&vec![layer(1.0 / parts as f64, 5.0, nu, Bonded); parts], base);
                for q in WAVES {
                    for parts in [2, 3, 20] {
                        let error = slices(parts).compliance(q) / whole.compliance(q) - 1.0;
                        assert!(error.abs() < 1e-12, "{base:?} {nu} {parts} {q}: {error:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_stack_of_the_material_of_its_base_is_a_half_space() {
        for nu in [-0.9, 0.0, 0.3, 0.5] {
            for d in [1e-12, 1e-3, 1.0, 1e6] {
                let layers = [layer(d, 7.0, nu, Bonded), layer(0.3 * d, 7.0, nu, Bonded)];
                let same = stack(&layers, Base::HalfSpace { shear: 7.0, poisson: nu });
                for q in WAVES {
                    let error = same.compliance(q) * 7.0 * q / (1.0 - nu) - 1.0;
                    assert!(error.abs() < 1e-12, "{nu} {d} {q}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn long_waves_squeeze_what_lies_on_a_rigid_base() {
        let layers = [layer(0.5, 2.0, 0.3, Bonded), layer(1.5, 1.0, 0.45, Bonded)];
        let squeezed = stack(&layers, Base::Rigid);
        let uniform = squeezed.uniform().unwrap();
        assert!((uniform / (0.5 * 0.4 / (4.0 * 0.7) + 1.5 * 0.1 / (2.0 * 0.55)) - 1.0).abs() < 1e-14);
        // Terms of order (q d)^2.
        assert!((squeezed.compliance(1e-5) / uniform - 1.0).abs() < 1e-8);
        // An incompressible layer is squeezed out sideways: d^3 q^2/(3 mu).
        let incompressible = stack(&[layer(2.0, 3.0, 0.5, Bonded)], Base::Rigid);
        assert_eq!(incompressible.uniform(), Some(0.0));
        assert!((incompressible.compliance(1e-5) / (8.0 * 1e-10 / 9.0) - 1.0).abs() < 1e-8);
    }

    #[test]
    fn stiffening_a_layer_never_raises_c() {
        let base = Base::HalfSpace { shear: 1.0, poisson: 0.3 };
        let of = |mu: f64| {
            stack(
                &[layer(0.2, 3.0, 0.4, Bonded), layer(0.5, mu, 0.5, Slip), layer(1.0, 0.1, 0.1, Bonded)],
                base,
            )
        };
        for q in WAVES {
            let mut last = f64::INFINITY;
            for mu in [1e-8, 1e-4, 0.1, 1.0, 30.0, 1e4, 1e8] {
                let c = of(mu).compliance(q);
                assert!(c > 0.0 && c <= last * (1.0 + 1e-12), "{q} {mu}: {c} {last}");
                last = c;
            }
        }
    }
}
