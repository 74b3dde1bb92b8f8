// The chosen figure by cave: dots with intervals, and the same as a table.

function cellsOf(m, cave) { return data.contestants.map((_, i) => cave < 0 ? data.summaries[m][i].all : data.summaries[m][i].caves[cave]); }

/** Rows of dots with whiskers. rows: [name, [{ value, interval, style, tip }]]; an entry may be null. */
function dotPlot({ title, heading, label, rows, zero = false, seeds, width = 560 }) {
  const values = rows.flatMap(([, dots]) => dots.filter(Boolean).flatMap((d) => [d.value, ...d.interval]));
  if (zero) values.push(0);
  const step = 15, gap = 12, count = Math.max(1, ...rows.map(([, dots]) => dots.length));
  const rowHeight = count * step + gap, height = rows.length * rowHeight + 54;
  const longest = Math.max(...rows.map(([name]) => name.length));
  const plot = makePlot({ title, heading, aside: seeds, width, height, left: Math.min(200, 22 + 6.4 * longest),
    x: { range: rangeOf(values), label, ticks: 6 },
    y: { range: [rows.length, 0], rows: true, ticks: rows.map((_, k) => k + 0.5),
         text: (v) => { const name = rows[Math.floor(v)][0]; return name.length > 27 ? name.slice(0, 26) + "…" : name; } } });
  if (zero) plot.body.append(svg("line", { class: "zero", x1: plot.x(0), x2: plot.x(0), y1: plot.area.top, y2: plot.area.bottom }));
  rows.forEach(([, dots], k) => {
    if (k) plot.body.append(svg("line", { class: "grid", x1: plot.area.left, x2: plot.area.right, y1: plot.y(k), y2: plot.y(k) }));
    dots.forEach((d, i) => {
      if (!d || d.value === null) return;
      const y = plot.y(k + 0.5) + (i - (dots.length - 1) / 2) * step;
      if (d.interval[0] !== null)
        plot.body.append(svg("path", { class: "whisker", style: `stroke: ${colourOf(d.style)}`,
          d: `M${plot.x(d.interval[0]).toFixed(1)} ${y}H${plot.x(d.interval[1]).toFixed(1)}` +
             [0, 1].map((e) => `M${plot.x(d.interval[e]).toFixed(1)} ${y - 3.5}v7`).join("") }));
      plot.body.append(markAt(plot.x(d.value), y, d.style, 4.6, d.tip));
    });
  });
  return plot.figure;
}

function showByCave(m) {
  const caves = [...data.caves.map((_, i) => i), ...(data.caves.length > 1 ? [-1] : [])];
  const name = (cave) => cave < 0 ? "all caves" : caveNames[cave];
  const better = data.metrics[m].better;
  const rows = caves.map((cave) => [name(cave), cellsOf(m, cave).map((s, i) => s && {
    value: s.mean, interval: s.interval, style: i,
    tip: `${contestantNames[i]}, ${name(cave)}: ${numberText(s.mean)} ${intervalText(s.interval)}, ${s.n} trials` })]);
  const known = rows.some(([, dots]) => dots.some(Boolean));
  element("figure-plot").replaceChildren(known ? dotPlot({
    title: `${metricNames[m]} of each contestant in each cave, mean and ${percentOfIntervals} % interval; the numbers are in the table beside`,
    label: metricLabel(m) + (better === "more" ? " (more is better)" : better === "less" ? " (less is better)" : ""), rows, width: 480 })
    : make("p", { className: "quiet" }, "This figure is not known of any trial."));
  fillTable(element("figure-table"), [["cave", "name"], ["trials", "number"], ...contestantNames.map((_, i) => [named(i), "number"])],
    caves.map((cave) => {
      const cells = cellsOf(m, cave), known = cells.filter(Boolean), means = known.map((s) => s.mean);
      const best = numberText(better === "less" ? Math.min(...means) : Math.max(...means));
      const alone = means.filter((v) => numberText(v) === best).length === 1;  // as the tables for a paper
      return [[name(cave), "name"], [countText(known.map((s) => s.n)), "number"], ...cells.map((s) => {
        if (!s) return ["–", "number"];
        const leads = better !== "neither" && known.length > 1 && alone && numberText(s.mean) === best;
        return [make("span", {}, make(leads ? "b" : "span", {}, numberText(s.mean)), make("br"),
          make("small", {}, intervalText(s.interval) + (s.over ? "*" : ""))), "number"];
      })];
    }), (_, k) => caves[k] < 0 ? "total" : "");
  element("figure-note").textContent = `Mean and ${percentOfIntervals} % interval; trials of each contestant. Bold is the best mean of a row, if one contestant alone has it; whether it is shown to be better stands under Pairs. Over all caves, each cave weighs the same` + (data.summaries[m].some((s) => s.all && s.all.over) ? "; * over caves, for want of seeds in each." : ".");
}
