"""Builds the documentation as web pages in target/site: `cargo xtask site` calls it, with the command in ASPERITY_COMMAND.

The documents of the repository are the source. The build adds what is made from the program: the gallery, the executed notebooks,
and the references of the case file, the command and the Python package.
"""

import logging
import os
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import yaml
from mkdocs.commands.build import build
from mkdocs.config import load_config

import case_file
import command
import gallery
import notebooks
import python_reference
import sources

ROOT = Path(__file__).parents[2]
SOURCE, WORK = ROOT / "target/site-source", ROOT / "target/site-work"


def main():
    # Of the generator; a warning ends the build.
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")
    program = os.environ["ASPERITY_COMMAND"]
    shutil.rmtree(SOURCE, ignore_errors=True)
    address = sources.repository(ROOT)
    places = sources.stage(ROOT, SOURCE, address)
    landing(SOURCE / "index.md")

    def write(place, text):
        sources.write(SOURCE / place, text)

    write("gallery.md", gallery.page(program, ROOT, WORK / "results", WORK / "pictures"))
    shutil.copytree(WORK / "pictures", SOURCE / "gallery", dirs_exist_ok=True)
    schema = subprocess.run([program, "schema"], capture_output=True, text=True, encoding="utf-8", check=True).stdout
    write("reference/case.md", case_file.page(schema))
    write("reference/command.md", command.page(program))
    write("reference/index.md", REFERENCE)
    lists = {
        "@notebooks": notebooks.pages(ROOT, SOURCE, WORK / "notebooks", places, address),
        "@python": python_reference.pages(ROOT, write),
    }
    config = load_config(str(ROOT / "xtask/site/mkdocs.yml"), nav=filled(navigation(), lists))
    if address:
        config.repo_url = address
    config.plugins.on_startup(command="build", dirty=False)
    build(config)
    print(f"the site is in {config.site_dir}")


REFERENCE = """# Reference

- [Case file](case.md): every key, made from the schema.
- [Command](command.md): every option, made from the help texts.
- [Python](../python.md): the guide, then every function and class with its types.
- The Rust library documents itself: `cargo doc --open -p asperity`.
"""


def navigation():
    text = (ROOT / "xtask/site/mkdocs.yml").read_text(encoding="utf-8")
    return yaml.safe_load(text[text.index("\nnav:"):])["nav"]


def filled(items, lists):
    """The navigation with the pages that the build has made."""
    full = []
    for item in items:
        if isinstance(item, str):
            full += lists.get(item, [item])
        else:
            full += [{title: filled(below, lists) if isinstance(below, list) else below} for title, below in item.items()]
    return full


def landing(path):
    """The first page: without lists at its sides, the picture beside the first words and commands, and with buttons."""
    text = path.read_text(encoding="utf-8")
    head, _, rest = text.partition("\n![")
    picture, _, rest = rest.partition("\n\n")
    caption, _, rest = rest.partition("\n\n```")
    commands, _, rest = rest.partition("\n```\n\n")
    _, _, rest = rest.partition("\n\n")
    path.write_text(
        f"---\nhide: [navigation, toc]\ntitle: asperity\n---\n<div class='hero' markdown>\n<div markdown>\n{head}\n```{commands}\n```\n\n"
        "[Start in five minutes](start.md){ .md-button .md-button--primary } [Gallery](gallery.md){ .md-button }\n</div>\n"
        f"<figure markdown>\n![{picture}{{ .plate }}\n<figcaption>{caption}</figcaption>\n</figure>\n</div>\n\n"
        f"<div class='topics' markdown>\n\n{rest}\n</div>\n",
        encoding="utf-8",
    )


if __name__ == "__main__":
    main()
