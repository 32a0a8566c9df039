//! `asperity export`: a result for other programs.

use asperity_io::export::{Format, Options, export};
use asperity_io::store::{At, FieldKind, Look, Reader};
use asperity_io::topography::{self, Topography, write};
use asperity_report::pictures::pictures;

use crate::args::Export;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::verb::Verb;

impl Verb for Export {
    fn files(&self) -> Files {
        Files::default().reads([&self.result]).writes(&self.output).force(self.force)
    }

    /// Writes the result in the format asked for and prints the files written.
    fn run(&self) -> Result<(), Failure> {
        let reader = Reader::open(&self.result)?;
        let fields = self.fields.as_ref();
        let fields = fields.map(|names| names.iter().map(|name| field(name)).collect::<Result<Vec<_>, _>>());
        let fields = fields.transpose()?;
        let output = |extension| self.output.clone().unwrap_or_else(|| self.result.with_extension(extension));
        if self.to == "png" {
            let directory = output("pictures");
            pictures(&reader, fields.as_deref(), &directory, self.force)?;
            return crate::print(&format!("{}\n", directory.display()));
        }
        if self.to == "sdf" {
            let path = output("sdf");
            if path.exists() && !self.force {
                refuse!("{} exists already; --force replaces it", path.display());
            }
            write(&path, &surface(&reader, fields.as_deref())?, topography::Format::Sdf)?;
            return crate::print(&format!("{}\n", path.display()));
        }
        let Some(format) = Format::from_name(&self.to) else {
            let names: Vec<_> = Format::ALL.iter().map(|f| f.name()).collect();
            refuse!("there is no export to \"{}\"; choose one of {}, sdf, png", self.to, names.join(", "));
        };
        let options = Options { fields, force: self.force, ..Options::default() };
        let written = export(&reader, format, &output(format.extension()), &options)?;
        if let Some(sentence) = format.left_out(&reader) {
            crate::messages::message!("{sentence}");
        }
        crate::print(&written.iter().map(|path| format!("{}\n", path.display())).collect::<String>())
    }
}

/// One field of the last stored instant as a surface; of a gap the heights that have it over a flat, so that a case can take it.
fn surface(reader: &Reader, fields: Option<&[FieldKind]>) -> Result<Topography, Failure> {
    let grid = &reader.header().grid;
    let (Some([kind]), false) = (fields, grid.is_line()) else {
        let expected = "one field of a plane, such as --fields undeformed_gap";
        refuse!("a surface file holds {expected}");
    };
    if kind.units() != "m" {
        refuse!("{kind} is no length, and a surface file holds heights: take npz");
    }
    let values = reader.field(*kind, At::Last)?;
    let heights = if kind.look() == Look::Gap { -values } else { values };
    let heights = heights.mapv(|height| if height.is_finite() { height } else { f64::NAN });
    Ok(Topography {
        format: topography::Format::Sdf,
        heights,
        size: grid.size(),
        channel: Some(kind.name().to_owned()),
        channels: vec![],
        metadata: vec![],
    })
}

fn field(name: &str) -> Result<FieldKind, Failure> {
    FieldKind::from_name(name).ok_or_else(|| {
        let names = FieldKind::ALL.map(FieldKind::name).join(", ");
        Failure::input(format!("there is no field \"{name}\"; choose from {names}"))
    })
}
