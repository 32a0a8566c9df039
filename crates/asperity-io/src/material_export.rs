//! Materials for other programs: relative moduli and times with the block of their temperature shift.
//!
//! All start from the relaxation modulus M(t) = M_inf + sum M_i exp(-t/tau_i) of the material at the reference temperature,
//! M(0) = M_inf + sum M_i, where M is Young's or the shear modulus as the material states it:
//!
//! | program | numbers |
//! |---|---|
//! | Abaqus | E(0), ν; g_i = G_i/G(0), k_i = K_i/K(0), tau_i; `*TRS` |
//! | Ansys | E(0), ν; a_i = G_i/G(0) of `TB,PRONY` in shear and bulk, tau_i; `TB,SHIFT` |
//! | COMSOL | branch, G_i \[Pa\], tau_i, as its viscoelasticity node loads them; G_inf and ν in remarks |
//! | csv | time, M_i, M_i/M(0); M_inf and M(0) in remarks |
//!
//! With a constant Poisson's ratio bulk and shear modulus relax alike (k_i = g_i); with a constant bulk modulus k_i = 0.
//! A shift factor is the factor by which processes take longer, log10 a_T = -c1 (T - T_r)/(c2 + T - T_r); temperatures are in
//! kelvin.

use std::fmt::Write;

use asperity::material::{GAS_CONSTANT, Lateral, Material, Modulus, Relaxation, Shift, VerticalShift};

/// A program that reads materials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Program {
    /// Keywords of an Abaqus input file.
    Abaqus,
    /// Commands of Ansys Mechanical APDL.
    Ansys,
    /// Branches of COMSOL's generalised Maxwell model.
    Comsol,
    /// Comma-separated values.
    Csv,
}

/// A material that other programs can take.
#[derive(Clone, Debug, PartialEq)]
pub struct Exported<'a> {
    /// Its name.
    pub name: &'a str,
    /// It, at the reference temperature of its shift.
    pub material: &'a Material,
    /// Poisson's ratio or bulk modulus; csv and the times of all need none.
    pub lateral: Option<Lateral>,
    /// Its shift.
    pub shift: Option<&'a Shift>,
    /// How its moduli depend on temperature; the programs take none, so that it is a remark.
    pub vertical: Option<&'a VerticalShift>,
}

/// The constants that a finite-element program takes.
struct Isotropic {
    /// Young's modulus at t = 0 \[Pa\].
    young: f64,
    /// Shear modulus over Young's modulus at t = 0.
    shear: f64,
    /// Poisson's ratio at t = 0.
    poisson: f64,
    /// Whether the bulk modulus relaxes like the shear modulus.
    bulk_relaxes: bool,
}

/// Text for a program.
///
/// # Errors
/// A sentence: a material without an instantaneous or (Abaqus, Ansys) without an equilibrium modulus, no Poisson's ratio, a
/// Young's modulus with a constant bulk modulus.
pub fn text(exported: &Exported<'_>, program: Program) -> Result<String, String> {
    let relaxation = exported.material.relaxation().map_err(|error| error.to_string())?;
    let instantaneous = relaxation.instantaneous();
    if relaxation.viscosity > 0.0 || !instantaneous.is_finite() {
        return Err(format!(
            "{} has no instantaneous modulus (it contains a dashpot in parallel), but the moduli of other programs are \
             relative to it",
            exported.name
        ));
    }
    let text = match program {
        Program::Csv => Ok(csv(exported, &relaxation)),
        Program::Comsol => Ok(comsol(exported, &relaxation, &isotropic(exported, instantaneous)?)),
        Program::Abaqus | Program::Ansys if relaxation.equilibrium <= 0.0 => Err(format!(
            "{} is a fluid: its relative moduli add up to 1, which Abaqus and Ansys refuse; fit it as a solid, or export csv",
            exported.name
        )),
        Program::Abaqus => Ok(abaqus(exported, &relaxation, &isotropic(exported, instantaneous)?)),
        Program::Ansys => Ok(ansys(exported, &relaxation, &isotropic(exported, instantaneous)?)),
    };
    let mark = match program {
        Program::Abaqus => "**",
        Program::Ansys => "!",
        Program::Comsol => "%",
        Program::Csv => "#",
    };
    Ok(exported.vertical.map_or(String::new(), |vertical| raised(vertical, mark)) + &text?)
}

/// A remark on a vertical shift.
fn raised(vertical: &VerticalShift, mark: &str) -> String {
    let law = match vertical {
        VerticalShift::Density { reference, expansion } => {
            format!("b_T = (Tr/T) (1 + a (T - Tr)), Tr = {reference:?} K, a = {expansion:?} 1/K\n")
        }
        VerticalShift::Table { points } => {
            let points: Vec<String> =
                points.iter().map(|(kelvin, ln)| format!("({kelvin:?}, {:?})", ln.exp())).collect();
            format!("(T [K], b_T) {}\n", points.join(" "))
        }
    };
    format!(
        "{mark} At the temperature T all moduli are those below over b_T, which is not in the numbers: {law}"
    )
}

fn isotropic(exported: &Exported<'_>, modulus: f64) -> Result<Isotropic, String> {
    match (exported.lateral, exported.material.measure()) {
        (None, _) => Err("Poisson's ratio is not known: the file is no case; give it".to_owned()),
        (Some(Lateral::Poisson(poisson)), measure) => {
            let shear = 0.5 / (1.0 + poisson);
            let young = if measure == Modulus::Young { modulus } else { modulus / shear };
            Ok(Isotropic { young, shear, poisson, bulk_relaxes: true })
        }
        (Some(Lateral::BulkModulus(bulk)), Modulus::Shear) => {
            let young = 9.0 * bulk * modulus / (3.0 * bulk + modulus);
            let poisson = (3.0 * bulk - 2.0 * modulus) / (2.0 * (3.0 * bulk + modulus));
            Ok(Isotropic { young, shear: modulus / young, poisson, bulk_relaxes: false })
        }
        (Some(Lateral::BulkModulus(_)), Modulus::Young) => Err(format!(
            "{} has Young's moduli and a constant bulk modulus, so that its shear modulus has other terms; give the material by \
             shear moduli, or a Poisson's ratio",
            exported.name
        )),
    }
}

/// Poisson's ratio that stands for 0.5.
const NEARLY_HALF: f64 = 0.4999;

impl Isotropic {
    /// The constants with a Poisson's ratio below 0.5, and a remark on it: Abaqus and Ansys refuse 0.5, where the bulk modulus is
    /// infinite. The shear modulus, which alone is finite there, is kept: E = 2 G (1 + ν).
    fn compressible(&self, mark: &str) -> (f64, f64, String) {
        if self.poisson < 0.5 {
            return (self.young, self.poisson, String::new());
        }
        let young = 2.0 * (1.0 + NEARLY_HALF) * self.shear * self.young;
        let remark = format!(
            "{mark} Poisson's ratio is 0.5, which the program refuses: {NEARLY_HALF} is written, with the same shear modulus. Use elements \
             for nearly incompressible materials.\n"
        );
        (young, NEARLY_HALF, remark)
    }
}

/// (M_i/M(0), tau_i).
fn fractions(relaxation: &Relaxation) -> Vec<(f64, f64)> {
    let whole = relaxation.instantaneous();
    relaxation.terms.iter().map(|term| (term.modulus / whole, term.relaxation_time)).collect()
}

fn measure(exported: &Exported<'_>) -> &'static str {
    match exported.material.measure() {
        Modulus::Young => "Young's modulus",
        Modulus::Shear => "shear modulus",
    }
}

/// Name of a material without marks that end a name elsewhere.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

/// A number with as many digits as fit into 20 characters, the width of a field in a data line of Abaqus.
fn abaqus_number(x: f64) -> String {
    let exact = [format!("{x:?}"), format!("{x:e}")].into_iter();
    let rounded = (0..16).rev().map(|digits| format!("{x:.digits$e}"));
    exact.chain(rounded).find(|text| text.len() <= 20).unwrap_or_default()
}

fn abaqus(exported: &Exported<'_>, relaxation: &Relaxation, isotropic: &Isotropic) -> String {
    let (young, poisson, remark) = isotropic.compressible("**");
    let mut text = format!(
        "** {}: SI units (Pa, s, K).\n{remark}** The elastic constants are the instantaneous ones; g_i = G_i/G(0), k_i = K_i/K(0).\n\
         *MATERIAL, NAME={}\n*ELASTIC, MODULI=INSTANTANEOUS\n{}, {}\n*VISCOELASTIC, TIME=PRONY\n",
        plain(exported.name),
        plain(exported.name),
        abaqus_number(young),
        abaqus_number(poisson)
    );
    for (fraction, time) in fractions(relaxation) {
        let bulk = if isotropic.bulk_relaxes { fraction } else { 0.0 };
        let _ = writeln!(text, "{}", [fraction, bulk, time].map(abaqus_number).join(", "));
    }
    text.push_str(&match exported.shift {
        None => String::new(),
        Some(Shift::Wlf { c1, c2, reference }) => format!(
            "** log10 a_T = -C1 (T - T0)/(C2 + T - T0): T0, C1, C2. Temperatures are in K.\n*TRS, \
             DEFINITION=WLF\n{}\n",
            [*reference, *c1, *c2].map(abaqus_number).join(", ")
        ),
        Some(Shift::Arrhenius { activation_energy, reference }) => format!(
            "** ln a_T = (E0/R)(1/T - 1/T0): T0, E0. Temperatures are in K, R in J/(mol K); the model needs\n** *PHYSICAL \
             CONSTANTS, ABSOLUTE ZERO=0., UNIVERSAL GAS CONSTANT={GAS_CONSTANT:?}\n*TRS, \
             DEFINITION=ARRHENIUS\n{}\n",
            [*reference, *activation_energy].map(abaqus_number).join(", ")
        ),
        Some(Shift::Table { points }) => format!(
            "** Shift factors are a table, which *TRS takes through a user subroutine only (T [K], log10 a_T):\n{}",
            factors(points, "** ")
        ),
    });
    text
}

fn ansys(exported: &Exported<'_>, relaxation: &Relaxation, isotropic: &Isotropic) -> String {
    let fractions = fractions(relaxation);
    let (young, poisson, remark) = isotropic.compressible("!");
    let mut text = format!(
        "! {}: SI units (Pa, s, K), material 1.\n{remark}! The elastic constants are the instantaneous ones; pairs a_i = G_i/G(0) (bulk: \
         K_i/K(0)), tau_i.\nMP,EX,1,{young:e}\nMP,NUXY,1,{poisson:?}\n",
        plain(exported.name)
    );
    let tables: &[&str] = if isotropic.bulk_relaxes { &["SHEAR", "BULK"] } else { &["SHEAR"] };
    for table in tables {
        let _ = writeln!(text, "TB,PRONY,1,1,{},{table}", fractions.len());
        // A command takes six numbers.
        for (n, three) in fractions.chunks(3).enumerate() {
            let numbers: Vec<String> = three.iter().map(|(a, tau)| format!("{a:e},{tau:e}")).collect();
            let _ = writeln!(text, "TBDATA,{},{}", 6 * n + 1, numbers.join(","));
        }
    }
    text.push_str(&match exported.shift {
        None => String::new(),
        Some(Shift::Wlf { c1, c2, reference }) => format!(
            "! log10 A = C1 (T - Tr)/(C2 + T - Tr), A = 1/a_T: Tr [K], C1, C2.\nTB,SHIFT,1,1,3,WLF\nTBDATA,1,{reference:?},{c1:?},{c2:?}\n"
        ),
        Some(Shift::Arrhenius { activation_energy, reference }) => format!(
            "! ln A = (H/R)(1/Tr - 1/T), A = 1/a_T: Tr [K], H/R [K].\nTB,SHIFT,1,1,2,TN\nTBDATA,1,{reference:?},{:?}\n",
            activation_energy / GAS_CONSTANT
        ),
        Some(Shift::Table { points }) => format!(
            "! Shift factors are a table, which TB,SHIFT takes through a user subroutine only (T [K], log10 a_T):\n{}",
            factors(points, "! ")
        ),
    });
    text
}

fn comsol(exported: &Exported<'_>, relaxation: &Relaxation, isotropic: &Isotropic) -> String {
    // Of Young's moduli at constant Poisson's ratio, or of shear moduli as they are.
    let to_shear = match exported.material.measure() {
        Modulus::Young => isotropic.shear,
        Modulus::Shear => 1.0,
    };
    let mut text = format!(
        "% {}: branches of a generalised Maxwell model, to be loaded from file: branch, shear modulus G_i [Pa], relaxation \
         time tau_i [s].\n% The parent material has the long-term stiffness: shear modulus {:e} Pa; {}.\n",
        plain(exported.name),
        to_shear * relaxation.equilibrium,
        match exported.lateral {
            Some(Lateral::BulkModulus(bulk)) => format!(
                "bulk modulus {bulk:e} Pa at all times (choose shear and bulk modulus as the elastic constants)"
            ),
            _ => format!("Poisson's ratio {:?}", isotropic.poisson),
        }
    );
    if isotropic.bulk_relaxes {
        text.push_str("% At a constant Poisson's ratio the bulk modulus relaxes too: apply the branches to the whole stress.\n");
    }
    text.push_str(&match exported.shift {
        None => String::new(),
        Some(Shift::Wlf { c1, c2, reference }) => format!(
            "% Williams-Landel-Ferry, log10 a_T = -C1 (T - Tref)/(C2 + T - Tref): Tref = {reference:?} K, C1 = {c1:?}, C2 = {c2:?} K\n"
        ),
        Some(Shift::Arrhenius { activation_energy, reference }) => format!(
            "% Arrhenius, ln a_T = (Q/R)(1/T - 1/Tref): Tref = {reference:?} K, Q = {activation_energy:?} J/mol\n"
        ),
        Some(Shift::Table { points }) => {
            format!("% User defined shift, an interpolation of (T [K], log10 a_T):\n{}", factors(points, "% "))
        }
    });
    for (n, term) in relaxation.terms.iter().enumerate() {
        let _ = writeln!(text, "{} {:e} {:e}", n + 1, to_shear * term.modulus, term.relaxation_time);
    }
    text
}

fn csv(exported: &Exported<'_>, relaxation: &Relaxation) -> String {
    let mut text = format!(
        "# {}: M(t) = equilibrium + sum modulus_i exp(-t/time_i), M is the {}; fraction_i = modulus_i/M(0).\n\
         # equilibrium {:e} Pa, M(0) {:e} Pa\n",
        plain(exported.name),
        measure(exported),
        relaxation.equilibrium,
        relaxation.instantaneous()
    );
    text.push_str(&match exported.shift {
        None => String::new(),
        Some(Shift::Wlf { c1, c2, reference }) => format!(
            "# WLF, log10 a_T = -c1 (T - Tr)/(c2 + T - Tr): c1 {c1:?}, c2 {c2:?} K, Tr {reference:?} K\n"
        ),
        Some(Shift::Arrhenius { activation_energy, reference }) => {
            format!(
                "# Arrhenius, ln a_T = (E/R)(1/T - 1/Tr): E {activation_energy:?} J/mol, Tr {reference:?} K\n"
            )
        }
        Some(Shift::Table { points }) => {
            format!("# Shift factors (T [K], log10 a_T):\n{}", factors(points, "# "))
        }
    });
    text.push_str("time [s],modulus [Pa],fraction\n");
    for (term, (fraction, _)) in relaxation.terms.iter().zip(fractions(relaxation)) {
        let _ = writeln!(text, "{:e},{:e},{fraction:e}", term.relaxation_time, term.modulus);
    }
    text
}

fn factors(points: &[(f64, f64)], mark: &str) -> String {
    let line = |(kelvin, ln): &(f64, f64)| format!("{mark}{kelvin:?}, {:?}\n", ln / std::f64::consts::LN_10);
    points.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WLF: Shift = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 };

    fn rubber(measure: Modulus) -> Material {
        let relaxation =
            Relaxation::absolute(1.5e6, &[(5e8, 1.25e-4), (8e7, 1e-2), (3e6, 2.0), (1e6, 7.0)]).unwrap();
        Material::prony(measure, relaxation).unwrap()
    }

    fn exported(material: &Material, lateral: Lateral) -> Exported<'_> {
        Exported { name: "rubber 1", material, lateral: Some(lateral), shift: Some(&WLF), vertical: None }
    }

    /// The numbers of the lines that begin neither with a remark nor a keyword.
    fn numbers(text: &str, remarks: char) -> Vec<Vec<f64>> {
        let rows = text.lines().filter(|line| !line.starts_with(remarks));
        rows.filter_map(|line| {
            line.split([',', ' ']).filter(|c| !c.is_empty()).map(|c| c.parse().ok()).collect()
        })
        .collect()
    }

    #[test]
    fn an_incompressible_material_is_written_with_what_other_programs_take() {
        let material = rubber(Modulus::Shear);
        let of =
            |poisson: f64, program| text(&exported(&material, Lateral::Poisson(poisson)), program).unwrap();
        let constants = |text: &str, name: &str| -> f64 {
            let line = text.lines().find_map(|line| line.strip_prefix(name)).unwrap();
            line.parse().unwrap()
        };
        let shear = material.relaxation().unwrap().instantaneous();
        let ansys = of(0.5, Program::Ansys);
        let (young, poisson) = (constants(&ansys, "MP,EX,1,"), constants(&ansys, "MP,NUXY,1,"));
        assert!(poisson < 0.5 && (young / (2.0 * (1.0 + poisson)) / shear - 1.0).abs() < 1e-12, "{ansys}");
        assert!(ansys.contains("0.4999 is written"), "{ansys}");
        let abaqus = of(0.5, Program::Abaqus);
        let line = abaqus.lines().skip_while(|line| !line.starts_with("*ELASTIC")).nth(1).unwrap();
        let numbers: Vec<f64> = line.split(", ").map(|number| number.parse().unwrap()).collect();
        assert!(numbers == [young, poisson] && abaqus.contains("0.4999 is written"), "{abaqus}");
        for program in [Program::Abaqus, Program::Ansys] {
            assert!(of(0.49, program).contains("0.49") && !of(0.49, program).contains("is written"));
        }
    }

    fn same(read: &Relaxation, material: &Material) {
        let truth = material.relaxation().unwrap();
        assert_eq!(read.terms.len(), truth.terms.len());
        for t in [0.0, 1e-4, 1e-2, 1.0, 10.0, 1e3] {
            // Shortest decimal numbers give the same doubles; fractions of the sum are rounded.
            assert!((read.value(t) / truth.value(t) - 1.0).abs() < 1e-13, "{t}");
        }
    }

    #[test]
    fn abaqus_gives_the_material_back() {
        let material = rubber(Modulus::Young);
        let written = text(&exported(&material, Lateral::Poisson(0.49)), Program::Abaqus).unwrap();
        assert!(written.contains("*TRS, DEFINITION=WLF\n293.15, 8.86, 101.6\n"), "{written}");
        let fields = written.lines().filter(|line| !line.starts_with('*')).flat_map(|line| line.split(", "));
        assert!(fields.map(str::len).max().is_some_and(|width| width <= 20), "{written}");
        assert_eq!(abaqus_number(-1.0 / 30_000.0), "-3.33333333333333e-5");
        let rows = numbers(&written, '*');
        let terms: Vec<(f64, f64)> = rows[1..5].iter().map(|row| (row[0], row[2])).collect();
        assert!(rows[1..5].iter().all(|row| row[0] == row[1]) && rows[0][1] == 0.49, "{written}");
        same(&Relaxation::from_instantaneous(rows[0][0], &terms).unwrap(), &material);
    }

    #[test]
    fn a_vertical_shift_is_a_remark() {
        let material = rubber(Modulus::Young);
        let vertical = VerticalShift::Density { reference: 293.15, expansion: 6e-4 };
        let with = Exported { vertical: Some(&vertical), ..exported(&material, Lateral::Poisson(0.49)) };
        for (program, mark) in
            [(Program::Abaqus, "** "), (Program::Ansys, "! "), (Program::Comsol, "% "), (Program::Csv, "# ")]
        {
            let written = text(&with, program).unwrap();
            let first = written.lines().next().unwrap();
            assert!(first.starts_with(mark) && first.contains("293.15 K, a = 0.0006 1/K"), "{first}");
        }
    }

    #[test]
    fn ansys_gives_the_material_back() {
        let material = rubber(Modulus::Shear);
        let bulk = 2e9;
        let written = text(&exported(&material, Lateral::BulkModulus(bulk)), Program::Ansys).unwrap();
        assert!(written.contains("TB,SHIFT,1,1,3,WLF\nTBDATA,1,293.15,8.86,101.6\n"), "{written}");
        assert!(!written.contains("BULK\n"), "{written}");
        let value = |key: &str| -> f64 {
            written.lines().find_map(|line| line.strip_prefix(key)).unwrap().parse().unwrap()
        };
        let (young, poisson) = (value("MP,EX,1,"), value("MP,NUXY,1,"));
        let pairs: Vec<f64> = written
            .lines()
            .skip_while(|line| !line.starts_with("TB,PRONY"))
            .take_while(|line| !line.starts_with("TB,SHIFT"))
            .filter_map(|line| line.strip_prefix("TBDATA,")?.split_once(','))
            .flat_map(|(_, rest)| rest.split(',').map(|n| n.parse::<f64>().unwrap()).collect::<Vec<f64>>())
            .collect();
        let terms: Vec<(f64, f64)> = pairs.chunks(2).map(|pair| (pair[0], pair[1])).collect();
        same(&Relaxation::from_instantaneous(young / (2.0 * (1.0 + poisson)), &terms).unwrap(), &material);
        // K = E/(3 (1 - 2 nu)), whose rounding grows near the incompressible.
        assert!((young / (3.0 * (1.0 - 2.0 * poisson)) / bulk - 1.0).abs() < 1e-12);
    }

    #[test]
    fn comsol_and_csv_give_the_material_back() {
        let material = rubber(Modulus::Young);
        let one = exported(&material, Lateral::Poisson(0.25));
        let written = text(&one, Program::Comsol).unwrap();
        let equilibrium: f64 =
            written.split("shear modulus ").nth(2).unwrap().split(' ').next().unwrap().parse().unwrap();
        let terms: Vec<(f64, f64)> =
            numbers(&written, '%').iter().map(|row| (2.5 * row[1], row[2])).collect();
        same(&Relaxation::absolute(2.5 * equilibrium, &terms).unwrap(), &material);
        let shear = rubber(Modulus::Shear);
        let constant = text(&exported(&shear, Lateral::BulkModulus(2e9)), Program::Comsol).unwrap();
        assert!(
            constant.contains("bulk modulus 2e9 Pa at all times") && !constant.contains("Poisson"),
            "{constant}"
        );
        let written = text(&Exported { lateral: None, ..one }, Program::Csv).unwrap();
        let terms: Vec<(f64, f64)> = numbers(&written, '#').iter().map(|row| (row[1], row[0])).collect();
        let equilibrium: f64 =
            written.split("# equilibrium ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        same(&Relaxation::absolute(equilibrium, &terms).unwrap(), &material);
    }

    #[test]
    fn what_a_program_cannot_take_is_said() {
        let says = |material: &Material, lateral: Option<Lateral>, program: Program, words: &str| {
            let refused =
                text(&Exported { name: "x", material, lateral, shift: None, vertical: None }, program)
                    .unwrap_err();
            assert!(refused.contains(words), "{refused}");
        };
        let young = rubber(Modulus::Young);
        says(&young, None, Program::Abaqus, "Poisson");
        says(&young, Some(Lateral::BulkModulus(2e9)), Program::Ansys, "shear moduli");
        let fluid = Material::maxwell(Modulus::Young, 1e6, 1.0).unwrap();
        says(&fluid, Some(Lateral::Poisson(0.5)), Program::Abaqus, "fluid");
        let kelvin = Material::kelvin_voigt(Modulus::Young, 1e6, 1.0).unwrap();
        says(&kelvin, Some(Lateral::Poisson(0.5)), Program::Csv, "dashpot");
    }
}
