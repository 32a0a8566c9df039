"""The gallery: each picture is drawn from a case that its reader can copy."""

import os
import shlex
import subprocess

import markup

#: Case, lines that draw it, caption. RESULT stands for the result of the case, PICTURE for the file.
PICTURES = [
    ("rough-pmma", "plot RESULT pressure -o PICTURE", "A rough sphere on PMMA: pressure after 500 s, limited by the hardness."),
    ("zener-step", "plot RESULT profile --time '0 s' -o PICTURE", "A sphere pressed suddenly on a rubber: pressure along the middle."),
    ("ground-steel", "plot RESULT pressure -o PICTURE", "A measured surface of ground steel on a rubber seal."),
    ("cyclic", "plot RESULT load-displacement -o PICTURE", "PMMA under a cyclic load: hysteresis loops that drift as the mean load creeps."),
    ("press-hold-retract", "plot RESULT evolution -o PICTURE", "Pressed, held and pulled back, in stages that switch at events."),
    ("rubber-friction", "plot RESULT friction -o PICTURE", "Friction of a tread rubber on a rough road over seven decades of velocity."),
    ("sliding-sphere", "plot RESULT pressure -o PICTURE", "A sphere slides over a rubber: the pressure leans forward."),
    ("rolling-cylinder", "plot RESULT profile -o PICTURE", "A cylinder rolls over a viscoelastic body, in plane strain."),
    ("seal", "plot RESULT leak --log-time -o PICTURE", "A seal on turned steel: the helium leak over time until the last path closes."),
    ("gasket", "plot RESULT contact -o PICTURE", "A gasket of 1 mm on a rough flange: the area in contact."),
    ("coated-steel", "plot RESULT profile -o PICTURE", "A ball on steel with a hard coating."),
    ("subsurface-stress", "plot RESULT stress -o PICTURE", "Von Mises stress below a ball, and where the plate yields first."),
    ("capped-cycle", "plot RESULT load-displacement -o PICTURE", "Asperities that the hardness flattens, loaded twice."),
    ("periodic-rough", "plot RESULT histogram -o PICTURE", "A rough surface on rubber: how pressures and gaps are distributed."),
    ("warming-rubber", "plot RESULT evolution -o PICTURE", "A rubber that warms up creeps faster."),
    ("rubber-dma", "material show CASE --plot PICTURE", "A material from DMA sweeps: relaxation, creep, storage and loss."),
    ("ground-steel", "surface info examples/data/ground-steel.x3p --plot PICTURE", "Heights, spectrum, distribution and bearing area of a measured surface."),
]

OPENING = """# Gallery

Every picture is drawn by the build of this site from the case below it, which `asperity new` or the folder `examples` has too. Copy a
case, change it, run it.

"""


def page(program, root, work, pictures):
    """The page; results go to `work`, pictures to `pictures`."""
    work.mkdir(parents=True, exist_ok=True)
    pictures.mkdir(parents=True, exist_ok=True)
    thumbs, cards = [], []
    for number, (name, draw, caption) in enumerate(PICTURES):
        case = root / "examples" / f"{name}.toml"
        result = work / f"{name}.zarr"
        picture = pictures / f"{number + 1:02}-{name}.png"
        if "RESULT" in draw and not newer(result / "zarr.json", case, program):
            asperity(program, root, ["run", "--quiet", "--force", str(case), "-o", str(result)])
        if not newer(picture, result / "zarr.json" if "RESULT" in draw else case, program):
            picture.unlink(missing_ok=True)
            given = {"RESULT": str(result), "PICTURE": str(picture), "CASE": str(case)}
            asperity(program, root, [given.get(word, word) for word in shlex.split(draw)])
        thumbs.append(thumb(caption, picture.name))
        cards.append(card(name, draw, caption, picture.name, case.read_text(encoding="utf-8")))
    return OPENING + "<div class='thumbs' markdown>\n\n" + "\n".join(thumbs) + "\n\n</div>\n\n" + "\n".join(cards)


def title(caption):
    return caption.split(":")[0].rstrip(".")


def thumb(caption, picture):
    """A small picture with its title, which leads to the large one."""
    return f"- [![]({'gallery/' + picture}){{ loading=lazy }} {title(caption)}](#{markup.slug(title(caption), '-')})"


def card(name, draw, caption, picture, case):
    shown = {"RESULT": f"{name}.zarr", "PICTURE": f"{name}.png", "CASE": f"{name}.toml"}
    commands = [f"asperity run {name}.toml -o {name}.zarr"] if "RESULT" in draw else []
    commands.append(shlex.join(["asperity", *(shown.get(word, word) for word in shlex.split(draw))]))
    block = "\n".join(f"    {line}" if line else "" for line in case.splitlines())
    return f"""## {title(caption)}

![{caption}](gallery/{picture}){{ .plate loading=lazy }}

{caption}

```sh
{chr(10).join(commands)}
```

??? example "{name}.toml"

    ```toml
{block}
    ```
"""


def asperity(program, root, words):
    print("asperity", *words, flush=True)
    subprocess.run([program, *words], cwd=root, check=True, stdout=subprocess.DEVNULL)


def newer(made, *sources):
    """Whether a file exists and is newer than what it is made from."""
    return made.exists() and all(os.path.getmtime(made) > os.path.getmtime(source) for source in sources)
