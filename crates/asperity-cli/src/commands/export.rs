//! `asperity export`: a result for other programs.

use asperity_io::export::{Format, Options, export};
use asperity_io::store::{FieldKind, Reader};

use crate::args::Export;
use crate::failure::Failure;

/// Writes the result in the format asked for and prints the files written.
pub fn run(args: &Export) -> Result<(), Failure> {
    let Some(format) = Format::from_name(&args.to) else {
        let names: Vec<_> = Format::ALL.iter().map(|f| f.name()).collect();
        return Err(Failure::input(format!(
            "there is no export to \"{}\"; choose one of {}",
            args.to,
            names.join(", ")
        )));
    };
    let fields = args.fields.as_ref().map(|names| names.iter().map(|name| field(name)).collect());
    let options = Options { fields: fields.transpose()?, force: args.force, ..Options::default() };
    let reader = Reader::open(&args.result).map_err(|error| Failure::input(error.to_string()))?;
    let output = args.output.clone().unwrap_or_else(|| args.result.with_extension(format.extension()));
    let written = export(&reader, format, &output, &options);
    let written = written.map_err(|error| Failure::input(error.to_string()))?;
    crate::print(&written.iter().map(|path| format!("{}\n", path.display())).collect::<String>())
}

fn field(name: &str) -> Result<FieldKind, Failure> {
    FieldKind::from_name(name).ok_or_else(|| {
        Failure::input(format!(
            "there is no field \"{name}\"; choose from pressure, gap, displacement, contact"
        ))
    })
}
