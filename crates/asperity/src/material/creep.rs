//! Creep functions as a Prony (Dirichlet) series.

/// C(t) = C0 + sum_j C_j (1 - exp(-t/lambda_j)) + t/eta, per pascal.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Creep {
    /// C0 \[1/Pa\].
    pub instantaneous: f64,
    /// The retarded terms, in order of retardation time.
    pub terms: Vec<CreepTerm>,
    /// 1/eta \[1/(Pa s)\]; 0 for a solid.
    pub fluidity: f64,
}

/// One retarded term C_j (1 - exp(-t/lambda_j)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CreepTerm {
    /// C_j \[1/Pa\].
    pub compliance: f64,
    /// lambda_j \[s\].
    pub retardation_time: f64,
}
