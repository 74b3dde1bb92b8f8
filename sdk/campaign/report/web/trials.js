// The worst trials with the way to their reports, all trials, and what stands behind the figures.

function trialLink(t) {
  if (t.run === null) return make("span", { className: "quiet" }, "recording not kept");
  return t.reported ? make("a", { href: t.run + "/report.html" }, "mission report") : make("code", {}, `karst report '${t.path.replaceAll("'", "'\\''")}'`);
}

function showWorst() {
  const coverage = metricNames.indexOf("coverage"), m = data.verdicts.metric;
  const shown = [...new Set([m, coverage])].filter((k) => k >= 0);
  if (!data.worst.length) {
    element("worst-table").parentElement.replaceChildren(make("p", { className: "quiet" }, data.trials.length ? "None failed, touched rock, went other than meant, or fell behind its cave's mean." : "Nothing has flown yet."));
    return;
  }
  fillTable(element("worst-table"),
    [["why", "name"], ["contestant", "name"], ["cave", "name"], ["seed", "number"], "outcome", ...shown.map((k) => [metricLabel(k), "number"]), "look at it"],
    data.worst.map(({ trial, why }) => {
      const t = data.trials[trial];
      return [[why, "name"], [named(t.contestant), "name"], [caveNames[t.cave], "name"], [String(t.seed), "number"],
        t.reason ? `${t.outcome || "failed"}: ${t.reason}` : t.outcome, ...shown.map((k) => [numberText(t.figures[k]), "number"]), trialLink(t)];
    }));
  const missing = data.worst.some(({ trial }) => data.trials[trial].run !== null && !data.trials[trial].reported);
  element("worst-note").textContent = missing
    ? "A trial's mission report is made when it is asked for: run the command from the folder of this page, then load RUN/report.html."
    : "";
}

function startTrials() {
  const details = document.querySelector("#trials details");
  details.querySelector("summary").textContent = `All trials (${data.trials.length})`;
  details.addEventListener("toggle", () => {
    const box = details.querySelector("div");
    if (box.children.length) return;
    const table = make("table");
    fillTable(table, [["contestant", "name"], ["cave", "name"], ["seed", "number"], "outcome", "report", ...data.metrics.map((_, m) => [metricLabel(m), "number"])],
      data.trials.map((t) => [[named(t.contestant), "name"], [caveNames[t.cave], "name"], [String(t.seed), "number"],
        make("span", { title: t.ended || t.reason }, t.failed ? "failed" : t.outcome), [trialLink(t), "name"], ...t.figures.map((v) => [numberText(v, 4), "number"])]));
    box.append(table);
  });
}

function showMethod() {
  element("method-text").append(make("p", { className: "note" },
    `Every contestant flies every cave with every seed; flights with the same cave and seed share start, noise and gusts and are compared pair by pair. ` +
    `A trial that failed counts as a flight that found nothing more. The primary figure is ${metricNames[data.verdicts.metric] || "–"}. ` +
    `Intervals hold ${percentOfIntervals} % and are bootstrapped; caves weigh the same in every mean over caves. How each figure is tested is written in docs/statistics.md of karst.`));
  const text = (v) => typeof v === "string" ? v : Object.entries(v || {}).map(([k, x]) => `${k} ${typeof x === "string" ? x : JSON.stringify(x)}`).join(", ");
  fillTable(element("contestants"), [["name", "name"], "policy", "version", "parameters", "settings of its own"],
    data.contestants.map((c, i) => [[named(i), "name"], c.policy, c.version, text(c.parameters), text(c.settings)]));
  fillTable(element("definitions"), [["figure", "name"], "unit", "better", "what it is"],
    data.metrics.map((m) => [[m.name, "name"], unitText(m.unit), m.better === "neither" ? "" : m.better, m.meaning]));
}
