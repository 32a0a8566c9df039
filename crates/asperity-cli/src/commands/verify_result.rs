//! `asperity verify-result`: whether a result is as it was written.

use asperity_io::store::{Verification, verify};
use serde_json::json;

use crate::args::VerifyResult;
use crate::failure::Failure;
use crate::format::counted;
use crate::verb::Verb;

impl Verb for VerifyResult {
    /// Reads all of the result and prints what is damaged.
    fn run(&self) -> Result<(), Failure> {
        let found = verify(&self.result)?;
        crate::print(&if self.json { object(self, &found) } else { text(self, &found) })?;
        match found.damage.len() {
            0 => Ok(()),
            files => Err(Failure::System(format!(
                "{} damaged; restore the result from a copy or run the case again",
                if files == 1 { "1 file is".to_owned() } else { format!("{files} files are") }
            ))),
        }
    }
}

fn object(args: &VerifyResult, found: &Verification) -> String {
    let damage = found.damage.iter();
    let damage: Vec<_> =
        damage.map(|one| json!({ "file": one.path.to_string_lossy(), "what": one.what })).collect();
    let object = json!({
        "result": args.result.to_string_lossy(),
        "ok": found.damage.is_empty(),
        "checksums": found.has_checksums,
        "arrays": found.arrays,
        "chunks": found.chunks,
        "damage": damage,
    });
    format!("{object}\n")
}

fn text(args: &VerifyResult, found: &Verification) -> String {
    let mut text = String::new();
    for one in &found.damage {
        text += &format!("damaged  {}: {}\n", one.path.display(), one.what);
    }
    let read = format!("{} in {} chunks", counted(found.arrays, "array"), found.chunks);
    if found.damage.is_empty() && found.has_checksums {
        text += &format!("{}: {read}, all with their checksums\n", args.result.display());
    } else if found.damage.is_empty() {
        text += &format!(
            "{}: {read}, no damage found; an earlier version wrote it, without checksums of rows and documents\n",
            args.result.display()
        );
    }
    text
}
