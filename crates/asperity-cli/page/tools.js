// What every page uses: elements, requests, messages, the command line of what was clicked.

const $ = (id) => document.getElementById(id);
const known = JSON.parse($("known").textContent);

/** An element with attributes and children; functions are listeners. */
function make(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === "function") node.addEventListener(key, value);
    else if (value === true) node.setAttribute(key, "");
    else if (value !== false && value != null) node.setAttribute(key, value);
  }
  node.append(...children.flat(9).filter((child) => child != null && child !== false));
  return node;
}

const section = (title, ...children) => make("section", {}, make("h2", {}, title), ...children);
const button = (text, click, attributes = {}) => make("button", { type: "button", click, ...attributes }, text);
const controls = (...children) => make("div", { class: "controls" }, ...children);
const encoded = (name) => name.split("/").map(encodeURIComponent).join("/");
const link = (page, name) => `#/${page}/${encoded(name)}`;
/** Pages and pictures open here; what only other programs read is taken from the folder. */
const fileLink = (name, words = name) => /\.(html|png|svg|gif|pdf|toml|x3p)$/i.test(name)
  ? make("a", { href: link("file", name) }, words) : make("a", { href: `file/${encoded(name)}`, download: name.replace(/^.*\//, "") }, words);
const stem = (name) => name.replace(/^.*\//, "").replace(/\.[^.]*$/, "");

async function answer(response) {
  if (!response.ok) throw new Error(await response.text());
  return (response.headers.get("content-type") ?? "").startsWith("application/json") ? response.json() : response.text();
}
const ask = async (path) => answer(await fetch(path).catch(gone));
const send = async (path, content) => answer(await fetch(path, { method: "POST", body: JSON.stringify(content) }).catch(gone));
const gone = () => Promise.reject(new Error("asperity app does not answer: start it again. Runs go on meanwhile."));

/** Something that is only looked at; null where this page looks at something else by now, for which the earlier look ends. */
const tab = Math.random().toString(36).slice(2);
let looks = 0;
async function look(action) {
  const own = ++looks, done = await send(`do?${tab}`, action);
  return own === looks ? done : null;
}
const endLooks = () => { looks++; navigator.sendBeacon(`leave?${tab}`); };

/** A message to the user, above the page, with a link to a file of which it tells. */
function tell(text, bad = false, file = null) {
  $("told").replaceChildren(text, file ? fileLink(file, " open it") : "");
  $("told").className = bad ? "bad" : "";
  $("told").hidden = !text;
}

/** Does something that may fail, and says so. */
const trying = (work) => async (...given) => {
  try {
    tell("");
    return await work(...given);
  } catch (error) {
    tell(error.message, true);
  }
};

/** The command line and the Python that do what was clicked. */
function commands({ shell, python }) {
  const part = (title, text) => make("details", { class: "words" }, make("summary", {}, title),
    make("pre", { class: "words" }, text), button("copy", trying(async () => (await navigator.clipboard.writeText(text), tell("copied")))));
  return make("div", { class: "commands" }, part("show the command", shell), part("show the Python", python));
}

/** Inputs of options [name, words, example], the first of them in sight; `values()` holds those that are filled in. */
function optionFields(options, changed, first = 9) {
  const inputs = options.map(([name, words, example]) => [name, make("input", { name, placeholder: example, change: changed }), words]);
  const [some, more] = [inputs.slice(0, first), inputs.slice(first)].map((part) => part.map(([name, input, words]) =>
    make("label", {}, make("span", {}, words, make("code", { class: "note" }, ` --${name}`)), input)));
  const form = make("div", { class: "form" }, some, more.length > 0 && make("details", {}, make("summary", {}, "more"), more));
  const values = () => Object.fromEntries(inputs.filter(([, input]) => input.value.trim()).map(([name, input]) => [name, input.value.trim()]));
  return { form, values };
}

/** A choice between names of files. */
const choice = (names, attributes = {}) => make("select", attributes, names.map((name) => make("option", { value: name }, name)));

/** What a command said: findings and errors on stderr, answers on stdout. */
const words = (done) => [
  done.told.trim() && make("pre", { class: done.ok ? "words" : "words notice", role: done.ok ? null : "alert" }, done.told.trim()),
  !done.json && done.out.trim() && make("pre", { class: "words scroll" }, done.out.trim()),
];
const picture = (done, alt) => done.picture && make("img", { class: "picture", src: `look/${done.picture}`, alt });

/** Tables of columns that a command printed; on a phone each row is a block. */
function printed(text) {
  return text.trim().split(/\n\n+/).map((block) => {
    const [head, ...rows] = block.split("\n").map((line) => line.trim().split(/ {2,}/));
    if (!rows.length || head.length < 2) return make("p", {}, block);
    return make("table", { class: "wide" }, make("tr", {}, head.map((cell) => make("th", {}, cell))),
      rows.map((row) => make("tr", {}, row.map((cell, n) => make("td", { "data-head": n ? head[n] ?? "" : "" }, cell)))));
  });
}
