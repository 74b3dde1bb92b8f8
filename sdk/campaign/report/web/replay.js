// Two flights through one cave side by side: one time, one camera.

/** A scene's cloud, unpacked: each axis as differences to the cell before, times, normals (docs/report.md). */
async function unpackCloud(c) {
  if (!c) return null;
  const packed = decode(c.packed, Uint8Array);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = await new Response(stream).arrayBuffer(), n = c.count;
  const cells = new Int16Array(3 * n), normals = new Int8Array(3 * n);
  for (let axis = 0; axis < 3; ++axis) {
    const steps = new Int16Array(bytes, 2 * n * axis, n), coarse = new Int8Array(bytes, 10 * n + n * axis, n);
    for (let i = 0, at = 0; i < n; ++i) {
      at += steps[i];
      cells[3 * i + axis] = at;
      normals[3 * i + axis] = coarse[i];
    }
  }
  return { ...c, cells, normals, from: new Uint16Array(bytes, 6 * n, n), until: new Uint16Array(bytes, 8 * n, n) };
}

const flightOnly = { goals: [], plans: [], frontiers: [], choices: [], drawings: [], objects: [], true_track: null };
const lookUniforms = { clip: 1e9, size: 1.2, mode: 0, inside: true };

/** Two windows whose cameras stand at the same place; null without WebGL. */
function makeTwins() {
  const stages = [];
  let copying = false;
  const changed = (from) => {
    if (copying) return;
    copying = true;
    for (const to of stages) {
      if (to === from) continue;
      to.camera.position.copy(from.camera.position);
      to.controls.target.copy(from.controls.target);
      to.controls.update();
      to.redraw();
    }
    copying = false;
  };
  const viewed = (name) => { for (const b of document.querySelectorAll("[data-view]")) b.classList.toggle("on", b.dataset.view === name); };
  for (const side of ["a", "b"]) {
    const stage = makeStage(element("view-" + side), element("labels-" + side), () => 0, { changed, viewed });
    if (!stage) return null;
    stages.push(stage);
  }
  return stages;
}

function sceneOf(contestant, cave, seed) {
  return data.replays.scenes.find((s) => { const t = data.trials[s.trial]; return t.contestant === contestant && t.cave === cave && t.seed === seed; });
}

/** Coverage of both flights over time, with a line that follows the slider. */
function replayCurve(scenes) {
  const lines = scenes.map((s) => data.curves && (data.curves.coverage.trials[s.trial] || null));
  if (!lines.some(Boolean)) return null;
  const t = data.curves.t;
  const plot = makePlot({ title: "Coverage of both flights over time", width: 1280, height: 190, left: 60,
    x: { range: [0, Math.max(t[t.length - 1], moment.end)], ticks: timeTicks(Math.max(t[t.length - 1], moment.end), 14), text: clockText, label: "time from take-off, min:s" },
    y: { range: [0, Math.max(rangeOf(lines.flatMap((l) => l || []), true)[1], 1e-9)], ticks: 4, text: (v) => tickText(100 * v) + " %", label: "coverage" } });
  lines.forEach((l, k) => {
    const i = data.trials[scenes[k].trial].contestant;
    if (l) plot.body.append(svg("path", { class: "line", d: pathOf(plot, t, l), style: `stroke: ${colourOf(i)}`, "stroke-dasharray": dashOf(i) }));
    for (let j = 4 + 4 * k; l && j < t.length; j += 10) plot.body.append(markAt(plot.x(t[j]), plot.y(l[j]), i, 4));
  });
  const now = svg("line", { class: "now", y1: plot.area.top, y2: plot.area.bottom });
  plot.body.append(now);
  plot.root.addEventListener("click", (e) => {
    const share = (e.clientX - plot.root.getBoundingClientRect().left) / plot.root.getBoundingClientRect().width;
    const [x0, x1] = [plot.x(0), plot.x(1)];
    setMoment((share * 1280 - x0) / (x1 - x0));
  });
  return { figure: plot.figure, at(time) { for (const x of ["x1", "x2"]) now.setAttribute(x, plot.x(time)); } };
}

/** The value of a trial's curve at a time from take-off; null if it is not known. */
function curveValue(quantity, trial, t) {
  const curve = data.curves && data.curves[quantity].trials[trial], grid = data.curves && data.curves.t;
  if (!curve) return null;
  const i = lastAt(grid.length, (k) => grid[k], t);
  if (i < 0 || i + 1 >= grid.length) return curve[Math.max(0, Math.min(i, grid.length - 1))];
  return curve[i] + (curve[i + 1] - curve[i]) * (t - grid[i]) / (grid[i + 1] - grid[i]);
}

async function startReplay(asked) {
  const { scenes, seeds } = data.replays;
  const refuse = (text) => {
    element("replay-empty").hidden = false;
    element("replay-empty").textContent = text;
    element("replay-body").hidden = true;
  };
  if (!scenes.length) return refuse("No recorded flights are embedded in this page.");
  if (!window.DecompressionStream) return refuse("This browser is too old to unpack the recorded flights.");
  const stages = makeTwins();
  if (!stages) return refuse("This browser cannot draw in 3D (no WebGL). Plots and tables are above.");

  const caves = data.caves.map((_, i) => i).filter((c) => scenes.some((s) => data.trials[s.trial].cave === c));
  element("replay-cave").replaceChildren(...caves.map((c) => make("option", { value: String(c) }, caveNames[c])));
  const ranked = data.verdicts.ranking.map((p) => p.contestant);
  let shown = [], curve = null, clouds = [], turn = 0;

  const fillSeeds = () => {
    const of = seeds[choice("replay-cave")] || [];
    element("replay-seed").replaceChildren(...of.map((seed, k) =>
      make("option", { value: String(seed) }, `${seed}` + (of.length > 1 ? (k === 0 ? " (middle)" : " (worst)") : ""))));
  };
  const fillContestants = () => {
    const there = ranked.filter((c) => sceneOf(c, choice("replay-cave"), choice("replay-seed")));
    ["replay-a", "replay-b"].forEach((id, k) => {
      const before = element(id).value, keep = there.includes(Number(before)) && before !== "";
      element(id).replaceChildren(...there.map((c) => make("option", { value: String(c) }, contestantNames[c])));
      element(id).value = String(keep ? before : there[Math.min(k, there.length - 1)]);
    });
  };
  const applyLook = () => {
    for (const cloud of clouds) {
      if (!cloud) continue;
      const { uniforms, top, bottom } = cloud, share = lookUniforms.clip;
      uniforms.clip.value = share >= 1 ? 1e9 : bottom + share * (top - bottom);
      uniforms.size.value = lookUniforms.size;
      uniforms.mode.value = lookUniforms.mode;
      uniforms.inside.value = lookUniforms.inside;
    }
    stages.forEach((s) => s.redraw());
  };
  const show = async () => {
    const mine = ++turn;
    const picked = ["replay-a", "replay-b"].map((id) => sceneOf(choice(id), choice("replay-cave"), choice("replay-seed")));
    const unpacked = await Promise.all(picked.map((s) => unpackCloud(s.cloud)));
    if (mine !== turn) return;  // another choice was made meanwhile
    shown = picked;
    clouds = unpacked.map(makeCloud);
    const flights = picked.map((s) => makeFlight({ ...flightOnly, phases: s.phases, track: s.track }));
    const points = flights.flatMap((f, k) => samplePoints(clouds[k], f));
    if (!points.length) points.push(new THREE.Vector3(-5, -5, -5), new THREE.Vector3(5, 5, 5));
    const both = clouds.filter(Boolean);
    for (const c of both)  // one scale of heights
      for (const [limit, pick] of [["low", Math.min], ["high", Math.max]]) c.uniforms[limit].value = pick(...both.map((o) => o[limit]));
    for (const c of both) c.top = Math.max(...both.map((o) => o.top)), c.bottom = Math.min(...both.map((o) => o.bottom));
    applyLook();
    stages.forEach((s, k) => s.show(clouds[k], flights[k], points));
    stages[0].setView("oblique");
    setTimeRange(0, Math.max(1, ...picked.map((s) => s.end_s)));
    curve = replayCurve(picked);
    element("replay-curve").replaceChildren(curve ? curve.figure : "");
    const size = both.length ? `cells of ${numberText(Math.max(...both.map((c) => c.cell_m)), 2)} m, ` : "";
    element("replay-note").textContent = `Drag to turn, right-drag to pan, wheel to zoom: both cameras move together. Way out in orange, way home in blue; ${size}colour by height. ` +
      `Of each cave the seed in the middle and the worst are embedded, by ${metricNames[data.verdicts.metric]} in the mean over contestants.`;
    setMoment(moment.end);
  };
  moment.listeners.push((t) => {
    stages.forEach((s) => s.setTime(t));
    if (curve) curve.at(t);
    shown.forEach((s, k) => {
      const trial = data.trials[s.trial], coverage = curveValue("coverage", s.trial, t), volume = curveValue("explored_m3", s.trial, t);
      const phase = t >= s.end_s ? (trial.failed ? "failed" : trial.outcome) : phaseAt(s, t);
      const numbers = [phase, coverage === null ? "" : `${(100 * coverage).toFixed(1)} %`, volume === null ? "" : `${numberText(volume)} m³`].filter(Boolean).join(" · ");
      element("caption-" + "ab"[k]).replaceChildren(make("b", {}, swatch(trial.contestant), " " + contestantNames[trial.contestant]), make("span", { className: "numbers" }, numbers));
      element("view-" + "ab"[k]).setAttribute("aria-label", `Map and path of ${contestantNames[trial.contestant]} in ${caveNames[trial.cave]} at ${clockText(t)}: ${numbers}`);
    });
  });

  startTimeline();
  foldWhereNarrow(element("replay-choices"));
  connectSlider("clip", (v) => v >= 1 ? "off" : Math.round(100 * v) + " %", (v) => { lookUniforms.clip = v; applyLook(); });
  connectSlider("size", (v) => Math.round(v * 100) + " %", (v) => { lookUniforms.size = v; applyLook(); });
  whenChosen(["colour"], () => { lookUniforms.mode = choice("colour"); applyLook(); });
  whenChosen(["inside"], () => { lookUniforms.inside = element("inside").checked; applyLook(); });
  whenChosen(["replay-cave"], () => { fillSeeds(); fillContestants(); show(); });
  whenChosen(["replay-seed"], () => { fillContestants(); show(); });
  whenChosen(["replay-a", "replay-b"], show);
  for (const b of document.querySelectorAll("[data-view]")) b.addEventListener("click", () => stages[0].setView(b.dataset.view));
  const put = (id, value) => { if (value !== null && [...element(id).options].some((o) => o.value === value)) element(id).value = value; };
  put("replay-cave", asked.get("cave"));
  fillSeeds();
  put("replay-seed", asked.get("seed"));
  fillContestants();
  put("replay-a", asked.get("a"));
  put("replay-b", asked.get("b"));
  await show();
  if (asked.has("t")) setMoment(Number(asked.get("t")) || 0);
  if (asked.get("view")) stages[0].setView(asked.get("view"));
}
