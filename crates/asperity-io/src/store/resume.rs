//! Going on with a run that stopped.

use std::fs;
use std::path::Path;

use asperity::step::Checkpoint;
use ndarray::ArrayView2;

use super::checkpoint;
use super::checksum::Sums;
use super::column;
use super::document::{Document, Pages};
use super::error::{Result, StoreError, io};
use super::header::{Header, Progress, Status};
use super::layout::{ArraySpec, Storage};
use super::reader::Reader;
use super::stress;
use super::writer::{Writer, lock, remove};
use crate::compare::other_line;

impl Writer {
    /// Opens the result at `path` to go on from its checkpoint. Rows and fields after the checkpoint
    /// are taken back (the run computes them again, to the same bits); without a checkpoint all are,
    /// and the run starts anew.
    ///
    /// # Errors
    /// [`StoreError::Mismatch`] where `header` or `initial_gap` \[m\] is not that of the result (the case,
    /// or a file that it names, has changed); [`StoreError::Complete`] where nothing is left to do;
    /// [`StoreError::FormerCheckpoint`] where an earlier version wrote the checkpoint;
    /// [`StoreError::Busy`] where another process is writing it; [`StoreError::NotAResult`],
    /// [`StoreError::Newer`], [`StoreError::Corrupt`] and [`StoreError::Io`] as of [`Reader::open`].
    pub fn resume(
        path: &Path,
        header: &Header,
        initial_gap: ArrayView2<'_, f64>,
    ) -> Result<(Writer, Option<Checkpoint<'static>>)> {
        let reader = Reader::open(path)?;
        let held = lock(path)?;
        // Once more: a run that ended meanwhile has changed it.
        let reader = if held.is_some() { Reader::open(path)? } else { reader };
        compare(path, reader.header(), header)?;
        if reader.status() == Status::Complete {
            return Err(StoreError::Complete { path: path.to_owned(), rows: reader.len() });
        }
        compare_gap(path, reader.initial_gap()?.view(), initial_gap)?;
        refuse_links(path)?;

        let checkpoint = checkpoint::read(path, reader.header(), reader.len())?;
        let rows = checkpoint.as_ref().map_or(0, |checkpoint| checkpoint.step);
        if rows > reader.len() {
            let what = format!("it is of row {rows}, but {} rows are stored", reader.len());
            return Err(checkpoint::damaged(&checkpoint::path(path), &what));
        }
        let all = reader.rows()?;
        let maps = reader.field_steps().iter().take_while(|step| **step < rows).count();
        for kind in &reader.header().fields {
            (0..maps).try_for_each(|map| reader.verify_map(kind.name(), &[map as u64]))?;
        }

        let stored = &reader.document().progress;
        let (stored_maps, mut progress) = (stored.maps, Progress { rows, maps, ..stored.clone() });
        progress.sums = kept_sums(&reader, &progress)?;
        // Stress and leaks are computed again at the end of the run.
        let Document { form, header: mut kept, .. } = reader.into_document();
        progress.status = Status::Running;
        progress.work.message = None;
        progress.work.iterations = all[..rows].iter().map(|row| row.iterations as u64).sum();
        progress.work.convolutions = all[..rows].iter().map(|row| row.convolutions as u64).sum();
        if !kept.version.split(", ").any(|version| version == header.version) {
            kept.version = format!("{}, {}", kept.version, header.version);
        }
        kept.rows_expected = header.rows_expected;
        let document = Document { form, header: kept, progress, stress: None, leaks: None, error_bars: None };
        Pages::publish(path, &document)?;
        stress::clear(path)?;
        // Maps after the last one counted may have been written, the last of them by half.
        for kind in &document.header.fields {
            for map in maps.. {
                let directory = path.join(kind.name()).join("c").join(map.to_string());
                if map > stored_maps && !directory.exists() {
                    break;
                }
                remove(&directory)?;
            }
        }
        let last = all[..rows].last().map_or(f64::NEG_INFINITY, |row| row.coordinate.value());
        Ok((Writer::attach(path, document, held, last)?, checkpoint))
    }
}

/// Refuses links below `directory`: what they lead to is not ours to write into.
fn refuse_links(directory: &Path) -> Result<()> {
    let read = io("read", directory);
    for entry in fs::read_dir(directory).map_err(&read)? {
        let entry = entry.map_err(&read)?;
        let (kind, path) = (entry.file_type().map_err(&read)?, entry.path());
        if kind.is_symlink() {
            let why = "it is a link, and files outside of the result would change; copy the result with what its links lead to \
                       (cp -rL) and resume the copy";
            let source = std::io::Error::new(std::io::ErrorKind::InvalidInput, why);
            return Err(StoreError::Io { path, action: "resume into", source });
        }
        if kind.is_dir() {
            refuse_links(&path)?;
        }
    }
    Ok(())
}

/// The checksums of the rows and fields that are kept. All rows of each array are compared with their own first.
fn kept_sums(reader: &Reader, kept: &Progress) -> Result<Sums> {
    let mut sums = Sums::new();
    if reader.document().form < 2 {
        return Ok(sums);
    }
    let is_kept = |array: &ArraySpec| {
        array.storage == Storage::Rows && !stress::names().any(|name| name == array.name())
    };
    for array in reader.document().arrays().into_iter().filter(is_kept) {
        let rows = kept.length_of(array.dimensions[0].0).unwrap_or(0);
        let width: usize = array.shape()[1..].iter().product();
        let numbers = reader.column(&array)?;
        sums.insert(array.name().to_owned(), column::sum(&numbers[..rows * width]));
    }
    Ok(sums)
}

/// Compares what decides the numbers of a run.
fn compare(path: &Path, stored: &Header, given: &Header) -> Result<()> {
    let mismatch = |what: &str, stored: String, given: String| {
        Err(StoreError::Mismatch { path: path.to_owned(), what: what.to_owned(), stored, given })
    };
    if stored.case_text != given.case_text {
        return match other_line(&stored.case_text, &given.case_text) {
            Some((n, [old, new])) => mismatch(&format!("line {n} of the case"), old, new),
            None => mismatch("the case", "of other line ends".into(), "not".into()),
        };
    }
    if stored.grid != given.grid {
        let name = |header: &Header| {
            let ([nx, ny], [lx, ly]) = (header.grid.cells(), header.grid.size());
            match header.grid.is_line() {
                true => format!("a line of {nx} cells over {lx:e} m"),
                false => format!("{nx} x {ny} cells over {lx:e} m x {ly:e} m"),
            }
        };
        return mismatch("the grid", name(stored), name(given));
    }
    let listed = |names: Vec<&str>| if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    if stored.fields != given.fields {
        let [stored, given] =
            [stored, given].map(|header| listed(header.fields.iter().map(|kind| kind.name()).collect()));
        return mismatch("the list of fields", stored, given);
    }
    if stored.quantities != given.quantities {
        let names = |header: &Header| header.quantities.iter().map(|column| column.quantity.name()).collect();
        let [stored, given] = [stored, given].map(|header| listed(names(header)));
        return mismatch("the list of quantities or their bins", stored, given);
    }
    let keys = stored.setup.keys().chain(given.setup.keys());
    // An estimate, which depends on the number of threads.
    for key in keys.filter(|key| *key != "memory_bytes") {
        let (old, new) = (stored.setup.get(key), given.setup.get(key));
        if old != new {
            let show = |value: Option<&serde_json::Value>| value.map_or("missing".into(), |v| v.to_string());
            return mismatch(&format!("`{key}`"), show(old), show(new));
        }
    }
    Ok(())
}

/// The surfaces may come from files that have changed.
fn compare_gap(path: &Path, stored: ArrayView2<'_, f64>, given: ArrayView2<'_, f64>) -> Result<()> {
    let mismatch = |what: String, stored: String, given: String| {
        Err(StoreError::Mismatch { path: path.to_owned(), what, stored, given })
    };
    if stored.dim() != given.dim() {
        let show = |(nx, ny): (usize, usize)| format!("{nx} x {ny}");
        return mismatch("the shape of the undeformed gap".into(), show(stored.dim()), show(given.dim()));
    }
    for ((cell, old), new) in stored.indexed_iter().zip(given) {
        if old.to_bits() != new.to_bits() {
            let what = format!("the undeformed gap at cell ({}, {})", cell.0, cell.1);
            return mismatch(what, format!("{old:e} m"), format!("{new:e} m (has a surface changed?)"));
        }
    }
    Ok(())
}
