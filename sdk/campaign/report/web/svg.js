// Plots as SVG: sharp in print and in papers, their colours follow the page's theme, and marks say their values.

/** An SVG element; `style` as text, so that colours may be the page's variables. */
function svg(tag, attributes = {}, ...children) {
  const e = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, value);
  e.append(...children.filter((c) => c !== null));
  return e;
}

/** Round numbers from low to high, about `count` of them. */
function roundTicks(low, high, count) {
  const step = niceStep((high - low) / count || 1), list = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) list.push(k * step);
  return list;
}
/** The range of the values with a little room; from 0 if that is near or `zero` asks for it. */
function rangeOf(values, zero = false) {
  let low = Infinity, high = -Infinity;
  for (const v of values) if (typeof v === "number") { low = Math.min(low, v); high = Math.max(high, v); }
  if (low > high) return [0, 1];
  if (zero || (low >= 0 && low < 0.6 * high)) low = Math.min(0, low);
  if (high - low < 1e-12) return [low - (Math.abs(low) || 1) * 0.1, high + (Math.abs(high) || 1) * 0.1];
  const room = 0.05 * (high - low);
  return [low === 0 ? 0 : low - room, high === 0 ? 0 : high + room];
}
function tickText(v) { return Math.abs(v) >= 1e4 ? numberText(v) : String(Number(v.toPrecision(6))); }

/** Axes in a frame: { figure, root, body, x(v), y(v), area, range (of y) }. Each axis: { range, label, text(v), ticks (values, or how
 *  many), rows (names instead of numbers) }. `title` is read to those who do not see the plot. */
function makePlot({ title, heading, aside, width = 420, height = 280, x, y, left = 50 }) {
  const area = { left, right: width - 12, top: 10, bottom: height - (x.label ? 40 : 24) };
  const scale = (axis, from, to) => (v) => from + (v - axis.range[0]) / (axis.range[1] - axis.range[0]) * (to - from);
  const X = scale(x, area.left, area.right), Y = scale(y, area.bottom, area.top);
  const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title });
  root.append(svg("title", {}, title));
  const ticksOf = (axis, count) => Array.isArray(axis.ticks) ? axis.ticks : roundTicks(...axis.range, axis.ticks || count);
  for (const v of ticksOf(x, 6)) {
    root.append(svg("line", { class: "grid", x1: X(v), x2: X(v), y1: area.top, y2: area.bottom }),
      svg("text", { class: "axis", x: X(v), y: area.bottom + 15, "text-anchor": "middle" }, (x.text || tickText)(v)));
  }
  for (const v of ticksOf(y, 5)) {
    if (!y.rows) root.append(svg("line", { class: "grid", x1: area.left, x2: area.right, y1: Y(v), y2: Y(v) }));
    root.append(svg("text", { class: "axis", x: area.left - 6, y: Y(v) + 4, "text-anchor": "end" }, (y.text || tickText)(v)));
  }
  if (x.label) root.append(svg("text", { class: "axis-title", x: (area.left + area.right) / 2, y: height - 6, "text-anchor": "middle" }, x.label));
  if (y.label) root.append(svg("text", { class: "axis-title", "text-anchor": "middle", transform: `translate(12 ${(area.top + area.bottom) / 2}) rotate(-90)` }, y.label));
  const body = svg("g");
  root.append(body, svg("path", { class: "frame", d: `M${area.left} ${area.top}V${area.bottom}H${area.right}` }));
  const figure = make("figure", { className: "card plot" });
  if (heading) figure.append(make("h3", {}, make("span", {}, heading), make("small", {}, aside || "")));
  figure.append(root, saveButton(root, heading || title));
  return { figure, root, body, x: X, y: Y, area, range: y.range };
}

/** The points as a path; null breaks it. */
function pathOf(plot, xs, ys) {
  let d = "", pen = "M";
  xs.forEach((v, i) => {
    if (ys[i] === null) { pen = "M"; return; }
    d += `${pen}${plot.x(v).toFixed(1)} ${plot.y(ys[i]).toFixed(1)}`;
    pen = "L";
  });
  return d;
}
function bandPath(plot, xs, low, high) {
  const known = xs.map((_, i) => i).filter((i) => low[i] !== null && high[i] !== null);
  if (known.length < 2) return "";
  const at = (i, v) => `${plot.x(xs[i]).toFixed(1)} ${plot.y(v[i]).toFixed(1)}`;
  return "M" + known.map((i) => at(i, high)).join("L") + "L" + known.reverse().map((i) => at(i, low)).join("L") + "Z";
}

/** A button that saves the plot as a file of its own, with the colours it has now. */
function saveButton(root, name) {
  const button = make("button", { type: "button", className: "save", title: "Save this plot as an SVG file" }, "SVG");
  button.addEventListener("click", () => {
    const copy = root.cloneNode(true);
    const names = ["--text", "--quiet", "--line", "--card", "--page", ...Array.from({ length: 8 }, (_, i) => "--s" + i)];
    const colours = names.map((n) => `${n}: ${cssColour(n)};`).join(" ");
    copy.prepend(svg("style", {}, `svg { ${colours} background: var(--card); }\n` + plotStyle));
    copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
    const url = URL.createObjectURL(new Blob([new XMLSerializer().serializeToString(copy)], { type: "image/svg+xml" }));
    make("a", { href: url, download: name.replace(/[^\w.-]+/g, "_").slice(0, 80) + ".svg" }).click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  });
  return button;
}
const plotStyle = document.querySelector("style").textContent.split("/* plots */")[1] || "";
