//! `asperity app`: a page in the browser on a folder of cases, data and results.
//!
//! The page asks for command lines of this program, which run as processes of their own; only the check of a case while it is
//! typed, lists and pictures are made here. What can be asked for is an [`Action`]; names of files are those below the folder.

mod action;
mod case;
mod folder;
mod jobs;

use std::fs::{self, File};
use std::io::Read;
use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use asperity_examples::{TEMPLATES, Template};
use asperity_io::case::{schema, with_key};
use asperity_io::store::Reader;
use asperity_report::page::{Live, STYLE};
use asperity_report::thumbnail;
use serde::Deserialize;
use serde_json::{Value, json};

use self::action::{Action, Choice, FIT, INDENTATION, SPECTRUM, SURFACE};
use self::folder::{Folder, LARGEST};
use self::jobs::Jobs;
use super::view::page_of;
use crate::args::App;
use crate::failure::{Failure, refuse};
use crate::serve::{self, Body, FOREIGN, Request, Response, Site};
use crate::verb::Verb;

/// The page; its script is several files, in the order in which they use one another.
const PAGE: &str = include_str!("../../../page/page.html");
const OWN_STYLE: &str = include_str!("../../../page/style.css");
const SCRIPT: [&str; 7] = [
    include_str!("../../../page/tools.js"),
    include_str!("../../../page/start.js"),
    include_str!("../../../page/completion.js"),
    include_str!("../../../page/case.js"),
    include_str!("../../../page/runs.js"),
    include_str!("../../../page/data.js"),
    include_str!("../../../page/main.js"),
];
/// The editor: see `crates/asperity-cli/page/codemirror/README.md`.
const EDITOR: &str = include_str!("../../../page/codemirror/codemirror.iife.min.js");
const EDITOR_LICENSE: &str = include_str!("../../../page/codemirror/LICENSE-CodeMirror");

/// The application's own folder, below the one that it works on.
const PLACE: &str = ".asperity-app";
/// Pictures that are kept for looking at, and processes that draw them at a time.
const LOOKS: u64 = 64;
const DRAWN: usize = 4;
/// Largest text that a page sends \[bytes\].
const LARGEST_TEXT: u64 = 16 << 20;

impl Verb for App {
    /// Serves until it is interrupted.
    fn run(&self) -> Result<(), Failure> {
        let folder = Folder::open(&self.folder)?;
        let place = own_place(&folder)?;
        let _lock = alone(&folder, &place)?;
        jobs::sweep(&place);
        let opened = serve::open(IpAddr::V4(Ipv4Addr::LOCALHOST), self.port)?;
        private(&place.join("address"), &opened.address)?;
        let jobs = Jobs::start(&folder, place.clone())?;
        crate::print(&format!("{}\n", opened.address))?;
        crate::messages::message!(
            "this page works on {}; who knows its address can read and write there; press Ctrl-C to stop: runs go on",
            folder.path().display()
        );
        if !self.no_open {
            open_browser(&opened.address);
        }
        let (number, looks) = (AtomicU64::new(0), Mutex::default());
        opened.serve(Application { folder, place, jobs, number, looks })
    }
}

/// The folder for logs, the queue and what is only looked at; a link in its place is refused.
fn own_place(folder: &Folder) -> Result<PathBuf, Failure> {
    let place = folder.path().join(PLACE);
    let failed = |why: String| Failure::input(format!("cannot use {}: {why}", place.display()));
    match fs::create_dir(&place) {
        Err(error) if error.kind() != std::io::ErrorKind::AlreadyExists => Err(failed(error.to_string())),
        _ if place.symlink_metadata().is_ok_and(|data| data.is_dir()) => Ok(place),
        _ => Err(failed("it is no folder; remove it".to_owned())),
    }
}

/// The lock of the only application on a folder.
fn alone(folder: &Folder, place: &Path) -> Result<File, Failure> {
    let lock = jobs::own_file(&place.join("lock"))?;
    match lock.try_lock() {
        Ok(()) => Ok(lock),
        Err(_) => {
            let address = fs::read_to_string(place.join("address")).unwrap_or_default();
            let there = if address.is_empty() { String::new() } else { format!(" at {address}") };
            refuse!(
                "{} is open in another asperity app{there}; use that one, or stop it first",
                folder.path().display()
            )
        }
    }
}

/// Writes a file that only this user can read.
fn private(path: &Path, text: &str) -> Result<(), Failure> {
    let _ = fs::remove_file(path);
    let mut options = File::options();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    Ok(std::io::Write::write_all(&mut options.open(path)?, text.as_bytes())?)
}

/// Opens the address in the user's browser, where the system has a way; it is printed in any case.
fn open_browser(address: &str) {
    let words: &[&str] = match std::env::consts::OS {
        "macos" => &["open"],
        "windows" => &["rundll32", "url.dll,FileProtocolHandler"],
        _ => &["xdg-open"],
    };
    let mut command = std::process::Command::new(words[0]);
    command.args(&words[1..]).arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    if let Ok(mut child) = command.spawn() {
        // Waited for, so that it does not stay as a dead process.
        std::thread::spawn(move || child.wait());
    }
}

struct Application {
    folder: Folder,
    place: PathBuf,
    jobs: Jobs,
    /// Of the last picture that was drawn for looking at.
    number: AtomicU64,
    /// The processes that draw, each with its page.
    looks: Mutex<Vec<(String, Arc<Mutex<Child>>)>>,
}

/// What a page sends.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Edit {
    name: String,
    text: String,
    #[serde(default)]
    cost: bool,
    before: Option<String>,
    #[serde(default)]
    key: String,
    /// Of the key; or what a study varies.
    #[serde(default)]
    value: String,
}

impl Site for Application {
    fn methods(&self) -> &'static [&'static str] {
        &["GET", "POST"]
    }

    fn answer(&self, request: &Request, path: &str, body: Body<'_>) -> Response {
        let answer = match request.method.as_str() {
            "POST" => self.post(request, path, body).map(|value| json_of(&value)),
            _ => self.get(path),
        };
        answer.unwrap_or_else(|error| Response::text("422 Unprocessable Content", &error))
    }
}

impl Application {
    fn get(&self, path: &str) -> Result<Response, String> {
        let path = decoded(path);
        let (place, name) = path[1..].split_once('/').unwrap_or((&path[1..], ""));
        let nothing = || Response::text("404 Not Found", "there is nothing here");
        Ok(match place {
            "" => Response::of("text/html; charset=utf-8", page(&self.folder)),
            "editor.js" => Response::of("text/javascript; charset=utf-8", EDITOR),
            "list" => json_of(&self.folder.list()),
            "runs" => json_of(&self.jobs.told()),
            "schema" => json_of(&schema()),
            "starter" => {
                let template = name.strip_suffix(".png").and_then(Template::find);
                template.map_or_else(nothing, |template| Response::of("image/png", template.picture))
            }
            "kind" => json_of(&json!(self.folder.kind_of(name)?)),
            "free" => json_of(&json!(self.folder.free(name)?)),
            "result-of" => json_of(&json!(case::result_name(&self.folder, name)?)),
            "origin" => json_of(&case::origin(&self.folder, name, self.jobs.case_of(name))?),
            "text" => json_of(&json!(text(&self.folder.find(name)?)?)),
            "thumbnail" => {
                let reader = Reader::open(&self.folder.find(name)?).map_err(|error| error.to_string())?;
                Response::of("image/png", thumbnail(&reader).map_err(|error| error.to_string())?)
            }
            // The page of a result ends with a slash, and asks for its parts below.
            "live" => {
                let is_result = |at: &usize| {
                    self.folder.find(&name[..*at]).is_ok_and(|path| path.join("zarr.json").is_file())
                };
                let ends = name.match_indices('/').map(|(at, _)| at);
                let end = { ends }.find(is_result).ok_or("there is no such result")?;
                page_of(&Live::new(&self.folder.find(&name[..end])?), &name[end..])
            }
            "file" => foreign(&self.folder.find(name)?)?,
            "look" => match name.split_once('/') {
                Some((look, file)) if is_look(look) && ["shown.svg", "shown.html"].contains(&file) => {
                    foreign(&self.place.join(look).join(file))?
                }
                _ => nothing(),
            },
            _ => nothing(),
        })
    }

    fn post(&self, request: &Request, path: &str, body: Body<'_>) -> Result<Value, String> {
        if path == "/upload" {
            return self.folder.take(&decoded(&request.query), request.length, body).map(Value::from);
        }
        if request.length > LARGEST_TEXT {
            return Err(format!("more than {} bytes", LARGEST_TEXT));
        }
        let mut text = vec![];
        body.take(LARGEST_TEXT).read_to_end(&mut text).map_err(|error| error.to_string())?;
        let unread = |error: serde_json::Error| format!("the request is not understood: {error}");
        match path {
            "/do" => self.carry_out(&serde_json::from_slice(&text).map_err(unread)?, &request.query),
            "/leave" => Ok(json!(self.end_looks(&request.query, DRAWN))),
            "/anew" => {
                let action = self.jobs.action(serde_json::from_slice(&text).map_err(unread)?)?;
                let output = action.run().map(|[_, output]| self.folder.free(output)).transpose()?;
                self.carry_out(&action.again(output), "")
            }
            "/stop" => self.jobs.stop(serde_json::from_slice(&text).map_err(unread)?).map(|()| json!(true)),
            "/again" => self.jobs.again(serde_json::from_slice(&text).map_err(unread)?).map(|()| json!(true)),
            "/check" | "/save" | "/set" => {
                let Edit { name, text, cost, before, key, value } =
                    serde_json::from_slice(&text).map_err(unread)?;
                match path {
                    "/check" => case::checked(&self.folder, &name, &text, &value, cost),
                    "/save" => {
                        case::save(&self.folder, &name, &text, before.as_deref()).map(|()| json!(true))
                    }
                    _ => with_key(&text, &key, &value).map(Value::from),
                }
            }
            _ => Err("there is nothing here".to_owned()),
        }
    }

    /// Ends what a page looks at, and the oldest looks beyond so many.
    fn end_looks(&self, page: &str, most: usize) {
        let mut looks = self.looks.lock().unwrap_or_else(PoisonError::into_inner);
        let over = looks.len().saturating_sub(most);
        let mut n = 0;
        looks.retain(|(of, child)| {
            n += 1;
            let is_kept = of != page && n > over;
            if !is_kept {
                let _ = child.lock().unwrap_or_else(PoisonError::into_inner).kill();
            }
            is_kept
        });
    }

    /// Runs a command line, or puts it into the queue. What a page looks at ends with its next look.
    fn carry_out(&self, action: &Action, page: &str) -> Result<Value, String> {
        let number = self.number.fetch_add(1, Ordering::Relaxed);
        let look = look_of(number);
        let line = action.line(&self.folder, &format!("{PLACE}/{look}"))?;
        let (shell, python) = (line.in_shell(), line.in_python());
        if action.run().is_some() {
            case::ready(&self.folder, action)?;
            return self.jobs.add(action.clone(), shell, python).map(|id| json!({ "run": id }));
        }
        let failed = |error: std::io::Error| format!("cannot run the command: {error}");
        let own = self.place.join(&look);
        if line.draws.is_some() {
            // Both, as the place may have been removed meanwhile.
            fs::create_dir_all(&own).map_err(failed)?;
        }
        let mut command = jobs::program().map_err(failed)?;
        command.args(line.words()).current_dir(self.folder.path()).stdin(Stdio::null());
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().map_err(failed)?;
        let (out, told) = (child.stdout.take(), child.stderr.take());
        let child = Arc::new(Mutex::new(child));
        if action.looks() {
            self.end_looks(page, DRAWN - 1);
            let mut looks = self.looks.lock().unwrap_or_else(PoisonError::into_inner);
            looks.push((page.to_owned(), child.clone()));
        }
        let told = std::thread::spawn(move || all_of(told));
        let out = all_of(out);
        let told = told.join().unwrap_or_default();
        let done = child.lock().unwrap_or_else(PoisonError::into_inner).wait().map_err(failed)?;
        let mut looks = self.looks.lock().unwrap_or_else(PoisonError::into_inner);
        looks.retain(|(_, other)| !Arc::ptr_eq(other, &child));
        drop(looks);
        // Heights that were only looked at may be large; pictures are asked for soon or never.
        let others = own.read_dir().into_iter().flatten().flatten();
        others.filter(|entry| line.draws.is_none_or(|name| entry.file_name() != name)).for_each(|entry| {
            let _ = fs::remove_file(entry.path());
        });
        // Where nothing was drawn.
        let _ = fs::remove_dir(&own);
        let _ = fs::remove_dir_all(self.place.join(look_of(number.wrapping_sub(LOOKS))));
        let picture = line.draws.filter(|name| own.join(name).is_file());
        Ok(json!({
            "shell": shell,
            "python": python,
            "ok": done.success(),
            "json": serde_json::from_str::<Value>(&out).ok(),
            "out": out,
            "told": told.replace(&format!("{PLACE}/{look}/"), ""),
            "picture": picture.map(|name| format!("{look}/{name}")),
        }))
    }
}

/// All that a process writes there.
fn all_of(pipe: Option<impl Read>) -> String {
    let mut bytes = vec![];
    let _ = pipe.map(|mut pipe| pipe.read_to_end(&mut bytes));
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The folder of what is only looked at, by its number.
fn look_of(number: u64) -> String {
    format!("look-{}-{number}", std::process::id())
}

/// Whether this is the name of such a folder.
fn is_look(name: &str) -> bool {
    name.strip_prefix("look-").is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit() || c == '-'))
}

fn json_of(value: &Value) -> Response {
    Response::of("application/json", value.to_string())
}

/// The page with what it knows from the start.
fn page(folder: &Folder) -> String {
    let choices = |list: &[Choice]| json!(list);
    let starters: Vec<_> = TEMPLATES.iter().map(|t| json!([t.name, t.title()])).collect();
    let known = json!({
        "folder": folder.path().display().to_string(),
        "starters": starters,
        "options": { "surface": choices(SURFACE), "spectrum": choices(SPECTRUM), "fit": choices(FIT), "indentation": choices(INDENTATION) },
    });
    let parts = [
        ("style", format!("{STYLE}{OWN_STYLE}")),
        ("license", EDITOR_LICENSE.replace('<', "&lt;")),
        ("known", known.to_string().replace('<', "\\u003c")),
        ("script", SCRIPT.concat()),
    ];
    let mut page = PAGE.to_owned();
    for (name, part) in parts {
        page = page.replacen(&format!("{{{{{name}}}}}"), &part, 1);
    }
    page
}

fn text(path: &Path) -> Result<String, String> {
    let file = File::open(path).map_err(|error| error.to_string())?;
    if file.metadata().is_ok_and(|data| data.len() > LARGEST_TEXT) {
        return Err("this text is too large to be shown; open it in an editor".to_owned());
    }
    let mut text = String::new();
    file.take(LARGEST_TEXT).read_to_string(&mut text).map_err(|_| "this is no text in UTF-8".to_owned())?;
    Ok(text)
}

/// A file that others may have written, as it is.
fn foreign(path: &Path) -> Result<Response, String> {
    let size = path.metadata().map_err(|error| error.to_string())?;
    if !size.is_file() || size.len() > LARGEST {
        return Err("this is no file, or too large to be shown; open it from the folder".to_owned());
    }
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let content_type = match ending.as_str() {
        "html" => "text/html; charset=utf-8",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "gif" => "image/gif",
        "jpg" => "image/jpeg",
        "pdf" => "application/pdf",
        "toml" | "csv" | "txt" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    };
    let content = fs::read(path).map_err(|error| error.to_string())?;
    Ok(Response { policy: FOREIGN, ..Response::of(content_type, content) })
}

/// The text of a part of an address, in which bytes may be written as "%20".
fn decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let code = after.get(..2).and_then(|two| std::str::from_utf8(two).ok());
        let code = code.filter(|_| *first == b'%').and_then(|two| u8::from_str_radix(two, 16).ok());
        bytes.push(code.unwrap_or(*first));
        rest = if code.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::decoded;

    #[test]
    fn bytes_of_an_address_are_decoded() {
        assert_eq!(decoded("/text/a%20b%C2%B5.toml"), "/text/a bµ.toml");
        assert_eq!(decoded("100%"), "100%");
        assert_eq!(decoded("%zz%4"), "%zz%4");
    }
}
