"""How to cite the program and the methods that it uses."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Literal

from ._core import CaseError, __version__

_BIBTEX = f"""@software{{asperity,
  title = {{asperity: contact of rough, linear viscoelastic bodies}},
  author = {{{{The asperity developers}}}},
  version = {{{__version__}}},
}}
@article{{spinu2017,
  title = {{Modelling of Rough Contact between Linear Viscoelastic Materials}},
  author = {{Spinu, S. and Cerlinca, D.}},
  journal = {{Modelling and Simulation in Engineering}},
  year = {{2017}},
  pages = {{2521903}},
  doi = {{10.1155/2017/2521903}},
  note = {{The model}},
}}
@article{{polonsky1999,
  title = {{A numerical method for solving rough contact problems based on the multi-level multi-summation and conjugate gradient techniques}},
  author = {{Polonsky, I. A. and Keer, L. M.}},
  journal = {{Wear}},
  volume = {{231}},
  year = {{1999}},
  pages = {{206--219}},
  doi = {{10.1016/S0043-1648(99)00113-1}},
  note = {{The method "polonsky-keer"}},
}}
@article{{yastrebov2017,
  title = {{On the accurate computation of the true contact-area in mechanical contact of random rough surfaces}},
  author = {{Yastrebov, V. A. and Anciaux, G. and Molinari, J.-F.}},
  journal = {{Tribology International}},
  volume = {{114}},
  year = {{2017}},
  pages = {{161--171}},
  doi = {{10.1016/j.triboint.2017.04.023}},
  note = {{The corrected contact area}},
}}
"""
_TEXT = f"""asperity {__version__}: contact of rough, linear viscoelastic bodies. The asperity developers.

Please cite it together with the paper of its model:
  S. Spinu, D. Cerlinca, Modelling of Rough Contact between Linear Viscoelastic Materials,
  Modelling and Simulation in Engineering 2017, 2521903, doi:10.1155/2017/2521903
and, where you use them,
  the solver "polonsky-keer": I. A. Polonsky, L. M. Keer, Wear 231 (1999) 206, doi:10.1016/S0043-1648(99)00113-1
  contact_area_corrected: V. A. Yastrebov, G. Anciaux, J.-F. Molinari, Tribol. Int. 114 (2017) 161,
  doi:10.1016/j.triboint.2017.04.023
"""


def entries(keys: Sequence[str]) -> str:
    """The entries of BibTeX with these keys."""
    every = {entry[1:].split("{", 1)[1].split(",", 1)[0]: entry for entry in re.split("(?m)^(?=@)", _BIBTEX) if entry}
    return "".join(every[key] for key in keys)


def cite(format: Literal["text", "bibtex"] = "text") -> str:
    """How to cite the program and its methods, as "text" or "bibtex".

    >>> import asperity as asp
    >>> asp.cite().splitlines()[0].startswith("asperity")
    True
    """
    if format not in ("text", "bibtex"):
        raise CaseError(f"format is {format!r}, but must be 'text' or 'bibtex'")
    return _TEXT if format == "text" else _BIBTEX
