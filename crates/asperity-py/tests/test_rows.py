"""The declarations of the numbers of a row are those of the library's registry. `ASPERITY_STUB=write` writes them anew."""

import os
import pathlib

from asperity import _core

HEAD = '''"""Generated from the library's registry: see tests/test_rows.py."""

from typing import Literal

from ._arrays import Floats

'''


def declared() -> str:
    registry = _core.registry()
    numbers = [one for part in ("rows", "quantities") for one in registry[part] if one[-1] != "histogram"]
    of_contact = [one for one in registry["rows"] if one[0] not in ("time", "time_error", "stage")]

    def holder(name: str, entries: list[tuple[str, ...]], kind: str) -> str:
        def of(entry: tuple[str, ...]) -> str:
            return {"count": "int", "vector": "Floats"}.get(entry[-1], kind) if kind == "float" else kind

        return f"class {name}:\n" + "".join(f"    @property\n    def {one[0]}(self) -> {of(one)}: ...\n" for one in entries)

    def words(name: str, part: str) -> str:
        return f"{name} = Literal[\n" + "".join(f'    "{one[0]}",\n' for one in registry[part]) + "]\n"

    names = "OF_CONTACT: list[str]\n\n"
    holders = (
        ("Columns", numbers, "Floats"),
        ("Numbers", numbers, "float"),
        ("StressColumns", registry["stress"], "Floats"),
        ("ContactColumns", of_contact, "Floats"),
        ("ContactNumbers", of_contact, "float"),
    )
    return HEAD + words("Quantity", "quantities") + words("Field", "fields") + names + "\n".join(holder(*one) for one in holders)


def test_the_stub_is_that_of_the_registry():
    stub = pathlib.Path(__file__).parent.parent / "python" / "asperity" / "_rows.pyi"
    if os.environ.get("ASPERITY_STUB") == "write":
        stub.write_text(declared())
    assert stub.read_text() == declared()
