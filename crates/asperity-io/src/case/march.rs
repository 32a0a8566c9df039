//! TEMPORARY: the types of `asperity::march` until they land.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    Linear,
    Constant,
    Direct,
}
#[derive(Clone, Debug, PartialEq)]
pub enum TimeGrid {
    Uniform { end: f64, steps: usize },
    Logarithmic { end: f64, steps: usize, first: f64 },
    List(Vec<f64>),
}
pub struct Simulation {
    pub grid: asperity::Grid,
    pub boundary: asperity::Boundary,
    pub gap: ndarray::Array2<f64>,
    pub creep: asperity::material::Creep,
    pub hardness: f64,
    pub loading: asperity::Loading,
    pub times: TimeGrid,
    pub scheme: Scheme,
    pub solver: asperity::SolverOptions,
}
impl TimeGrid {
    pub fn end(&self) -> f64 {
        match self {
            TimeGrid::Uniform { end, .. } | TimeGrid::Logarithmic { end, .. } => *end,
            TimeGrid::List(t) => t.last().copied().unwrap_or(0.0),
        }
    }
}
