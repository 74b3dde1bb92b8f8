// Frontiers in the colour of the score of the goal that was offered for them.

// One hue from dark to light, so that it is told apart from the ramp of heights; grey where no score is known.
const scoreRamp = ["#4a1942", "#7d2c6b", "#b0468f", "#e07ab5", "#f7b3d8", "#ffe6f4"];

/** What the decision at exactly this time had to choose from (docs/report.md), or null. */
function choiceAt(choices, t) {
  const i = lastAt(choices.length, (k) => choices[k].t, t);
  return i >= 0 && choices[i].t === t ? choices[i] : null;
}

/** The best score of the goals offered for each frontier: a map by the frontier's id. */
function frontierScores(choice) {
  const scores = new Map();
  for (const answer of choice ? choice.answers : [])
    for (const g of answer.goals || [])
      if (g.frontier && typeof g.score === "number")
        scores.set(g.frontier, Math.max(g.score, scores.get(g.frontier) ?? -Infinity));
  return scores;
}

/** { tints, range, unknown }: a colour [r, g, b] for each cluster [x, y, z, cells, id]; the least and greatest score, or
 *  null; whether a cluster has none. */
function scoreTints(clusters, choice) {
  const scores = frontierScores(choice), known = clusters.map((c) => scores.get(c[4])).filter((s) => s !== undefined);
  const low = Math.min(...known), high = Math.max(...known);
  const colour = (s) => s === undefined ? colours.other
    : scoreRamp[high > low ? Math.round((scoreRamp.length - 1) * (s - low) / (high - low)) : scoreRamp.length - 1];
  return { tints: clusters.map((c) => new THREE.Color(colour(scores.get(c[4]))).toArray()),
           range: known.length ? [low, high] : null, unknown: known.length < clusters.length };
}

/** The legend of these colours; `shown` is that of the moment: { range, unknown }, or null without frontiers. */
function showScoreScale(shown) {
  const box = element("score-scale");
  box.hidden = !shown;
  if (!shown) return;
  const grey = make("i", { className: "dot" });
  grey.style.background = colours.other;
  const lines = [make("div", {}, "frontiers: score of their goal")];
  if (shown.range) {
    const bar = make("div", { className: "bar" });
    bar.style.background = `linear-gradient(90deg, ${scoreRamp.join(",")})`;
    lines.push(bar, make("div", { className: "ends" }, ...shown.range.map((s) => make("span", {}, numberText(s)))));
  }
  if (shown.unknown) lines.push(make("div", { className: "quiet" }, grey, "no score known"));
  box.replaceChildren(...lines);
}
