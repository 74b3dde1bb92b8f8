// Two contestants in the chosen figure: every pair of flights, differences by cave, and all pairs as a table.

const comparisonAt = new Map(data.verdicts.comparisons.map((c) => [`${c.metric} ${c.a} ${c.b}`, c]));
/** How a compares with b: differences are a - b. Null without a comparison. */
function comparisonOf(a, b, m) {
  const c = comparisonAt.get(`${m} ${a} ${b}`);
  if (c || a === b) return c || null;
  const r = comparisonAt.get(`${m} ${b} ${a}`);
  const flip = ([low, high]) => [high === null ? null : -high, low === null ? null : -low];
  const minus = (v) => v === null ? null : -v;
  return !r ? null : { ...r, a, b, mean_a: r.mean_b, mean_b: r.mean_a, difference: minus(r.difference), interval: flip(r.interval),
    interval_caves: flip(r.interval_caves), rank_biserial: minus(r.rank_biserial), standardized: minus(r.standardized),
    caves: (r.caves || []).map((k) => ({ ...k, difference: minus(k.difference), interval: flip(k.interval) })) };
}

/** Pairs of trials with the same cave and seed of which the figure is known. */
function pairsOf(a, b, m) {
  const partner = new Map(data.trials.filter((t) => t.contestant === b).map((t) => [`${t.cave} ${t.seed}`, t]));
  return data.trials.filter((t) => t.contestant === a).map((t) => {
    const other = partner.get(`${t.cave} ${t.seed}`);
    return other && { cave: t.cave, seed: t.seed, x: countedIn(t, m), y: countedIn(other, m), failed: t.failed || other.failed };
  }).filter((p) => p && p.x !== null && p.y !== null);
}

function scatter(a, b, m, pairs) {
  const better = data.metrics[m].better;
  const range = rangeOf(pairs.flatMap((p) => [p.x, p.y]));
  const plot = makePlot({
    title: `${metricNames[m]} of ${contestantNames[b]} against ${contestantNames[a]}, a mark for each pair of flights with the same cave and seed; means by cave are in the table above`,
    heading: "Pair by pair", aside: `${pairs.length} pairs`, width: 560, height: 520, left: 62,
    x: { range, label: `${contestantNames[a]}: ${metricLabel(m)}` }, y: { range, label: `${contestantNames[b]}: ${metricLabel(m)}`, ticks: 6 } });
  const { left, right, top, bottom } = plot.area;
  const below = better === "less" ? b : a, above = better === "less" ? a : b, word = better === "neither" ? "more" : "better";
  plot.root.insertBefore(svg("path", { class: "side", d: `M${left} ${bottom}L${right} ${top}V${bottom}Z` }), plot.root.firstChild);
  plot.body.append(svg("line", { class: "zero", x1: left, y1: bottom, x2: right, y2: top }),
    svg("text", { class: "inside", x: right - 8, y: bottom - 10, "text-anchor": "end" }, `${contestantNames[below]} ${word} ↘`),
    svg("text", { class: "inside", x: left + 8, y: top + 16 }, `↖ ${contestantNames[above]} ${word}`));
  for (const p of pairs)
    plot.body.append(markAt(plot.x(p.x), plot.y(p.y), p.cave, 4.8,
      `${caveNames[p.cave]}, seed ${p.seed}: ${numberText(p.x)} against ${numberText(p.y)}${p.failed ? ", one of them failed" : ""}`, p.failed));
  return plot.figure;
}

function differencePlot(a, b, m, c) {
  const tip = (name, d) => `${name}: ${signedText(d.difference)} ${intervalText(d.interval, signedText)}`;
  const rows = (c.caves || []).map((k) => [caveNames[k.cave], [{ value: k.difference, interval: k.interval, style: k.cave, tip: tip(caveNames[k.cave], k) }]]);
  rows.push(["these caves", [{ value: c.difference, interval: c.interval, style: 6, tip: tip("these caves", c) }]]);
  if ((c.caves || []).length > 1)
    rows.push(["caves like these", [{ value: c.difference, interval: c.interval_caves, style: 6, tip: tip("caves like these", { ...c, interval: c.interval_caves }) }]]);
  return dotPlot({ title: `Difference in ${metricNames[m]}, ${contestantNames[a]} less ${contestantNames[b]}, by cave and over all; the numbers are in the table below`,
    heading: `${contestantNames[a]} − ${contestantNames[b]}`, seeds: `${percentOfIntervals} % intervals`, label: metricLabel(m), rows, zero: true });
}

function differenceTable(c) {
  const table = make("table"), number = (text) => [text, "number"];
  const row = (name, pairs, difference, interval) => [[name, "name"], number(String(pairs)), number(signedText(difference)), number(intervalText(interval, signedText))];
  fillTable(table, [["cave", "name"], ["pairs", "number"], ["difference", "number"], [`${percentOfIntervals} % interval`, "number"]],
    [...(c.caves || []).map((k) => row(caveNames[k.cave], k.pairs, k.difference, k.interval)), row("these caves", c.pairs, c.difference, c.interval)],
    (_, k) => k === (c.caves || []).length ? "total" : "");
  return make("div", { className: "card wide" }, table);
}

const pairHeads = [["a", "name"], ["b", "name"], ["mean a", "number"], ["mean b", "number"], ["a − b", "number"], ["of b", "number"],
  [`${percentOfIntervals} % interval`, "number"], ["caves like these", "number"], ["p", "number"], ["rank-biserial", "number"], ["d", "number"], ["pairs", "number"], "shown"];
/** A difference in per cent of what b has, with its interval; b's mean is taken as known. */
function relativeText(c) {
  if (!(c.mean_b > 0) || c.difference === null) return "–";
  const percent = (v) => v === null ? null : 100 * v / c.mean_b;
  return `${signedText(percent(c.difference))} % ${intervalText(c.interval.map(percent), signedText)}`;
}

function pairCells(c) {
  const number = (text) => [text, "number"];
  const shown = c.shown === "" ? "no difference" : `${contestantNames[c.shown[0] === "a" ? c.a : c.b]} ${c.shown.slice(2)}`;
  return [[named(c.a), "name"], [named(c.b), "name"], number(numberText(c.mean_a)), number(numberText(c.mean_b)), number(signedText(c.difference)),
    number(relativeText(c)), number(intervalText(c.interval, signedText)), number(intervalText(c.interval_caves, signedText)), number(pText(c.p)),
    number(c.rank_biserial === null ? "–" : signedText(Number(c.rank_biserial.toFixed(2)))), number(c.standardized === null ? "–" : signedText(c.standardized)),
    number(String(c.pairs)), [shown, c.shown ? "shown" : "quiet"]];
}

function showPairs(m) {
  const a = choice("pair-a"), b = choice("pair-b"), c = comparisonOf(a, b, m), pairs = a === b ? [] : pairsOf(a, b, m);
  element("pair-sentence").textContent = a === b ? "Choose two contestants." : c ? asSentence(c.sentence) : "Not compared.";
  const flown = caveNames.map((name, i) => [name, i]).filter(([, i]) => pairs.some((p) => p.cave === i));
  element("pair-legend").replaceChildren(...flown.map(([name, i]) => make("span", {}, swatch(i, false), name)));
  const none = make("p", { className: "quiet" }, "No pair of flights has this figure.");
  element("pair-scatter").replaceChildren(pairs.length ? scatter(a, b, m, pairs) : none);
  element("pair-differences").replaceChildren(...(pairs.length && c ? [differencePlot(a, b, m, c), differenceTable(c)] : []));
  fillTable(element("pair-table"), pairHeads, data.verdicts.comparisons.filter((k) => k.metric === m).map(pairCells));
}

function startPairs() {
  if (data.contestants.length < 2) {
    element("pairs").replaceChildren(make("h2", {}, "Pairs"), make("p", { className: "quiet" }, "With one contestant there is nothing to compare."));
    return false;
  }
  const ranked = data.verdicts.ranking.map((p) => p.contestant);
  fillChoices("pair-a", contestantNames, ranked[0] ?? 0);
  fillChoices("pair-b", contestantNames, ranked[1] ?? 1);
  element("pair-note").textContent = `“of b”: in per cent of b's mean, which is taken as known, with the interval of a − b. Intervals are bootstrapped: over seeds, for these caves; over caves, for caves like these. p: Wilcoxon's signed-rank test, corrected by Holm for the pairs in this figure. Effect sizes: rank-biserial correlation from −1 to 1; d is the difference in standard deviations within caves.`;
  const every = element("every-pair");
  every.addEventListener("toggle", () => {
    const box = every.querySelector("div");
    if (box.children.length) return;
    const table = make("table");
    fillTable(table, [["figure", "name"], ...pairHeads], data.verdicts.comparisons.map((c) => [[metricLabel(c.metric), "name"], ...pairCells(c)]));
    box.append(table);
  });
  return true;
}
