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

function startPlots() {
  const c = data.curves, m = data.metrics;
  Chart.defaults.font.family = "system-ui, 'DejaVu Sans', sans-serif";
  Chart.defaults.font.size = 11;
  // Coverage over time is in proportion to the explored volume (docs/metrics.md), so one curve has both axes. Where the
  // coverage would be complete, both end.
  const final = c.volume ? c.volume[c.volume.length - 1][1] : 0;
  const whole = m.coverage > 0 && final > 0 ? final / m.coverage : 0;
  const peak = whole ? Math.max(...c.volume.map((p) => p[1])) : 0;
  addPlot({ title: whole ? "Explored volume, m³ (left), coverage (right)" : "Explored volume, m³", unit: "m³",
            shareOf: whole, max: whole ? Math.min(1.06 * peak, whole) : undefined,
            sets: [{ label: "explored", points: c.volume, colour: colours.blue, fill: "rgba(0,114,178,.18)" }] });
  addPlot({ title: "Speed, m/s", unit: "m/s", sets: [{ label: "speed", points: c.speed, colour: colours.explore }] });
  addPlot({ title: "Clearance to rock, m (truth)", unit: "m", none: "not known: no ground truth",
            sets: [{ label: "clearance", points: c.clearance, colour: colours.plan }] });
  addPlot({ title: "Battery left, %", unit: "%", max: 100,
            sets: [{ label: "battery", points: c.battery, colour: "#cc79a7", fill: "rgba(204,121,167,.16)" }] });
  addPlot({ title: "Distance from the start, m (straight)", unit: "m",
            sets: [{ label: "distance", points: c.distance, colour: colours.home }] });
  addPlot({ title: "Decision and planning time, ms (wall clock)", unit: "ms", log: true,
            sets: [{ label: "decision", points: positive(c.decide), colour: colours.blue, marks: true, style: "circle" },
                   { label: "planning", points: positive(c.plan), colour: "#e69f00", marks: true, style: "triangle" }] });
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
