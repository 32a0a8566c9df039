// Which page is shown: the part of the address behind "#".

const PAGES = {
  "": startPage, case: casePage, new: newPage, runs: runsPage, result: resultPage, compare: comparePage, study: studyPage,
  surface: surfacePage, material: (name) => materialPage(name, "fit"), indentation: (name) => materialPage(name, "indentation"),
  block: blockPage, picture: picturePage,
  // What a file is decides its page.
  file: async (name) => { history.replaceState(null, "", link(await ask(`kind/${encoded(name)}`), name)); await show(); },
};
/** Called when the page is left; the page stays where it says false. */
let leave = () => {};
let turn = 0, message = "", shown = location.hash;

/** Goes to a page, which then has this message above it. */
function go(page, text = "") {
  message = text;
  if (location.hash === page) show();
  else location.hash = page;
}

async function show() {
  const [page, ...names] = location.hash.replace(/^#\/?/, "").split("/").map(decodeURIComponent);
  const own = ++turn;
  if ((await leave()) === false) {
    history.replaceState(null, "", shown || location.pathname);
    return;
  }
  if (own !== turn) return;
  leave = () => {};
  shown = location.hash;
  document.documentElement.dataset.ready = "no";
  try {
    const content = await (PAGES[page] ?? startPage)(page === "compare" ? names : names.join("/"));
    if (!content || own !== turn) return;
    $("main").replaceChildren(...[content].flat(9).filter(Boolean));
    document.title = `${names.join(", ") || page || "start"} - asperity`;
  } catch (error) {
    if (own !== turn) return;
    $("main").replaceChildren(make("p", { class: "notice", role: "alert" }, error.message), make("p", {}, make("a", { href: "#/" }, "back to the start")));
  }
  document.documentElement.dataset.ready = "yes";
}

const dark = window.matchMedia("(prefers-color-scheme: dark)");
function theme(name) {
  document.documentElement.dataset.theme = name;
  for (const frame of document.querySelectorAll("iframe.own")) frame.contentWindow.theme?.(name);
}
theme(dark.matches ? "dark" : "light");
dark.addEventListener("change", (event) => theme(event.matches ? "dark" : "light"));
$("theme").addEventListener("click", () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
$("folder").textContent = known.folder.split(/[\\/]/).pop() || known.folder;
$("folder").title = known.folder;
window.addEventListener("hashchange", () => { tell(message); message = ""; show().then(() => $("main").focus({ preventScroll: true })); });
// Its address is that of no page.
document.querySelector(".skip").addEventListener("click", (event) => { event.preventDefault(); $("main").focus(); });
// A file dropped beside the zone would replace the page.
for (const type of ["dragover", "drop"]) window.addEventListener(type, (event) => event.preventDefault());
window.addEventListener("pagehide", endLooks);
countRuns();
show();
