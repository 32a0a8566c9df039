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
const stem = (name) => name.replace(/^.*\//, "").replace(/\.[^.]*$/, "");

async function answer(response) {
  if (!response.ok) throw new Error(await response.text());
  return (response.headers.get("content-type") ?? "").startsWith("application/json") ? response.json() : response.text();
}
const ask = async (path) => answer(await fetch(path).catch(gone));
const send = async (path, content) => answer(await fetch(path, { method: "POST", body: JSON.stringify(content) }).catch(gone));
const gone = () => Promise.reject(new Error("asperity app does not answer: start it again. Runs go on meanwhile."));

/** A message to the user, above the page. */
function tell(text, bad = false) {
  $("told").textContent = text;
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

/** Inputs of options [name, words, example]; `values()` holds those that are filled in. */
function optionFields(options, changed) {
  const inputs = options.map(([name, words, example]) => [name, make("input", { name, placeholder: example, change: changed }), words]);
  const form = make("div", { class: "form" }, inputs.map(([, input, words]) => make("label", {}, words, input)));
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
