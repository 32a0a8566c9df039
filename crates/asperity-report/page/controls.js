// The controls of the maps: field, colours, time, line, player.

function fieldControls() {
  const buttons = state.fields.map((kind) => {
    const button = make("button", { type: "button", "aria-pressed": "false" }, kind.name);
    button.addEventListener("click", () => {
      chosen.field = kind.name;
      press(buttons, button);
      $("log-part").hidden = kind.colours !== "sequential" && kind.colours !== "pressure";
      showMap();
    });
    return button;
  });
  $("fields").replaceChildren(...buttons);
  chosen.field = state.fields[0].name;
  press(buttons, buttons[0]);
  $("limits").addEventListener("change", () => {
    if ($("limits").value === "own") return typedLimits();
    limitsOf(field()).ends = $("limits").value;
    showMap();
  });
  for (const id of ["low", "high"]) $(id).addEventListener("change", typedLimits);
  $("log-colours").addEventListener("change", () => {
    // Limits of the other scale are of no use.
    Object.assign(limitsOf(field()), { log: $("log-colours").checked, ends: limitsOf(field()).ends === "own" ? "each" : limitsOf(field()).ends });
    showMap();
  });
}

/** All instants one after another, at so many maps a second, from the start again where the last is shown. */
function player() {
  let playing = false;
  const show = (now) => {
    playing = now;
    $("play").setAttribute("aria-pressed", String(now));
    $("play").textContent = now ? "❚❚ pause" : "▶ play";
  };
  $("play").addEventListener("click", async () => {
    if (playing) return show(false);
    show(true);
    if (chosen.instant >= state.instants.length - 1) chosen.instant = -1;
    while (playing) {
      if (chosen.instant >= state.instants.length - 1) {
        if (!$("repeat").checked) break;
        chosen.instant = -1;
      }
      chosen.instant += 1;
      const since = performance.now();
      await showMap();
      await new Promise((done) => setTimeout(done, Math.max(1000 / Number($("speed").value) - (performance.now() - since), 0)));
    }
    show(false);
  });
}

/** The probe under the pointer, and the line that follows a drag. */
function pointing() {
  const canvas = $("map");
  const value = (event) => {
    const { map, unit, label, colours } = view.what, [i, j] = view.cell(event), one = map.values[i * map.ny + j];
    const text = isNaN(one) ? "undefined" : colours === "states" ? STATES[Math.round(one)][0] : words(one, unit);
    return [i, j, `${label} ${text}`];
  };
  const overArea = (event) => {
    const { map } = view.what, [i, j, text] = value(event), [lx, ly] = state.grid.size;
    $("probe").textContent = `x = ${words(((i + 0.5) / map.nx) * lx, "m")}, y = ${words(((j + 0.5) / map.ny) * ly, "m")}: ${text}`;
    if (!event.buttons && event.type !== "pointerdown") return;
    chosen.share = chosen.along === "x" ? (j + 0.5) / map.ny : (i + 0.5) / map.nx;
    moveLine();
  };
  const overTime = (event) => {
    const { map, rows } = view.what, [i, j, text] = value(event), part = (j + 0.5) / map.ny;
    const time = rows.log ? rows.first * Math.pow(rows.last / rows.first, part) : rows.first + part * (rows.last - rows.first);
    $("probe").textContent = `x = ${words(((i + 0.5) / map.nx) * state.grid.size[0], "m")}, t = ${words(time, "s")}: ${text}`;
    if (event.buttons || event.type === "pointerdown") showNearest(time);
  };
  const move = (event) => view.what && (state.grid.line ? overTime : overArea)(event);
  canvas.addEventListener("pointermove", move);
  canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); move(event); });
  canvas.addEventListener("keydown", (event) => {
    if (state.grid.line || !view.what) return;
    const step = chosen.along === "x" ? { ArrowUp: 1, ArrowDown: -1 }[event.key] : { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const count = chosen.along === "x" ? view.what.map.ny : view.what.map.nx;
    chosen.share = Math.min(Math.max(chosen.share + step / count, 0.5 / count), 1 - 0.5 / count);
    moveLine();
  });
}

function moveLine() {
  view.move({ along: chosen.along, share: chosen.share });
  showProfile(field(), view.what.map);
}

function mapsPart() {
  $("maps").hidden = !state.fields.length || !state.instants.length;
  if ($("maps").hidden) return;
  fieldControls();
  $("map-note").textContent = state.note;
  // The last maps with contact: without, they are empty.
  const touching = state.running ? -1 : state.instants.findLastIndex(({ row }) => state.series.contact_area[row] > 0);
  chosen.instant = touching < 0 ? state.instants.length - 1 : touching;
  $("instant").max = state.instants.length - 1;
  $("instant").addEventListener("input", () => {
    chosen.instant = Number($("instant").value);
    showMap();
  });
  const one = state.rows.label, many = one === "time" ? "times" : "velocities";
  $("limits").querySelector("[value=each]").textContent = `of each ${one}`;
  $("limits").querySelector("[value=all]").textContent = `common to all ${many}`;
  $("instant").setAttribute("aria-label", `${one} of the map`);
  const lines = [...document.querySelectorAll("[data-line]")];
  if (state.grid.line) {
    lines[0].parentElement.hidden = true;
    $("h-maps").textContent = "Fields";
    // The map over x and time has all instants.
    $("limits").querySelector("[value=all]").remove();
    $("limits").querySelector("[value=each]").textContent = `of all ${many}`;
    $("probe").textContent = "At each time the nearest stored instant. Point at it for values; drag to choose the instant.";
  }
  lines.forEach((button) => button.addEventListener("click", () => {
    chosen.along = button.dataset.line;
    press(lines, button);
    moveLine();
  }));
  player();
  pointing();
  return showMap();
}
