//! Relaxation functions as a Prony series.

/// E(t) = E_inf + sum_i E_i exp(-t/tau_i) + viscosity delta(t), in pascal.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Relaxation {
    /// E_inf \[Pa\].
    pub equilibrium: f64,
    /// The relaxing terms, in order of relaxation time.
    pub terms: Vec<RelaxationTerm>,
    /// Newtonian dashpot in parallel \[Pa s\] (Kelvin-Voigt); 0 where the modulus at t = 0 is finite.
    pub viscosity: f64,
}

/// One relaxing term E_i exp(-t/tau_i).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxationTerm {
    /// E_i \[Pa\].
    pub modulus: f64,
    /// tau_i \[s\].
    pub relaxation_time: f64,
}
