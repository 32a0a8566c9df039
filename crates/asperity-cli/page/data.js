// Surfaces, measured materials, and a new case from both.

const number = (value) => (value == null ? "–" : Math.abs(value) >= 1e-2 && Math.abs(value) < 1e4 ? String(Number(value.toPrecision(4))) : value.toExponential(3));

/** A length with its prefix. */
const metres = (value) => {
  const [factor, unit] = [[1, "m"], [1e3, "mm"], [1e6, "µm"], [1e9, "nm"]].find(([factor]) => Math.abs(value * factor) >= 1) ?? [1e9, "nm"];
  return value == null ? "–" : `${Number((value * factor).toPrecision(4))} ${unit}`;
};

/** Operations on a surface: name, words, what is added at first. */
const OPERATIONS = [["level=plane", "level"], ["crop size=", "crop, e.g. crop size=50um,50um"], ["fill=harmonic", "fill undefined points"], ["filter shortest=", "filter, e.g. filter shortest=2um"],
  ["outliers=6 radius=2", "outliers"], ["border=mirror", "continue by reflections, to repeat on a periodic domain"], ["resample=bilinear cells=", "resample, e.g. cells=256,256"], ["flip=x", "flip"], ["rotate=1", "rotate"], ["invert", "invert"]];

async function surfacePage(name) {
  const steps = make("textarea", { rows: 4, id: "steps", "aria-label": "Steps, one a line", spellcheck: "false", placeholder: "one step a line, done in their order" });
  let timer, stored, written = "";
  const options = optionFields(known.options.surface, () => { stored = null; draw(); }), spectrum = optionFields(known.options.spectrum, () => { stored = null; draw(); });
  const shown = make("div", { id: "shown", "aria-live": "polite" });
  const output = make("input", { id: "output", value: await ask(`free/${encoded(`${stem(name)}-processed.x3p`)}`), "aria-label": "name of the new file" });
  const ops = () => steps.value.split("\n").map((line) => line.trim()).filter(Boolean);
  const processed = (write) => ({ do: "process", file: name, options: options.values(), ops: ops(), output: output.value, write });
  const draw = trying(async () => {
    shown.dataset.busy = "yes";
    next.textContent = ops().length ? "write the new file, and a new case with it" : "a new case with this surface";
    const asStored = stored ?? (await look({ do: "surface", file: name, options: { ...options.values(), ...spectrum.values() } }));
    const done = asStored && ops().length ? await look(processed(false)) : asStored;
    if (!done) return;
    stored = asStored.ok ? asStored : null;
    shown.replaceChildren(...[words(done), picture(done, `heights, spectrum and distribution of ${ops().length ? `${name} after the steps` : name}`), statistics(done.json, ops().length > 0 && stored?.json), commands(done)].flat().filter(Boolean));
    shown.dataset.busy = "no";
  });
  const soon = () => { clearTimeout(timer); timer = setTimeout(draw, 400); };
  steps.addEventListener("input", soon);
  const store = async () => {
    const file = output.value, done = await send("do", processed(true));
    if (!done.ok) throw new Error(done.told);
    output.value = await ask(`free/${encoded(file)}`);
    return file;
  };
  const write = button("write the new file", trying(async () => { const file = await store(); tell(`wrote ${file}; ${name} is as it was.`, false, file); }), { id: "write" });
  const next = button("", trying(async () => go(link("new", ops().length ? await store() : name))), { id: "next" });
  const add = ([step, title]) => button(title, () => { steps.value = `${steps.value.trimEnd()}${steps.value.trim() ? "\n" : ""}${step}`; steps.focus(); step.endsWith("=") || draw(); });
  leave = () => { clearTimeout(timer); endLooks(); };
  setTimeout(draw);
  return [make("h1", {}, name), make("div", { class: "two" }, shown, make("div", {},
    make("h2", {}, "Steps"), controls(OPERATIONS.map(add)), steps, controls(output, write),
    make("h2", {}, "About the file"), options.form, spectrum.form, controls(next),
    /\.(csv|txt|dat)$/i.test(name) && make("p", {}, make("a", { href: link("indentation", name) }, "It is a record of an indentation or a force curve"))))];
}

/** Statistics as stored and levelled; with `before`, after steps beside those as stored. */
function statistics(found, before) {
  if (!found?.shape) return null;
  const rows = [["Sa", "sa", metres], ["Sq", "sq", metres], ["Sz", "sz", metres], ["Ssk", "ssk", number], ["Sku", "sku", number], ["Sdq", "sdq", number], ["Sdr", "sdr", number]];
  const columns = [...(before ? [["as stored", before], ["after the steps", found]] : [["as stored", found]]), ["levelled", found.levelled]];
  const row = ([title, key, words]) => make("tr", {}, make("th", { scope: "row" }, title), columns.map(([, of]) => make("td", {}, of ? words(of[key]) : "")));
  return [make("p", { id: "shape" }, `${found.shape.join(" × ")} points, ${found.size.map(metres).join(" × ")}, ${found.undefined} undefined`,
      found.fit && `; Hurst exponent ${number(found.fit.hurst)} ± ${number(found.fit.error)}`),
    make("table", { id: "statistics" }, make("tr", {}, make("th", {}, ""), columns.map(([head]) => make("th", {}, head))), rows.map(row)),
    make("ul", { class: "marks" }, found.findings.map((finding) => make("li", { class: finding.severity }, make("b", {}, finding.severity), ` ${finding.text} `, make("code", {}, finding.code))))];
}

/** A table of a material test, or a record of an indentation: data, fit, what was found, the block for a case. */
async function materialPage(name, way) {
  const options = optionFields(known.options[way], () => fit());
  const shown = make("div", { id: "shown", "aria-live": "polite" });
  const output = make("input", { id: "output", value: await ask(`free/${encoded(`${stem(name)}-material.toml`)}`), "aria-label": "name of the new file" });
  const draw = (done) => {
    const found = done.json ?? {};
    const marks = (found.findings ?? []).map((finding) => make("li", { class: finding.severity }, make("b", {}, finding.severity), ` ${finding.text}`)).concat((found.notes ?? []).map((note) => make("li", {}, note)));
    const interval = (title, value) => value && make("tr", {}, make("th", { scope: "row" }, title), value.map((part) => make("td", {}, number(part))));
    const terms = found.function?.terms?.map(([value, time]) => make("tr", {}, make("td", {}, number(value)), make("td", {}, number(time))));
    shown.replaceChildren(...[words(done), picture(done, `data and fit of ${name}`), make("ul", { class: "marks" }, marks),
      found.misfit && make("p", {}, `misfit ${number(100 * found.misfit.rms)} % rms, ${number(100 * found.misfit.max)} % at most; ${found.terms} terms`),
      terms && make("details", {}, make("summary", {}, "terms"), make("table", {}, make("tr", {}, make("th", {}, found.function.instantaneous == null ? "modulus [Pa]" : "compliance [1/Pa]"), make("th", {}, "time [s]")), terms)),
      way === "indentation" && done.ok && make("table", { id: "intervals" }, make("tr", {}, ["", "value", "95 % from", "to"].map((head) => make("th", {}, head))),
        interval("at once [Pa]", found.instantaneous), interval("relaxed [Pa]", found.equilibrium), interval("Young's modulus [Pa]", found.young), interval("work of adhesion [J/m²]", found.work),
        (found.terms ?? []).map((term, n) => [interval(`term ${n + 1} [Pa]`, term.modulus), interval(`its time [s]`, term.time)])),
      found.material && make("details", { open: true }, make("summary", {}, "the block for a case"), make("pre", { class: "words", id: "block" }, found.material)), commands(done)].flat().filter(Boolean));
  };
  const fit = trying(async (write = false) => {
    shown.dataset.busy = "yes";
    const done = await (write ? (action) => send("do", action) : look)({ do: way, file: name, options: options.values(), output: output.value, write });
    if (!done) return null;
    draw(done);
    shown.dataset.busy = "no";
    return done;
  });
  const write = button("write the block as a file", trying(async () => {
    const file = output.value, done = await fit(true);
    if (!done?.ok) return;
    tell(`wrote ${file}.`, false, file);
    output.value = await ask(`free/${encoded(file)}`);
  }), { id: "write" });
  const data = button("only the data", trying(async () => { const done = await look({ do: "data", file: name }); if (done) draw(done); }));
  leave = endLooks;
  if (way === "fit") setTimeout(fit);
  else shown.append(make("p", { class: "note" }, "The radius of the sphere, or the slope of the cone, is needed for a fit."));
  return [make("h1", {}, name), make("div", { class: "two" }, shown, make("div", {}, make("h2", {}, "Fit"), options.form,
    controls(button("fit", () => fit(), { id: "fit" }), way === "fit" && data), controls(output, write)))];
}

/** A new case with own files, as a few questions. */
async function newPage(surface = "") {
  const list = await ask("list"), of = (...kinds) => list.filter((entry) => kinds.includes(entry.kind)).map((entry) => entry.name);
  const files = of("file"), blocks = of("block");
  const purposes = [["seal", "How much leaks through the gap?"], ["friction", "Which friction over the velocity?"], ["contact", "Which area and pressure?"], ["indentation", "A ball pressed in"], ["adhesion", "A contact that sticks"]];
  const purpose = make("select", { id: "purpose" }, purposes.map(([name, title]) => make("option", { value: name }, title)));
  const from = choice(files, { id: "from" }), material = choice([...blocks, ...files], { id: "material" });
  if (files.includes(surface)) from.value = surface;
  const options = optionFields(known.options.surface.slice(0, 2), () => {}), output = make("input", { id: "output" });
  const name = async () => { output.value = await ask(`free/${purpose.value}.toml`); };
  purpose.addEventListener("change", trying(name));
  await name();
  const said = make("div", { id: "shown", "aria-live": "polite" });
  const write = button("write the case", trying(async () => {
    const file = output.value;
    const done = await send("do", { do: "new", purpose: purpose.value, from: from.value, material: material.value, output: file, options: options.values() });
    if (!done.ok) { said.replaceChildren(...words(done).filter(Boolean)); return; }
    go(link("case", file), done.told.trim());
  }), { id: "write", class: "primary" });
  return [make("h1", {}, "A new case with your own files"), make("div", { class: "form" },
    make("label", {}, "What do you want to know?", purpose), make("label", {}, "Measured surface (of an indentation: the record)", from),
    make("label", {}, "Measured material, or a fitted block", material), make("label", {}, "Name of the case", output)),
    make("details", {}, make("summary", {}, "about the surface file"), options.form), controls(write), said];
}

/** A block that a fit wrote. */
const blockPage = async (name) => [make("h1", {}, name), make("pre", { class: "words" }, await ask(`text/${encoded(name)}`)), make("p", {}, make("a", { href: "#/new" }, "A new case with this material"))];
const picturePage = (name) => [make("h1", {}, name), /\.(html|pdf)$/i.test(name) ? make("iframe", { src: `file/${encoded(name)}`, title: name }) : make("img", { class: "picture", src: `file/${encoded(name)}`, alt: name })];
