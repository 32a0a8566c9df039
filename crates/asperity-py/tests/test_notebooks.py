"""The notebooks in examples/notebooks run, and their checks hold."""

from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[3] / "examples" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def test_there_are_notebooks_without_outputs():
    nbformat = pytest.importorskip("nbformat")
    if not FOLDER.exists():
        pytest.skip("the examples are not here")
    assert len(NOTEBOOKS) >= 6
    for path in NOTEBOOKS:
        notebook = nbformat.read(path, as_version=4)
        nbformat.validate(notebook)
        assert all(not cell.get("outputs") for cell in notebook.cells), f"{path.name} is kept with outputs"


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path):
    for needed in ("nbclient", "nbformat", "ipykernel", "matplotlib", "xarray"):
        pytest.importorskip(needed)
    if "other-programs" in path.stem:
        for peer in ("tamaas", "ContactMechanics"):
            pytest.importorskip(peer)
    import nbclient
    import nbformat

    notebook = nbformat.read(path, as_version=4)
    # Generous: they take seconds, but other tests may run beside them.
    client = nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(FOLDER)}})
    client.execute()
    pictures = [out for cell in notebook.cells for out in cell.get("outputs", []) if "image/png" in out.get("data", {})]
    assert pictures, "a notebook shows figures"
