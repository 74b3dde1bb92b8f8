// Values of plotted curves, and lists of values for panels.

/** Value of a plotted curve at t, linear between samples; NaN without one. */
function curveAt(points, t) {
  const i = points ? lastAt(points.length, (k) => points[k][0], t) : -1;
  if (i < 0) return NaN;
  if (i + 1 >= points.length) return points[i][1];
  const [a, b] = [points[i], points[i + 1]];
  return b[0] > a[0] ? a[1] + (b[1] - a[1]) * (t - a[0]) / (b[0] - a[0]) : b[1];
}

function rows(list) {
  const dl = make("dl");
  for (const [name, text] of list) if (text !== null) dl.append(make("dt", {}, name), make("dd", {}, text));
  return dl;
}
function withUnit(v, unit, digits = 3) {
  const text = numberText(v, digits);
  return text === "–" ? text : text + "\u202f" + unit;
}
