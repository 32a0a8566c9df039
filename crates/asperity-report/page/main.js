// The page: what stands where, light and dark, and a run that goes on.

// Light and dark: as the system has it, until the button is used.
const dark = window.matchMedia("(prefers-color-scheme: dark)");
function theme(name) {
  document.documentElement.dataset.theme = name;
  charts.forEach((chart) => chart.uplot?.redraw());
  for (const part of [view, heights, relief]) if (part.what) part.render();
}
document.documentElement.dataset.theme = dark.matches ? "dark" : "light";
dark.addEventListener("change", (event) => theme(event.matches ? "dark" : "light"));
$("theme").addEventListener("click", () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));

// A number stays with its unit and its error.
const unbroken = (value) => value.replace(/([\d)]) ([^\s±]+)(?= ±|$)/, "$1\u00a0$2").replace(" ± ", "\u00a0±\u00a0");

function summary() {
  $("title").textContent = state.title;
  document.title = state.title;
  $("status").textContent = state.status;
  $("case").textContent = state.case;
  $("footer").textContent = state.footer;
  $("findings").hidden = !state.findings.length;
  $("finding-list").replaceChildren(...state.findings.map((finding) =>
    make("li", { class: finding.severity }, make("b", {}, finding.severity), ` ${finding.text} `, make("code", {}, finding.code))));
  $("headline").replaceChildren(...state.headline.map(([name, value]) => make("div", {}, make("b", {}, unbroken(value)), make("span", {}, name))));
  $("facts").replaceChildren(...terms(state.facts));
}

async function start() {
  summary();
  axisSwitches();
  stressPart();
  evolutionPart();
  solverPart();
  leakPart();
  materialPart();
  if (typeof DecompressionStream === "undefined") {
    $("maps").replaceChildren(make("p", { class: "notice" }, "This browser is too old to unpack the maps (it lacks DecompressionStream); all others since 2023 can."));
    $("surface").hidden = true;
  } else {
    await surfacePart();
    await mapsPart();
  }
  document.documentElement.dataset.ready = "yes";
  if (state.running) setTimeout(follow, 2000);
}

/** A run that goes on: what is new every two seconds. */
async function follow() {
  let next;
  try {
    next = await (await fetch("state")).json();
  } catch {
    $("status").textContent = "no longer served: start asperity view again";
    return;
  }
  const atEnd = chosen.instant >= state.instants.length - 1, hadMaps = state.instants.length > 0;
  if (next.instants.length < state.instants.length) {
    cache.clear();
    single.clear();
  }
  for (const key of ["series", "status", "headline", "facts", "findings", "instants", "fields", "running", "stress", "leak", "last_cycle", "force_curve", "cycles"]) state[key] = next[key];
  summary();
  stressPart();
  evolutionPart();
  solverPart();
  leakPart();
  if (!hadMaps && state.instants.length) await mapsPart();
  else if (state.instants.length) {
    $("instant").max = state.instants.length - 1;
    if (atEnd) {
      chosen.instant = state.instants.length - 1;
      await showMap();
    }
  }
  if (state.running) setTimeout(follow, 2000);
}
start();
