// How contestants and caves are told apart: by colour, and without colour by dash and shape.
const dashes = ["", "7 3", "2 2.6", "10 3 2 3", "14 4", "5 2 1.5 2 1.5 2"];
const shapes = [
  (r) => `M${-r} 0a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`,
  (r) => `M${-0.9 * r} ${-0.9 * r}h${1.8 * r}v${1.8 * r}h${-1.8 * r}Z`,
  (r) => `M0 ${-1.2 * r}L${1.1 * r} ${0.8 * r}H${-1.1 * r}Z`,
  (r) => `M0 ${-1.3 * r}L${1.15 * r} 0L0 ${1.3 * r}L${-1.15 * r} 0Z`,
  (r) => `M0 ${1.2 * r}L${1.1 * r} ${-0.8 * r}H${-1.1 * r}Z`,
  (r) => { const a = 0.42 * r, b = 1.15 * r; return `M${-a} ${-b}H${a}V${-a}H${b}V${a}H${a}V${b}H${-a}V${a}H${-b}V${-a}H${-a}Z`; },
  (r) => `M0 ${-1.2 * r}L${1.1 * r} ${-0.4 * r}L${0.7 * r} ${r}H${-0.7 * r}L${-1.1 * r} ${-0.4 * r}Z`,
];
const colourOf = (i) => `var(--s${i % 8})`;
const dashOf = (i) => dashes[i % dashes.length];

/** A mark at a place, with what it stands for as its tooltip. */
function markAt(x, y, i, r, tip, hollow = false) {
  const look = hollow ? `fill: var(--card); stroke: ${colourOf(i)}; stroke-width: 1.5` : `fill: ${colourOf(i)}`;
  return svg("path", { class: "mark", d: shapes[i % shapes.length](r), transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})`, style: look },
    tip ? svg("title", {}, tip) : null);
}
/** Line and mark of contestant i as they look in plots. */
function swatch(i, line = true) {
  const root = svg("svg", { class: "swatch", width: line ? 34 : 14, height: 14, "aria-hidden": "true" });
  if (line) root.append(svg("line", { class: "line", x1: 0, x2: 34, y1: 7, y2: 7, style: `stroke: ${colourOf(i)}`, "stroke-dasharray": dashOf(i) }));
  root.append(markAt(line ? 17 : 7, 7, i, 4.4));
  return root;
}
function fillLegend(id, names, line) {
  element(id).replaceChildren(...names.map((name, i) => make("span", {}, swatch(i, line), name)));
}

const contestantNames = data.contestants.map((c) => c.name);
const caveNames = data.caves.map((c) => c.name);
const metricNames = data.metrics.map((m) => m.name);
/** "explored_volume_m3, m³", as axes are labelled. */
function metricLabel(m) { const { name, unit } = data.metrics[m]; return name + (unit ? `, ${unitText(unit)}` : ""); }
/** What a trial counts as in a figure. */
function countedIn(trial, m) { return (trial.counted || trial.figures)[m]; }

/** "10", or "8–17" where they differ. */
function countText(counts) {
  if (!counts.length) return "0";
  const least = Math.min(...counts), most = Math.max(...counts);
  return least === most ? String(most) : `${least}–${most}`;
}
function pText(p) { return p === null ? "–" : p < 0.001 ? "< 0.001" : p.toFixed(3); }
function signedText(v) { return v === null ? "–" : (v > 0 ? "+" : v < 0 ? "−" : "") + numberText(Math.abs(v)); }
function intervalText([low, high], text = numberText) { return low === null || high === null ? "" : `[${text(low)}, ${text(high)}]`; }
const percentOfIntervals = Number((100 * (1 - data.alpha)).toPrecision(3));

/** A table's content: heads as [text, class], rows of cells; a cell is text, an element, or [content, class]. */
function fillTable(target, heads, rows, classOf = () => "") {
  const cell = (tag, c) => {
    const [content, className] = Array.isArray(c) ? c : [c, ""];
    return make(tag, { className }, content);
  };
  const head = make("tr", {}, ...heads.map((h) => { const th = cell("th", h); th.scope = "col"; return th; }));
  target.replaceChildren(make("thead", {}, head),
    make("tbody", {}, ...rows.map((r, i) => make("tr", { className: classOf(r, i) }, ...r.map((c) => cell("td", c))))));
}
/** Text with a quieter remark behind. */
function withRemark(text, remark) { return make("span", {}, text, remark ? make("small", {}, " " + remark) : ""); }
function named(i) { return make("span", {}, swatch(i, false), " " + contestantNames[i]); }
function fillChoices(id, names, chosen) {
  element(id).replaceChildren(...names.map((name, i) => make("option", { value: String(i), selected: i === chosen }, name)));
}
function choice(id) { return Number(element(id).value); }
function whenChosen(ids, listener) { for (const id of ids) element(id).addEventListener("change", listener); }
