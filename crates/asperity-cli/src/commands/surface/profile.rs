//! Profiles: `asperity surface info` and `process` of a file with one or two columns, and `asperity surface from-profile`.

use asperity::Grid;
use asperity::finding;
use asperity::surface::profile::{ProfileParameters, ProfileSpectrum, roughness};
use asperity::surface::statistics::Extent;
use asperity::surface::{Fill, Level, Operation};
use asperity_io::output::write_all;
use asperity_io::preparation::{Step, prepare};
use asperity_io::quantity::Length;
use asperity_io::topography::{Format, Profile, ReadOptions, read_profile};
use asperity_report::figure::{Axis, Curves, Figure, Series, Style};
use serde_json::json;

use crate::args::{SurfaceFile, SurfaceFromProfile, SurfaceInfo, SurfaceProcess};
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::format::{extent, quantity};
use crate::verb::Verb;

/// Rings of the spectrum per decade.
const PER_DECADE: u32 = 16;
/// Largest share of undefined points that are filled.
const MOST_FILLED: f64 = 0.25;

/// The profile of the file, where it holds one.
pub(super) fn open(file: &SurfaceFile) -> Result<Option<Profile>, Failure> {
    // One length of a profile; two of a map are read again as such.
    let size = match file.size.as_deref() {
        Some(text) if !text.contains(',') => Some([super::length("--size", text)?, 1.0]),
        _ => None,
    };
    let height_unit = file.height_unit.as_deref().map(super::unit).transpose()?;
    let options = ReadOptions { size, height_unit, ..ReadOptions::default() };
    Ok(read_profile(&file.file, &options)?)
}

/// Heights without their straight line and, with a cut-off, without their Gaussian mean line; and what was done.
fn prepared(
    name: &str,
    profile: Profile,
    args: &SurfaceInfo,
) -> Result<(Vec<f64>, f64, Vec<String>), Failure> {
    let failed = Failure::about(&name);
    let spacing = profile.surface.grid().spacing()[0];
    let mut steps = vec![];
    if profile.surface.undefined() > 0 {
        steps.push(Step::Operation(Operation::Fill { method: Fill::Harmonic, largest_share: MOST_FILLED }));
    }
    steps.push(match args.circle.as_deref() {
        None => Step::Operation(Operation::Level(Level::Plane)),
        Some("fit") => Step::Circle { radius: None },
        Some(radius) => Step::Circle { radius: Some(super::length("--circle", radius)?) },
    });
    let done = prepare(profile.surface, &steps, None).map_err(&failed)?;
    let mut heights: Vec<f64> = done.surface.heights().iter().copied().collect();
    let mut history = profile.history;
    history.extend(done.history.into_iter().map(|step| step.replace("the plane", "the straight line")));
    if let Some(cutoff) = args.cutoff.map(Length::get) {
        heights = roughness(&heights, spacing, cutoff).map_err(&failed)?;
        history.push(format!(
            "subtract the Gaussian mean line of cut-off {} (ISO 16610-21)",
            quantity(cutoff, "m")
        ));
    }
    Ok((heights, spacing, history))
}

/// Prints the parameters of the profile, and draws the picture asked for.
pub(super) fn info(args: &SurfaceInfo, profile: Profile) -> Result<(), Failure> {
    let name = args.file.file.display().to_string();
    let failed = Failure::about(&name);
    let (stored, undefined) = (profile.surface.clone(), profile.surface.undefined());
    let gaps = finding::gaps_of_profile("the profile of the file", profile.gaps);
    let size = stored.grid().size()[0];
    let (heights, spacing, history) = prepared(&name, profile, args)?;
    let found = ProfileParameters::of(&heights, spacing).map_err(&failed)?;
    let spectrum = ProfileSpectrum::of(&heights, spacing, args.periodic, PER_DECADE).map_err(&failed)?;
    let told: Vec<_> = gaps.into_iter().chain(finding::of_profile("the profile", &stored)).collect();
    let [low, high] = extent(stored.heights().iter().copied());
    if let Some(path) = &args.plot {
        crate::commands::picture::write(&figure(&name, &heights, spacing, &spectrum), path, args.force)?;
    }
    if args.json {
        let object = json!({
            "format": "profile", "shape": [heights.len()], "size": [size], "undefined": undefined,
            "min": low, "max": high, "history": history,
            "ra": found.ra, "rq": found.rq, "rz": found.rz, "rt": found.rt, "rsk": found.rsk, "rku": found.rku,
            "rsm": found.rsm, "rdq": found.rdq,
            "wave_number": spectrum.wave_numbers(), "power": spectrum.power,
            "findings": asperity_io::finding::list(&told),
        });
        return crate::print(&format!("{object}\n"));
    }
    let mut text = format!("{name}\n");
    let mut line =
        |name: &str, value: String, words: &str| text += &format!("  {name:<12}{value:<13} {words}\n");
    line(
        "profile",
        format!("{} points", heights.len()),
        &format!("over {}, spacing {}", quantity(size, "m"), quantity(spacing, "m")),
    );
    line("heights", format!("{} to {}", quantity(low, "m"), quantity(high, "m")), "as stored");
    for step in &history {
        line("", format!("- {step}"), "");
    }
    line("Ra", quantity(found.ra, "m"), "mean of the absolute height");
    line("Rq", quantity(found.rq, "m"), "rms height");
    line("Rz", quantity(found.rz, "m"), "highest less lowest height, mean of five sections");
    line("Rt", quantity(found.rt, "m"), "highest less lowest height");
    line("Rsk", format!("{:.4}", found.rsk), "skewness");
    line("Rku", format!("{:.4}", found.rku), "kurtosis");
    let or_none =
        |value: Option<f64>, unit: &str| value.map_or("none".to_owned(), |value| quantity(value, unit));
    line("Rsm", or_none(found.rsm, "m"), "mean length of a profile element");
    line("Rdq", or_none(found.rdq, ""), "rms slope");
    if args.cutoff.is_none() {
        text += "  without --cutoff: the parameters of the primary profile (Pa, Pq, ...)\n";
    }
    for finding in told {
        text += &format!("  {finding}\n");
    }
    crate::print(&text)
}

/// Prepares the profile, writes it as two columns of text, and prints its parameters.
pub(super) fn process(
    args: &SurfaceProcess,
    profile: Profile,
    format: Format,
    steps: &[Step],
) -> Result<(), Failure> {
    let name = args.file.file.display().to_string();
    let to = &args.to;
    if format != Format::Text {
        refuse!("{name} is a profile, and {format} holds maps; a profile is written as text: -o profile.txt");
    }
    let done = super::prepared(&name, profile.surface, steps)?;
    let history: Vec<String> = profile.history.into_iter().chain(done.history).collect();
    let spacing = done.surface.grid().spacing()[0];
    let step = |step: &String| format!("# {step}\n");
    let mut text: String = history.iter().map(step).collect();
    text += "x [m]\tz [m]\n";
    for (i, z) in done.surface.heights().iter().enumerate() {
        let z = if z.is_nan() { "nan".to_owned() } else { format!("{z:e}") };
        text += &format!("{:e}\t{z}\n", i as f64 * spacing);
    }
    write_all(&to.output, to.force, text.as_bytes())?;
    let history = history.iter().map(|step| format!("in the file: {step}")).collect();
    let written = Profile { surface: done.surface, history, metadata: profile.metadata, gaps: profile.gaps };
    let file = SurfaceFile { file: to.output.clone(), ..SurfaceFile::default() };
    let plot = to.plot.clone();
    let shown = SurfaceInfo { file, plot, force: to.force, json: to.json, ..SurfaceInfo::default() };
    info(&shown, written)
}

fn figure(name: &str, heights: &[f64], spacing: f64, spectrum: &ProfileSpectrum) -> Figure {
    let x: Vec<f64> = (0..heights.len()).map(|i| (i as f64 + 0.5) * spacing).collect();
    let profile = Curves::new("Profile", Axis::linear("x", "m"), Axis::linear("height", "m"))
        .with(Series::new("", Style::Line, x, heights));
    let power = Curves::new(
        "Power spectrum of the profile",
        Axis::log("wave number", "1/m"),
        Axis::log("power", "m3"),
    )
    .with(Series::new("", Style::Points, spectrum.wave_numbers(), spectrum.power.clone()));
    let mut figure = Figure::new(name).columns(1).with(profile).with(power);
    figure.panel = [430.0, 200.0];
    figure
}

impl Verb for SurfaceFromProfile {
    fn files(&self) -> Files {
        self.to.files().reads([&self.file.file])
    }

    /// Makes an isotropic surface with the spectrum of a profile, writes it, and prints its statistics.
    fn run(&self) -> Result<(), Failure> {
        let format = super::target(&self.to.output, self.to.to.as_deref())?;
        let name = self.file.file.display().to_string();
        let failed = Failure::about(&name);
        let Some(profile) = open(&self.file)? else {
            refuse!(
                "{name} is no profile: it needs two columns of text, position and height, or one column of heights with --size LENGTH"
            );
        };
        let (mut history, gaps) =
            (profile.history, finding::gaps_of_profile("the profile of the file", profile.gaps));
        let done = super::prepared(&name, profile.surface, &super::steps(&self.op)?)?;
        history.extend(done.history);
        let profile = done.surface;
        let spacing = profile.grid().spacing()[0];
        let heights: Vec<f64> = profile.heights().iter().copied().collect();
        let spectrum = ProfileSpectrum::of(&heights, spacing, self.periodic, PER_DECADE).map_err(&failed)?;
        let size = match self.to_size.as_deref() {
            Some(text) if text.contains(',') => super::size("--to-size", text)?,
            Some(text) => [super::length("--to-size", text)?; 2],
            None => [profile.grid().size()[0]; 2],
        };
        let (cells, wanted) = cells(self.cells.as_deref(), size, spacing)?;
        let grid = Grid::new(cells, size).map_err(&failed)?;
        let made = spectrum.surface(&grid, self.seed).map_err(&failed)?;
        history.push(format!(
            "isotropic surface with the power spectrum of the profile {name}, random phases, seed {}, waves from {} to {}",
            self.seed,
            quantity(made.waves[1], "m"),
            quantity(made.waves[0], "m"),
        ));
        let changed = match made.changed_beyond < made.waves[0] {
            true => format!(
                "; for it, waves longer than {} have less than half, or more than twice, their power",
                quantity(made.changed_beyond, "m")
            ),
            false => String::new(),
        };
        let row = |words: &str, height: f64, slope: f64| {
            format!(
                "{words}: rms height {}, rms slope along each direction {}",
                quantity(height, "m"),
                quantity(slope, "")
            )
        };
        let ([held, whole], [slope, whole_slope]) = (made.rms_height, made.rms_slope);
        history.push(row("the surface", held, made.slope) + &changed);
        history.push(row("the same waves of the profile", held, slope));
        history.push(row("all waves of the profile", whole, whole_slope));
        let told = gaps.into_iter().chain(finding::of_profile("the profile", &profile));
        let told = told.chain(finding::unlike_profile(&made)).collect();
        let topography = super::roughness(format, made.heights, size, history);
        super::finish(&self.to, &topography, Extent::Periodic, |summary| summary.told(told))?;
        if let Some([x, y]) = wanted {
            crate::messages::message!(
                "note: the surface has {} x {} cells, the most that are chosen unasked; the spacing of the profile would need {x} x {y}: \
                 --cells {x},{y}. --to-size gives a smaller surface",
                cells[0],
                cells[1],
            );
        }
        if !self.to.json {
            crate::messages::message!(
                "assumed: the surface is the same in all directions and its heights are Gaussian; a profile cannot tell a lay"
            );
        }
        Ok(())
    }
}

/// Most cells along a side that are chosen without being asked for.
const MOST_CELLS: usize = 2048;

/// Cells of the surface: those asked for, or of the spacing of the profile, at most [`MOST_CELLS`] along a side; then also the
/// number that the spacing needs.
fn cells(
    given: Option<&str>,
    size: [f64; 2],
    spacing: f64,
) -> Result<([usize; 2], Option<[usize; 2]>), Failure> {
    let Some(text) = given else {
        let wanted = size.map(|length| (length / spacing).round().max(1.0) as usize);
        let most = wanted[0].max(wanted[1]);
        let fewer = wanted.map(|n| (n * MOST_CELLS).div_ceil(most));
        return Ok(if most > MOST_CELLS { (fewer, Some(wanted)) } else { (wanted, None) });
    };
    let numbers: Result<Vec<usize>, _> = text.split(',').map(|n| n.trim().parse::<usize>()).collect();
    match numbers.as_deref() {
        Ok([n]) => Ok(([*n; 2], None)),
        Ok([nx, ny]) => Ok(([*nx, *ny], None)),
        _ => refuse!("--cells is \"{text}\", but must be one or two numbers, e.g. --cells 512,512"),
    }
}
