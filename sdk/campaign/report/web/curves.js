// Coverage and explored volume over time: one large plot over all caves, a small one for each.

function quantileOf(sorted, share) {
  if (!sorted.length) return null;
  const at = share * (sorted.length - 1), i = Math.floor(at);
  return i + 1 < sorted.length ? sorted[i] + (at - i) * (sorted[i + 1] - sorted[i]) : sorted[i];
}

/** Indices of a contestant's trials that have a curve, in a cave or (-1) in all. */
function trialsOf(contestant, cave, curves) {
  return data.trials.map((t, i) => i).filter((i) => curves[i] && data.trials[i].contestant === contestant &&
    (cave < 0 || data.trials[i].cave === cave));
}

/** { n, mean, low, high } of a contestant: mean with interval, or median with quartiles. */
function middleOf(quantity, contestant, cave, median) {
  const { trials, bands } = data.curves[quantity];
  if (!median) return cave < 0 ? bands[contestant].all : bands[contestant].caves[cave];
  const own = trialsOf(contestant, cave, trials);
  if (!own.length) return null;
  const sorted = data.curves.t.map((_, k) => own.map((i) => trials[i][k]).sort((a, b) => a - b));
  return { n: own.length, mean: sorted.map((s) => quantileOf(s, 0.5)), low: sorted.map((s) => quantileOf(s, 0.25)),
           high: sorted.map((s) => quantileOf(s, 0.75)) };
}

function timeTicks(end, count) {
  const step = [10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200].find((s) => end / s <= count) || 14400;
  return Array.from({ length: Math.floor(end / step + 1e-9) + 1 }, (_, i) => i * step);
}

function curvePlot(cave, large) {
  const quantity = element("curve-quantity").value, median = element("curve-middle").value === "median";
  const withTrials = element("curve-trials").checked;
  const t = data.curves.t, share = quantity === "coverage";
  const lines = data.contestants.map((_, i) => middleOf(quantity, i, cave, median));
  const seen = lines.filter(Boolean).flatMap((l) => [...l.mean, ...l.high]);
  if (withTrials)
    data.contestants.forEach((_, i) => { for (const k of trialsOf(i, cave, data.curves[quantity].trials)) seen.push(...data.curves[quantity].trials[k]); });
  const trials = countText(lines.filter(Boolean).map((l) => l.n));
  const where = cave < 0 ? "all caves" : caveNames[cave];
  const plot = makePlot({
    title: `${share ? "Coverage" : "Explored volume"} over time in ${where}, ${median ? "median and quartiles" : `mean and ${percentOfIntervals} % interval`} of each contestant; the numbers are in the table below`,
    heading: where, aside: `${trials} ${trials === "1" ? "trial" : "trials"} each` + (lines.some((l) => l && l.over) ? ", bands over caves for want of seeds" : ""), width: large ? 640 : 310, height: large ? 478 : 218, left: large ? 54 : 44,
    x: { range: [0, t[t.length - 1]], ticks: timeTicks(t[t.length - 1], large ? 8 : 5), text: clockText, label: large ? "time from take-off, min:s" : "" },
    y: { range: [0, Math.max(Math.min(rangeOf(seen, true)[1], share ? 1 : Infinity), 1e-9)], text: share ? (v) => tickText(100 * v) + " %" : tickText, ticks: large ? 7 : 4,
         label: large ? (share ? "coverage" : "explored volume, m³") : "" } });
  // Intervals of few seeds reach beyond what can be: bands end at the frame, the table has them whole.
  const framed = (values) => values.map((v) => v === null ? v : Math.min(plot.range[1], Math.max(plot.range[0], v)));
  lines.forEach((l, i) => { if (l) plot.body.append(svg("path", { class: "band", d: bandPath(plot, t, framed(l.low), framed(l.high)), style: `fill: ${colourOf(i)}` })); });
  if (withTrials)
    data.contestants.forEach((_, i) => {
      for (const k of trialsOf(i, cave, data.curves[quantity].trials))
        plot.body.append(svg("path", { class: "thin", d: pathOf(plot, t, data.curves[quantity].trials[k]), style: `stroke: ${colourOf(i)}` }));
    });
  const every = large ? 12 : 25;
  lines.forEach((l, i) => {
    if (!l) return;
    plot.body.append(svg("path", { class: "line", d: pathOf(plot, t, l.mean), style: `stroke: ${colourOf(i)}`, "stroke-dasharray": dashOf(i) }));
    const first = Math.round(every * (0.5 + i) / data.contestants.length);
    for (let k = first; k < t.length; k += every)
      plot.body.append(markAt(plot.x(t[k]), plot.y(l.mean[k]), i, large ? 4.4 : 3.4,
        `${contestantNames[i]} at ${clockText(t[k])}: ${numberText(share ? 100 * l.mean[k] : l.mean[k])} ${share ? "%" : "m³"}`));
  });
  return plot.figure;
}

function curveTable() {
  const quantity = element("curve-quantity").value, median = element("curve-middle").value === "median";
  const t = data.curves.t, picked = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10].map((k) => Math.round(k * (t.length - 1) / 10));
  const text = quantity === "coverage" ? (v) => numberText(100 * v) : (v) => numberText(v);
  const table = make("table"), rows = [];
  for (let cave = -1; cave < data.caves.length; ++cave)
    data.contestants.forEach((_, i) => {
      const l = middleOf(quantity, i, cave, median);
      if (l) rows.push([[cave < 0 ? "all caves" : caveNames[cave], "name"], [named(i), "name"], [String(l.n), "number"],
        ...picked.map((k) => [withRemark(text(l.mean[k]), intervalText([l.low[k], l.high[k]], text)), "number"])]);
    });
  fillTable(table, [["cave", "name"], ["contestant", "name"], ["trials", "number"],
    ...picked.map((k) => [`${clockText(t[k])}`, "number"])], rows);
  element("curve-table").replaceChildren(make("p", { className: "quiet note" },
    `${quantity === "coverage" ? "Coverage in percent" : "Explored volume in m³"} by time from take-off, ${median ? "median and quartiles" : `mean and ${percentOfIntervals} % interval`}.`), table);
}

function startCurves() {
  if (!data.curves) {
    element("curves").replaceChildren(make("h2", {}, "Over time"), make("p", { className: "quiet" }, "No flight has recorded anything over time yet."));
    return;
  }
  fillLegend("curve-legend", contestantNames, true);
  const show = () => {
    const caves = data.caves.map((_, i) => i);
    element("curve-plots").replaceChildren(curvePlot(-1, true), ...(caves.length > 1 ? caves.map((c) => curvePlot(c, false)) : []));
    curveTable();
  };
  whenChosen(["curve-quantity", "curve-middle", "curve-trials"], show);
  show();
}
