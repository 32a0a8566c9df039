//! The arguments of `leak`.

use std::path::PathBuf;

use asperity::leakage::{Rarefaction, Sides, Species};
use asperity_io::leakage::LeakDirection;
use asperity_io::quantity::range::{NonNegative, Positive};
use asperity_io::quantity::{Length, MolarMass, Pressure, Temperature, Viscosity};

use crate::input::quantity;

#[derive(Debug, clap::Args)]
pub struct Leak {
    /// The result (a Zarr directory); its leakage is stored in it. Options change only what they name
    #[arg(required_unless_present = "gap", conflicts_with = "gap")]
    pub result: Option<PathBuf>,
    /// A map of the gap instead: a file of any format that surfaces are read from, its heights are the gap
    #[arg(long, value_name = "FILE")]
    pub gap: Option<PathBuf>,
    /// A map of the contact for --gap (nonzero where the bodies touch) [default: where the gap is not above 0]
    #[arg(long, value_name = "FILE", requires = "gap", conflicts_with = "result")]
    pub contact: Option<PathBuf>,
    /// Physical size of the map along x and y, if the file does not state it: --size '1 mm,1 mm'
    #[arg(long, value_name = "A,B", requires = "gap", conflicts_with = "result")]
    pub size: Option<String>,
    /// Unit of the gap, if the file does not state it: --height-unit um
    #[arg(long, value_name = "U", requires = "gap", conflicts_with = "result")]
    pub height_unit: Option<String>,
    #[command(flatten)]
    pub fluid: FluidOptions,
    /// Times of stored fields, e.g. '1 s,10 s', or fields for all of them [default: those stored, or all]
    #[arg(long, value_name = "LIST", conflicts_with = "gap")]
    pub times: Option<String>,
    /// Unit for leaks or times, e.g. --unit leak=ml/year --unit time=h [default: that of the case]
    #[arg(long, value_name = "NAME=UNIT")]
    pub unit: Vec<String>,
    /// Do not store the leakage in the result
    #[arg(long, conflicts_with = "gap")]
    pub no_store: bool,
    /// The figure to write for --gap: flow, critical constriction and pockets (png, svg or pdf)
    #[arg(long, value_name = "PATH")]
    pub plot: Option<PathBuf>,
    /// Replace an existing file of --plot
    #[arg(long, requires = "plot")]
    pub force: bool,
    /// Threads to use [default: one per core]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// The keys of `[leakage]`. Of a result, each changes one key of what is stored, or of what its case asks for.
#[derive(Debug, clap::Args)]
pub struct FluidOptions {
    /// Direction of the flow; both: also the effective conductance of a periodic gap
    #[arg(long, value_parser = super::choice::<LeakDirection>())]
    pub direction: Option<LeakDirection>,
    /// Pressure drop of a liquid, e.g. '2 bar'
    #[arg(long, value_name = "P", value_parser = quantity::<Pressure<Positive>>(), allow_hyphen_values = true)]
    pub pressure_drop: Option<Pressure<Positive>>,
    /// Viscosity of a liquid, e.g. '1 mPa s', or of a gas that --gas does not name
    #[arg(long, value_name = "MU", value_parser = quantity::<Viscosity<Positive>>(), allow_hyphen_values = true)]
    pub viscosity: Option<Viscosity<Positive>>,
    /// A gas with known properties
    #[arg(long, value_parser = super::choice::<Species>())]
    pub gas: Option<Species>,
    /// Molar mass of a gas that --gas does not name, e.g. '44 g/mol'
    #[arg(long, value_name = "M", value_parser = quantity::<MolarMass<Positive>>(), allow_hyphen_values = true)]
    pub molar_mass: Option<MolarMass<Positive>>,
    /// Temperature of the gas, e.g. '20 degC'
    #[arg(long, value_name = "T", value_parser = quantity::<Temperature>(), allow_hyphen_values = true)]
    pub temperature: Option<Temperature>,
    /// Absolute pressure of the gas at the inlet, e.g. '3 bar'
    #[arg(long, value_name = "P", value_parser = quantity::<Pressure<Positive>>(), allow_hyphen_values = true)]
    pub inlet: Option<Pressure<Positive>>,
    /// Absolute pressure of the gas at the outlet, e.g. '1 bar'
    #[arg(long, value_name = "P", value_parser = quantity::<Pressure<NonNegative>>(), allow_hyphen_values = true)]
    pub outlet: Option<Pressure<NonNegative>>,
    /// Law for the rarefaction of the gas [default: boltzmann]
    #[arg(long, value_parser = super::choice::<Rarefaction>())]
    pub rarefaction: Option<Rarefaction>,
    /// What bounds the flow at the sides [default: periodic; closed on a free domain]
    #[arg(long, value_parser = super::choice::<Sides>())]
    pub sides: Option<Sides>,
    /// Cells with a smaller gap are closed, e.g. '0.3 nm'
    #[arg(long, value_name = "H", value_parser = quantity::<Length<NonNegative>>(), allow_hyphen_values = true)]
    pub smallest_gap: Option<Length<NonNegative>>,
    /// Store the pressure of the fluid as a field of the result
    #[arg(long, conflicts_with = "gap")]
    pub field: bool,
    /// Do not store it, where it is stored now
    #[arg(long, conflicts_with_all = ["gap", "field"])]
    pub no_field: bool,
}
