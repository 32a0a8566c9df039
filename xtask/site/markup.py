"""Markup of the pages: formulas as MathML, anchors as Git forges make them, labelled parts as tabs."""

import re

import math_core

FORMULAS = math_core.LatexToMathML()
TABS = re.compile(r"^<!-- tabs -->\n(.*?)^<!-- end tabs -->\n", re.M | re.S)
LABEL = re.compile(r"^\*\*(.+)\*\*\n", re.M)


def formula(source, language, css_class, options, md, **kwargs):
    """A fenced block ```math as MathML, which browsers draw without a script."""
    return f'<div class="{css_class}">{FORMULAS.convert_with_local_state(source, displaystyle=True)}</div>'


def with_formulas(text):
    """LaTeX between dollars, as notebooks have it, as MathML. Code is left alone."""
    pieces = re.split(r"(^```.*?^```$|`[^`\n]+`)", text, flags=re.M | re.S)
    for n in range(0, len(pieces), 2):
        pieces[n] = re.sub(r"\$\$(.+?)\$\$", lambda m: f"\n\n```math\n{m[1].strip()}\n```\n\n", pieces[n], flags=re.S)
        pieces[n] = re.sub(r"(?<![\w$\\])\$(?!\s)([^$\n]+?)(?<!\s)\$(?!\w)", inline, pieces[n])
    return "".join(pieces)


def inline(match):
    return FORMULAS.convert_with_local_state(match[1], displaystyle=False)


def slug(title, separator):
    """The anchor of a heading, as Git forges and the tests of the documents have it."""
    kept = "".join(c for c in title if c.isalnum() or c in " -_")
    return kept.lower().replace(" ", separator)


def with_tabs(text):
    """The parts between <!-- tabs --> and <!-- end tabs -->, each below a bold label, as tabs."""

    def tabs(match):
        parts = LABEL.split(match.group(1))
        labelled = zip(parts[1::2], parts[2::2])
        return "".join(f'=== "{label}"\n\n{indented(body.strip())}\n\n' for label, body in labelled)

    return TABS.sub(tabs, text)


def indented(text):
    return "\n".join(f"    {line}" if line else line for line in text.split("\n"))
