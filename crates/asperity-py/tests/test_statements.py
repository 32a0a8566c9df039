"""What README, paper and the files for archives say that the program has, and has not, is what the program says."""

import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
PAPER = "docs/paper-joss/paper.md"
#: Documents that say in short what the program is.
DOCUMENTS = [
    "README.md",
    "crates/asperity-py/README.md",
    "docs/index.md",
    "CITATION.cff",
    "codemeta.json",
    ".zenodo.json",
    "CHANGELOG.md",
    PAPER,
]
#: Words for a capability, and the table of a case that has it.
TABLES = {
    r"adhesion|adheres?|adhesive": "adhesion",
    r"friction|stick and slip|partial slip": "friction",
    r"tangential (?:loads?|tractions?|forces?)": "tangential",
    r"wear": "wear",
    r"flash temperature": "flash",
    r"leakages?|leaks?": "leakage",
    r"sliding|rolling": "motion",
    r"stress below the surface": "stress",
    r"whole seals?": "seal",
}
#: In words "no ..." says that something is missing.
LACKS = r"(?:\b(?:no|without|lacks|neither|nor|except|not in asperity:)\s+(?:any\s+|the\s+)?)"
#: Numerals that a sentence may begin with or have in words.
WORDS = {"one": 1, "two": 2, "ten": 10, "eleven": 11, "twelve": 12, "twenty": 20, "thirty": 30}
NUMBER = rf"(\d+|{'|'.join(WORDS)})"

if not (ROOT / "Cargo.toml").exists():
    pytest.skip("the repository is not here", allow_module_level=True)


def command(*words):
    program = (
        [os.environ["ASPERITY_COMMAND"]] if "ASPERITY_COMMAND" in os.environ else [sys.executable, "-m", "asperity"]
    )
    return subprocess.run([*program, *words], check=True, capture_output=True, encoding="utf-8").stdout


def prose(name):
    """The text on one line, without code blocks."""
    text = (ROOT / name).read_text(encoding="utf-8")
    return " ".join(re.sub(r"^```.*?^```", "", text, flags=re.M | re.S).split())


@pytest.fixture(scope="module")
def tables():
    """The tables that a case may have: the registry of the program."""
    return set(json.loads(command("schema"))["properties"])


def lacking(text, tables):
    """What the text says that is missing, and the program has."""
    found = ["frictionless"] if "friction" in tables and re.search(r"\bfrictionless\b", text, re.I) else []
    for words, table in TABLES.items():
        if table in tables:
            found += [hit.group() for hit in re.finditer(rf"{LACKS}(?:{words})\b", text, re.I)]
    return found


def test_every_word_stands_for_a_table_of_a_case(tables):
    assert set(TABLES.values()) <= tables


@pytest.mark.parametrize("name", DOCUMENTS)
def test_nothing_that_the_program_has_is_said_to_be_missing(name, tables):
    text = prose(name)
    if name == "CHANGELOG.md":
        text = text.split("## [")[1]
    # Sentences about other programs say what those lack.
    text = re.sub(r"[^.]*\b(?:Tamaas|ContactMechanics)\b[^.]*\.", "", text)
    # "with or without friction" offers both.
    text = re.sub(r"\bwith or without friction and adhesion\b", "", text)
    assert lacking(text, tables) == []


def test_a_wrong_statement_would_be_found(tables):
    wrong = "A frictionless solver; it has no adhesion, no tangential tractions and runs without wear."
    assert lacking(wrong, tables) == ["frictionless", "no adhesion", "no tangential tractions", "without wear"]
    assert lacking(wrong, set()) == []


@pytest.mark.parametrize("name", ["CITATION.cff", "codemeta.json", ".zenodo.json"])
def test_archives_name_the_main_capabilities(name):
    text = prose(name)
    assert re.search(r"friction", text) and re.search(r"adhesion", text) and re.search(r"sliding or rolling", text)


def formats():
    """Lines of the table of readers."""
    source = (ROOT / "crates/asperity-files/src/topography/mod.rs").read_text(encoding="utf-8")
    table = re.search(r"^formats! \{\n(.*?)^\}", source, re.M | re.S).group(1)
    return len(re.findall(r"^    [A-Z]\w*: \w+::", table, re.M))


COUNTS = {
    rf"{NUMBER} (?:instrument |file )?formats": formats,
    rf"{NUMBER} starter cases": lambda: len(command("new").splitlines()),
    rf"{NUMBER} (?:executed )?notebooks": lambda: len(list((ROOT / "examples/notebooks").glob("*.ipynb"))),
}


@pytest.mark.parametrize("pattern", COUNTS)
def test_counts_are_those_of_the_program(pattern):
    known, stated = COUNTS[pattern](), []
    for name in DOCUMENTS:
        stated += [(name, WORDS.get(hit.lower()) or int(hit)) for hit in re.findall(pattern, prose(name), re.I)]
    # Most of these documents state it; a pattern that finds none would be no test.
    assert stated and all(count == known for _, count in stated), f"the program has {known}: {stated}"


def test_the_steps_of_creep_over_decades_are_those_stated(tmp_path):
    import asperity as asp

    command("run", str(ROOT / "examples/creep-decades.toml"), "--quiet", "-o", str(tmp_path / "creep.zarr"))
    steps = len(asp.open(tmp_path / "creep.zarr")) - 1
    for name, words in (
        ("README.md", r"eight decades of time in (\d+) steps"),
        ("examples/creep-decades.toml", r"in (\d+) adaptive steps"),
    ):
        assert re.search(words, (ROOT / name).read_text(encoding="utf-8")).group(1) == str(steps)


def test_what_the_comparison_says_that_asperity_has_is_there(tables):
    """The rows of the README's table that are features of a case."""
    rows = re.findall(r"^\| ([^|]+) \| ([^|]+) \|", (ROOT / "README.md").read_text(encoding="utf-8"), re.M)
    stated = {row.strip(): cell.strip() for row, cell in rows}
    for row, table in {"adhesion": "adhesion", "friction and partial slip": "friction"}.items():
        assert stated[row].startswith("yes") == (table in tables)
    assert stated["elastoplastic residual stress"] == "no"
    schema = command("schema")
    # A plasticity that leaves stress would be another choice than these two.
    assert (
        re.search(r'"cap"', schema)
        and re.search(r'"accumulate"', schema)
        and "residual" not in json.dumps(json.loads(schema)["properties"])
    )


#: Of the README's commands: they serve until stopped, need a case of the reader, or have tests of their own.
ELSEWHERE = ("app", "view", "seal", "verify", "reproduce")


def test_the_commands_of_the_readme_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    section = (ROOT / "README.md").read_text(encoding="utf-8").split("\n## The command\n")[1]
    lines = re.search(r"^```sh\n(.*?)^```", section, re.M | re.S).group(1).splitlines()
    ran = set()
    for line in lines:
        words = shlex.split(line, comments=True)[1:]
        words = words[: words.index(">")] if ">" in words else words
        if words[0] in ELSEWHERE:
            continue
        words = [{"a.zarr": "my.zarr", "b.zarr": "heavier.zarr"}.get(word, word) for word in words]
        written = command(*words)
        if words[:1] == ["new"]:
            # The reader's case, in fewer cells.
            case = tmp_path / words[-1]
            case.write_text(re.sub(r"^cells = .*", "cells = [32, 32]", case.read_text(encoding="utf-8"), flags=re.M))
        if words[0] == "schema":
            json.loads(written)
        ran.add(words[0])
    assert {
        "run",
        "check",
        "converge",
        "surface",
        "material",
        "show",
        "report",
        "plot",
        "compare",
        "study",
        "export",
    } <= ran
