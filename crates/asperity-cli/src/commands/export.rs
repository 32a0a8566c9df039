//! `asperity export`: a result for other programs.

use asperity_io::export::{Format, Options, export};
use asperity_io::store::{FieldKind, Reader};
use asperity_report::pictures::pictures;

use crate::args::Export;
use crate::failure::Failure;
use crate::verb::{Paths, Verb};

impl Verb for Export {
    fn reads(&self) -> Paths<'_> {
        vec![Some(&self.result)]
    }

    fn writes(&self) -> Paths<'_> {
        vec![self.output.as_ref()]
    }

    /// Writes the result in the format asked for and prints the files written.
    fn run(&self) -> Result<(), Failure> {
        if self.to == "png" {
            return png(self);
        }
        let Some(format) = Format::from_name(&self.to) else {
            let names: Vec<_> = Format::ALL.iter().map(|f| f.name()).collect();
            return Err(Failure::input(format!(
                "there is no export to \"{}\"; choose one of {}, png",
                self.to,
                names.join(", ")
            )));
        };
        let options = Options { fields: fields(self)?, force: self.force, ..Options::default() };
        let reader = Reader::open(&self.result).map_err(|error| Failure::input(error.to_string()))?;
        let output = self.output.clone().unwrap_or_else(|| self.result.with_extension(format.extension()));
        let written = export(&reader, format, &output, &options);
        let written = written.map_err(Failure::of)?;
        if let Some(sentence) = format.left_out(&reader) {
            crate::messages::message!("{sentence}");
        }
        crate::print(&written.iter().map(|path| format!("{}\n", path.display())).collect::<String>())
    }
}

/// A directory of pictures.
fn png(args: &Export) -> Result<(), Failure> {
    let reader = Reader::open(&args.result).map_err(|error| Failure::input(error.to_string()))?;
    let output = args.output.clone().unwrap_or_else(|| args.result.with_extension("pictures"));
    let fields = fields(args)?;
    let written = pictures(&reader, fields.as_deref(), &output, args.force);
    written.map_err(Failure::of)?;
    crate::print(&format!("{}\n", output.display()))
}

fn fields(args: &Export) -> Result<Option<Vec<FieldKind>>, Failure> {
    args.fields.as_ref().map(|names| names.iter().map(|name| field(name)).collect()).transpose()
}

fn field(name: &str) -> Result<FieldKind, Failure> {
    FieldKind::from_name(name).ok_or_else(|| {
        Failure::input(format!(
            "there is no field \"{name}\"; choose from pressure, gap, displacement, contact, flattening"
        ))
    })
}
