//! A commented case with one's own files: what the files say is filled in; what only the user knows has an example value and
//! the remark [`YOURS`].

use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

use asperity::finding::repeats;
use asperity::indentation::{Given, IndentationRecord, controlled};
use asperity::material::{Modulus, Shift};
use asperity::surface::Operation;
use asperity::surface::process::Outliers;
use asperity_io::case::Case;
use asperity_io::curve::{
    Columns, CurveError, Curves, Indentation, Kind, Request, ShiftRequest, Words, thinned,
};
use asperity_io::output::write_all;
use asperity_io::topography::Topography;

use super::adhesion;
use crate::args::{New, Purpose, SurfaceFile};
use crate::commands::material::{ROOM, estimated_unless_known, refused};
use crate::commands::surface;
use crate::failure::{Failure, refuse};
use crate::format::{counted, extent, quantity};

/// The remark behind a value that only the user knows.
pub(super) const YOURS: &str = "# YOUR VALUE: ";
/// Points along a side of a surface at most; a finer one is resampled.
const MOST_CELLS: usize = 512;
/// Deviations of a spike from the lines through its neighbours.
const SPIKES: f64 = 8.0;

/// Writes the case.
pub(super) fn write(args: &New, purpose: Purpose, from: &Path, material: &Path) -> Result<(), Failure> {
    if args.path.is_some() {
        refuse!("with --for give one PATH, that of the case; a template has no own files");
    }
    let name = format!("{purpose:?}").to_lowercase();
    let path = args.template.as_ref().map_or_else(|| PathBuf::from(format!("{name}.toml")), PathBuf::from);
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let material = Material::of(material, &folder)?;
    let record = match purpose {
        Purpose::Indentation | Purpose::Adhesion => Indentation::read(from, &Columns::default()).ok(),
        _ => None,
    };
    let text = match record {
        Some(record) => indentation_of(&record, purpose, from, &folder, &material)?,
        None => of_surface(args, purpose, from, &folder, &material)?,
    };
    write_all(&path, args.force, text.as_bytes())?;
    let missing = marked(&text);
    let shown = path.display();
    let examples = match missing.as_slice() {
        [] => String::new(),
        keys => format!("; example values that only you know, marked \"YOUR VALUE\": {}", keys.join(", ")),
    };
    crate::messages::message!("wrote {shown}{examples}. Then: asperity check {shown}");
    Ok(())
}

/// The keys of the marked lines, with their tables: "load.history".
fn marked(text: &str) -> Vec<String> {
    let mut table = "";
    let mut keys = vec![];
    for line in text.lines() {
        if line.starts_with('[') {
            table = line.split(']').next().unwrap_or_default().trim_matches(['[', ']']);
        }
        if let Some((key, _)) = line.split_once('=').filter(|_| line.contains(YOURS)) {
            let key = format!("{table}.{}", key.trim());
            if !keys.contains(&key) {
                keys.push(key);
            }
        }
    }
    keys
}

/// A fault of measured data: what to say of them is said where they are fitted.
fn unread(error: CurveError) -> Failure {
    let first = match error.remedies(Words::Command).is_empty() {
        true => "",
        false => {
            " (options of `asperity material fit`: fit the data with them and -o material.toml, and give --material material.toml here)"
        }
    };
    Failure::input(error.told(Words::Command) + first)
}

/// What a case needs to know of the material.
pub(super) struct Material {
    /// Lines of the body.
    text: String,
    /// Least and greatest time of the data \[s\].
    times: Option<[f64; 2]>,
    /// The reference temperature in words, where the times depend on the temperature.
    reference: Option<String>,
    /// The lines of `[[surface]]` that make the indenter of the test, as `fit-indentation` wrote it.
    indenter: Option<String>,
}

impl Material {
    fn of(path: &Path, folder: &Path) -> Result<Material, Failure> {
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
            return Material::written(path);
        }
        let kind = Curves::kind_of(path, None).map_err(unread)?;
        let mut curves = Curves::read(path, kind, &Columns::default()).map_err(unread)?;
        let ends = extent(curves.sweeps.iter().flat_map(|sweep| sweep.x.iter().copied()));
        let (model, measure_key, range, mut times) = match kind {
            Kind::Dma => {
                let hertz = ends.map(|omega| quantity(omega / TAU, "Hz"));
                ("dma", "modulus", hertz, [1.0 / ends[1], 1.0 / ends[0]])
            }
            Kind::Relaxation => ("relaxation-table", "modulus", ends.map(|t| quantity(t, "s")), ends),
            Kind::Creep => ("creep-table", "compliance", ends.map(|t| quantity(t, "s")), ends),
        };
        let celsius: Vec<f64> =
            curves.sweeps.iter().filter_map(|sweep| Some(sweep.temperature? - 273.15)).collect();
        let [coldest, warmest] = extent(celsius.iter().copied());
        let at = match celsius.len() {
            0 => String::new(),
            1 => format!(" at {coldest:.1} °C"),
            n => format!(" at {n} temperatures, {coldest:.1} °C to {warmest:.1} °C"),
        };
        let mut text = format!("# {} points from {} to {}{at}.\n", curves.points(), range[0], range[1]);
        let (measure, unknown) = match curves.measure {
            Some(Modulus::Shear) => ("shear", String::new()),
            Some(Modulus::Young) => ("young", String::new()),
            None => ("young", format!("   {YOURS}\"young\" (tension, bending) or \"shear\"")),
        };
        text +=
            &format!("poisson = 0.5           {YOURS}0.5 rubber and gel, 0.3 to 0.4 plastics and metals\n");
        text += &format!("[body.material]\nmodel = \"{model}\"\n");
        text += &format!("path = {}\n", toml(&relative(path, folder)));
        text += &format!("{measure_key} = \"{measure}\"{unknown}\n");
        let mut reference = None;
        if celsius.len() > 1 {
            let held = curves.held.shift().is_some();
            let shift = estimated_unless_known(ShiftRequest::None, &mut curves);
            // A ramp does not tell its shift: the law that the user will write is about the temperature of a room.
            let mut kelvin = ROOM;
            if !curves.is_over_temperature() {
                let measure = curves.measure.unwrap_or(Modulus::Young);
                let fitted =
                    Request { measure, shift, ..Request::default() }.fit(&curves).map_err(refused)?;
                kelvin = fitted.shift.as_ref().and_then(Shift::reference).unwrap_or(ROOM);
                times = fitted.window;
            }
            let about = format!("{:.2} °C", kelvin - 273.15);
            let law = format!("{{ model = \"wlf\", c1 = 8.86, c2 = \"101.6 K\", reference = \"{about}\" }}");
            if curves.is_over_temperature() {
                text += &format!("shift = {law}   {YOURS}the law of your material\n");
            } else if !held {
                text += &format!(
                    "shift = {{ model = \"estimated\", reference = \"{about}\" }}   # or your WLF: {law}\n"
                );
            }
            reference = Some(about);
        }
        Ok(Material { text, times: (times[0] > 0.0).then_some(times), reference, indenter: None })
    }

    /// What `material fit -o` or `fit-indentation -o` wrote.
    fn written(path: &Path) -> Result<Material, Failure> {
        let shown = path.display();
        let mut text =
            std::fs::read_to_string(path).map_err(Failure::about(format!("cannot read {shown}")))?;
        let has = |text: &str, key: &str| text.lines().any(|line| line.trim_start().starts_with(key));
        if has(&text, "[") || !has(&text, "material") {
            refuse!(
                "{shown} must hold the material of a body as `material fit -o` writes it, `material = {{ ... }}`, and no tables in brackets; \
                 give that file, or the measured data"
            );
        }
        if !has(&text, "poisson") && !has(&text, "bulk_modulus") {
            let line = format!(
                "poisson = 0.5           {YOURS}0.5 rubber and gel, 0.3 to 0.4 plastics and metals\n"
            );
            text.insert_str(0, &line);
        }
        let reference = text.contains("shift =").then(|| {
            // A table of factors names no reference.
            quoted(&text, "reference = ").unwrap_or("20 °C").to_owned()
        });
        let indenter = text.lines().find_map(|line| line.strip_prefix(INDENTER)).map(|line| {
            line.trim_end_matches('.').split(", ").map(|key| format!("{key}\n")).collect::<String>()
        });
        if let Some(differs) = text.lines().find_map(|line| line.strip_prefix(BALL)) {
            crate::messages::message!("note: the sphere of a case{differs}");
        }
        let seconds = |text: &str| text.trim_matches(['"', ' ']).trim_end_matches(" s").parse::<f64>().ok();
        let times = text.split_once("window = [").and_then(|(_, rest)| {
            let (first, last) = rest.split(']').next()?.split_once(',')?;
            Some([seconds(first)?, seconds(last)?])
        });
        if has(&text, "thickness") {
            // The layer of the test, on its rigid base.
            let interface = quoted(&text, "interface = ").unwrap_or("bonded").to_owned();
            let lines = text
                .lines()
                .filter(|line| !line.starts_with("# The sample") && !line.starts_with("# of the test"));
            let lines: String = lines.map(|line| format!("{line}\n")).collect();
            text = format!("base = \"rigid\"\n[[body.layer]]\ninterface = \"{interface}\"\n{lines}");
        }
        Ok(Material { text: text.trim_end().to_owned() + "\n", times, reference, indenter })
    }

    fn body(&self) -> String {
        let mut text = format!("\n[[body]]\n{}", self.text);
        if let Some(reference) = &self.reference {
            text += &format!(
                "\n[temperature]\nhistory = {{ kind = \"constant\", value = \"{reference}\" }}   {YOURS}of the contact; this is the reference of the shift\n"
            );
        }
        text
    }

    /// The first of so many logarithmic steps up to `end` \[s\]: this share of the end, or longer, so that no step is shorter than the data
    /// of the material tell.
    pub(super) fn first(&self, end: f64, steps: usize, share: f64) -> f64 {
        let known = self.times.map_or(0.0, |[first, _]| first);
        let shortest = |first: f64| first * ((end / first).powf(1.0 / (steps - 1) as f64) - 1.0).min(1.0);
        let mut first = one_digit(share * end);
        while shortest(first) < known && first < 0.1 * end {
            first = one_digit(2.0 * first);
        }
        first
    }

    /// The last time of a run: that of the data to one digit, so that the material is known throughout.
    pub(super) fn end(&self) -> f64 {
        self.times.map_or(100.0, |[_, last]| one_digit(last))
    }
}

/// How the line begins in which `fit-indentation` keeps the indenter of the test.
const INDENTER: &str = "# Indenter of the test, as [[surface]]: ";

/// How the line begins in which it says how the ball of the test differs from the sphere of a case.
const BALL: &str = "# The sphere of a case";

/// The text in quotes behind the first `key`.
fn quoted<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    text.split_once(key)?.1.strip_prefix('"')?.split('"').next()
}

/// The largest number of one digit that is not above a value: 2e3 of 2.9e3.
pub(super) fn one_digit(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    // Rounded in decimal, so that it reads "0.3" and not "0.30000000000000004".
    format!("{:.0e}", (value / power + 1e-9).floor() * power).parse().unwrap_or(value)
}

/// A case over a measured surface.
fn of_surface(
    args: &New,
    purpose: Purpose,
    from: &Path,
    folder: &Path,
    material: &Material,
) -> Result<String, Failure> {
    let file = SurfaceFile {
        file: from.to_owned(),
        size: args.size.clone(),
        height_unit: args.height_unit.clone(),
        channel: None,
    };
    if surface::is_profile(&file)? {
        refuse!(
            "{} is a profile, and the case needs a surface; make one: asperity surface from-profile {} -o surface.npz, then --from surface.npz",
            from.display(),
            from.display()
        );
    }
    let topography = surface::open(&file)?;
    let title = match purpose {
        Purpose::Seal => "Leak of a seal",
        Purpose::Friction => "Friction over the velocity",
        Purpose::Indentation => "Ball with a rough surface",
        Purpose::Adhesion => "Adhesion of a rough surface",
        _ => "Contact of a rough surface",
    };
    let mut text = head(title, from);
    let border = match purpose {
        Purpose::Indentation => Border::Free,
        _ if repeats_as_stored(&topography)? => Border::Repeats,
        // It keeps the lay, which slides differently along +x and -x, and friction hardly depends on it.
        Purpose::Friction => Border::Window,
        _ => Border::Mirror,
    };
    text += &domain(&topography, border);
    text += &surface_part(args, &topography, &relative(from, folder), border);
    let ball = indenter(material, one_digit(topography.size[0]));
    if purpose == Purpose::Indentation {
        text += &ball;
    }
    text += &material.body();
    let rest = match purpose {
        Purpose::Friction => friction(&topography, material),
        Purpose::Adhesion => {
            let [low, high] = extent(topography.heights.iter().copied());
            adhesion::retraction(high - low, material)
        }
        Purpose::Indentation => {
            let side = topography.size[0].min(topography.size[1]);
            let load = load(&text, material, folder, &ball, side).unwrap_or(1e-3);
            in_time(purpose, material, load)
        }
        _ => in_time(purpose, material, 0.0),
    };
    Ok(with_adhesion(text, rest, purpose, folder))
}

/// How a case begins; its title ends with the name of a file.
fn head(title: &str, from: &Path) -> String {
    format!(
        "#:schema case.schema.json\n# (asperity schema > case.schema.json lets an editor check this file while you type)\n#\n# Lines with \"YOUR VALUE\" hold examples: put your own there. `asperity check` says what will be solved.\n\
         title = {}\n\n",
        toml(&format!("{title}: {}", surface::name(from)))
    )
}

/// The two parts of a case, with `[adhesion]` between them where it is for that.
fn with_adhesion(before: String, after: String, purpose: Purpose, folder: &Path) -> String {
    let section = match purpose {
        Purpose::Adhesion => adhesion::section(&before, &after, folder),
        _ => String::new(),
    };
    [before, section, after].concat()
}

/// The border of the domain, and what the surface does there.
#[derive(Clone, Copy, PartialEq)]
enum Border {
    /// Free.
    Free,
    /// Periodic, of a surface that goes on at the opposite border.
    Repeats,
    /// Periodic, of a surface that does not, which is continued by its reflections.
    Mirror,
    /// Periodic, of a surface whose heights fall to zero there.
    Window,
}

/// Whether a map continues at the opposite border. Spikes would hide how large a jump is.
fn repeats_as_stored(topography: &Topography) -> Result<bool, Failure> {
    let map = surface::map("the surface", topography)?;
    let spikes = Outliers { threshold: SPIKES, ..Outliers::default() };
    let clean = Operation::RemoveOutliers(spikes).apply(&map).map_err(Failure::about("the surface"))?;
    Ok(repeats(&clean))
}

impl Border {
    /// The keys of the domain, with a remark.
    fn key(self) -> &'static str {
        match self {
            Border::Free => "boundary = \"free\"\n",
            Border::Repeats => {
                "boundary = \"periodic\"                 # opposite borders of the file match\n"
            }
            Border::Mirror => {
                "boundary = \"periodic\"                 # a part of a larger surface, continued by its reflections\n"
            }
            Border::Window => {
                "boundary = \"periodic\"                 # a part of a larger surface; its border is windowed\n"
            }
        }
    }

    /// Sides of the domain over those of the surface.
    fn times(self) -> usize {
        if self == Border::Mirror { 2 } else { 1 }
    }
}

fn domain(topography: &Topography, border: Border) -> String {
    let shape: [usize; 2] = topography.heights.dim().into();
    let longest = shape[0].max(shape[1]);
    let (times, with) = (border.times(), if border == Border::Mirror { " with its reflections" } else { "" });
    let cells = if longest > MOST_CELLS {
        let fewer = shape.map(|n| times * (n * MOST_CELLS).div_ceil(longest).max(8));
        format!(
            "cells = [{}, {}]                    # of the {} x {} points of the file{with}; all of them cost more\n",
            fewer[0],
            fewer[1],
            times * shape[0],
            times * shape[1]
        )
    } else {
        String::new()
    };
    let size = topography.size.map(|side| quantity(times as f64 * side, "m"));
    format!(
        "[domain]                              # its size is that of the surface{with}, {} x {}\n{cells}{}",
        size[0],
        size[1],
        border.key()
    )
}

fn surface_part(args: &New, topography: &Topography, path: &str, border: Border) -> String {
    let [low, high] = extent(topography.heights.iter().copied());
    let (nx, ny) = topography.heights.dim();
    let holes = topography.heights.iter().filter(|height| !height.is_finite()).count();
    let mut text = format!(
        "\n[[surface]]                           # {nx} x {ny} points, heights from {} to {} as stored\nkind = \"file\"\npath = {}\n",
        quantity(low, "m"),
        quantity(high, "m"),
        toml(path)
    );
    if args.size.is_some() {
        let [x, y] = topography.size.map(|side| plain(side, "m"));
        text += &format!("size = [\"{x}\", \"{y}\"]\n");
    }
    if let Some(unit) = &args.height_unit {
        text += &format!("height_unit = {}\n", toml(unit));
    }
    text += match border {
        Border::Repeats => {
            "level = \"none\"                        # a plane would part the borders, which match\n"
        }
        _ => "level = \"plane\"                       # the sample may be tilted under the instrument\n",
    };
    text += &format!(
        "outliers = {{ threshold = {SPIKES}, radius = 2 }}   # spikes of the instrument; summits of the surface stay\n"
    );
    if holes > 0 {
        text += &format!("fill = \"harmonic\"                     # {} undefined\n", counted(holes, "point"));
    }
    // Over four points at each border at least.
    let share = (8.0 / nx.min(ny) as f64).clamp(0.1, 1.0);
    let window = format!(
        "window = {{ shape = \"tukey\", share = {share:.2} }}   # opposite borders match; not for a leak\n"
    );
    text += match border {
        Border::Mirror => {
            "border = \"mirror\"                     # the surface and its reflections: opposite borders match\n"
        }
        Border::Window => window.as_str(),
        Border::Free | Border::Repeats => "",
    };
    if nx.max(ny) > MOST_CELLS {
        text += "resample = \"band-limited\"             # to the cells of the domain\n";
    }
    text
}

/// The load \[N\] under which the contact is at most half as wide as the surface, and small beside the indenter: of a ball
/// F = 4 a³/(3 R C), of a cone π a² slope/(2 C), with the compliance C at the end.
fn load(before: &str, material: &Material, folder: &Path, indenter: &str, side: f64) -> Option<f64> {
    let text = [before, &in_time(Purpose::Indentation, material, 1e-3)].concat();
    let compliance = Case::parse(&text, folder, &[]).ok()?.simulation().ok()?.relaxed();
    let load = match (ball_radius(indenter), cone_slope(indenter)) {
        (Some(radius), _) => 4.0 * (0.25 * side).min(0.2 * radius).powi(3) / (3.0 * radius * compliance),
        (None, Some(slope)) => 0.5 * PI * (0.25 * side).powi(2) * slope / compliance,
        (None, None) => return None,
    };
    Some(one_digit(load)).filter(|load| load.is_finite() && *load > 0.0)
}

/// Load, times and output of a run in time.
fn in_time(purpose: Purpose, material: &Material, load: f64) -> String {
    /// Steps of the run.
    const STEPS: usize = 40;
    let end = material.end();
    let mut text = match purpose {
        Purpose::Indentation => format!(
            "\n[load]\ncontrol = \"load\"\nhistory = {{ kind = \"ramp\", value = \"{}\", duration = \"{} s\" }}   {YOURS}load, and time to reach it\n",
            quantity(load, "N"),
            one_digit(end / 10.0)
        ),
        _ => format!(
            "\n[load]\ncontrol = \"pressure\"                  # mean over the surface\nhistory = {{ kind = \"step\", value = \"0.1 MPa\" }}   {YOURS}pressure\n"
        ),
    };
    text += &format!(
        "\n[time]\nend = \"{end} s\"   {YOURS}length of the run; the data of the material reach {}\nsteps = {STEPS}\nspacing = \"log\"\nfirst = \"{} s\"\n",
        material.times.map_or("as far as was fitted".to_owned(), |[_, last]| quantity(last, "s")),
        material.first(end, STEPS, 1e-3),
    );
    if purpose == Purpose::Seal {
        text += &format!(
            "\n[solver]\ntolerance = 1e-8                      # narrow gaps need it\n\n[leakage]\ndirection = \"x\"                       {YOURS}from inlet to outlet: \"x\" or \"y\"\npressure_drop = \"1 kPa\"               {YOURS}between inlet and outlet; above 0.02 of the pressure of the load add coupling = \"two-way\"\nviscosity = \"1 mPa s\"                 {YOURS}water 1 mPa s, oil 100 mPa s; of a gas: gas, inlet and outlet in place of both\n"
        );
    }
    text + "\n[output]\nfields = [\"pressure\", \"gap\"]\nevery = 4\n"
}

/// Velocities v = λ/(2π t) at which the material is known: at the times t of its data for every wave λ from two cells to the whole surface or,
/// where that is less than a decade, for waves of a tenth of its length.
fn friction(topography: &Topography, material: &Material) -> String {
    let points = topography.heights.dim().0.min(MOST_CELLS);
    let whole = topography.size[0];
    let reach = |longest: f64, shortest: f64| {
        let times = material.times.unwrap_or([longest / TAU, longest / (TAU * 1e-3)]);
        // So that rounding does not leave the data.
        [1.01 * longest / (TAU * times[1]), 0.99 * shortest / (TAU * times[0])]
    };
    let all = reach(whole, 2.0 * whole / points as f64);
    let ([from, to], waves) = match all[1] >= 10.0 * all[0] {
        true => (all, "all waves of the surface".to_owned()),
        false => (reach(0.1 * whole, 0.1 * whole), format!("waves of {}", quantity(0.1 * whole, "m"))),
    };
    let decades = (to / from).log10().max(1.0);
    let at = material.reference.as_ref().map_or(String::new(), |reference| format!(" at {reference}"));
    let count = (3.0 * decades).ceil() as usize + 1;
    format!(
        "\n[load]\ncontrol = \"pressure\"                  # nominal\nhistory = {{ kind = \"step\", value = \"0.1 MPa\" }}   {YOURS}pressure\n\n[motion]\ndirection = \"x\"                       {YOURS}of sliding: \"x\", \"y\" or an angle\n\n[motion.steady]                       # these velocities deform {waves} within the data of the material{at}\nvelocities = {{ from = \"{:.3e} m/s\", to = \"{:.3e} m/s\", count = {count}, spacing = \"log\" }}   {YOURS}velocities\n\n[solver]\ntolerance = 1e-4\n\n[output]\nfields = [\"pressure\"]\nevery = 7\n",
        from,
        to.max(10.0 * from),
    )
}

/// The indenter of the test, or a ball with this radius \[m\] as an example.
fn indenter(material: &Material, radius: f64) -> String {
    let keys = material.indenter.clone().unwrap_or_else(|| {
        format!("kind = \"sphere\"\nradius = \"{}\"   {YOURS}of the ball\n", plain(radius, "m"))
    });
    format!("\n[[surface]]\n{keys}")
}

/// The radius \[m\] of the contact at a depth: (R d)^(1/2) under a ball, 2 d/(pi slope) under a cone.
fn contact_radius(indenter: &str, depth: f64) -> Option<f64> {
    let ball = ball_radius(indenter).map(|radius| (radius * depth).sqrt());
    ball.or_else(|| Some(2.0 * depth / (PI * cone_slope(indenter)?)))
}

fn ball_radius(indenter: &str) -> Option<f64> {
    quoted(indenter, "radius = ")?.trim_end_matches(" m").parse().ok()
}

fn cone_slope(indenter: &str) -> Option<f64> {
    indenter.split_once("slope = ")?.1.trim().parse().ok()
}

/// An indentation by what the test controlled: its depths or its loads. Bodies that stick are moved by the depth, through the largest
/// tension.
fn indentation_of(
    record: &Indentation,
    purpose: Purpose,
    from: &Path,
    folder: &Path,
    material: &Material,
) -> Result<String, Failure> {
    /// Points of the history in the case, at most.
    const POINTS: usize = 5000;
    let columns = IndentationRecord { times: &record.times, loads: &record.loads, depths: &record.depths };
    let given = controlled(&columns).map_err(Failure::about(from.display()))?;
    let sticks = purpose == Purpose::Adhesion;
    let (control, values, unit) = match given {
        _ if sticks => ("approach", &record.depths, "m"),
        Given::Depth => ("approach", &record.depths, "m"),
        Given::Load => ("load", &record.loads, "N"),
    };
    let start = record.times.first().copied().unwrap_or_default();
    let last = record.times.len().saturating_sub(1);
    let (kept, error) = thinned(&record.times, values, POINTS);
    let point = |n: &usize| {
        let (time, value) = (record.times[*n] - start, values[*n].max(if sticks { f64::MIN } else { 0.0 }));
        format!("  [\"{time:.6e} s\", \"{value:.6e} {unit}\"],")
    };
    let points: Vec<String> = kept.iter().map(point).collect();
    let [least, most] = extent(values.iter().copied());
    let off = match error <= 1e-6 * (most - least) {
        true => "on".to_owned(),
        false => format!("within {} of", quantity(error, unit)),
    };
    let thinned = match kept.len() > last {
        true => String::new(),
        false => {
            format!(", {} of them here: the others lie {off} the straight lines between these", kept.len())
        }
    };
    let deepest = record.depths.iter().copied().fold(0.0, f64::max).max(1e-9);
    if sticks && record.depths.iter().all(|depth| *depth >= 0.0) {
        crate::messages::message!(
            "note: the depths of the record do not fall below 0, where bodies that stick come off: add points to the history"
        );
    }
    // A ball whose contact radius, sqrt(R d), is a tenth of its own radius.
    let indenter = indenter(material, one_digit(100.0 * deepest));
    let radius = contact_radius(&indenter, deepest).unwrap_or(10.0 * deepest);
    let size = one_digit(8.0 * radius).max(1e-9);
    let [low, high] = extent(record.loads.iter().copied());
    let title = if sticks { "Pull-off" } else { "Indentation" };
    let by = if sticks {
        "# the depth of the test, through the pull-off"
    } else {
        "# what the test controlled; the other channel is the response"
    };
    let before = format!(
        "{}[domain]\ncells = [192, 192]\nsize = [\"{size:e} m\", \"{size:e} m\"]    # four times as wide as the contact at the largest depth\n{indenter}{}",
        head(title, from),
        material.body(),
    );
    // Adaptive steps are a tenth of the first one at least.
    let end = record.times.get(last).copied().unwrap_or(1.0) - start;
    let known = material.times.map_or(0.0, |[first, _]| 10.0 * first);
    let first = match known > 1e-3 * end && known < 0.1 * end {
        true => {
            format!("first = \"{known:.3e} s\"                    # the data of the material begin there\n")
        }
        false => String::new(),
    };
    let after = format!(
        "\n[load]                                # {} rows of the record, {} to {}, depth up to {}{thinned}\ncontrol = \"{control}\"{}{by}\nhistory = {{ kind = \"table\", points = [\n{}\n] }}\n\n[time]\nend = \"{:.6e} s\"\nspacing = \"adaptive\"                  # as short as the error of a step asks\n{first}\n[output]\nfields = [\"pressure\", \"displacement\"]\nevery = 10\n",
        record.times.len(),
        quantity(low, "N"),
        quantity(high, "N"),
        quantity(deepest, "m"),
        " ".repeat(16),
        points.join("\n"),
        end,
    );
    Ok(with_adhesion(before, after, purpose, folder))
}

/// A number with its unit in full digits, to be read again.
fn plain(value: f64, unit: &str) -> String {
    format!("{value:e} {unit}")
}

/// A text in quotes.
fn toml(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// A path as a case in this folder names it: below the folder relative to it, else as it is from the root.
fn relative(path: &Path, folder: &Path) -> String {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let shown = |path: &Path| path.display().to_string();
    match (path.canonicalize(), here.canonicalize()) {
        (Ok(path), Ok(folder)) => shown(path.strip_prefix(&folder).unwrap_or(&path)),
        _ => shown(path),
    }
}
