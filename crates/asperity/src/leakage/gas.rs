//! Gases: viscosity, and the flow between parallel plates from continuum to free molecular flow.
//!
//! The mass flux per width between plates at a distance h is
//!
//! ```text
//! m' = -h^3 P Q(D)/(12 mu R_s T) dP/dx      R_s = R/M,  D = P h/(mu sqrt(2 R_s T)) = (sqrt(pi)/2) h/lambda
//! ```
//!
//! with the inverse Knudsen number D (lambda: mean free path; Kn = sqrt(pi)/(2 D)). The factor Q of the rarefaction is
//!
//! - continuum: 1;
//! - slip: 1 + 6 Kn;
//! - Boltzmann: 6 Qp(D)/D, with the fit of S. Fukui & R. Kaneko (J. Tribol. 112 (1990) 78) to the linearised Boltzmann equation
//!   with diffuse reflection:
//!
//! ```text
//! Qp = D/6 + 1.0162 + 1.0653/D - 2.1354/D^2                       D >= 5
//!      0.13852 D + 1.25087 + 0.15653/D - 0.00969/D^2              0.15 <= D < 5
//!      -2.22919 D + 2.10673 + 0.01653/D - 0.0000694/D^2           0.01 <= D < 0.15
//!      Qp(0.01) - ln(D/0.01)/sqrt(pi)                             D < 0.01, free molecular flow
//! ```
//!
//! whose pieces agree within 0.3 % where they meet.

use std::f64::consts::PI;

use crate::error::{Error, Result, positive, require};

/// R \[J/(mol K)\].
pub const GAS_CONSTANT: f64 = 8.314_462_618;
/// 0 degC, at which standard leak rates are stated \[K\].
pub const STANDARD_TEMPERATURE: f64 = 273.15;

/// A gas with known properties.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Species {
    /// Dry air.
    Air,
    /// N2.
    Nitrogen,
    /// O2.
    Oxygen,
    /// He.
    Helium,
    /// H2.
    Hydrogen,
}

/// Temperatures at which the viscosities of the gases are known \[K\].
const KNOWN: [f64; 2] = [200.0, 500.0];

/// The viscosity over temperature, relative to that at 20 degC.
enum Law {
    /// (T/T0)^1.5 (T0 + S)/(T + S), with this S \[K\].
    Sutherland(f64),
    /// (T/T0)^n.
    Power(f64),
}

impl Species {
    /// Its name, molar mass \[kg/mol\] and viscosity at 20 degC \[Pa s\], and the law of the viscosity.
    fn properties(self) -> (&'static str, f64, f64, Law) {
        match self {
            Species::Air => ("air", 0.028_964_7, 18.2e-6, Law::Sutherland(110.4)),
            Species::Nitrogen => ("nitrogen", 0.028_013_4, 17.57e-6, Law::Sutherland(111.0)),
            Species::Oxygen => ("oxygen", 0.031_998_8, 20.25e-6, Law::Sutherland(125.0)),
            Species::Helium => ("helium", 0.004_002_6, 19.6e-6, Law::Power(0.67)),
            Species::Hydrogen => ("hydrogen", 0.002_015_88, 8.80e-6, Law::Power(0.68)),
        }
    }

    /// "air", ...
    pub fn name(self) -> &'static str {
        self.properties().0
    }

    /// Molar mass \[kg/mol\].
    pub fn molar_mass(self) -> f64 {
        self.properties().1
    }

    /// Viscosity \[Pa s\] at a temperature \[K\] and moderate pressure.
    ///
    /// Measured at 20 degC (E. W. Lemmon & R. T. Jacobsen, Int. J. Thermophys. 25 (2004) 21, and the NIST database for helium and
    /// hydrogen); over temperature by Sutherland's formula, and for helium and hydrogen by a power of T. Within 2 % from 200 K to
    /// 500 K.
    pub fn viscosity(self, temperature: f64) -> f64 {
        const T0: f64 = 293.15;
        let ratio = temperature / T0;
        let (_, _, mu, law) = self.properties();
        match law {
            Law::Sutherland(s) => mu * ratio * libm::sqrt(ratio) * (T0 + s) / (temperature + s),
            Law::Power(n) => mu * libm::pow(ratio, n),
        }
    }
}

/// The properties of a gas for the flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gas {
    /// Viscosity \[Pa s\].
    pub viscosity: f64,
    /// Molar mass \[kg/mol\].
    pub molar_mass: f64,
    /// Temperature \[K\].
    pub temperature: f64,
}

/// The model of the rarefaction of the gas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Rarefaction {
    /// No rarefaction: for gaps much wider than the mean free path.
    Continuum,
    /// Slip at the walls, to first order: accurate to 10 % if the gap is larger than a few mean free paths.
    Slip,
    /// The linearised Boltzmann equation, for any gap.
    #[default]
    Boltzmann,
}

impl Gas {
    /// A gas with these properties.
    ///
    /// # Errors
    /// [`Error::Invalid`] if one is not positive, or for a molar mass above 1 kg/mol (it is probably in g/mol).
    pub fn new(viscosity: f64, molar_mass: f64, temperature: f64) -> Result<Gas> {
        positive("viscosity of the gas", viscosity, "Pa s")?;
        positive("molar mass of the gas", molar_mass, "kg/mol")?;
        positive("temperature of the gas", temperature, "K")?;
        if molar_mass > 1.0 {
            let expected = "in kg/mol, below 1 (air: 0.02896)";
            return Err(Error::invalid("molar mass of the gas", format!("{molar_mass} kg/mol"), expected));
        }
        Ok(Gas { viscosity, molar_mass, temperature })
    }

    /// A gas with known properties, at a temperature \[K\].
    ///
    /// # Errors
    /// [`Error::Invalid`] if the temperature is not between 200 K and 500 K.
    pub fn of(species: Species, temperature: f64) -> Result<Gas> {
        require(
            (KNOWN[0]..=KNOWN[1]).contains(&temperature),
            "temperature of the gas",
            format!("{temperature} K"),
            "between 200 K and 500 K, where its viscosity is known; give viscosity and molar mass outside",
        )?;
        Gas::new(species.viscosity(temperature), species.molar_mass(), temperature)
    }

    /// R_s T = R T/M \[J/kg\].
    pub fn specific_energy(&self) -> f64 {
        GAS_CONSTANT * self.temperature / self.molar_mass
    }

    /// D/(P h) \[1/(Pa m)\].
    pub fn inverse_knudsen_scale(&self) -> f64 {
        (self.viscosity * (2.0 * self.specific_energy()).sqrt()).recip()
    }

    /// Kn, mean free path over gap, at a pressure \[Pa\] and a gap \[m\].
    pub fn knudsen(&self, pressure: f64, gap: f64) -> f64 {
        0.5 * PI.sqrt() / (self.inverse_knudsen_scale() * pressure * gap)
    }
}

/// A piece of Qp = a D + b + c/D + d/D^2, from its smallest D on.
struct Piece {
    from: f64,
    a: f64,
    b: f64,
    c: f64,
    d: f64,
}

const PIECES: [Piece; 3] = [
    Piece { from: 0.01, a: -2.22919, b: 2.10673, c: 0.01653, d: -0.000_069_4 },
    Piece { from: 0.15, a: 0.13852, b: 1.25087, c: 0.15653, d: -0.00969 },
    Piece { from: 5.0, a: 1.0 / 6.0, b: 1.0162, c: 1.0653, d: -2.1354 },
];

impl Piece {
    fn at(&self, d: f64) -> f64 {
        self.a * d + self.b + self.c / d + self.d / (d * d)
    }

    /// An integral over D.
    fn integral(&self, d: f64) -> f64 {
        0.5 * self.a * d * d + self.b * d + self.c * libm::log(d) - self.d / d
    }
}

/// Qp at 0.01, where free molecular flow begins.
fn molecular() -> f64 {
    PIECES[0].at(PIECES[0].from)
}

/// Qp(D), by the fit to the linearised Boltzmann equation.
fn poiseuille(d: f64) -> f64 {
    match PIECES.iter().rev().find(|piece| d >= piece.from) {
        Some(piece) => piece.at(d),
        None => molecular() - libm::log(d / PIECES[0].from) / PI.sqrt(),
    }
}

/// Integral of Qp from 0 to D.
fn poiseuille_integral(d: f64) -> f64 {
    let start = PIECES[0].from;
    let below = |d: f64| d * (molecular() + (1.0 - libm::log(d / start)) / PI.sqrt());
    if d < start {
        return if d > 0.0 { below(d) } else { 0.0 };
    }
    let mut sum = below(start);
    for (k, piece) in PIECES.iter().enumerate().filter(|(_, piece)| d >= piece.from) {
        let end = PIECES.get(k + 1).map_or(d, |next| d.min(next.from));
        sum += piece.integral(end) - piece.integral(piece.from);
    }
    sum
}

impl Rarefaction {
    /// Q(D), D > 0.
    pub fn factor(self, d: f64) -> f64 {
        match self {
            Rarefaction::Continuum => 1.0,
            Rarefaction::Slip => 1.0 + 3.0 * PI.sqrt() / d,
            Rarefaction::Boltzmann => 6.0 * poiseuille(d) / d,
        }
    }

    /// W(D), the integral of D Q(D) from 0.
    pub fn potential(self, d: f64) -> f64 {
        match self {
            Rarefaction::Continuum => 0.5 * d * d,
            Rarefaction::Slip => 0.5 * d * d + 3.0 * PI.sqrt() * d,
            Rarefaction::Boltzmann => 6.0 * poiseuille_integral(d),
        }
    }

    /// The D of a given W; `near` is an estimate of it.
    pub(super) fn inverse_potential(self, w: f64, near: f64) -> f64 {
        if w <= 0.0 {
            return 0.0;
        }
        // W increases at least as fast as in the continuum.
        let (mut low, mut high) = (0.0, (2.0 * w).sqrt() * (1.0 + 1e-12));
        let mut d = if near > low && near < high { near } else { 0.5 * high };
        for _ in 0..200 {
            let off = self.potential(d) - w;
            if off > 0.0 {
                high = d;
            } else {
                low = d;
            }
            let newton = d - off / (d * self.factor(d));
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - d).abs() <= 1e-14 * next {
                return next;
            }
            d = next;
        }
        d
    }
}
