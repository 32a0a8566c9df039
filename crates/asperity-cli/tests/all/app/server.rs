//! The application without a browser: who is answered, which names, which files; the queue of runs.

use std::path::Path;
use std::time::{Duration, Instant};

use asperity_io::store::Reader;
use serde_json::{Value, json};

use super::{App, raw};
use crate::asperity;

const CASE: &str = r#"title = "small"
[domain]
cells = [32, 32]
size = ["1 mm", "1 mm"]
[[surface]]
kind = "sphere"
radius = "5 mm"
[[body]]
poisson = 0.5
material = { model = "zener", shear = "1 MPa", shear_kelvin = "2 MPa", retardation_time = "3 s" }
[load]
control = "load"
history = { kind = "step", value = "0.5 N" }
[time]
end = "8 s"
steps = 8
[output]
fields = ["pressure"]
every = 4
"#;

fn folder() -> (tempfile::TempDir, std::path::PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let folder = directory.path().join("work");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(directory.path().join("secret.toml"), "secret").unwrap();
    std::fs::write(folder.join("small.toml"), CASE).unwrap();
    (directory, folder)
}

/// A long case: some minutes, if it is not stopped.
fn long() -> String {
    CASE.replace("[32, 32]", "[256, 256]").replace("steps = 8", "steps = 5000")
}

/// Waits until the first run of the list is in one of these states.
fn wait(app: &App, states: &[&str]) -> Value {
    let start = Instant::now();
    loop {
        let runs: Value = serde_json::from_str(&app.get("runs").1).unwrap();
        if states.contains(&runs[0]["state"].as_str().unwrap_or_default()) {
            return runs;
        }
        assert!(start.elapsed() < Duration::from_secs(120), "{runs}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

fn rows(result: &Path) -> usize {
    Reader::open(result).map_or(0, |reader| reader.len())
}

#[test]
fn only_its_own_page_is_answered() {
    let (_keep, folder) = folder();
    let app = App::start(&folder);
    let host = &app.host;
    let page = |head: &str| raw(host, &format!("GET /{}/ HTTP/1.1\r\n{head}\r\n", app.token), b"").0;
    assert_eq!(page(&format!("Host: {host}\r\n")), 200);
    assert_eq!(page(&format!("Host: {host}\r\nOrigin: http://{host}\r\n")), 200);
    // A page of another name that leads here, another site, another server of this machine, no name at all.
    for head in [
        "Host: example.org\r\n".to_owned(),
        format!("Host: {host}\r\nOrigin: http://example.org\r\n"),
        format!("Host: {host}\r\nOrigin: http://127.0.0.1:1\r\n"),
        format!("Host: {host}\r\nOrigin: null\r\n"),
        format!("Host: {host}\r\nSec-Fetch-Site: cross-site\r\n"),
        String::new(),
    ] {
        assert_eq!(page(&head), 403, "{head}");
    }
    for path in ["/", "/list", &format!("/{}/list", "0".repeat(32)), &format!("/{}", app.token)] {
        assert_eq!(raw(host, &format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n"), b"").0, 403, "{path}");
    }
    assert_eq!(app.ask("DELETE", "file/small.toml", "", b"").0, 405);
}

#[test]
fn no_name_leads_out_of_the_folder() {
    let (_keep, folder) = folder();
    #[cfg(unix)]
    std::os::unix::fs::symlink(folder.parent().unwrap(), folder.join("up")).unwrap();
    let app = App::start(&folder);
    assert!(app.get("file/small.toml").1.contains("small"));
    let outside = folder.parent().unwrap().join("secret.toml").display().to_string();
    for name in [
        "../secret.toml",
        "%2e%2e/secret.toml",
        "..%2fsecret.toml",
        &outside,
        "up/secret.toml",
        ".asperity-app/address",
    ] {
        for place in ["file", "text", "kind", "thumbnail", "result-of"] {
            let (status, content) = app.get(&format!("{place}/{name}"));
            assert!(status == 422 && !content.contains("\"secret\""), "{place}/{name}: {status} {content}");
        }
        let name = name.replace("%2e", ".").replace("%2f", "/");
        for action in [
            json!({ "do": "run", "case": name, "output": "r.zarr" }),
            json!({ "do": "run", "case": "small.toml", "output": name }),
            json!({ "do": "surface", "file": name }),
            json!({ "do": "export", "result": "small.toml", "to": "csv", "output": name }),
        ] {
            assert_eq!(app.post("do", &action).0, 422, "{action}");
        }
        let save = json!({ "name": name, "text": "", "before": "secret" });
        assert_eq!(app.post("save", &save).0, 422, "{name}");
    }
    assert_eq!(std::fs::read_to_string(outside).unwrap(), "secret");
    assert_eq!(app.get("look/look-..%2f..%2fsmall.toml").0, 404);
}

#[test]
fn what_is_dropped_replaces_nothing_and_has_a_limit() {
    let (_keep, folder) = folder();
    let app = App::start(&folder);
    let (status, name) = app.ask("POST", "upload?small.toml", "", b"other");
    assert_eq!((status, name.as_slice()), (200, &b"\"small-2.toml\""[..]));
    assert_eq!(std::fs::read_to_string(folder.join("small.toml")).unwrap(), CASE);
    assert_eq!(std::fs::read_to_string(folder.join("small-2.toml")).unwrap(), "other");
    for name in ["..%2fa.toml", ".hidden", "a%2fb.toml", ""] {
        assert_eq!(app.ask("POST", &format!("upload?{name}"), "", b"x").0, 422, "{name}");
    }
    // 10 GB are refused before any of it is taken.
    let head = format!(
        "POST /{}/upload?big.x3p HTTP/1.1\r\nHost: {}\r\nContent-Length: 10000000000\r\n\r\n",
        app.token, app.host
    );
    let (status, why) = raw(&app.host, &head, b"begin");
    assert!(status == 422 && String::from_utf8_lossy(&why).contains("copy it into the folder"), "{status}");
    // One that ends early leaves nothing.
    let head = head.replace("10000000000", "1000");
    let mut stream = std::net::TcpStream::connect(&app.host).unwrap();
    std::io::Write::write_all(&mut stream, format!("{head}begin").as_bytes()).unwrap();
    stream.shutdown(std::net::Shutdown::Write).unwrap();
    std::io::Read::read_to_end(&mut stream, &mut vec![]).unwrap();
    let names: Vec<_> = folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names.len(), 3, "two cases and the application's own folder: {names:?}");
}

#[test]
fn a_case_is_saved_unless_it_has_changed_since() {
    let (_keep, folder) = folder();
    let app = App::start(&folder);
    let save = |text: &str, before: Option<&str>| {
        app.post("save", &json!({ "name": "small.toml", "text": text, "before": before })).0
    };
    assert_eq!(save("first tab", Some(CASE)), 200);
    assert_eq!(save("second tab", Some(CASE)), 422, "the other tab has saved");
    assert_eq!(save("no text of before", None), 422);
    assert_eq!(std::fs::read_to_string(folder.join("small.toml")).unwrap(), "first tab");
    assert_eq!(app.post("save", &json!({ "name": "data.csv", "text": "" })).0, 422, "only cases are written");
}

#[test]
fn a_case_is_checked_while_it_is_typed() {
    let (_keep, folder) = folder();
    let app = App::start(&folder);
    let check = |text: &str| app.post("check", &json!({ "name": "small.toml", "text": text })).1;
    let told = check(CASE);
    assert_eq!(told["faults"], json!([]), "{told}");
    assert!(told["summary"].as_str().unwrap().contains("32 x 32 cells"), "{told}");
    assert!(told["keys"].as_array().unwrap().contains(&json!(["load.history.value", "0.5 N", 13])), "{told}");
    // Places count in 16 bits: "µ" is one of them, and two bytes.
    let wrong = CASE.replace("\"small\"", "\"µ\"").replace("\"5 mm\"", "\"5 N\"");
    let fault = &check(&wrong)["faults"][0];
    assert_eq!((&fault["line"], &fault["key"]), (&json!(7), &json!("surface[0].radius")), "{fault}");
    let units: Vec<u16> = wrong.encode_utf16().collect();
    let [from, to] = ["from", "to"].map(|end| usize::try_from(fault[end].as_u64().unwrap()).unwrap());
    assert_eq!(String::from_utf16(&units[from..to]).unwrap(), "\"5 N\"");
    // What lies outside may be read, as a run could, and is told.
    let outside =
        CASE.replace("kind = \"sphere\"\nradius = \"5 mm\"", "kind = \"file\"\npath = \"../heights.x3p\"");
    assert_eq!(check(&outside)["outside"], json!(["../heights.x3p"]));
    // Its result stays inside.
    for path in ["../out.zarr", "/tmp/out.zarr"] {
        std::fs::write(
            folder.join("out.toml"),
            CASE.replace("[output]", &format!("[output]\npath = \"{path}\"")),
        )
        .unwrap();
        let (status, why) = app.get("result-of/out.toml");
        assert!(status == 422 && why.contains("not in the folder"), "{path}: {why}");
    }
    assert_eq!(app.get("result-of/small.toml").1, "\"small.zarr\"");
}

#[test]
fn what_a_study_varies_is_checked() {
    let (_keep, folder) = folder();
    let app = App::start(&folder);
    let check = |more: &str, vary: &str| {
        let text = format!("{CASE}{more}");
        app.post("check", &json!({ "name": "small.toml", "text": text, "value": vary, "cost": true })).1
    };
    assert_eq!(check("", "load.history.value=1 N:2 N:3")["study"], json!({ "runs": 3 }));
    for (vary, why) in
        [("load.history.value=1 m,2 m", "unit of a length"), ("load.history.value=1 N:2 N", "how many")]
    {
        let told = check("", vary);
        assert!(told["study"]["error"].as_str().unwrap().contains(why), "{told}");
        assert_eq!(told["faults"], json!([]), "the case itself is right: {told}");
        let study = json!({ "do": "study", "case": "small.toml", "vary": vary, "output": "st" });
        let (status, told) = app.post("do", &study);
        assert!(status == 422 && told.as_str().unwrap().contains(why), "{told}");
    }
    let told = check("[study]\nvary = { \"load.history.value\" = [\"0.1 N\", \"1 m\"] }\n", "");
    let line = CASE.lines().count() + 2;
    assert_eq!(told["faults"][0]["line"], line, "{told}");
    assert!(told["faults"][0]["message"].as_str().unwrap().contains("1 m"), "{told}");
}

#[test]
fn a_run_with_faults_is_refused_with_the_first() {
    let (_keep, folder) = folder();
    std::fs::write(folder.join("wrong.toml"), CASE.replace("8 s", "8 N").replace("\"5 mm\"", "\"5 Pa\""))
        .unwrap();
    let app = App::start(&folder);
    let (status, told) = app.post("do", &json!({ "do": "run", "case": "wrong.toml", "output": "w.zarr" }));
    let told = told.as_str().unwrap();
    assert!(status == 422 && told.contains("line 7") && !told.contains("line 15"), "{told}");
    assert_eq!(app.get("runs").1, "[]");
}

#[test]
fn a_run_whose_case_has_changed_begins_anew() {
    let (_keep, folder) = folder();
    std::fs::write(folder.join("long.toml"), long()).unwrap();
    let app = App::start(&folder);
    assert_eq!(app.post("do", &json!({ "do": "run", "case": "long.toml", "output": "long.zarr" })).0, 200);
    let start = Instant::now();
    while rows(&folder.join("long.zarr")) < 3 {
        assert!(start.elapsed() < Duration::from_secs(120), "no rows");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(app.post("stop", &json!(1)).0, 200);
    assert_eq!(wait(&app, &["stopped"])[0]["changed"], json!([]));
    std::fs::write(folder.join("long.toml"), CASE).unwrap();
    let change = "domain.cells: [256, 256] → [32, 32]";
    let runs: Value = serde_json::from_str(&app.get("runs").1).unwrap();
    assert_eq!(runs[0]["changed"], json!([change, "time.steps: 5000 → 8"]));
    let resume = json!({ "do": "run", "case": "long.toml", "output": "long.zarr", "resume": true });
    for (status, told) in [app.post("do", &resume), app.post("again", &json!(1))] {
        assert!(status == 422 && told.as_str().unwrap().contains(change), "{told}");
    }
    // Its case is with the result, also where the file is another one by now.
    let origin: Value = serde_json::from_str(&app.get("origin/long.zarr").1).unwrap();
    assert_eq!((&origin["case"], &origin["text"]), (&json!("long.toml"), &json!(long())));
    assert_eq!(app.post("anew", &json!(1)).0, 200);
    let runs = wait(&app, &["done", "failed"]);
    assert_eq!((&runs[0]["state"], &runs[0]["result"]), (&json!("done"), &json!("long-2.zarr")), "{runs}");
    let origin: Value = serde_json::from_str(&app.get("origin/long-2.zarr").1).unwrap();
    assert_eq!((&origin["case"], &origin["changed"]), (&json!("long.toml"), &json!([])));
}

#[test]
fn two_files_of_one_name_at_a_time_are_both_kept() {
    let (_keep, folder) = folder();
    let app = App::start(&folder);
    let begin = |content: &str| {
        let mut stream = std::net::TcpStream::connect(&app.host).unwrap();
        let head = format!(
            "POST /{}/upload?data.csv HTTP/1.1\r\nHost: {}\r\nContent-Length: {}\r\n\r\n",
            app.token,
            app.host,
            content.len() + 1
        );
        std::io::Write::write_all(&mut stream, format!("{head}{content}").as_bytes()).unwrap();
        std::thread::sleep(Duration::from_millis(300));
        stream
    };
    let names = [begin("first"), begin("second")].map(|mut stream| {
        std::io::Write::write_all(&mut stream, b"!").unwrap();
        let mut answer = String::new();
        std::io::Read::read_to_string(&mut stream, &mut answer).unwrap();
        answer.rsplit_once("\r\n\r\n").unwrap().1.to_owned()
    });
    assert_eq!(names, ["\"data.csv\"", "\"data-2.csv\""]);
    let content = ["data.csv", "data-2.csv"].map(|name| std::fs::read_to_string(folder.join(name)).unwrap());
    assert_eq!(content, ["first!", "second!"]);
}

#[test]
fn its_own_folder_may_vanish() {
    let (_keep, folder) = folder();
    let app = App::start(&folder);
    let run = |output: &str| {
        std::fs::remove_dir_all(folder.join(".asperity-app")).unwrap();
        app.post("do", &json!({ "do": "run", "case": "small.toml", "output": output })).0
    };
    assert_eq!(run("a.zarr"), 200);
    assert_eq!(wait(&app, &["done", "failed"])[0]["state"], "done");
    let (_, done) =
        app.post("do", &json!({ "do": "report", "results": ["a.zarr"], "output": "a.html", "write": false }));
    assert_eq!(
        (&done["ok"], app.get(&format!("look/{}", done["picture"].as_str().unwrap())).0),
        (&json!(true), 200)
    );
}

/// The steps of a surface are drawn while they are typed: what is drawn in vain ends, and leaves nothing.
#[test]
fn a_later_look_of_a_page_ends_the_earlier_one() {
    let (_keep, folder) = folder();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/data/ground-steel.x3p");
    std::fs::copy(data, folder.join("s.x3p")).unwrap();
    let app = App::start(&folder);
    let look = |page: &str, cells: usize| {
        let op = format!("resample=bilinear cells={cells},{cells}");
        let action =
            json!({ "do": "process", "file": "s.x3p", "ops": [op], "output": "p.x3p", "write": false });
        let (_, done) = app.post(&format!("do?{page}"), &action);
        done["ok"] == true
    };
    // Far more points than are drawn in the time of a small one.
    let (large, of_another, small) = std::thread::scope(|scope| {
        let large = scope.spawn(|| look("one", 6000));
        let of_another = scope.spawn(|| look("two", 64));
        std::thread::sleep(Duration::from_millis(200));
        let small = look("one", 32);
        (large.join().unwrap(), of_another.join().unwrap(), small)
    });
    assert_eq!((large, of_another, small), (false, true, true));
    let files = |name: &std::path::PathBuf| name.read_dir().unwrap().map(|entry| entry.unwrap().file_name());
    let own = folder.join(".asperity-app").read_dir().unwrap().map(|entry| entry.unwrap().path());
    let kept: Vec<_> =
        own.filter(|path| path.is_dir()).flat_map(|path| files(&path).collect::<Vec<_>>()).collect();
    assert_eq!(kept, ["shown.svg", "shown.svg"], "only pictures");
}

#[test]
fn a_study_runs_and_results_are_exported() {
    let (_keep, folder) = folder();
    let app = App::start(&folder);
    let study = json!({ "do": "study", "case": "small.toml", "vary": "load.history.value=0.4 N,0.5 N", "output": "loads" });
    assert_eq!(app.post("do", &study).0, 200);
    let runs = wait(&app, &["done", "failed"]);
    assert_eq!(runs[0]["state"], "done", "{runs}");
    // The same command goes on with its folder, in which all is done by now.
    assert_eq!(app.post("again", &runs[0]["id"]).0, 200);
    assert_eq!(wait(&app, &["done", "failed"])[0]["state"], "done");
    let (_, table) = app.get("text/loads/study.csv");
    let table: String = serde_json::from_str(&table).unwrap();
    assert_eq!(table.lines().count(), 3, "{table}");
    let list: Value = serde_json::from_str(&app.get("list").1).unwrap();
    let of = |kind: &str| {
        list.as_array().unwrap().iter().filter(|entry| entry["kind"] == kind).collect::<Vec<_>>()
    };
    assert_eq!((of("study").len(), of("result").len()), (1, 2), "{list}");
    // The page of one of its results, its picture, and its export.
    let name = of("result")[0]["name"].as_str().unwrap();
    let encoded = name.replace(' ', "%20");
    assert!(app.get(&format!("live/{encoded}/")).1.contains("\"live\":true"));
    assert_eq!(app.get(&format!("live/{encoded}/state")).0, 200);
    assert_eq!(app.get(&format!("live/{encoded}/map/pressure-0")).0, 200);
    let picture = app.ask("GET", &format!("thumbnail/{encoded}"), "", b"").1;
    assert!(picture.starts_with(b"\x89PNG"));
    assert_eq!(picture[16..24], [0, 0, 0, 32, 0, 0, 0, 32], "a point for each of the 32 x 32 cells");
    let export = json!({ "do": "export", "result": name, "to": "csv", "output": "rows.csv" });
    let (_, done) = app.post("do", &export);
    assert!(done["ok"] == true && folder.join("rows.csv").is_file(), "{done}");
    assert_eq!(app.post("do", &export).0, 422, "it exists");
}

#[test]
fn a_second_application_is_told_of_the_first() {
    let (_keep, folder) = folder();
    let app = App::start(&folder);
    let second = asperity(&folder, &["app", "--no-open"]);
    let told = String::from_utf8_lossy(&second.stderr).into_owned();
    assert_eq!(second.status.code(), Some(2), "{told}");
    assert!(told.contains("another asperity app") && told.contains(&app.token), "{told}");
    app.kill();
    let again = App::start(&folder);
    assert_eq!(again.get("").0, 200, "the lock ends with the process");
}

#[test]
fn a_run_outlives_the_application_and_is_found_again() {
    let (_keep, folder) = folder();
    std::fs::write(folder.join("long.toml"), long()).unwrap();
    let app = App::start(&folder);
    let run =
        |case: &str, output: &str| app.post("do", &json!({ "do": "run", "case": case, "output": output }));
    assert_eq!(run("long.toml", "long.zarr").0, 200);
    // A second run of the same result is refused, one of another waits.
    let (status, why) = run("small.toml", "long.zarr");
    assert!(status == 422 && why.as_str().unwrap().contains("already"), "{why}");
    assert_eq!(run("small.toml", "small.zarr").0, 200);
    let result = folder.join("long.zarr");
    let start = Instant::now();
    while rows(&result) < 3 {
        assert!(start.elapsed() < Duration::from_secs(120), "no rows");
        std::thread::sleep(Duration::from_millis(20));
    }
    app.kill();
    let before = rows(&result);
    let app = App::start(&folder);
    let runs: Value = serde_json::from_str(&app.get("runs").1).unwrap();
    assert_eq!([&runs[0]["state"], &runs[1]["state"]], ["stopped", "running"], "{runs}");
    assert_eq!(app.post("again", &runs[0]["id"]).0, 200);
    let start = Instant::now();
    while rows(&result) <= before {
        assert!(start.elapsed() < Duration::from_secs(120), "the run ended with the application");
        std::thread::sleep(Duration::from_millis(20));
    }
    // Stopped, it leaves what it has, and the one that waits begins.
    assert_eq!(app.post("stop", &runs[1]["id"]).0, 200);
    let runs = wait(&app, &["done"]);
    assert_eq!(runs[1]["state"], "stopped", "{runs}");
    assert_eq!(rows(&folder.join("small.zarr")), 9);
    assert!(Reader::open(&result).unwrap().state().contains("--resume"));
    assert!(app.post("stop", &runs[1]["id"]).0 == 422, "it has ended");
}

#[test]
fn a_prepared_folder_starts_nothing_and_leads_nowhere() {
    let (keep, folder) = folder();
    let place = folder.join(".asperity-app");
    std::fs::create_dir(&place).unwrap();
    let waiting = |action: Value| {
        json!([{ "id": 1, "action": action, "shell": "asperity run small.toml -o b.zarr", "python": "", "case": "small.toml",
            "result": "b.zarr", "state": "waiting", "pid": null }])
    };
    let outside = json!({ "do": "run", "case": "small.toml", "output": "../b.zarr" });
    std::fs::write(place.join("runs.json"), waiting(outside).to_string()).unwrap();
    #[cfg(unix)]
    {
        std::fs::write(keep.path().join("lock"), "kept").unwrap();
        std::fs::write(keep.path().join("log"), "kept").unwrap();
        std::os::unix::fs::symlink(keep.path().join("lock"), place.join("lock")).unwrap();
        std::os::unix::fs::symlink(keep.path().join("log"), place.join("run-1.log")).unwrap();
        let pipe = std::process::Command::new("mkfifo").arg(folder.join("pipe.toml")).status().unwrap();
        assert!(pipe.success());
    }
    let app = App::start(&folder);
    // What waited is not begun; when it is asked for, its command line is made anew, and leads out of the folder no more.
    assert_eq!(wait(&app, &["waiting", "running", "done", "stopped"])[0]["state"], "stopped");
    assert_eq!(app.post("again", &json!(1)).0, 200);
    let runs = wait(&app, &["done", "failed"]);
    assert!(
        runs[0]["state"] == "failed" && runs[0]["log"].as_str().unwrap().contains("below the folder"),
        "{runs}"
    );
    assert!(!keep.path().join("b.zarr").exists());
    // A pipe is not waited for.
    assert_eq!(app.get("list").0, 200);
    assert_eq!(app.get("text/pipe.toml").0, 422);
    #[cfg(unix)]
    for name in ["lock", "log"] {
        assert_eq!(std::fs::read_to_string(keep.path().join(name)).unwrap(), "kept");
    }
}

#[cfg(unix)]
#[test]
fn a_saved_case_keeps_its_rights() {
    use std::os::unix::fs::PermissionsExt;
    let (_keep, folder) = folder();
    let path = folder.join("small.toml");
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o600)).unwrap();
    let app = App::start(&folder);
    let text = format!("{CASE}# more\n");
    assert_eq!(app.post("save", &json!({ "name": "small.toml", "text": text, "before": CASE })).0, 200);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    assert_eq!(path.metadata().unwrap().permissions().mode() & 0o777, 0o600);
}
