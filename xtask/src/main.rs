//! Tasks of the project: `cargo xtask test | golden | bench | peers | sanitize | miri | figures | verification | notices |
//! package | site | workflows | lines`.

mod golden;
mod lines;
mod lock;
mod notices;
mod package;
mod peers;
mod site;
mod surfaces;
mod workflows;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

const HELP: &str = "\
cargo xtask TASK

  test          format, lints, all tests, documentation, licences and advisories of the dependencies (where cargo-deny is
                installed), Python's view of the results; installs the Python packages that
                it needs below target/, and fails where it cannot, unless told --without-python
  golden        runs the cases of crates/asperity-io/tests/all/golden with two programs, golden OLD NEW, and says of each case whether
                the results have the same bits
  bench         times convolution, elastic contact, creep and surfaces, and prints tables (a quiet machine, please);
                with --quick up to 1024 x 1024 cells
  peers         times other programs and this one on the same surfaces, and writes target/peers/peers.md
  sanitize      tests the crate that holds the unsafe code under the address sanitizer (needs a nightly toolchain)
  miri          tests the same crates, without their instructions for one processor, in the interpreter Miri, which finds
                undefined behaviour (needs: rustup +nightly component add miri rust-src); hours
  figures       draws the pictures of the documentation
  verification  writes docs/verification.md from `asperity verify`
  notices       writes THIRD-PARTY-LICENSES.txt: the packages that the command and the Python package are linked with, and
                their licences; after every change of Cargo.lock
  package       makes the crates, the wheel, the source archive and the zipped program in target/packages, and tries them;
                with names, only these (crates, python, program); with --tag v1.2.3, first or only, asks whether the
                sources may be released under this tag
  workflows     compares the files for forge and archives with their schemas, and lints the workflows
  site          builds the documentation as web pages in target/site; with --check, looks at them in Chromium: links,
                formulas, search, phone width, errors
  lines         counts the lines of Rust and Python that are neither test nor comment nor blank, by crate and folder
";

/// What the Python side of the tests and figures imports.
const PYTHON_PACKAGES: [&str; 16] = [
    "numpy",
    "xarray",
    "zarr",
    "h5py",
    // the readers of exports: HDF5 and NetCDF by xarray
    "h5netcdf",
    "netCDF4",
    "scipy",
    "matplotlib",
    "maturin",
    "pytest",
    "mypy",
    // files of force curves
    "afmformats",
    // studies on a cluster, and the notebooks
    "distributed",
    "nbclient",
    "nbformat",
    "ipykernel",
];

/// The system's interpreter.
const PYTHON: &str = if cfg!(windows) { "python" } else { "python3" };

/// Other programs that tests and a notebook compare with; where they cannot be installed, these are skipped.
const PEERS: [&str; 3] = ["tamaas", "ContactMechanics", "SurfaceTopography"];

type Done = Result<(), String>;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let (task, words) = words.split_first().map_or((None, &[][..]), |(task, words)| (Some(task), words));
    let has = |option: &str| words.iter().any(|word| word == option);
    let done = match task.map(String::as_str) {
        Some("test") => test(has("--without-python")),
        Some("golden") => golden::golden(words),
        Some("bench") => bench(has("--quick")),
        Some("peers") => peers::peers(has("--quick")),
        Some("sanitize") => sanitize(),
        Some("miri") => miri(),
        Some("figures") => figures(),
        Some("verification") => verification(),
        Some("notices") => notices::notices(),
        Some("package") => package::package(words),
        Some("workflows") => workflows::workflows(),
        Some("lines") => lines::lines(),
        Some("site") => site::site(has("--check")),
        _ => {
            print!("{HELP}");
            return ExitCode::from(if task.is_none() { 0 } else { 2 });
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn run(command: &mut Command) -> Done {
    eprintln!("xtask: {command:?}");
    match command.current_dir(root()).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?} ended with {status}")),
        Err(error) => Err(format!("{command:?}: {error}")),
    }
}

/// What a command prints.
fn output(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|error| format!("{command:?}: {error}"))?;
    match output.status.success() {
        true => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
    }
}

/// What went wrong with a file.
fn at(path: impl AsRef<Path>) -> impl Fn(std::io::Error) -> String {
    move |error| format!("{}: {error}", path.as_ref().display())
}

/// Cargo of the nightly toolchain on the tests of the crates with unsafe code.
fn nightly(words: &[&str], target: &str) -> Command {
    let mut command = Command::new("rustup");
    command.args(["run", "nightly", "cargo"]).args(words);
    command.args(["-p", "asperity-sweep", "-p", "asperity-convolution", "--lib"]);
    command.env("CARGO_TARGET_DIR", root().join(target));
    command
}

fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    command.args(arguments).current_dir(root());
    command
}

fn test(without_python: bool) -> Done {
    run(&mut cargo(&["fmt", "--all", "--check"]))?;
    run(&mut cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))?;
    supply_chain()?;
    let mut tests = cargo(&["test", "--workspace", "--no-fail-fast"]);
    if without_python {
        eprintln!("xtask: the checks in Python are left out, as --without-python says");
    } else {
        let python = python()
            .map_err(|message| format!("{message} (--without-python leaves out what needs Python)"))?;
        package_tests(&python)?;
        // A test that finds this variable may not skip what needs Python.
        tests.env("ASPERITY_PYTHON", python);
    }
    run(cargo(&["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings"))?;
    // Last, so that the runner's closing lines close the output.
    run(&mut tests)
}

/// Licences, advisories and sources of the dependencies, by deny.toml. The list of advisories comes from the network.
fn supply_chain() -> Done {
    if output(&mut cargo(&["deny", "--version"])).is_err() {
        eprintln!("xtask: cargo-deny is not installed: licences and advisories are not checked");
        return Ok(());
    }
    run(&mut cargo(&["deny", "--workspace", "check"]))
}

/// A Python with the packages that the checks need, in a virtual environment below target/.
fn python() -> Result<PathBuf, String> {
    let python = interpreter("target/python");
    let imports = format!("import {}", PYTHON_PACKAGES.join(", "));
    let complete = output(Command::new(&python).args(["-c", &imports])).is_ok();
    let python = if complete { python } else { python_in("target/python", &PYTHON_PACKAGES)? };
    let imports = format!("import {}", PEERS.join(", "));
    if output(Command::new(&python).args(["-c", &imports])).is_err()
        && let Err(message) = python_in("target/python", &PEERS)
    {
        eprintln!("xtask: {message}: comparisons with these programs are left out");
    }
    Ok(python)
}

/// A Python in a virtual environment in this folder, with what pip installs by these words.
fn python_in(folder: &str, packages: &[&str]) -> Result<PathBuf, String> {
    let python = environment(folder)?;
    run(Command::new(&python).args(["-m", "pip", "install", "--quiet"]).args(packages))?;
    Ok(python)
}

/// A Python in a virtual environment in this folder.
fn environment(folder: &str) -> Result<PathBuf, String> {
    let python = interpreter(folder);
    if !python.exists() {
        run(Command::new(PYTHON).args(["-m", "venv"]).arg(root().join(folder)))?;
    }
    Ok(python)
}

fn interpreter(folder: &str) -> PathBuf {
    let programs = if cfg!(windows) { "Scripts" } else { "bin" };
    root().join(folder).join(programs).join(format!("python{}", std::env::consts::EXE_SUFFIX))
}

/// Builds the Python package with this profile of cargo, and returns its wheel.
fn wheel(python: &Path, profile: &str) -> Result<PathBuf, String> {
    let wheels = root().join("target/wheels");
    let _ = std::fs::remove_dir_all(&wheels);
    run(Command::new(python).args(["-m", "maturin", "build", "--profile", profile, "--out"]).arg(&wheels))?;
    package::files(&wheels, "whl")?.pop().ok_or_else(|| "maturin made no wheel".into())
}

/// Builds the Python package and installs it in the environment of `python`, which has what it needs.
fn install(python: &Path, profile: &str) -> Done {
    let wheel = wheel(python, profile)?;
    run(Command::new(python)
        .args(["-m", "pip", "install", "--quiet", "--force-reinstall", "--no-deps"])
        .arg(&wheel))
}

/// Installs the Python package in the environment of `python`, and tests it there.
fn package_tests(python: &Path) -> Done {
    // The test profile shares what the other tests compile.
    install(python, "dev")?;
    run(Command::new(python).args(["-m", "mypy", "--strict", "crates/asperity-py/python/asperity"]))?;
    run(Command::new(python).args(["-m", "mypy.stubtest", "asperity._core"]))?;
    // Its numbers are those of the command, which must be of the same source.
    run(&mut cargo(&["build", "-p", "asperity-cli"]))?;
    let command = root().join("target/debug").join(format!("asperity{}", std::env::consts::EXE_SUFFIX));
    run(Command::new(python)
        .args(["-m", "pytest", "-q", "crates/asperity-py/tests"])
        .env("ASPERITY_COMMAND", std::path::absolute(command).map_err(|error| error.to_string())?))
}

/// The tables of docs/performance.md: the convolution's forms, where the time of a contact goes, and whole runs with their files.
fn bench(quick: bool) -> Done {
    let sizes: &[&str] =
        if quick { &["256", "512", "1024"] } else { &["256", "512", "1024", "2048", "4096"] };
    let convolution =
        ["bench", "-p", "asperity-convolution", "--bench", "convolution", "--", "20", "256", "1024"];
    run(&mut cargo(&convolution))?;
    run(cargo(&["bench", "-p", "asperity", "--bench", "solver", "--"]).args(sizes))?;
    run(&mut cargo(&["bench", "-p", "asperity", "--bench", "sliding", "--", "256", "512"]))?;
    run(&mut cargo(&["build", "--release", "-p", "asperity-cli"]))?;
    let directory = root().join("target/bench");
    std::fs::create_dir_all(&directory).map_err(at(&directory))?;
    for case in ["hertz", "rough-pmma"] {
        run(Command::new(root().join("target/release/asperity"))
            .args(["run", "--quiet", "--force", "-o"])
            .arg(directory.join(format!("{case}.zarr")))
            .arg(root().join(format!("examples/{case}.toml"))))?;
    }
    surfaces::bench()
}

/// Every instruction set that this processor has, with reads and writes out of bounds told.
fn sanitize() -> Done {
    let mut tests = nightly(&["test", "--target", &package::host()?], "target/sanitize");
    run(tests.env("RUSTFLAGS", "-Zsanitizer=address"))
}

/// The parts with unsafe code in the interpreter Miri.
fn miri() -> Done {
    // It knows no vector instructions of one processor beyond the oldest: the portable forms run. The last bits of sin and
    // cos are random in it unless told otherwise, and tests compare the bits of transforms planned twice. The threads of rayon
    // never end.
    let flags =
        "-Zmiri-disable-isolation -Zmiri-tree-borrows -Zmiri-deterministic-floats -Zmiri-ignore-leaks";
    let mut tests = nightly(&["miri", "test"], "target/miri");
    run(tests.env("MIRIFLAGS", flags).env("PROPTEST_CASES", "1"))
}

fn figures() -> Done {
    run(&mut cargo(&["build", "--release", "-p", "asperity-cli"]))?;
    let result = root().join("target/figures/rough-pmma.zarr");
    std::fs::create_dir_all(root().join("target/figures")).map_err(|e| e.to_string())?;
    surfaces::figure()?;
    run(Command::new(root().join("target/release/asperity"))
        .args(["run", "--quiet", "--force", "examples/rough-pmma.toml", "-o"])
        .arg(&result))?;
    run(Command::new(python()?)
        .arg("docs/images/rough_pmma.py")
        .arg(&result)
        .arg("docs/images/rough-pmma.png"))?;
    let directory = root().join("target/figures/paper");
    let pictures = root().join("docs/images/paper");
    std::fs::create_dir_all(&pictures).map_err(|error| error.to_string())?;
    run(Command::new(root().join("target/release/asperity"))
        .args(["reproduce", "--force", "-o"])
        .arg(&directory))?;
    for n in 1..=8 {
        let name = format!("figure-{n}.png");
        let to = pictures.join(&name);
        std::fs::copy(directory.join(&name), &to).map_err(at(&to))?;
    }
    Ok(())
}

const VERIFICATION: &str = "\
# Verification

Written by `cargo xtask verification` from `asperity verify`. Every quantity is compared with an expected value that
does not come from the solver. An error is |found/expected - 1| unless the quantity says otherwise. The tolerances
follow from the discretisation (approach and peak pressure converge as (dx/a)², an area is known to a part of its
outermost ring of cells) or, for an invariant, from the solver's tolerance; they do not depend on the error found.
The test `every_case_holds` of the crate `asperity-verify` asserts all of them. Further tests compare with slow reference
implementations (dense matrix, Gauss-Seidel, full hereditary sum, one-dimensional springs).

";

const ERROR_BARS: &str = "
## Stated against true errors of answers

The test `error_bars` finds the error bars of 100 random cases with closed forms (32 to 80 cells a side, 64 to 320 on lines), as
`asperity converge` does: spheres under a load (Hertz) and under one that rises and falls (Ting, 8 to 80 steps), waves in partial contact
(Westergaard), a cylinder that slides on a viscoelastic body (Hunter), and the flow along the furrows of a wave in contact. An answer is
covered if its stated error is at least its true one; it is close if its stated error is at most ten times the true one, or at most 1e-3 of
the answer. `unknown` are answers whose error is stated as not known. The test asserts that 95 of 100 answers are known, and that 95 of 100 of these are
covered.

| case | answers | covered | close | unknown |
|---|---|---|---|---|
";

const TIME_ERRORS: &str = "\
## Stated against true errors of the time steps

The test `time_error` runs 50 random cases of each of six classes, from seeds that no number was chosen with: a cylinder, every other
one rough, on a free line under a load, on a periodic line, and moving along one; a sphere, every other one rough; waves all over a periodic square; a
sphere that adheres, in and out again. The bodies have 1 to 4 terms with E(0)/E(infinity) from 2 to 3000 (with adhesion to 40). Load or approach run
straight between 2 to 5 points, some with jumps, or along a sine; the steps are uniform or logarithmic (5 to 500), or adaptive with a tolerance of
1e-4 to 3e-2. Lines have 48 cells, squares 18 x 18. The reference takes 16 steps in place of each, so that its own error is 256 times smaller.

A case is covered if the largest `time_error` of its rows is at least its largest error of the load, of the largest pressure, and of the stress
history of a body whose Poisson's ratio changes (or these are below 1e-6, the tolerance of the solver). A load below a hundredth of the largest one
is measured by that hundredth. A case is close if the largest `time_error` is at most ten times the largest of these errors and those of the pressure
fields, or at most 1e-3. Adaptive steps are within their tolerance if these errors are.

Most cases that are not covered have a cell at the rim that has just touched: on a stiff body it carries the largest pressure, and a touch that
comes a little early or late in a step shows there at once. With adhesion this cell has an estimate of its own, which is seldom close: it takes the
touch at the worst moment of the step. The two that are left: a stress history under a moving line, 1.8 times its bar, and a sphere off by 5.5e-6, where
no error is stated. Of 300 cases from other seeds a line under a load that had fallen to a tenth missed by 20 times (1.5e-3 of the largest pressure):
its cells remember more than the rows say. The test asserts that 95 of 100 of each class are covered, that 65 of 100 are close, and that 90 of 100
adaptive runs are within.

| class | cases | covered | close | adaptive | within tolerance |
|---|---|---|---|---|---|
";

fn verification() -> Done {
    run(&mut cargo(&["build", "--release", "-p", "asperity-cli"]))?;
    let program = root().join("target/release/asperity");
    let cases = output(Command::new(program).args(["verify", "--markdown"]))?;
    let times = rows_of_test("asperity", "time_error")?;
    let bars = rows_of_test("asperity-io", "error_bars::the_stated")?;
    let text = format!("{VERIFICATION}{cases}{TIME_ERRORS}{times}\n{ERROR_BARS}{bars}\n");
    std::fs::write(root().join("docs/verification.md"), text).map_err(|error| error.to_string())
}

/// The rows of the table that a test prints.
fn rows_of_test(package: &str, test: &str) -> Result<String, String> {
    let found = cargo(&["test", "-p", package, "--test", "all", test, "--", "--nocapture"])
        .env("ASPERITY_ERROR_BARS", "100")
        .output()
        .map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&found.stdout);
    match found.status.success() {
        true => Ok(text.lines().filter(|line| line.starts_with("| ")).collect::<Vec<_>>().join("\n")),
        false => Err(text.into_owned()),
    }
}
