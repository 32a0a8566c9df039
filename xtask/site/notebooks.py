"""The notebooks as pages, executed by the build."""

import base64
import hashlib
import json
import os
import re

import nbformat
from nbclient import NotebookClient

import markup
import sources


def pages(root, site, work, places, address):
    """Writes a page for each notebook and returns their titles and places."""
    work.mkdir(parents=True, exist_ok=True)
    found = []
    for path in sorted((root / "examples/notebooks").glob("*.ipynb")):
        source = path.relative_to(root).as_posix()
        text, pictures = page(executed(path, work))
        place = places[source]
        for name, data in pictures.items():
            (site / "notebooks").mkdir(parents=True, exist_ok=True)
            (site / "notebooks" / f"{path.stem}-{name}").write_bytes(data)
        text = text.replace("PICTURE-", f"{path.stem}-")
        sources.write(site / place, sources.linked(text, source, place, {**places, **own(path, pictures)}, root, address))
        title = re.search(r"^# (.+)$", text, re.M).group(1)
        found.append({title: place})
    return found


def own(path, pictures):
    """Pictures of a notebook, which lie beside its page."""
    folder = "examples/notebooks"
    return {f"{folder}/{path.stem}-{name}": f"notebooks/{path.stem}-{name}" for name in pictures}


def executed(path, work):
    """The notebook with its outputs; kept as long as neither it nor the package changes."""
    import asperity

    text = path.read_text(encoding="utf-8")
    digest = hashlib.sha256(text.encode())
    digest.update(str(os.path.getmtime(asperity._core.__file__)).encode())
    kept = work / f"{path.stem}-{digest.hexdigest()[:16]}.ipynb"
    if not kept.exists():
        print("notebook", path.name, flush=True)
        notebook = nbformat.reads(text, as_version=4)
        NotebookClient(notebook, timeout=1800, resources={"metadata": {"path": str(path.parent)}}).execute()
        nbformat.write(notebook, kept)
    return json.loads(kept.read_text(encoding="utf-8"))


def page(notebook):
    """Markdown of an executed notebook, and its pictures by name."""
    parts, pictures = [], {}
    for cell in notebook["cells"]:
        source = "".join(cell["source"]).strip()
        if not source:
            continue
        if cell["cell_type"] == "markdown":
            parts.append(markup.with_formulas(source))
            continue
        parts.append(f"```python\n{source}\n```")
        for output in cell.get("outputs", []):
            parts.append(shown(output, pictures))
    return "\n\n".join(part for part in parts if part) + "\n", pictures


def shown(output, pictures):
    if output["output_type"] == "stream":
        if output["name"] == "stderr":
            return ""
        return text_block("".join(output["text"]))
    data = output.get("data", {})
    if "image/png" in data:
        name = f"{len(pictures) + 1}.png"
        pictures[name] = base64.b64decode(data["image/png"])
        return f"![Figure](PICTURE-{name}){{ .plate loading=lazy }}"
    return text_block("".join(data.get("text/plain", "")))


def text_block(text):
    text = text.rstrip()
    # Objects without a form of their own say nothing to a reader.
    return f"```text title=\"Output\"\n{text}\n```" if text and not re.fullmatch(r"<[^>]+ at 0x\w+>|\[?<.*>\]?", text) else ""
