"""The command, run in a process of its own for its answer in JSON."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ._core import CaseError
from ._solve import source


def answered(verb: str, case: Any, directory: Any, words: Sequence[str], quiet: bool, **options: Any) -> dict[str, Any]:
    """The object that ``asperity VERB CASE WORDS -o DIRECTORY --OPTIONS --json`` prints; what it tells goes to stderr unless `quiet`."""
    words = [verb, _case_file(case, directory, f"a {verb}"), *words, *["-q"] * quiet]
    for option, value in {"-o": directory, **{f"--{name}": value for name, value in options.items()}}.items():
        words += [] if value is None else [option, str(value)]
    told: list[str] = []
    # A pipe for the answer would fill up, and stop the command, while this reads what it tells.
    command = [sys.executable, "-m", "asperity", *words, "--json"]
    with (
        tempfile.TemporaryFile("w+", encoding="utf-8") as answer,
        subprocess.Popen(command, stdout=answer, stderr=subprocess.PIPE, encoding="utf-8") as process,
    ):
        try:
            assert process.stderr is not None
            for line in process.stderr:
                told.append(line)
                if not quiet:
                    sys.stderr.write(line)
            process.wait()
        except KeyboardInterrupt:
            process.terminate()
            raise
        answer.seek(0)
        text = answer.read()
    if process.returncode == 2:
        raise CaseError("".join(told).removeprefix("error: ").strip())
    if not text:
        raise RuntimeError("".join(told).strip() or f"asperity {verb} ended with exit code {process.returncode}")
    return dict(json.loads(text))


def _case_file(case: Any, directory: Any, what: str) -> str:
    """The file of a case; one that is given as text or keys is written into the folder of `what`."""
    path, text = source(case)
    if text is None:
        return path
    if directory is None:
        raise CaseError(f"{what} of a case that is no file needs a folder: give directory=")
    file = Path(os.fspath(directory), "case.toml")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")
    return str(file)
