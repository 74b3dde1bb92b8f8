// The plots over time, with a line at the chosen moment.
const plotCharts = [];

const momentLine = {
  id: "momentLine",
  afterDatasetsDraw(chart) {
    const x = chart.scales.x.getPixelForValue(moment.t), { top, bottom, left, right } = chart.chartArea;
    if (x < left - 1 || x > right + 1) return;
    const c = chart.ctx;
    c.save();
    c.strokeStyle = cssColour("--text");
    c.lineWidth = 1;
    c.setLineDash([4, 3]);
    c.beginPath(); c.moveTo(x, top); c.lineTo(x, bottom); c.stroke();
    c.restore();
  },
};

function timeStep(duration) {
  return [5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200].find((s) => duration / s <= 8) || 14400;
}

function axisText(v) { return Math.abs(v) >= 1e4 ? numberText(v) : String(Number(v.toPrecision(3))); }

function axes(plot) {
  const grid = { color: cssColour("--line"), borderColor: cssColour("--line") }, ticks = { color: cssColour("--quiet") };
  const scales = {
    x: { type: "linear", min: 0, max: data.duration_s, grid, title: { display: true, text: "time, min:s", color: ticks.color, padding: 0 },
         ticks: { ...ticks, maxRotation: 0, callback: clockText },
         afterBuildTicks: (axis) => {
           const step = timeStep(data.duration_s);
           axis.ticks = Array.from({ length: Math.floor(data.duration_s / step) + 1 }, (_, i) => ({ value: i * step }));
         } },
    y: { type: plot.log ? "logarithmic" : "linear", min: plot.log ? undefined : 0, max: plot.max, suggestedMax: plot.suggestedMax,
         grid, ticks: { ...ticks, maxTicksLimit: 6, includeBounds: !plot.shareOf, callback: (v) => plot.log && Math.log10(v) % 1 ? null : axisText(v) } },
  };
  if (plot.shareOf)
    scales.share = { type: "linear", position: "right", min: 0, max: 100 * plot.max / plot.shareOf,
      grid: { drawOnChartArea: false, borderColor: grid.borderColor },
      ticks: { ...ticks, maxTicksLimit: 6, includeBounds: false, callback: (v) => axisText(v) + " %" } };
  return scales;
}

function addPlot(plot) {
  const card = make("div", { className: "plot" }, make("h3", {}, plot.title));
  element("plots").append(card);
  const sets = plot.sets.filter((s) => s.points && s.points.length);
  if (!sets.length) {
    card.append(make("div", { className: "none" }, plot.none || "not recorded"));
    return;
  }
  const canvas = make("canvas");
  card.append(make("div", { className: "canvas" }, canvas));
  const chart = new Chart(canvas, {
    type: "line",
    data: { datasets: sets.map((s) => ({
      label: s.label, data: s.points.map(([x, y]) => ({ x, y })), borderColor: s.colour, backgroundColor: s.fill || s.colour,
      borderWidth: s.marks ? 0 : 1.8, pointRadius: s.marks ? 2.6 : 0, pointStyle: s.style, pointHoverRadius: 4, showLine: !s.marks,
      pointBackgroundColor: s.colour, fill: Boolean(s.fill), borderDash: s.dash })) },
    options: {
      parsing: false, animation: false, maintainAspectRatio: false, normalized: true, scales: axes(plot),
      interaction: { mode: "nearest", axis: "x", intersect: false },
      plugins: {
        legend: { display: sets.length > 1, position: "top", align: "end",
                  labels: { color: cssColour("--text"), usePointStyle: true, boxWidth: 8, boxHeight: 8, padding: 8 } },
        tooltip: { callbacks: { title: (items) => clockText(items[0].parsed.x),
                                label: (i) => `${i.dataset.label}: ${numberText(i.parsed.y)} ${plot.unit}` } },
      },
      onClick: (e) => setMoment(chart.scales.x.getValueForPixel(e.x)),
    },
    plugins: [momentLine],
  });
  plotCharts.push({ chart, plot });
}

/** A level line over the whole time. */
function level(v) { return [[0, v], [data.duration_s, v]]; }

/** Calls `add`, which adds the plots, and keeps them at the moment and in the theme's colours. */
function startCharts(add) {
  Chart.defaults.font.family = "system-ui, 'DejaVu Sans', sans-serif";
  Chart.defaults.font.size = 11;
  add();
  let frame = 0;
  moment.listeners.push(() => {
    frame = frame || requestAnimationFrame(() => { frame = 0; for (const p of plotCharts) p.chart.draw(); });
  });
  themeListeners.push(() => {
    for (const { chart, plot } of plotCharts) {
      chart.options.scales = axes(plot);
      chart.options.plugins.legend.labels.color = cssColour("--text");
      chart.update();
    }
  });
}
function positive(points) { return points && points.filter((p) => p[1] > 0); }
