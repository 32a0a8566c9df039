//! `asperity export`: a result for other programs.

use asperity_io::export::{Format, Options, export};
use asperity_io::store::{FieldKind, Reader};
use asperity_report::pictures::pictures;

use crate::args::Export;
use crate::failure::Failure;

/// Writes the result in the format asked for and prints the files written.
pub fn run(args: &Export) -> Result<(), Failure> {
    if args.to == "png" {
        return png(args);
    }
    let Some(format) = Format::from_name(&args.to) else {
        let names: Vec<_> = Format::ALL.iter().map(|f| f.name()).collect();
        return Err(Failure::input(format!(
            "there is no export to \"{}\"; choose one of {}, png",
            args.to,
            names.join(", ")
        )));
    };
    let options = Options { fields: fields(args)?, force: args.force, ..Options::default() };
    let reader = Reader::open(&args.result).map_err(|error| Failure::input(error.to_string()))?;
    let output = args.output.clone().unwrap_or_else(|| args.result.with_extension(format.extension()));
    let written = export(&reader, format, &output, &options);
    let written = written.map_err(Failure::of)?;
    if let Some(sentence) = format.left_out(&reader) {
        crate::messages::message!("{sentence}");
    }
    crate::print(&written.iter().map(|path| format!("{}\n", path.display())).collect::<String>())
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
