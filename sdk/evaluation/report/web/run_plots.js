// The plots of one flight.

function addRunPlots() {
  const c = data.curves, m = data.metrics;
  // Coverage over time is in proportion to the explored volume (docs/metrics.md), so one curve has both axes. Where the
  // coverage would be complete, both end.
  const final = c.volume ? c.volume[c.volume.length - 1][1] : 0;
  const whole = m.coverage > 0 && final > 0 ? final / m.coverage : 0;
  const peak = whole ? Math.max(...c.volume.map((p) => p[1])) : 0;
  addPlot({ title: whole ? "Explored volume, m³ (left), coverage (right)" : "Explored volume, m³", unit: "m³",
            shareOf: whole, max: whole ? Math.min(1.06 * peak, whole) : undefined,
            sets: [{ label: "explored", points: c.volume, colour: colours.blue, fill: "rgba(0,114,178,.18)" }] });
  addPlot({ title: "Speed, m/s", unit: "m/s", sets: [{ label: "speed", points: c.speed, colour: colours.explore }] });
  const distance = { title: "Distance from the start, m (straight)", unit: "m",
                     sets: [{ label: "distance", points: c.distance, colour: colours.home }] };
  if (isReplay) return addPlot(distance);
  addPlot({ title: "Clearance to rock, m (truth)", unit: "m", none: "not known: no ground truth",
            sets: [{ label: "clearance", points: c.clearance, colour: colours.plan }] });
  addPlot({ title: "Battery left, %", unit: "%", max: 100,
            sets: [{ label: "battery", points: c.battery, colour: "#cc79a7", fill: "rgba(204,121,167,.16)" }] });
  addPlot(distance);
  addPlot({ title: "Decision and planning time, ms (wall clock)", unit: "ms", log: true,
            sets: [{ label: "decision", points: positive(c.decide), colour: colours.blue, marks: true, style: "circle" },
                   { label: "planning", points: positive(c.plan), colour: "#e69f00", marks: true, style: "triangle" }] });
}
