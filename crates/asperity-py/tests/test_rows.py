"""The declarations of the numbers of a row are those of the library's registry. `ASPERITY_STUB=write` writes them anew."""

import os
import pathlib

from asperity import _core

HEAD = '''"""Generated from the library's registry: see tests/test_rows.py."""

from typing import Literal

from ._arrays import Floats

'''


def declared() -> str:
    rows = [name for name, _, _ in _core.rows()]
    quantities = [name for name, _, _, _ in _core.quantities()]
    numbers = [*rows, *(name for name, _, _, is_histogram in _core.quantities() if not is_histogram)]
    of_contact = [name for name in rows if name not in ("time", "time_error", "stage")]

    def holder(name: str, names: list[str], kind: str) -> str:
        return f"class {name}:\n" + "".join(f"    @property\n    def {one}(self) -> {kind}: ...\n" for one in names)

    words = "Quantity = Literal[\n" + "".join(f'    "{name}",\n' for name in quantities) + "]\n\n"
    holders = (("Columns", numbers, "Floats"), ("Numbers", numbers, "float"), ("ContactColumns", of_contact, "Floats"))
    return HEAD + words + "\n".join(holder(*one) for one in holders)


def test_the_stub_is_that_of_the_registry():
    stub = pathlib.Path(__file__).parent.parent / "python" / "asperity" / "_rows.pyi"
    if os.environ.get("ASPERITY_STUB") == "write":
        stub.write_text(declared())
    assert stub.read_text() == declared()
