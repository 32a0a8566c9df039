"""Docstrings as the generator reads them: roles of Sphinx become code, examples with >>> become blocks, and what follows the name of
a parameter is its meaning: its type is in the signature."""

import re

import griffe

ROLE = re.compile(r":(?:func|class|meth|attr|mod|data):`~?([^`]+)`")
EXAMPLE = re.compile(r"^( *)>>> .*(?:\n\1(?:>>>|\.\.\.| *\S).*)*", re.M)
SECTION = re.compile(r"^(Parameters|Raises|Warns|Yields|Attributes)\n-+\n((?:.+\n?)+)", re.M)
ENTRY = re.compile(r"^(\*{0,2}\w[\w, *]*) : ", re.M)


OPTIONS = re.compile(r"arguments_of\((\w+)\)")


class Markdown(griffe.Extension):
    """Changes each docstring before it is parsed, and gives functions of an options object the fields of its class as arguments."""

    def on_object(self, *, obj, **kwargs):
        if obj.docstring:
            obj.docstring.value = markdown(obj.docstring.value)

    def on_package(self, *, pkg, **kwargs):
        # Gives dataclasses their parameters.
        griffe.DataclassesExtension().on_package(pkg=pkg)
        for module in pkg.modules.values():
            for function in module.functions.values():
                for decorator in function.decorators if not function.is_alias else ():
                    if found := OPTIONS.fullmatch(str(decorator.value)):
                        _, *arguments = module[found[1]].parameters
                        function.parameters = griffe.Parameters(*arguments)


def markdown(text):
    text = ROLE.sub(r"`\1`", text).replace("``", "`")
    text = EXAMPLE.sub(lambda match: f"{match[1]}```pycon\n{match[0]}\n{match[1]}```", text)
    return SECTION.sub(lambda match: f"{match[1]}\n{'-' * len(match[1])}\n{ENTRY.sub(entry, match[2])}", text)


def entry(match):
    return f"{match[1]}\n    "
