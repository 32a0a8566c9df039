// The start: what is in the folder, what can be begun.

async function startPage() {
  const list = await ask("list");
  const studies = list.filter((entry) => entry.kind === "study");
  // What a study or a seal holds is shown on its page.
  const inside = (study) => list.filter((entry) => entry.name.startsWith(`${study.name}/`)), alone = list.filter((entry) => !studies.some((study) => inside(study).includes(entry)));
  const of = (...kinds) => alone.filter((entry) => kinds.includes(entry.kind));
  const results = of("result"), cases = of("case"), files = of("file", "block");
  const count = (study) => inside(study).filter((entry) => entry.kind === "result").length;
  const pictureOf = (study) => inside(study).find((entry) => /\/(seal|study)\.png$/.test(entry.name));
  const chosen = new Set();
  const compare = button("compare the chosen", () => go(`#/compare/${[...chosen].map(encodeURIComponent).join("/")}`), { disabled: true });
  const choose = (name) => make("input", { type: "checkbox", "aria-label": `choose ${name}`, change: (event) => {
    event.target.checked ? chosen.add(name) : chosen.delete(name);
    compare.disabled = chosen.size < 2;
  } });
  return [
    make("h1", {}, $("folder").textContent),
    dropZone(),
    section("Results", results.length + studies.length
      ? [results.length > 1 && controls(compare), make("ul", { class: "tiles" }, studies.map((study) => make("li", {},
          make("a", { class: "tile study", href: link("study", study.name) },
            pictureOf(study) && make("img", { src: `file/${encoded(pictureOf(study).name)}`, alt: "", loading: "lazy" }),
            make("b", {}, study.name), make("span", {}, `${pictureOf(study)?.name.endsWith("seal.png") ? "a whole seal" : "a study"}: ${count(study)} results`)))), results.map((entry) => make("li", {}, choose(entry.name),
          make("a", { class: "tile", href: link("result", entry.name) },
            entry.rows > 0 && make("img", { src: `thumbnail/${encoded(entry.name)}`, alt: "", loading: "lazy" }),
            make("b", {}, entry.title || entry.name), make("span", {}, `${entry.name}, ${entry.state}`),
            (entry.answers ?? []).map(([name, value]) => make("span", {}, `${name}: ${value}`))))))]
      : make("p", { class: "note" }, "No result yet: run a case.")),
    section("Cases", cases.length
      ? make("ul", { class: "tiles" }, cases.map((entry) => make("li", {},
          make("a", { class: "tile", href: link("file", entry.name) }, make("b", {}, entry.title ?? entry.name), make("span", {}, entry.name)))))
      : make("p", { class: "note" }, "No case yet: begin with one of these, or with your own files.")),
    section("Begin", make("p", {}, make("a", { href: "#/new" }, "A new case with your own files"), ": seal, friction, contact, indentation, adhesion. Or a starter case:"),
      make("ul", { class: "tiles", id: "starters" }, known.starters.map(([name, title]) => make("li", {},
        button([make("img", { src: `starter/${name}.png`, alt: "", loading: "lazy" }), make("b", {}, title), make("span", {}, name)],
          trying(() => begin(name)), { class: "tile", "aria-label": `new case ${name}: ${title}` }))))),
    files.length > 0 && section("Other files", make("ul", { class: "files" }, files.map((entry) =>
      make("li", {}, make("a", { href: link("file", entry.name) }, entry.name))))),
  ];
}

/** Writes a starter case, and opens it. */
async function begin(template) {
  const output = await ask(`free/${template}.toml`);
  const done = await send("do", { do: "template", template, output });
  if (!done.ok) throw new Error(done.told);
  go(link("case", output), `wrote ${output}`);
}

/** Where files are dropped or chosen. */
function dropZone() {
  const take = trying(async (files) => {
    const names = [];
    for (const file of files) {
      tell(`taking ${file.name} ...`);
      names.push(await answer(await fetch(`upload?${encodeURIComponent(file.name)}`, { method: "POST", body: file }).catch(gone)));
    }
    const told = `in the folder now: ${names.join(", ")}`;
    if (names.length === 1) go(link("file", names[0]), told);
    else if (names.length) {
      await show();
      tell(told);
    }
  });
  const input = make("input", { type: "file", multiple: true, id: "choose-files", change: (event) => take(event.target.files) });
  const zone = make("div", { class: "drop", id: "drop" },
    make("label", { for: "choose-files" }, "Drop surfaces, material data or cases here, or choose files: "), input,
    make("p", { class: "note" }, "They are copied into the folder; nothing is replaced."));
  zone.addEventListener("dragover", (event) => { event.preventDefault(); zone.classList.add("over"); });
  zone.addEventListener("dragleave", () => zone.classList.remove("over"));
  zone.addEventListener("drop", (event) => { event.preventDefault(); zone.classList.remove("over"); take(event.dataTransfer.files); });
  return zone;
}
