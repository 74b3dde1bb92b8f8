// Values of plotted curves, and lists of values for panels and cards.

/** Value of a plotted curve at t, linear between samples; NaN without one. */
function curveAt(points, t) {
  const i = points ? lastAt(points.length, (k) => points[k][0], t) : -1;
  if (i < 0) return NaN;
  if (i + 1 >= points.length) return points[i][1];
  const [a, b] = [points[i], points[i + 1]];
  return b[0] > a[0] ? a[1] + (b[1] - a[1]) * (t - a[0]) / (b[0] - a[0]) : b[1];
}

/** "not known: a, b", or "" if there is nothing to name. */
function notKnown(names) { return names.length ? "not known: " + names.join(", ") : ""; }

/** Rows of [name, text]: null leaves a row out, undefined has it named below as not known. */
function rows(list) {
  const dl = make("dl"), box = make("div", {}, dl);
  for (const [name, text] of list)
    if (text !== null && text !== undefined) dl.append(make("dt", {}, name), make("dd", {}, text));
  const unknown = notKnown(list.filter(([, text]) => text === undefined).map(([name]) => name));
  if (unknown) box.append(make("div", { className: "quiet" }, unknown));
  return box;
}
/** "1.25 m/s"; undefined for what is no number. */
function withUnit(v, unit, digits = 3) {
  return typeof v === "number" && isFinite(v) ? numberText(v, digits) + "\u202f" + unit : undefined;
}
/** "(1.0, 2.0, 0.5) m"; "" for what is no place. */
function placeText(p) {
  return Array.isArray(p) ? "(" + p.map((v) => Number(v).toFixed(1)).join(", ") + ") m" : "";
}
