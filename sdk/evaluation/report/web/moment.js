// The panel that says what the vehicle and its policy were about at the chosen moment.

function goalPanel(t) {
  const goal = goalAt(data, t);
  if (!goal) return [make("div", { className: "quiet" }, "none")];
  const place = goal.position ? goal.position.map((v) => v.toFixed(1)).join(", ") : "–";
  const end = goal.until !== null && goal.fate ? `${goal.fate} at ${clockText(goal.until)}` : "–";
  return [
    make("div", { className: "why" }, goal.why || "(the policy gave no reason)"),
    rows([["score", numberText(goal.score)], ["at", place], ["since", clockText(goal.t)], ["then", end],
          ["because", goal.fate_reason || null]]),
  ];
}

function decisionPanel(t) {
  const i = lastAt(decisions.length, (k) => decisions[k].t, t);
  if (i < 0) return [make("div", { className: "quiet" }, "none yet")];
  const d = decisions[i];
  return [
    rows([["number", String(d.sequence ?? i + 1)], ["at", clockText(d.t)],
          ["by", d.policy && d.policy !== data.metrics.policy ? d.policy : null], ["outcome", String(d.outcome ?? "–")],
          ["goals offered", String(d.goals ?? "–")], ["frontiers", String(d.frontiers ?? "–")]]),
    make("div", {}, d.reason || ""),
    ...refusals.filter((e) => e.t === d.t).map((e) =>
      make("div", { className: "refused" }, `refused: ${e.why || "a goal"}`, make("br"), e.reason || "")),
  ];
}
const refusals = data.events.filter((e) => e.kind === "goal" && e.state === "rejected");
const decisions = data.events.filter((e) => e.kind === "decision");

function startMomentPanel() {
  const box = element("moment");
  moment.listeners.push((t) => {
    const c = data.curves;
    box.replaceChildren(
      make("h3", {}, "Now"),
      make("div", { className: "phase" }, phaseAt(data, t) || "–"),
      rows([["speed", withUnit(curveAt(c.speed, t), "m/s", 2)], ["explored", withUnit(curveAt(c.volume, t), "m³", 4)],
            ["battery", withUnit(curveAt(c.battery, t), "%", 2)],
            ["clearance", withUnit(curveAt(c.clearance, t), "m", 2)], ["from the start", withUnit(curveAt(c.distance, t), "m", 3)]]),
      make("h3", {}, "Goal"), ...goalPanel(t),
      make("h3", {}, "Last decision"), ...decisionPanel(t));
  });
}
