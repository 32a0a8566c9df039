//! A figure of an instant as an animation over the stored ones: APNG or GIF.
//!
//! All frames have the axes and colours that hold every one of them, found in a first pass, so that colours can be compared
//! from frame to frame. One field at a time is in memory. Of the stress below the surface, instants without contact are left out.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use asperity_io::output::{PartialFile, WriteError};
use asperity_io::store::{At, Reader};
use asperity_io::stress::StressError;

use crate::figure::{FigureError, Pixels};
use crate::result::{Common, Options, Plot, PlotError, figure};

/// A form of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// PNG with frames, in full colours.
    Apng,
    /// GIF, 256 colours a frame.
    Gif,
}

/// How an animation runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// Most frames; of more instants some are left out evenly.
    pub frames: usize,
    /// Length of the whole \[s\]; `None` for a fifth of a second a frame, twelve seconds at most.
    pub duration: Option<f64>,
}

impl Default for Course {
    fn default() -> Self {
        Course { frames: 200, duration: None }
    }
}

/// What an animation shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frames {
    /// Number of frames.
    pub shown: usize,
    /// Instants at which nothing touches, so that they have no figure.
    pub without_contact: usize,
}

/// Dots to an inch: a map is some 700 dots wide.
const DOTS: f64 = 144.0;
/// Time of a frame and of all of them, where not given \[s\].
const FRAME: f64 = 0.2;
const WHOLE: f64 = 12.0;

impl Motion {
    /// The form that the ending of a path asks for.
    ///
    /// # Errors
    /// [`PlotError::Refused`] where it is none of `.png`, `.apng` and `.gif`.
    pub fn of(path: &Path) -> Result<Motion, PlotError> {
        match path.extension().map(|ending| ending.to_ascii_lowercase()) {
            Some(ending) if ending == "png" || ending == "apng" => Ok(Motion::Apng),
            Some(ending) if ending == "gif" => Ok(Motion::Gif),
            _ => Err(PlotError::Refused(format!(
                "{}: the ending says what an animation is written as: use .png, .apng or .gif",
                path.display()
            ))),
        }
    }
}

/// Writes the figure at the stored instants within the window of the options as an animation that repeats, and says how many
/// frames it has and how many instants it leaves out. The file appears whole or not at all.
///
/// # Errors
/// [`PlotError`]; [`FigureError::Drawing`] of what the encoder refuses.
pub fn animation(
    reader: &Reader,
    plot: Plot,
    options: &Options,
    course: Course,
    path: &Path,
    force: bool,
) -> Result<Frames, PlotError> {
    let form = Motion::of(path)?;
    let chosen = instants(reader, options, course.frames)?;
    let frame = |n: usize| figure(reader, plot, &Options { at: At::Index(n), ..options.clone() });
    let mut common = Common::default();
    let mut with_contact = vec![];
    for n in &chosen {
        match frame(*n) {
            Err(PlotError::Stress(StressError::NoContact { .. })) => continue,
            drawn => common.add(&drawn?),
        }
        with_contact.push(*n);
    }
    let without_contact = chosen.len() - with_contact.len();
    let chosen = with_contact;
    if chosen.len() < 2 {
        return Err(few(chosen.len(), "with contact"));
    }
    let whole = course.duration.unwrap_or((FRAME * chosen.len() as f64).min(WHOLE));
    let each = whole / chosen.len() as f64;
    let pictures = chosen.iter().map(|n| -> Result<Pixels, PlotError> {
        let mut figure = frame(*n)?;
        common.apply(&mut figure);
        Ok(figure.dots(DOTS)?)
    });
    let failed = |source| FigureError::from(WriteError::at(path, source));
    let partial = PartialFile::new(path, force).map_err(failed)?;
    let mut file = BufWriter::new(File::create(partial.place()).map_err(failed)?);
    match form {
        Motion::Apng => apng(&mut file, chosen.len(), each, pictures)?,
        Motion::Gif => gif(&mut file, each, pictures)?,
    }
    file.flush().and_then(|()| partial.finish()).map_err(failed)?;
    Ok(Frames { shown: chosen.len(), without_contact })
}

/// Numbers of the stored instants to show: those in the window, the first and the last among them.
fn instants(reader: &Reader, options: &Options, most: usize) -> Result<Vec<usize>, PlotError> {
    let times = reader.field_times();
    let inside: Vec<usize> = (0..times.len()).filter(|n| options.shows(times[*n])).collect();
    if inside.len() < 2 {
        let stored =
            if times.len() < 2 { "in the result (output.every stores more)" } else { "in this window" };
        return Err(few(inside.len(), stored));
    }
    let most = most.clamp(2, inside.len());
    let last = inside.len() - 1;
    Ok((0..most).map(|k| inside[(k * last + (most - 1) / 2) / (most - 1)]).collect())
}

fn few(found: usize, stored: &str) -> PlotError {
    PlotError::Refused(format!("an animation needs two stored times at least, but has {found} {stored}"))
}

fn refused(error: impl std::fmt::Display) -> PlotError {
    FigureError::Drawing(error.to_string()).into()
}

fn apng(
    file: &mut impl Write,
    count: usize,
    seconds: f64,
    mut frames: impl Iterator<Item = Result<Pixels, PlotError>>,
) -> Result<(), PlotError> {
    let Some(first) = frames.next() else { return Ok(()) };
    let first = first?;
    let [width, height] = first.size.map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_animated(u32::try_from(count).unwrap_or(u32::MAX), 0).map_err(refused)?;
    let milliseconds = (1000.0 * seconds).round().clamp(1.0, f64::from(u16::MAX)) as u16;
    encoder.set_frame_delay(milliseconds, 1000).map_err(refused)?;
    let mut writer = encoder.write_header().map_err(refused)?;
    writer.write_image_data(&first.rgb).map_err(refused)?;
    for frame in frames {
        writer.write_image_data(&frame?.rgb).map_err(refused)?;
    }
    writer.finish().map_err(refused)
}

fn gif(
    file: &mut impl Write,
    seconds: f64,
    mut frames: impl Iterator<Item = Result<Pixels, PlotError>>,
) -> Result<(), PlotError> {
    let Some(first) = frames.next() else { return Ok(()) };
    let first = first?;
    let [width, height] = first.size.map(|side| u16::try_from(side).unwrap_or(u16::MAX));
    let mut encoder = gif::Encoder::new(file, width, height, &[]).map_err(refused)?;
    encoder.set_repeat(gif::Repeat::Infinite).map_err(refused)?;
    let delay = (100.0 * seconds).round().clamp(2.0, f64::from(u16::MAX)) as u16;
    for frame in std::iter::once(Ok(first)).chain(frames) {
        // 1 is the slowest and best choice of 256 colours, 30 the fastest.
        let mut frame = gif::Frame::from_rgb_speed(width, height, &frame?.rgb, 10);
        frame.delay = delay;
        encoder.write_frame(&frame).map_err(refused)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Frames of one colour each.
    fn frames() -> Vec<Result<Pixels, PlotError>> {
        let frame = |k: u8| Pixels { size: [6, 4], rgb: [k, 0, 255 - k].repeat(24) };
        [10, 20, 30].map(|k| Ok(frame(k))).into()
    }

    #[test]
    fn an_apng_holds_every_frame_and_repeats() {
        let mut data = vec![];
        assert!(apng(&mut data, 3, 0.25, frames().into_iter()).is_ok());
        let mut reader = png::Decoder::new(std::io::Cursor::new(&data)).read_info().unwrap();
        let control = *reader.info().animation_control().unwrap();
        assert_eq!((control.num_frames, control.num_plays), (3, 0)); // 0: for ever
        let mut dots = vec![0; reader.output_buffer_size().unwrap()];
        for k in [10, 20, 30] {
            reader.next_frame(&mut dots).unwrap();
            assert_eq!(dots[..3], [k, 0, 255 - k]);
            let frame = reader.info().frame_control.unwrap();
            assert_eq!((frame.delay_num, frame.delay_den), (250, 1000));
        }
    }

    #[test]
    fn a_gif_holds_every_frame_and_repeats() {
        let mut data = vec![];
        assert!(gif(&mut data, 0.25, frames().into_iter()).is_ok());
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut reader = options.read_info(data.as_slice()).unwrap();
        assert_eq!(reader.repeat(), gif::Repeat::Infinite);
        for k in [10, 20, 30] {
            let frame = reader.read_next_frame().unwrap().unwrap();
            assert_eq!((frame.width, frame.height, frame.delay), (6, 4, 25));
            // One colour of 256 is kept as it is.
            assert_eq!(frame.buffer[..3], [k, 0, 255 - k]);
        }
        assert!(reader.read_next_frame().unwrap().is_none());
    }

    #[test]
    fn a_frame_that_fails_ends_the_file() {
        let failing = [Err(few(1, "here"))];
        let first = frames().into_iter().take(1).chain(failing);
        assert!(matches!(apng(&mut vec![], 3, 0.1, first), Err(PlotError::Refused(_))));
    }
}
