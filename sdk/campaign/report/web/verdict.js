// What the campaign shows, in sentences and a ranking.

function showHeader() {
  const trials = data.trials, failed = trials.filter((t) => t.failed).length;
  const flown = metricNames.indexOf("flight_time_s");
  const hours = trials.reduce((sum, t) => sum + (flown >= 0 ? t.figures[flown] || 0 : 0), 0) / 3600;
  const seeds = new Set(trials.map((t) => t.seed)).size;
  element("title").textContent = data.name || "karst campaign";
  document.title = "karst campaign" + (data.name ? ": " + data.name : "");
  const whole = data.contestants.length * data.caves.length * seeds;
  const figures = [["contestants", data.contestants.length], ["caves", data.caves.length], ["seeds", seeds],
    ["trials" + (trials.length < whole ? ` of ${whole} possible` : ""), trials.length], ["failed", failed],
    ["hours flown", hours ? numberText(hours) : "–"],
    ["at most explored for", data.horizon_s ? durationParts(data.horizon_s).join("\u00a0") : "–"]];
  element("summary").append(...figures.map(([name, value]) =>
    make("div", { className: "figure" }, make("b", {}, String(value)), make("span", {}, name))));
  if (!data.notes.length) return;
  const box = element("notes");
  box.hidden = false;
  box.querySelector("summary").textContent = `${data.notes.length} ${data.notes.length === 1 ? "note" : "notes"}: what is missing or damaged`;
  box.querySelector("ul").append(...data.notes.map((n) => make("li", {}, n)));
}

/** Verdicts are written to stand in a line of text. Contestants keep the case of their names. */
function asSentence(text) {
  if (!text) return "";
  const named = contestantNames.some((n) => text.startsWith(n));
  return tied((named ? text : text[0].toUpperCase() + text.slice(1)) + (/[.!]$/.test(text) ? "" : "."));
}

/** Parameters in which contestants of the same policy differ, as "name value". */
function differences(i) {
  const mine = data.contestants[i], list = [];
  const others = data.contestants.filter((c, k) => k !== i && c.policy === mine.policy);
  for (const part of ["parameters", "settings"]) {
    if (typeof mine[part] !== "object" || mine[part] === null) continue;
    for (const [key, value] of Object.entries(mine[part]))
      if (others.some((o) => JSON.stringify((o[part] || {})[key]) !== JSON.stringify(value)))
        list.push(`${key} ${typeof value === "string" ? value : JSON.stringify(value)}`);
  }
  return list.join(", ");
}

function showVerdict() {
  const v = data.verdicts, m = v.metric;
  element("sentence").textContent = asSentence(v.sentence) || "Nothing has flown yet.";
  const outcomes = (i) => {
    const own = data.trials.filter((t) => t.contestant === i);
    const count = (test) => own.filter(test).length;
    return [own.length, count((t) => t.outcome === "landed" && !t.failed), count((t) => t.outcome === "contact"), count((t) => t.failed)];
  };
  fillTable(element("ranking"),
    [["place", "number"], ["contestant", "name"], "policy", [metricLabel(m), "number"], [`${percentOfIntervals} % interval`, "number"],
     ["groups", "number"], ["may hold place", "number"], ["trials", "number"], ["landed", "number"], ["contact", "number"], ["failed", "number"]],
    v.ranking.map((p, k) => {
      const c = data.contestants[p.contestant], all = data.summaries[m][p.contestant].all;
      const own = p.mean !== null;
      return [[own ? String(k + 1) : "–", "number"], [named(p.contestant), "name"],
        withRemark(`${c.policy} ${c.version}`, differences(p.contestant)), [numberText(p.mean), "number"],
        [all ? intervalText(all.interval) + (all.over ? "*" : "") : "", "number"], [p.groups, "number"],
        [!own ? "–" : p.best === p.worst ? String(p.best) : `${p.best} to ${p.worst}`, "number"],
        ...outcomes(p.contestant).map((n) => [String(n), "number"])];
    }));
  element("ranking-note").textContent = v.ranking.length < 2 ? "" :
    `Ranked by ${metricNames[m]}, ${data.metrics[m].better === "less" ? "less" : "more"} is better. Contestants that share a letter are not shown to differ.`;
  if (data.summaries[m].some((s) => s.all && s.all.over)) element("ranking-note").textContent += " * over caves, for want of seeds in each.";
  const primary = v.comparisons.filter((c) => c.metric === m && c.sentence && c.sentence !== v.sentence);
  // Of four contestants there are six pairs, of eight 28: a list to open, not to scroll past.
  element("every-verdict").hidden = primary.length === 0;
  element("every-verdict").open = primary.length <= 6;
  element("every-verdict").querySelector("summary").textContent =
    primary.length === 1 ? "The pair in a sentence" : `The ${primary.length} pairs, a sentence each`;
  element("sentences").append(...primary.map((c) => make("li", {}, asSentence(c.sentence))));
}
