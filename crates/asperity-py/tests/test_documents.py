"""The Python in README.md and docs/*.md runs, and prints what its comments say."""

import contextlib
import io
import re
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
#: docs/start.md goes on with results of the command.
DOCUMENTS = ["README.md", "crates/asperity-py/README.md", *sorted(f"docs/{path.name}" for path in ROOT.glob("docs/*.md") if path.stem != "start")]
#: Of the README only this: the rest shows results that take long.
README = "In Python"


def sections(name):
    path = ROOT / name
    if not path.exists():
        return []
    parts = re.split(r"^##+ (.+)\n", path.read_text(encoding="utf-8"), flags=re.M)
    found = []
    for title, text in zip(parts[1::2], parts[2::2]):
        blocks = re.findall(r"^```python\n(.*?)^```", text, flags=re.M | re.S)
        if blocks and (name != "README.md" or title == README):
            found.append(pytest.param(blocks, id=f"{name}: {title}"))
    return found


@pytest.mark.parametrize("blocks", [section for name in DOCUMENTS for section in sections(name)])
def test_a_section_does_what_it_says(blocks, tmp_path, monkeypatch):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    pytest.importorskip("xarray")
    monkeypatch.chdir(tmp_path)
    if (ROOT / "examples").exists():
        (tmp_path / "examples").symlink_to(ROOT / "examples")
    names, skipped = {}, []
    for block in blocks:
        if missing := [m for m in re.findall(r"^(?:import|from) (\w+)", block, flags=re.M) if not there(m)]:
            skipped += missing
            continue
        expected = [line for told in re.findall(r"^ *print\(.*\)  # (.+)$", block, flags=re.M) for line in told.split(", then ")]
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            exec(compile(block, "a document", "exec"), names)
        if expected:
            assert out.getvalue().splitlines() == expected
    import matplotlib.pyplot as plt

    plt.close("all")
    if skipped and len(blocks) == 1:
        pytest.skip(f"needs {', '.join(skipped)}")


def there(module):
    try:
        __import__(module)
    except ImportError:
        return False
    return True


def test_every_public_name_has_a_topic_on_the_site():
    path = ROOT / "xtask/site/python_reference.py"
    if not path.exists():
        pytest.skip("no site here")
    reference = runpy.run_path(str(path))
    assert reference["pages"](ROOT, lambda place, text: None)
