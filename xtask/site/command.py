"""The reference of the command, from its help texts."""

import os
import re
import subprocess

SUBCOMMAND = re.compile(r"^  ([a-z][a-z-]+)(?:  |$)", re.M)


def page(program):
    lines = [
        "# Command",
        "",
        "The help texts of `asperity`, as `asperity help COMMAND` prints them. Data goes to stdout, everything else to stderr. Exit "
        "codes: 0 done; 1 the solve or the system failed, or a result is damaged; 2 the input is wrong; 130 interrupted.",
        "",
        *section(program, []),
    ]
    return "\n".join(lines) + "\n"


def section(program, words):
    """Help of a command and of those below it."""
    text = help_of(program, words)
    lines = [f"{'##' if len(words) < 2 else '###'} asperity {' '.join(words)}".rstrip(), ""]
    lines += ["```text", text.rstrip(), "```", ""]
    listed = text.partition("Commands:\n")[2].partition("\n\n")[0]
    for name in SUBCOMMAND.findall(listed):
        if name != "help":
            lines += section(program, [*words, name])
    return lines


def help_of(program, words):
    return subprocess.run([program, *words, "--help"], capture_output=True, text=True, encoding="utf-8", check=True, env=WIDE).stdout


#: Lines of the width of a page.
WIDE = {**os.environ, "COLUMNS": "96"}
