"""Every block of the first steps and of the how-to pages runs, in the order of the page: cases, commands and Python."""

import contextlib
import io
import os
import re
import shlex
import shutil
import subprocess
import sysconfig
from pathlib import Path

import pytest

from instrument_files import write_force_map

ROOT = Path(__file__).parents[3]
PAGES = [ROOT / "docs/start.md", *sorted(page for page in (ROOT / "docs/howto").glob("*.md") if page.stem != "index")]
BLOCK = re.compile(r'^```(sh|python|toml) ?(?:title="([^"\n]+)")?\n(.*?)^```', re.M | re.S)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_block_of_a_page_runs(page, tmp_path, monkeypatch):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    pytest.importorskip("xarray")
    # A reader follows the one or the other: each has a folder.
    shell, python = tmp_path / "shell", tmp_path / "python"
    for folder in (shell, python):
        shutil.copytree(ROOT / "examples", folder / "examples")
    monkeypatch.chdir(python)
    if page.stem == "force-curves":
        # The file of a map that an instrument would write.
        pytest.importorskip("afmformats")
        write_force_map(python / "map.h5", (16, 12))
    # The command of the same sources, where the caller says which, else that of the wheel.
    command = os.environ.get("ASPERITY_COMMAND") or str(Path(sysconfig.get_path("scripts")) / "asperity")
    names, expected, out = {}, [], io.StringIO()
    blocks = BLOCK.findall(page.read_text(encoding="utf-8"))
    assert {kind for kind, _, _ in blocks} >= {"sh", "python"}
    for kind, title, text in blocks:
        if kind == "toml":
            (shell / title).write_text(text, encoding="utf-8")
        elif kind == "sh":
            for line in text.splitlines():
                words = shlex.split(line)
                assert words[0] == "asperity", line
                words = [command, *words[1:]]
                ran = subprocess.run(words, cwd=shell, capture_output=True, text=True, encoding="utf-8", timeout=600)
                assert ran.returncode == 0, f"{line}\n{ran.stderr}"
        else:
            expected += re.findall(r"^ *print\(.*\)  # (.+)$", text, flags=re.M)
            with contextlib.redirect_stdout(out):
                exec(compile(text, str(page), "exec"), names)
    assert out.getvalue().splitlines() == expected
    import matplotlib.pyplot as plt

    plt.close("all")
