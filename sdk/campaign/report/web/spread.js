// How the chosen figure spreads over trials: strips of marks with boxes, a plot for each cave.

function valuesOf(m, contestant, cave) {
  return data.trials.filter((t) => t.contestant === contestant && t.cave === cave && countedIn(t, m) !== null)
    .map((t) => ({ value: countedIn(t, m), seed: t.seed, failed: t.failed }));
}
function fiveNumbers(values) {
  const sorted = values.map((v) => v.value).sort((a, b) => a - b);
  return [0, 0.25, 0.5, 0.75, 1].map((share) => quantileOf(sorted, share));
}

function spreadPlot(m, cave) {
  const columns = data.contestants.map((_, i) => valuesOf(m, i, cave));
  const plot = makePlot({
    title: `Spread of ${metricNames[m]} over the trials of each contestant in ${caveNames[cave]}; the numbers are in the table below`,
    heading: caveNames[cave], aside: `${columns.reduce((n, c) => n + c.length, 0)} trials`, width: 310, height: 230, left: 48,
    x: { range: [0, columns.length], ticks: [] }, y: { range: rangeOf(columns.flat().map((v) => v.value)), ticks: 4 } });
  const width = plot.x(1) - plot.x(0);
  columns.forEach((values, i) => {
    if (!values.length) return;
    const centre = plot.x(i + 0.5), half = Math.min(26, width * 0.36), colour = `stroke: ${colourOf(i)}`;
    const [least, q1, median, q3, most] = fiveNumbers(values).map((v) => Number(plot.y(v).toFixed(1)));
    if (values.length > 2)
      plot.body.append(svg("path", { class: "box", style: colour,
        d: `M${centre - half} ${q3}h${2 * half}V${q1}h${-2 * half}ZM${centre} ${q3}V${most}M${centre} ${q1}V${least}` }),
        svg("path", { class: "middle", style: colour, d: `M${centre - half} ${median}h${2 * half}` }));
    values.forEach((v, k) => {
      const aside = values.length > 1 ? ((k * 0.618034) % 1 - 0.5) * 1.3 * half : 0;  // spread evenly, the same every time
      plot.body.append(markAt(centre + aside, plot.y(v.value), i, 3.4,
        `${contestantNames[i]}, seed ${v.seed}: ${numberText(v.value)}${v.failed ? ", failed" : ""}`, v.failed));
    });
  });
  return plot.figure;
}

function showSpread(m) {
  const caves = data.caves.map((_, i) => i).filter((c) => data.contestants.some((_, i) => valuesOf(m, i, c).length));
  fillLegend("spread-legend", contestantNames, false);
  element("spread-plots").replaceChildren(...(caves.length ? caves.map((c) => spreadPlot(m, c))
    : [make("p", { className: "quiet" }, "This figure is not known of any trial.")]));
  const table = make("table"), rows = [];
  for (const cave of caves)
    data.contestants.forEach((_, i) => {
      const values = valuesOf(m, i, cave);
      if (values.length)
        rows.push([[caveNames[cave], "name"], [named(i), "name"], [String(values.length), "number"], ...fiveNumbers(values).map((v) => [numberText(v), "number"])]);
    });
  fillTable(table, [["cave", "name"], ["contestant", "name"], ...["trials", "least", "quartile", "median", "quartile", "greatest"].map((t) => [t, "number"])], rows);
  element("spread-table").replaceChildren(table);
}
