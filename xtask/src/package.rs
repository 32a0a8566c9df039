//! `cargo xtask package`: what a release consists of, as far as one machine can make it: crates, wheel and source archive for
//! Python, and the zipped program. Nothing is published.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{Done, PYTHON, at, cargo, output, python_in, root, run};

/// What can be packaged, and how.
type Part = (&'static str, fn() -> Done);

const PARTS: [Part; 3] = [("crates", crates), ("python", python), ("program", program)];

/// Members of the workspace that are not published as crates.
const UNPUBLISHED: [&str; 2] = ["asperity-py", "xtask"];

/// Makes the parts that are named, or all; `--tag v1.2.3` first asks whether the sources may be released under this tag.
pub fn package(arguments: &[String]) -> Done {
    let mut words = arguments.iter();
    let mut wanted = Vec::new();
    while let Some(word) = words.next() {
        if word == "--tag" {
            releasable(words.next().ok_or("--tag needs a tag, such as v1.2.3")?)?;
            if arguments.len() == 2 {
                return Ok(());
            }
        } else {
            let part = PARTS.iter().find(|(name, _)| name == word);
            wanted.push(part.ok_or_else(|| format!("no part {word}: crates, python or program"))?);
        }
    }
    if wanted.is_empty() {
        wanted.extend(&PARTS);
    }
    for (_, make) in &wanted {
        make()?;
    }
    eprintln!(
        "xtask: packages are in {}; wheels and programs of other systems, the container and the conda package are made by \
         the workflow of a release",
        folder()?.display()
    );
    Ok(())
}

/// The files of a folder with this ending.
pub fn files(folder: &Path, ending: &str) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(at(&folder))?;
    let paths = entries.flatten().map(|entry| entry.path());
    Ok(paths.filter(|path| path.to_string_lossy().ends_with(&format!(".{ending}"))).collect())
}

/// Where packages go: target/packages.
fn folder() -> Result<PathBuf, String> {
    let folder = root().join("target/packages");
    std::fs::create_dir_all(&folder).map_err(at(&folder))?;
    std::path::absolute(folder).map_err(|error| error.to_string())
}

/// The tag is the version's, the address of the repository is filled in everywhere, and the changelog has a date.
fn releasable(tag: &str) -> Done {
    let version = env!("CARGO_PKG_VERSION");
    if tag != format!("v{version}") {
        return Err(format!("the tag is {tag}, the version in Cargo.toml {version}"));
    }
    let read = |name| std::fs::read_to_string(root().join(name)).map_err(|error| format!("{name}: {error}"));
    let manifest = read("Cargo.toml")?;
    let address = manifest.lines().find_map(|line| line.strip_prefix("repository = \"")?.strip_suffix('"'));
    let address = address.filter(|address| address.starts_with("https://"));
    let address = address.ok_or("Cargo.toml: `repository` needs the address of the repository")?;
    for (file, key) in [
        ("pyproject.toml", format!("\nSource = \"{address}\"")),
        ("CITATION.cff", format!("\nrepository-code: {address}\n")),
        ("codemeta.json", format!("\"codeRepository\": \"{address}\"")),
        ("packaging/conda/recipe.yaml", format!("\n  repository: {address}\n")),
    ] {
        if !read(file)?.contains(&key) {
            return Err(format!("{file} needs the address of the repository: {}", key.trim()));
        }
    }
    let heading = format!("## [{version}] - ");
    let changelog = read("CHANGELOG.md")?;
    let date = changelog.lines().find_map(|line| line.strip_prefix(&heading));
    let date = date.filter(|date| date.starts_with(|c: char| c.is_ascii_digit()));
    let date = date.ok_or_else(|| {
        format!("CHANGELOG.md: version {version} needs its date, as in `{heading}2030-01-31`")
    })?;
    if !read("CITATION.cff")?.contains(&format!("\ndate-released: {date}\n")) {
        return Err(format!("CITATION.cff needs the date: date-released: {date}"));
    }
    Ok(())
}

/// Folders of this machine, and what stands for them in what is handed out: a later one counts where two fit.
fn folders() -> Result<Vec<(String, &'static str)>, String> {
    let compiler = PathBuf::from(output(Command::new("rustc").args(["--print", "sysroot"]))?.trim());
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a folder");
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(std::env::home_dir()?.join(".cargo"))).ok_or("no home folder")?;
    // Their names say which registry the packages came from.
    let registries = std::fs::read_dir(home.join("registry/src")).into_iter().flatten().flatten();
    let registries: Vec<PathBuf> = registries.map(|entry| entry.path()).collect();
    let mut folders = vec![(compiler, "/rust"), (sources.to_owned(), "/asperity"), (home, "/cargo")];
    folders.extend(registries.into_iter().map(|folder| (folder, "/cargo")));
    let folders = folders.into_iter().map(|(folder, name)| (folder.to_string_lossy().into_owned(), name));
    // A space would end the option.
    Ok(folders.filter(|(folder, _)| !folder.contains(' ')).collect())
}

/// Lets the compiler name no folder of this machine, as it does in messages of panics. The options are added to those that hold.
fn portable(command: &mut Command) -> Result<&mut Command, String> {
    run(&mut cargo(&["fetch", "--quiet", "--locked"]))?;
    let variable =
        if std::env::var_os("RUSTFLAGS").is_some() { "RUSTFLAGS" } else { "CARGO_BUILD_RUSTFLAGS" };
    let mut options = std::env::var(variable).unwrap_or_default();
    for (folder, name) in folders()? {
        options += &format!(" --remap-path-prefix={folder}={name}");
    }
    Ok(command.env(variable, options.trim()))
}

/// What is handed out has no table of symbols and names no folder of this machine.
fn presentable(program: &Path) -> Done {
    let bytes = std::fs::read(program).map_err(at(&program))?;
    let has = |text: &str| bytes.windows(text.len()).any(|part| part == text.as_bytes());
    if has("\0.symtab\0") {
        return Err(format!("{}: it has a table of symbols", program.display()));
    }
    match folders()?.into_iter().find(|(folder, _)| has(folder)) {
        Some((folder, _)) => Err(format!("{}: it names the folder {folder}", program.display())),
        None => Ok(()),
    }
}

/// The crates as they are published, each compiled from its package alone.
fn crates() -> Done {
    let mut package = cargo(&["package", "--workspace", "--locked", "--allow-dirty"]);
    package.args(UNPUBLISHED.iter().flat_map(|name| ["--exclude", name]));
    run(package.arg("--target-dir").arg(root().join("target/packages/build")))?;
    let packed = folder()?.join("build/package");
    for path in files(&packed, "crate")? {
        let list = output(Command::new("tar").arg("tzf").arg(&path))?;
        for file in ["LICENSE-MIT", "LICENSE-APACHE", "README.md", "Cargo.toml"] {
            if !list.lines().any(|line| line.ends_with(&format!("/{file}"))) {
                return Err(format!("{}: there is no {file} in it", path.display()));
            }
        }
        let to = folder()?.join(path.file_name().expect("a file"));
        std::fs::copy(&path, &to).map_err(at(&to))?;
    }
    Ok(())
}

/// The source archive, and the wheel of this machine made from it alone; the wheel is tested from outside of the source tree.
fn python() -> Done {
    let folder = folder()?;
    for old in files(&folder, "tar.gz")?.into_iter().chain(files(&folder, "whl")?) {
        std::fs::remove_file(&old).map_err(at(&old))?;
    }
    let maker = python_in("target/packages/maker", &["maturin>=1.9,<2"])?;
    run(Command::new(&maker).args(["-m", "maturin", "sdist", "--out"]).arg(&folder))?;
    let mut pip = Command::new(&maker);
    pip.args(["-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir"]).arg(&folder);
    run(portable(pip.args(files(&folder, "tar.gz")?))?.env("CARGO_TARGET_DIR", folder.join("build")))?;
    // An environment of its own: only what the wheel asks for is there.
    let environment = root().join("target/packages/user");
    let _ = std::fs::remove_dir_all(&environment);
    let user = python_in("target/packages/user", &["pytest"])?;
    run(Command::new(&user).args(["-m", "pip", "install", "--quiet"]).args(files(&folder, "whl")?))?;
    let module = "import asperity._core as module; print(module.__file__)";
    let module = output(Command::new(&user).args(["-c", module]).current_dir(&environment))?;
    presentable(Path::new(module.trim()))?;
    let tests = root().join("crates/asperity-py/tests/test_command.py");
    let test = std::path::absolute(tests).map_err(|error| error.to_string())?;
    let mut pytest = Command::new(&user);
    pytest.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir"]).arg(&environment).arg(test);
    // `run` would go to the root of the sources.
    eprintln!("xtask: {pytest:?}");
    let status = pytest.current_dir(&environment).status().map_err(|error| error.to_string())?;
    if status.success() { Ok(()) } else { Err(format!("the wheel fails its tests: {status}")) }
}

/// The program with its licences, and the cases and data that the documentation uses, zipped.
fn program() -> Done {
    let mut build = cargo(&["build", "--release", "--locked", "-p", "asperity-cli", "--target-dir"]);
    run(portable(build.arg(folder()?.join("build")))?)?;
    let name = format!("asperity-{}-{}", env!("CARGO_PKG_VERSION"), host()?);
    let folder = folder()?;
    let inside = folder.join(&name);
    let copy_to = |folder: &str, from: PathBuf| -> Done {
        let to = inside.join(folder);
        std::fs::create_dir_all(&to).map_err(at(&to))?;
        let to = to.join(from.file_name().expect("a file"));
        std::fs::copy(&from, &to).map(drop).map_err(at(&from))
    };
    let copy = |from: PathBuf| copy_to("", from);
    let program = folder.join(format!("build/release/asperity{}", std::env::consts::EXE_SUFFIX));
    presentable(&program)?;
    copy(program)?;
    for file in [
        "LICENSE-MIT",
        "LICENSE-APACHE",
        "THIRD-PARTY-LICENSES.txt",
        "CHANGELOG.md",
        "crates/asperity-cli/README.md",
        "crates/asperity-report/fonts/LICENSE-DejaVu",
        "crates/asperity-report/page/uplot/LICENSE-uPlot",
        "crates/asperity-cli/page/codemirror/LICENSE-CodeMirror",
    ] {
        copy(root().join(file))?;
    }
    for (folder, ending) in [("examples", "toml"), ("examples/data", "csv"), ("examples/data", "x3p")] {
        for file in files(&root().join(folder), ending)? {
            copy_to(folder, file)?;
        }
    }
    let archive = folder.join(format!("{name}.zip"));
    run(Command::new(PYTHON).args(["-m", "zipfile", "-c"]).arg(&archive).arg(&inside))?;
    std::fs::remove_dir_all(&inside).map_err(|error| error.to_string())?;
    unpacked(&archive, &name)
}

/// Unpacks the archive elsewhere and runs the program in it.
fn unpacked(archive: &Path, name: &str) -> Done {
    let place = std::env::temp_dir().join(format!("asperity-package-{}", std::process::id()));
    run(Command::new(PYTHON).args(["-m", "zipfile", "-e"]).arg(archive).arg(&place))?;
    let program = place.join(name).join(format!("asperity{}", std::env::consts::EXE_SUFFIX));
    #[cfg(unix)]
    {
        // Python's unpacker forgets which files are programs; unzip does not.
        use std::os::unix::fs::PermissionsExt;
        std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755))
            .map_err(|e| e.to_string())?;
    }
    let ran = run(Command::new(&program).args(["new", "hertz"]).arg(place.join("hertz.toml")))
        .and_then(|()| run(Command::new(&program).arg("check").arg(place.join("hertz.toml"))));
    let _ = std::fs::remove_dir_all(&place);
    ran
}

/// The machine that the compiler compiles for, such as x86_64-unknown-linux-gnu.
pub fn host() -> Result<String, String> {
    let version = output(Command::new("rustc").arg("-vV"))?;
    let host = version.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| "rustc names no host".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_and_folders_of_the_machine_are_found() {
        let place = std::env::temp_dir().join(format!("asperity-presentable-{}", std::process::id()));
        let told = |bytes: &str| {
            std::fs::write(&place, bytes).expect("a file");
            presentable(&place)
        };
        let (folder, _) = folders().expect("folders").swap_remove(0);
        assert!(told("\0.text\0 /rust/lib").is_ok());
        assert!(told("\0.text\0.symtab\0").is_err());
        assert!(told(&format!("{folder}/lib")).is_err());
        std::fs::remove_file(&place).expect("the file");
    }
}
