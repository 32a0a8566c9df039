"""The documents of the repository as pages: copied, with links that lead to pages where there is one."""

import posixpath
import re
import shutil
from pathlib import Path

import markup

#: Documents outside of docs/ that are pages too, and where they go.
PAGES = {
    "CHANGELOG.md": "project/changelog.md",
    "CONTRIBUTING.md": "project/contributing.md",
    "SECURITY.md": "project/security.md",
    "CODE_OF_CONDUCT.md": "project/code-of-conduct.md",
    "crates/asperity-py/DESIGN.md": "project/design-python.md",
    "crates/asperity-report/DESIGN.md": "project/design-report.md",
    "examples/data/README.md": "project/data.md",
    "examples/notebooks/README.md": "notebooks/index.md",
}
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")


def stage(root, site, address):
    """Copies all documents to `site`; links to other files lead to the repository at `address`, if it has one."""
    places = dict(PAGES)
    for path in sorted((root / "docs").rglob("*.md")):
        if "paper-joss" not in path.parts:
            places[path.relative_to(root).as_posix()] = path.relative_to(root / "docs").as_posix()
    for notebook in sorted((root / "examples/notebooks").glob("*.ipynb")):
        places[notebook.relative_to(root).as_posix()] = f"notebooks/{notebook.stem}.md"
    for source, place in places.items():
        if source.endswith(".md"):
            text = (root / source).read_text(encoding="utf-8")
            write(site / place, linked(markup.with_tabs(text), source, place, places, root, address))
    shutil.copytree(root / "docs/images", site / "images", dirs_exist_ok=True, ignore=shutil.ignore_patterns("*.py"))
    shutil.copytree(root / "xtask/site/assets", site / "assets", dirs_exist_ok=True)
    return places


def linked(text, source, place, places, root, address):
    """The text with links from `place` instead of `source`. Code is left alone."""
    pieces = re.split(r"(^ *```.*?^ *```$|`[^`\n]+`)", text, flags=re.M | re.S)
    # A link may hold code as its text: put back what was split inside of one.
    code = {}
    for n in range(1, len(pieces), 2):
        key = f"\x01{n}\x01"
        code[key], pieces[n] = pieces[n], key

    def replaced(match):
        picture, shown, target = match.groups()
        return f"{picture}[{shown}]({led(target)})" if led(target) else shown

    def led(target):
        if "://" in target or target.startswith(("#", "mailto:")):
            return target
        path, hash_, heading = target.partition("#")
        path = posixpath.normpath(posixpath.join(posixpath.dirname(source), path))
        if path in places:
            return posixpath.relpath(places[path], posixpath.dirname(place)) + hash_ + heading
        if path.startswith("docs/images/"):
            return posixpath.relpath(path.removeprefix("docs/"), posixpath.dirname(place))
        return f"{address}/blob/main/{path}" if address else None

    text = LINK.sub(replaced, "".join(pieces))
    return re.sub("\x01\\d+\x01", lambda match: code[match.group()], text)


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def repository(root):
    """The address of the repository in Cargo.toml; empty before it is published."""
    found = re.search(r'^repository = "(.*)"$', (root / "Cargo.toml").read_text(encoding="utf-8"), re.M)
    return found.group(1).rstrip("/")
