// Header, events, metrics, timing and settings.

/** A flight ends at its start; a replay with its recording. */
function endedWell(outcome) { return outcome === "landed" || outcome === "replayed"; }

function isTrouble(e) {
  return e.kind === "safety" || (e.kind === "log" && / broke, and was started once more: /.test(e.text)) || (e.kind === "truth" && /^(contact|battery)/.test(e.text)) || e.kind === "contact" || e.kind === "overrun" || e.kind === "degraded" ||
    (e.kind === "goal" && /rejected|unreachable|abandoned/.test(e.state)) ||
    (e.kind === "outcome" && !endedWell(e.outcome));
}

/** What an event says, in a line. */
function eventText(e) {
  const because = (text) => text ? ": " + text : "";
  switch (e.kind) {
    case "phase": return e.phase + because(e.reason);
    case "goal": return [`${e.state} ${placeText(e.position)}`, e.why, e.reason].filter(Boolean).join(" – ");
    case "decision":
      return `${e.outcome}, ${e.goals ?? 0} goals${typeof e.frontiers === "number" ? `, ${e.frontiers} frontiers` : ""}${because(e.reason)}`;
    case "plan": return "path" + (withUnit(e.length, "m") ? " of " + withUnit(e.length, "m") : "");
    case "homing": {
      const left = [withUnit(e.distance, "m"), withUnit(e.seconds_left, "s left")].filter(Boolean);
      return `flies home${because(e.reason)}${left.length ? ` (${left.join(", ")})` : ""}`;
    }
    case "frontier": return `${e.state} ${placeText(e.position)}${because(e.reason)}`;
    case "safety": return `${e.action}${because(e.reason)}`;
    case "object": case "object_known": return `${e.what || "object"} ${e.number} ${e.state || ""} ${placeText(e.position)}`;
    case "earlier_map":
      return `place in the earlier map ${e.state}${because(e.reason)}${typeof e.overlap === "number" ? ` (overlap ${Math.round(100 * e.overlap)} %)` : ""}`;
    case "outcome": return `${e.outcome}${because(e.reason)}`;
    case "log": case "truth": return e.text || "";
    default: {
      const { t, kind, ...rest } = e;
      return Object.entries(rest).map(([k, v]) => `${k} ${typeof v === "object" ? JSON.stringify(v) : v}`).join(", ");
    }
  }
}

/** The same with whose event it is, of a team. */
function eventLine(e) {
  if (!data.robots || !e.robot) return eventText(e);
  const { robot, ...rest } = e;
  return [`robot ${robot}`, eventText(rest)].filter(Boolean).join(": ");
}

/** The text of the outcome and its class: green only for a mission as planned that flew to a goal. */
function outcomeBadge(outcome) {
  const good = data.as_meant ?? endedWell(outcome);
  if (!good) return ["✕ " + (outcome || "not known") + (endedWell(outcome) ? ", not as planned" : ""), ""];
  const nowhere = outcome === "landed" && data.as_meant && data.goals && data.goals.length === 0;
  return nowhere ? ["landed without exploring", "nowhere"] : ["✓ " + outcome, "landed"];
}

/** What was flown, in a sentence, and whether the mission went as planned; `more` stands behind the title. */
function showTitle(more = []) {
  const m = data.metrics;
  const seed = typeof m.seed === "number" ? "seed " + m.seed : "";
  const title = isReplay ? [m.recording, "replay"]
    : [m.policy || "unknown policy", m.cave || "unknown cave", seed, ...more].filter(Boolean);
  element("title").textContent = title.join(" · ");
  document.title = "karst: " + title.join(", ");
  const [text, look] = outcomeBadge(m.outcome);
  element("outcome").textContent = text;
  element("outcome").className = "badge " + look;
  element("summary").textContent = tied(data.summary + (data.as_meant === null && m.reason ? "; " + m.reason : ""));
}

/** [[name, [value, unit] or null], ...] as cards; those without a value are named in one line below. */
function showFigures(figures) {
  for (const [name, known] of figures)
    if (known)
      element("figures").append(make("div", { className: "figure" },
        make("b", {}, known[0], known[1] ? make("small", {}, " " + known[1]) : ""), make("span", {}, name)));
  element("figures-unknown").textContent = notKnown(figures.filter(([, known]) => !known).map(([name]) => name));
}
/** [value, unit] of a figure for its card, or null. */
function figure(v, unit, digits) { return typeof v === "number" ? [numberText(v, digits), unit] : null; }
function figureShare(v) { return typeof v === "number" ? figure(100 * v, "%", 3) : null; }

function showProblems() {
  if (!data.problems.length) return;
  const box = element("problems"), n = data.problems.length;
  box.hidden = false;
  box.querySelector("summary").textContent = `${n} ${n === 1 ? "note" : "notes"} on this record: what is missing, damaged or thinned out`;
  for (const p of data.problems) box.querySelector("ul").append(make("li", {}, p));
}

/** What there is to say of a recording, and whether loops were closed in it. */
function replayFigures(m) {
  const count = (v) => typeof v === "number" ? [String(v), ""] : null;
  return [
    [m.scans_lost ? `scans (${m.scans_lost} lost)` : "scans", count(m.scans)],
    ["duration", typeof m.flight_time_s === "number" ? durationParts(m.flight_time_s) : null],
    ["path length", figure(m.path_length_m, "m")], ["mean speed", figure(m.mean_speed_mps, "m/s")],
    ["free volume", figure(m.explored_volume_m3, "m³", 4)], ["loops closed", count(m.loops_closed)],
    ...m.loops_closed ? [["greatest correction", typeof m.loop_correction_m === "number" ? [m.loop_correction_m.toFixed(2), "m"] : null]] : [],
  ];
}

function showHeader() {
  const m = data.metrics;
  showTitle();
  if (isReplay) {
    showFigures(replayFigures(m));
    return showProblems();
  }
  const refused = typeof m.goals_rejected === "number" ? `(${m.goals_rejected})` : "";
  showFigures([
    ["flight time", typeof m.flight_time_s === "number" ? durationParts(m.flight_time_s) : null],
    ["explored", figure(m.explored_volume_m3, "m³", 4)], [m.coverage_of ? `coverage of the ${m.coverage_of}` : "coverage", figureShare(m.coverage)],
    ["path length", figure(m.path_length_m, "m")], ["mean speed", figure(m.mean_speed_mps, "m/s")],
    ["least clearance", figure(m.min_clearance_m, "m", 2)], ["contacts", figure(m.contacts, "", 3)],
    ["landing error", figure(m.landing_error_m, "m", 2)], ["map error", figure(m.map_error_mean_m, "m", 2)],
    ["battery left", figureShare(m.battery_left)],
    ["goals (refused)", typeof m.goals_accepted === "number" ? [String(m.goals_accepted), refused] : null],
  ]);
  showProblems();
}

function showEvents() {
  const body = document.querySelector("#events tbody"), count = {};
  const hidden = new Set(["plan"]);
  for (const e of data.events) count[e.kind] = (count[e.kind] || 0) + 1;
  const fill = () => {
    const shown = data.events.filter((e) => !hidden.has(e.kind)).slice(0, 5000);
    body.replaceChildren(...shown.map((e) => {
      const row = make("tr", { className: isTrouble(e) ? "bad" : "" }, make("td", {}, clockText(e.t)),
        make("td", {}, e.kind), make("td", {}, tied(eventLine(e))));
      row.addEventListener("click", () => setMoment(e.t));
      return row;
    }));
    element("event-count").textContent = data.events.length
      ? `${shown.length} of ${data.events.length} shown; click a row to go to that moment` : "none recorded";
  };
  for (const kind of Object.keys(count)) {
    const button = make("button", { type: "button" }, `${kind} ${count[kind]}`);
    button.classList.toggle("on", !hidden.has(kind));
    button.addEventListener("click", () => {
      if (!hidden.delete(kind)) hidden.add(kind);
      button.classList.toggle("on", !hidden.has(kind));
      fill();
    });
    element("event-kinds").append(button);
  }
  fill();
}

function table(target, list) {
  for (const [name, text] of list)
    target.append(make("tr", {}, make("td", {}, name), make("td", { className: "number" }, text)));
}

function showTiming() {
  const box = element("timing"), timing = data.timing;
  if (!timing || typeof timing !== "object") { box.append(make("p", { className: "quiet" }, "not recorded")); return; }
  if (typeof timing.simulated_s_per_wall_s === "number")
    box.append(make("p", {}, `${numberText(timing.simulated_s_per_wall_s)} simulated seconds per second`));
  const rows = make("table", {}, make("tr", {}, ...["job", "count", "p50 ms", "p99 ms", "max ms"].map((t) => make("th", {}, t))));
  for (const [name, j] of Object.entries(timing.jobs || {})) {
    const cell = (v) => make("td", { className: "number" }, typeof v === "number" ? numberText(v) : "");
    rows.append(make("tr", {}, make("td", {}, name), make("td", { className: "number" }, String(j.count ?? "")), cell(j.p50_ms), cell(j.p99_ms), cell(j.max_ms)));
  }
  box.append(rows);
  if (timing.real_time && typeof timing.real_time === "object") showRealTime(box, timing.real_time);
}

/** How late the steps of a flight in real time were, what the computer granted, and what was left out. */
function showRealTime(box, realTime) {
  const cell = (v) => make("td", { className: "number" }, typeof v === "number" ? numberText(v) : "");
  const rows = make("table", {}, make("tr", {}, ...["step", "late: p50 ms", "p99 ms", "p99.9 ms", "max ms", "missed"].map((t) => make("th", {}, t))));
  for (const [name, l] of Object.entries(realTime.lateness || {}))
    rows.append(make("tr", {}, make("td", {}, name), cell(l.p50_ms), cell(l.p99_ms), cell(l.p99_9_ms), cell(l.max_ms), cell(l.missed_deadlines)));
  box.append(rows);
  const left = Object.entries(realTime.degraded || {}).map(([what, times]) => `${what} (${times})`);
  box.append(make("p", {}, left.length ? `left out while a lane was late: ${left.join(", ")}` : "nothing was left out"));
  for (const [what, grant] of Object.entries(realTime.granted || {}))
    box.append(make("p", { className: "quiet" }, `${what}: ${grant.text}`));
}

/** Name, value and unit of each figure that has a value; one line names the others. */
function showMetrics() {
  const figures = Object.entries(data.metrics).filter(([, v]) => typeof v !== "object" || v === null);
  const unknown = figures.filter(([, v]) => v === null).map(([name]) => name);
  const text = (v) => typeof v !== "number" ? String(v) : Number.isInteger(v) ? String(v) : numberText(v, 4);
  for (const [name, v] of figures)
    if (v !== null)
      element("metrics").append(make("tr", {}, make("td", {}, name), make("td", { className: "number" }, text(v)),
        make("td", { className: "unit quiet" }, unitText(data.units[name]))));
  element("metrics-unknown").textContent = notKnown(unknown);
}

function startTables() {
  showEvents();
  showMetrics();
  table(element("settings"), data.settings.length ? data.settings : [["not recorded", ""]]);
  showTiming();
}
