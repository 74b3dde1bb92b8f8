// The section of errors, from evaluation.json: trajectory and map against what is true.

/** Colour of an error: 0 blue, `top` and more yellow. */
function errorColour(e, top) {
  return ramp[Math.min(ramp.length - 1, Math.floor(ramp.length * Math.max(0, e) / (top || 1)))];
}

function errorCard(title) {
  const card = make("div", { className: "plot" }, make("h3", {}, title));
  element("error-plots").append(card);
  const canvas = make("canvas");
  card.append(make("div", { className: "canvas" }, canvas));
  return canvas;
}

const errorCharts = [];
function errorChart(title, config, xTitle) {
  const axis = (text) => ({ type: "linear", title: { display: Boolean(text), text }, grid: {}, ticks: { maxTicksLimit: 7, includeBounds: false } });
  config.options = {
    parsing: false, animation: false, maintainAspectRatio: false, normalized: true,
    scales: { x: axis(xTitle), y: axis("") }, plugins: { legend: { display: false } }, ...config.options,
  };
  const chart = new Chart(errorCard(title), config);
  errorCharts.push(chart);
  return chart;
}

/** The same length on both axes, whatever the shape of the canvas. */
const equalAxes = {
  id: "equalAxes",
  beforeLayout(chart) {
    const { width, height } = chart, box = chart.options.equalAxes;
    if (!box || !width) return;
    const perPixel = Math.max((box.x[1] - box.x[0]) / (width - 60), (box.y[1] - box.y[0]) / (height - 50)) * 1.06 || 1;
    for (const [axis, range, pixels] of [["x", box.x, width - 60], ["y", box.y, height - 50]]) {
      const middle = (range[0] + range[1]) / 2, half = perPixel * pixels / 2;
      Object.assign(chart.options.scales[axis], { min: middle - half, max: middle + half });
    }
  },
};

/** Seen along one axis: the true way as a grey line, the estimate in the colour of its error. */
function wayChart(title, poses, h, v, top) {
  const range = (i) => poses.reduce(([a, b], p) => [Math.min(a, p[i], p[i + 3]), Math.max(b, p[i], p[i + 3])], [Infinity, -Infinity]);
  const colour = poses.map((p) => errorColour(p[7], top));
  errorChart(title, {
    type: "scatter",
    data: { datasets: [
      { data: poses.map((p) => ({ x: p[h + 3], y: p[v + 3], p })), pointRadius: 2.2, pointBorderWidth: 0, backgroundColor: colour, order: 1 },
      { data: poses.map((p) => ({ x: p[h], y: p[v], p })), showLine: true, pointRadius: 0, borderColor: colours.other, borderWidth: 1, order: 2 }] },
    options: {
      equalAxes: { x: range(h), y: range(v) },
      interaction: { mode: "nearest", intersect: false },
      onClick: (e, items) => items.length && setMoment(items[0].element.$context.raw.p[0] + data.errors.trajectory.begin_s),
      plugins: { legend: { display: false }, tooltip: { callbacks: { label: (i) => `${clockText(i.raw.p[0])}  error ${numberText(i.raw.p[7])} m` } } },
    },
    plugins: [equalAxes],
  }, `error: blue 0, yellow ${numberText(top)} m and more`);
}

function startErrors() {
  const errors = data.errors;
  if (!errors || (!errors.trajectory && !errors.map)) return;
  element("errors").hidden = false;
  const unknown = [];
  const row = (name, text) => String(text).startsWith("–") ? unknown.push(name) : element("error-figures").append(make("div", { className: "figure" }, make("b", {}, text), make("span", {}, name)));
  const t = errors.trajectory, m = errors.map, degrees = 180 / Math.PI;
  if (t) {
    row("absolute error, rms", numberText(t.ape.translation_m.rmse) + " m");
    row("absolute rotation, rms", numberText(t.ape.rotation_rad.rmse * degrees) + "°");
    row(`relative error, ${t.rpe.by_distance.delta_m} m, rms`, numberText(t.rpe.by_distance.translation_m.rmse) + " m");
    row("drift at the end", numberText(t.drift.end_percent) + " %");
    row("drift over segments", numberText(t.drift.segment_percent) + " %");
    row("heading error, rms", numberText(t.heading_error_rad * degrees) + "°");
    row("alignment", t.alignment.kind);
    const poses = t.plots.poses;
    const sorted = poses.map((p) => p[7]).sort((a, b) => a - b), top = sorted[Math.floor(0.98 * (sorted.length - 1))];
    wayChart("Seen from above, m", poses, 1, 2, top);
    wayChart("Seen from the south, m", poses, 1, 3, top);
    const line = (points, colour) => ({ type: "line", data: { datasets: [{ data: points.map(([x, y]) => ({ x, y })), borderColor: colour, borderWidth: 1.6, pointRadius: 0 }] } });
    errorChart("Position error over time, m", line(t.plots.translation_m, colours.explore), "time, s");
    errorChart("Rotation error over time, degrees", line(t.plots.rotation_deg, colours.blue), "time, s");
  }
  if (m) {
    row("map error, mean", numberText(m.error_m.mean) + " m");
    row("map error, std", numberText(m.error_m.std) + " m");
    const { bin_m, counts } = m.plots, all = counts.reduce((a, b) => a + b, 0);
    errorChart("Map error, share of points, %", {
      type: "bar",
      data: { datasets: [{ data: counts.map((c, i) => ({ x: (i + 0.5) * bin_m, y: 100 * c / all })), backgroundColor: colours.plan, barPercentage: 1, categoryPercentage: 1 }] },
    }, "distance to the nearest point of the reference, m (the last bar holds all beyond)");
  }
  element("errors-unknown").textContent = notKnown(unknown);
  const paint = () => {
    for (const chart of errorCharts) {
      for (const axis of ["x", "y"]) {
        const scale = chart.options.scales[axis];
        scale.grid = { color: cssColour("--line"), borderColor: cssColour("--line") };
        scale.ticks = { ...scale.ticks, color: cssColour("--quiet") };
        scale.title = { ...scale.title, color: cssColour("--quiet") };
      }
      chart.update();
    }
  };
  themeListeners.push(paint);
  paint();
}
