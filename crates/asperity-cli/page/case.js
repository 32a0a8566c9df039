// A case: its text, what is wrong or found while it is typed, a form for its keys, and its run.

/** Keys that most cases have; those that are missing are offered by the form. */
const COMMON = ["title", "domain.cells", "domain.size", "domain.boundary", "load.control", "load.history.value", "time.end", "time.steps", "solver.tolerance", "output.fields", "output.every"];

const script = (() => {
  let loaded;
  return () => (loaded ??= new Promise((done, failed) => {
    document.head.append(make("script", { src: "editor.js", load: done, error: () => failed(new Error("the editor cannot be loaded")) }));
  }));
})();

async function casePage(name) {
  const [text] = await Promise.all([ask(`text/${encoded(name)}`), script(), (async () => { schema ??= await ask("schema"); })()]);
  let saved = text, told = { keys: [], faults: [] }, timer, busy = false, again = false, estimating = false, edits = Promise.resolve();
  const values = () => Object.fromEntries(told.keys.map(([key, value]) => [key, value]));
  const marks = make("ul", { class: "marks", id: "marks", "aria-live": "polite", "aria-label": "Errors and findings" });
  const summary = make("pre", { class: "words scroll", id: "summary" }), status = make("span", { id: "case-status", class: "note", role: "status" });
  const form = make("div", { class: "form", id: "form" });
  const solved = make("h2", {}, "What will be solved");
  const soon = () => { clearTimeout(timer); timer = setTimeout(check, 40); };
  const view = editor(text, values, () => { unsaved(); soon(); });
  const current = () => view.state.doc.toString();
  const unsaved = () => { save.disabled = current() === saved.replace(/\r\n/g, "\n"); };

  async function check() {
    if (busy) { again = true; return; }
    busy = true;
    const start = performance.now();
    await inspect(false);
    status.dataset.milliseconds = String(Math.round(performance.now() - start));
    busy = false;
    if (again) { again = false; check(); } else if (!told.faults.length) timer = setTimeout(estimate, 700);
  }
  /** What a run takes is asked for apart, so that errors do not wait for it. */
  async function estimate() {
    if (estimating) return;
    estimating = true;
    const isShown = await inspect(true);
    estimating = false;
    if (!isShown && !told.faults.length) timer = setTimeout(estimate, 700);
  }
  /** Shows what is found about the text; false where it is another one by now. */
  async function inspect(cost) {
    const text = current(), value = varied();
    try {
      const found = await send("check", { name, text, value, cost });
      if (text !== current() || value !== varied()) return false;
      told = found;
      showMarks();
      const has = (table) => told.keys.some(([key]) => key.startsWith(`${table}.`));
      seal.hidden = !has("seal");
      if (told.summary) summary.textContent = told.summary;
      summary.className = `words scroll${told.summary ? "" : " stale"}`;
      solved.textContent = told.summary ? "What will be solved" : "What would be solved, of the last text without errors";
      status.textContent = told.faults.length ? `${told.faults.length} to correct` : "can be run";
      studied.textContent = told.study?.error ?? (told.study ? `${told.study.runs} runs` : has("study") ? "as [study] says" : "");
      studied.className = told.study?.error ? "notice" : "note";
      study.disabled = told.faults.length > 0 || !!told.study?.error || !(told.study || has("study"));
      if (document.activeElement?.closest("#form") == null) fillForm();
    } catch (error) {
      tell(error.message, true);
    }
    return true;
  }

  function showMarks() {
    const doc = view.state.doc, whole = (line) => doc.line(Math.min(Math.max(line ?? 1, 1), doc.lines));
    const at = (mark) => (mark.from != null ? { from: Math.min(mark.from, doc.length), to: Math.min(Math.max(mark.to, mark.from), doc.length) } : { from: whole(mark.line).from, to: whole(mark.line).to });
    const all = [
      ...told.faults.map((fault) => ({ ...fault, severity: "error", text: `${fault.message}${fault.help ? ` (${fault.help})` : ""}` })),
      ...told.findings, ...told.outside.map((path) => ({ severity: "note", text: `${path} is outside of the folder; the case may read it, as with asperity run.` })),
    ];
    const placed = all.filter((mark) => mark.line || mark.from != null).map((mark) => ({ ...at(mark), severity: mark.severity === "note" ? "info" : mark.severity, message: mark.text }));
    view.dispatch(CodeMirror.setDiagnostics(view.state, placed));
    marks.replaceChildren(...all.map((mark) => make("li", { class: mark.severity },
      (mark.line || mark.from != null) && button(`line ${mark.line ?? doc.lineAt(at(mark).from).number}`, () => { view.focus(); view.dispatch({ selection: { anchor: at(mark).from }, scrollIntoView: true }); }),
      make("b", {}, mark.severity), ` ${mark.text} `, mark.code && make("code", {}, mark.code))));
  }

  /** The keys of the case, the common ones first, with what the schema says of them. */
  function fillForm() {
    const given = values(), missing = COMMON.filter((key) => !(key in given) && !told.keys.some(([known]) => known.startsWith(`${key}[`) || known.startsWith(`${key}.`)) && wanted(key, given));
    const shown = [...COMMON.filter((key) => key in given || missing.includes(key)), ...Object.keys(given).filter((key) => !COMMON.includes(key) && !/\.(terms|points)\[|^study\./.test(key))].slice(0, 80);
    const before = key.value || "load.history.value", all = Object.keys(given).filter((one) => !one.startsWith("study."));
    key.replaceChildren(...all.map((one) => make("option", { value: one, selected: one === before }, one)));
    form.replaceChildren(...shown.map((key) => {
      const value = given[key] ?? "", words = wordsOf(key, given);
      const text = descriptionOf(key, given);
      const attributes = { "data-key": key, change: (event) => set(key, event.target.value) };
      const offered = words && !words.many && !words.free ? words.list.map(String) : null;
      const input = offered
        ? make("select", attributes, [...new Set(["", ...offered, value])].filter((word) => word || !value).map((word) => make("option", { value: word, selected: word === value }, word || "(default)")))
        : make("input", { ...attributes, value, placeholder: key in given ? "" : "(default)" });
      return make("label", {}, make("span", {}, key, text && make("span", { class: "note" }, text)), input);
    }));
  }
  const wanted = (key, given) => formsOf(key, given).length > 0 && !(key.startsWith("time.") && "motion.steady.velocities" in given);

  /** One edit after the other, each of the text that the one before has left. */
  const set = (key, value) => (edits = edits.then(trying(async () => {
    let text, next;
    try {
      if (!value.trim()) throw new Error(`to leave ${key} out, remove its line in the text`);
      do { text = current(); next = await send("set", { name, text, key, value }); } while (text !== current());
    } catch (error) {
      fillForm();
      throw error;
    }
    change(next);
  })));
  /** Replaces only what differs, so that cursor and undo stay. */
  function change(next) {
    const now = current();
    let from = 0, to = now.length, end = next.length;
    while (from < to && from < end && now[from] === next[from]) from++;
    while (to > from && end > from && now[to - 1] === next[end - 1]) { to--; end--; }
    view.dispatch({ changes: { from, to, insert: next.slice(from, end) } });
    // Into view, without moving the page.
    view.requestMeasure({ read: () => view.lineBlockAt(from).top, write: (top) => { view.scrollDOM.scrollTop = top - view.scrollDOM.clientHeight / 2; } });
  }

  const store = async () => {
    await edits;
    const text = current();
    if (text !== saved.replace(/\r\n/g, "\n")) {
      await send("save", { name, text, before: saved });
      saved = text;
    }
    unsaved();
  };
  /** Saves what is left; where the file has changed meanwhile, beside it. False where neither is possible: then the text stays here. */
  async function keep() {
    try {
      await store();
    } catch (error) {
      try {
        const copy = await ask(`free/${encoded(name)}`);
        await send("save", { name: copy, text: current() });
        tell(`${error.message}\nYour text is kept in ${copy}.`, true);
      } catch (second) {
        tell(`${second.message}\nYour text is not saved, so it stays here: copy it, or make room and save.`, true);
        return false;
      }
    }
    return true;
  }
  const save = button("save", trying(async () => { await store(); tell(`saved ${name}`); }), { id: "save", disabled: true });
  const run = button("run", trying(async () => {
    await store();
    const output = await ask(`result-of/${encoded(name)}`);
    await send("do", { do: "run", case: name, output });
    go(link("result", output));
  }), { id: "run", class: "primary" });
  const key = make("select", { id: "vary-key", "aria-label": "key that varies", change: soon });
  const vary = make("input", { id: "vary", placeholder: "0.1 N, 1 N", "aria-label": "its values", input: soon });
  const studied = make("span", { id: "studied", class: "note", role: "status" });
  const varied = () => (vary.value.trim() ? `${key.value}=${vary.value.trim()}` : "");
  const study = button("run a study", trying(async () => {
    await store();
    const output = await ask(`free/${encoded(name.replace(/\.toml$/i, "-study"))}`);
    await send("do", { do: "study", case: name, vary: varied(), output });
    go("#/runs", `the results are in ${output}`);
  }), { id: "study", disabled: true });
  const seal = button("compute the whole seal", trying(async () => {
    await store();
    const output = await ask(`free/${encoded(name.replace(/\.toml$/i, "-seal"))}`);
    await send("do", { do: "seal", case: name, output });
    go("#/runs", `page and figure will be in ${output}`);
  }), { hidden: true });
  const warn = (event) => { if (current() !== saved.replace(/\r\n/g, "\n")) event.preventDefault(); };
  window.addEventListener("beforeunload", warn);
  leave = async () => {
    if (!(await keep())) return false;
    clearTimeout(timer);
    window.removeEventListener("beforeunload", warn);
    return true;
  };
  setTimeout(check);
  return [
    make("h1", {}, name),
    controls(run, seal, save, status, make("span", { class: "note" }, "Ctrl-Space offers what may stand here; what you typed is saved when you run or leave.")),
    make("div", { class: "two" },
      make("div", {}, make("div", { class: "editor" }, view.dom), marks),
      make("div", {}, make("h2", {}, "Keys"), form)),
    make("section", {}, solved, summary),
    section("A study", make("p", { class: "note" }, "It runs the case for several values of a key: a list such as 0.1 N, 1 N; from, to, how many as 0.1 N:10 N:5:log; whole numbers as 1..10. ",
      "The table [study] of the text varies several keys."), controls(key, vary, study, studied)),
  ];
}

function editor(text, values, changed) {
  const { EditorState, EditorView, StreamLanguage, HighlightStyle, tags } = CodeMirror;
  const colours = HighlightStyle.define([
    { tag: tags.comment, color: "var(--soft)" }, { tag: tags.string, color: "var(--c2)" }, { tag: [tags.number, tags.bool, tags.atom], color: "var(--c1)" },
    { tag: [tags.propertyName, tags.definition(tags.propertyName)], color: "var(--accent)" },
  ]);
  const keys = [...CodeMirror.completionKeymap, ...CodeMirror.lintKeymap, ...CodeMirror.historyKeymap, ...CodeMirror.defaultKeymap];
  return new EditorView({ state: EditorState.create({ doc: text, extensions: [
    CodeMirror.lineNumbers(), CodeMirror.lintGutter(), CodeMirror.history(), CodeMirror.highlightActiveLine(), CodeMirror.drawSelection(), CodeMirror.bracketMatching(),
    CodeMirror.closeBrackets(), EditorView.lineWrapping, StreamLanguage.define(CodeMirror.toml), CodeMirror.syntaxHighlighting(colours),
    CodeMirror.autocompletion({ override: [completions(values)] }), CodeMirror.keymap.of(keys),
    EditorView.contentAttributes.of({ "aria-label": "Text of the case" }),
    EditorView.updateListener.of((update) => update.docChanged && changed()),
  ] }) });
}
