"""Docstrings as the generator reads them: roles of Sphinx become code, examples with >>> become blocks, and what follows the name of
a parameter is its meaning: its type is in the signature."""

import re

import griffe

ROLE = re.compile(r":(?:func|class|meth|attr|mod|data):`~?([^`]+)`")
EXAMPLE = re.compile(r"^( *)>>> .*(?:\n\1(?:>>>|\.\.\.| *\S).*)*", re.M)
SECTION = re.compile(r"^(Parameters|Raises|Warns|Yields|Attributes)\n-+\n((?:.+\n?)+)", re.M)
ENTRY = re.compile(r"^(\*{0,2}\w[\w, *]*) : ", re.M)


class Markdown(griffe.Extension):
    """Changes each docstring before it is parsed."""

    def on_object(self, *, obj, **kwargs):
        if obj.docstring:
            obj.docstring.value = markdown(obj.docstring.value)


def markdown(text):
    text = ROLE.sub(r"`\1`", text).replace("``", "`")
    text = EXAMPLE.sub(lambda match: f"{match[1]}```pycon\n{match[0]}\n{match[1]}```", text)
    return SECTION.sub(lambda match: f"{match[1]}\n{'-' * len(match[1])}\n{ENTRY.sub(entry, match[2])}", text)


def entry(match):
    return f"{match[1]}\n    "
