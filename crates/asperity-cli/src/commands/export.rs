//! `asperity export`: a result for other programs.

use asperity_io::export::{Format, Options, export};
use asperity_io::store::{FieldKind, Reader};
use asperity_report::pictures::pictures;

use crate::args::Export;
use crate::failure::Failure;
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
        let Some(format) = Format::from_name(&self.to) else {
            let names: Vec<_> = Format::ALL.iter().map(|f| f.name()).collect();
            return Err(Failure::input(format!(
                "there is no export to \"{}\"; choose one of {}, png",
                self.to,
                names.join(", ")
            )));
        };
        let options = Options { fields, force: self.force, ..Options::default() };
        let written = export(&reader, format, &output(format.extension()), &options)?;
        if let Some(sentence) = format.left_out(&reader) {
            crate::messages::message!("{sentence}");
        }
        crate::print(&written.iter().map(|path| format!("{}\n", path.display())).collect::<String>())
    }
}

fn field(name: &str) -> Result<FieldKind, Failure> {
    FieldKind::from_name(name).ok_or_else(|| {
        Failure::input(format!(
            "there is no field \"{name}\"; choose from pressure, gap, displacement, contact, flattening"
        ))
    })
}
