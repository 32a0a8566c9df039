//! `asperity surface`: measured surfaces.

use asperity::Grid;
use asperity::surface::Surface as Map;
use asperity::surface::statistics::{HeightStatistics, SlopeStatistics};
use asperity_io::case::quantity::Length;
use asperity_io::topography::{Format, ReadOptions, Topography, read, write};
use serde_json::{Value, json};

use crate::args::{Surface, SurfaceFile};
use crate::failure::Failure;
use crate::words::quantity;

/// Looks at a surface or converts it.
pub fn run(command: &Surface) -> Result<(), Failure> {
    match command {
        Surface::Info { file, json } => info(file, *json),
        Surface::Convert { file, output, to, force } => {
            let ending = output.extension().map(|e| e.to_string_lossy().into_owned());
            let name = to.clone().or(ending).unwrap_or_default();
            let format: Format = name.parse().map_err(|error| {
                Failure::input(format!("{error}; name the format to write with --to, e.g. --to gwy"))
            })?;
            if output.exists() && !force {
                let path = output.display();
                return Err(Failure::input(format!(
                    "{path} is there already; name another file or give --force"
                )));
            }
            let topography = open(file)?;
            write(output, &topography, format).map_err(|error| Failure::input(error.to_string()))
        }
    }
}

fn open(file: &SurfaceFile) -> Result<Topography, Failure> {
    let size = file.size.as_deref().map(size).transpose()?;
    let height_unit = file.height_unit.as_deref().map(unit).transpose()?;
    let options = ReadOptions { size, height_unit, channel: file.channel.clone(), ..ReadOptions::default() };
    read(&file.file, &options).map_err(|error| Failure::input(error.to_string()))
}

/// "1 mm,2 mm" in metres.
fn size(text: &str) -> Result<[f64; 2], Failure> {
    let lengths: Vec<_> = text.split(',').map(length).collect::<Result<_, _>>()?;
    match lengths[..] {
        [x, y] if x > 0.0 && y > 0.0 => Ok([x, y]),
        _ => Err(Failure::input(format!(
            "--size is \"{text}\", but must be two lengths, e.g. --size '1 mm,1 mm'"
        ))),
    }
}

/// "um" or "0.1 um" in metres.
fn unit(text: &str) -> Result<f64, Failure> {
    let value = length(&format!("1 {text}")).or_else(|_| length(text))?;
    if value > 0.0 {
        return Ok(value);
    }
    Err(Failure::input(format!("--height-unit is \"{text}\", but must be a length, e.g. --height-unit um")))
}

fn length(text: &str) -> Result<f64, Failure> {
    let length: Length = text
        .trim()
        .parse()
        .map_err(|error| Failure::input(format!("length \"{}\": {error}", text.trim())))?;
    Ok(length.get())
}

fn info(file: &SurfaceFile, json: bool) -> Result<(), Failure> {
    let topography = open(file)?;
    let told = |error: asperity::Error| Failure::input(format!("{}: {error}", file.file.display()));
    let (nx, ny) = topography.heights.dim();
    let grid = Grid::new([nx, ny], topography.size).map_err(told)?;
    let map = Map::new(grid, topography.heights.clone()).map_err(told)?;
    let heights = HeightStatistics::of(&map).map_err(told)?;
    // A profile of one line or a map without neighbours has no slope.
    let slopes = SlopeStatistics::of(&map).ok();
    if json {
        let at = |i: usize, j: usize| topography.heights.get((i, j)).copied().filter(|h| h.is_finite());
        let object: Value = json!({
            "format": topography.format.name(),
            "shape": [nx, ny],
            "size": topography.size,
            "undefined": topography.undefined(),
            "min": heights.min,
            "max": heights.max,
            "mean": heights.mean,
            "sq": heights.sq,
            "sdq": slopes.map(|s| s.sdq),
            "h00": at(0, 0),
            "h10": at(1, 0),
            "h01": at(0, 1),
            "sa": heights.sa,
            "ssk": heights.ssk,
            "sku": heights.sku,
            "sz": heights.sz,
            "sdr": slopes.map(|s| s.sdr),
            "channel": topography.channel,
            "channels": topography.channels,
        });
        return crate::print(&format!("{object}\n"));
    }
    let [lx, ly] = topography.size;
    let mut text = String::new();
    let mut line = |name: &str, value: String| text += &format!("{name:<11}{value}\n");
    line("format", topography.format.to_string());
    line("points", format!("{nx} x {ny}, {} undefined", topography.undefined()));
    line("size", format!("{} x {}", quantity(lx, "m", 1), quantity(ly, "m", 1)));
    line("heights", format!("{} to {}", quantity(heights.min, "m", 1), quantity(heights.max, "m", 1)));
    line("mean", quantity(heights.mean, "m", 1));
    line("Sa", quantity(heights.sa, "m", 1));
    line("Sq", quantity(heights.sq, "m", 1));
    line("Sz", quantity(heights.sz, "m", 1));
    line("Ssk, Sku", format!("{:.3}, {:.3}", heights.ssk, heights.sku));
    if let Some(slopes) = slopes {
        line("Sdq", format!("{:.4}", slopes.sdq));
        line("Sdr", format!("{:.3} %", 100.0 * slopes.sdr));
    }
    if topography.channels.len() > 1 {
        line("channels", topography.channels.join(", "));
    }
    crate::print(&text)
}
