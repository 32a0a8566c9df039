// Runs, results, comparisons, studies.

/** Whether it writes a folder of results. */
const isFolder = (run) => /^asperity (study|seal)/.test(run.shell);
const isOpen = (run) => run.state === "waiting" || run.state === "running";

async function countRuns() {
  const open = (await ask("runs").catch(() => [])).filter(isOpen).length;
  $("runs-link").textContent = open ? `Runs (${open})` : "Runs";
  setTimeout(countRuns, 3000);
}

/** Calls `draw` with the runs now and then, until the page is left. */
async function follow(draw) {
  let timer;
  const look = async () => {
    try {
      await draw(await ask("runs"));
    } catch (error) {
      tell(error.message, true);
    }
    timer = setTimeout(look, 1000);
  };
  leave = () => clearTimeout(timer);
  await look();
}

/** Replaces what a place shows; what is unfolded or has the focus stays so. */
function renew(place, ...parts) {
  const all = () => [...place.querySelectorAll("summary, button, a")], isOpen = all().map((one) => one.parentElement.open);
  const focus = all().indexOf(document.activeElement);
  place.replaceChildren(...parts);
  all().forEach((one, n) => { if (one.localName === "summary" && isOpen[n]) one.parentElement.open = true; });
  all()[focus]?.focus();
}

/** One run: how far it is, what it says, stop and resume. */
function runPart(run, onResult = false) {
  const share = run.share ?? (run.state === "done" ? 1 : null), log = run.log.trim();
  const hasEnded = run.state === "stopped" || run.state === "failed";
  return make("div", { class: "run", "data-state": run.state },
    make("p", {}, make("b", {}, run.state), " ", make("a", { href: link("case", run.case) }, run.case), " → ", onResult ? run.result : make("a", { href: link(isFolder(run) ? "study" : "result", run.result) }, run.result)),
    run.state === "running" && make("progress", { max: 1, "aria-label": `progress of ${run.case}`, ...(share == null ? {} : { value: share }) }),
    isOpen(run) && make("p", { class: "note" }, run.progress || (run.state === "waiting" ? "waits for the runs before it" : "begins")),
    controls(
      isOpen(run) && button("stop", trying(async () => { await send("stop", run.id); tell("it stops after the row that it is at; what is computed stays"); }), { class: "stop" }),
      run.changed?.length === 0 && !isFolder(run) && button("resume", trying(() => resume(run.case, run.result)), { class: "resume" }),
      hasEnded && (isFolder(run) || !run.has_rows) && button(run.state === "failed" ? "try again" : "go on", trying(async () => { await send("again", run.id); await show(); })),
      hasEnded && button("run it to a new result", trying(async () => { await send("anew", run.id); go("#/runs"); }), { class: "anew" })),
    run.changed?.length > 0 && differs(run.case, run.changed),
    run.state === "failed" && make("pre", { class: "words notice", role: "alert" }, log.split("\n").filter((line) => !line.startsWith("row ")).join("\n")),
    run.state === "done" && run.out.trim() && make("details", {}, make("summary", {}, "what it printed"), make("pre", { class: "words scroll" }, run.out)),
    commands(run));
}

/** Why a run cannot go on. */
const differs = (name, changes) => make("p", { class: "notice changed" }, make("a", { href: link("case", name) }, name), ` has changed since: ${changes.join("; ")}. A run goes on only with the case that it began with.`);

async function resume(of, output) {
  await send("do", { do: "run", case: of, output, resume: true });
  go(link("result", output));
}

async function runsPage() {
  const list = make("div", { id: "runs" });
  let before = "";
  await follow((runs) => {
    const now = JSON.stringify(runs);
    if (now !== before) renew(list, ...(runs.length ? runs.map((run) => runPart(run)) : [make("p", { class: "note" }, "No run yet: open a case and run it.")]));
    before = now;
  });
  return [make("h1", {}, "Runs"), make("p", { class: "note" }, "One run at a time; the others wait. A run goes on when this page or asperity app is closed; what waits then waits for you."), list];
}

async function resultPage(name) {
  const place = make("div", { id: "run" }), page = make("div", { id: "page" }), done = make("div", { id: "done", role: "status" });
  const actions = make("div", {});
  let before = "", framed = "";
  const act = (what) => trying(async () => {
    tell("working ...");
    const found = await send("do", what);
    tell("");
    const files = found.ok ? (await ask("list")).map((one) => one.name).filter((one) => one === what.output || one.startsWith(`${what.output}/`) || found.out.split("\n").includes(one)) : [];
    done.replaceChildren(...[words({ ...found, out: "" }), files.length > 0 && make("p", { class: "files-made" }, "written: ", files.slice(0, 12).map((one) => [fileLink(one), " "]), files.length > 12 && `and ${files.length - 12} more`),
      commands(found)].flat().filter(Boolean));
    return found;
  });
  const exported = (to, ending) => button(to, async () => act({ do: "export", result: name, to, output: await ask(`free/${encoded(`${stem(name)}${ending}`)}`) })());
  const [list, from] = await Promise.all([ask("list"), ask(`origin/${encoded(name)}`).catch(() => null)]), entry = list.find((one) => one.name === name);
  const others = list.filter((one) => one.kind === "result" && one.name !== name).map((one) => one.name);
  const other = choice(others, { "aria-label": "other result" });
  actions.append(
    controls(
      button("write the report", async () => act({ do: "report", results: [name], output: await ask(`free/${encoded(`${stem(name)}.html`)}`), write: true })(), { id: "report" }),
      "export:", exported("netcdf", ".nc"), exported("hdf5", ".h5"), exported("npz", ".npz"), exported("vtk", ".pvd"), exported("csv", ".csv"), exported("png", "-pictures"),
      others.length > 0 && [other, button("compare", () => go(`#/compare/${[name, other.value].map(encodeURIComponent).join("/")}`), { id: "compare" })]),
    done);
  await follow(async (runs) => {
    const run = runs.find((one) => one.result === name), now = JSON.stringify(run ?? null);
    if (now !== before) renew(place, run ? runPart(run, true) : commands({ shell: `asperity view ${name}`, python: `import asperity as asp\n\nresult = asp.open(${JSON.stringify(name)})\nprint(result)\n` }));
    before = now;
    // Once more at its end, when all of it is there.
    const state = run && isOpen(run) ? "open" : "ended";
    if (framed !== state && (run ? run.has_rows : entry?.rows > 0)) {
      framed = state;
      page.replaceChildren(make("iframe", { class: "own", src: `live/${encoded(name)}/`, title: `report of ${name}`, load: () => theme(document.documentElement.dataset.theme) }));
    }
  });
  const isLeft = !before.includes('"state"') && from && entry && entry.state !== "complete" && entry.state !== "running";
  const caseOfIt = from && make("p", { id: "origin" }, "Its case: ", from.case ? make("a", { href: link("case", from.case) }, from.case) : "in no file of this folder", " ",
    from.changed?.length > 0 && `(changed since: ${from.changed.join("; ")}) `, from.changed?.length !== 0 && button("write its case as a new file", trying(async () => {
      const copy = await ask(`free/${encoded(from.case ?? `${stem(name)}.toml`)}`);
      await send("save", { name: copy, text: from.text });
      go(link("case", copy), `the case of ${name}`);
    }), { id: "restore" }));
  return [make("h1", {}, name), caseOfIt, place,
    isLeft && controls(entry.state, from.changed?.length === 0 ? button("resume", trying(() => resume(from.case, name))) : "It can go on only with its case, as it was."), actions, page];
}

async function comparePage(names) {
  const output = await ask("free/comparison.html");
  leave = endLooks;
  const sheet = await look({ do: "report", results: names, output, write: false });
  const found = sheet && await look({ do: "compare", results: names });
  if (!found) return null;
  const file = button("write this page as a file", trying(async () => {
    const output = await ask("free/comparison.html");
    const done = await send("do", { do: "report", results: names, output, write: true });
    tell(done.ok ? `wrote ${output}` : done.told, !done.ok, done.ok && output);
  }), { id: "write" });
  return [make("h1", {}, `Comparison of ${names.length} results`), make("ul", {}, names.map((name) => make("li", {}, make("a", { href: link("result", name) }, name)))),
    words({ ...found, out: "" }), found.ok && printed(found.out), commands(found), sheet.picture ? make("iframe", { src: `look/${sheet.picture}`, title: "comparison" }) : words(sheet), controls(file), commands(sheet)];
}

/** A study or a whole seal: its page, or what there is of its table so far. */
async function studyPage(name) {
  const list = await ask("list"), table = (await ask(`text/${encoded(`${name}/study.csv`)}`).catch(() => "")).trim();
  const rows = table.split("\n").map((line) => line.split(","));
  const files = list.filter((entry) => entry.name.startsWith(`${name}/`));
  const page = ["seal", "study"].map((of) => `${name}/${of}.html`).find((path) => files.some((entry) => entry.name === path));
  const run = (await ask("runs")).find((one) => one.result === name);
  const isResult = (entry) => entry.kind === "result";
  return [make("h1", {}, name), run && runPart(run, true),
    page ? make("iframe", { src: `file/${encoded(page)}`, title: `page of ${name}` }) : table ? make("div", { class: "scroll" }, make("table", {}, rows.map((row, n) => make("tr", {}, row.map((cell) => make(n ? "td" : "th", {}, cell)))))) : make("p", { class: "note" }, "No table yet: the study is not done."),
    make("ul", {}, files.map((entry) => make("li", {}, isResult(entry) ? make("a", { href: link("result", entry.name) }, entry.name) : fileLink(entry.name)))),
    !run && commands({ shell: `asperity study status ${name}`, python: `import pandas as pd\n\nprint(pd.read_csv(${JSON.stringify(`${name}/study.csv`)}))\n` })];
}
