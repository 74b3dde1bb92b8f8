// The panel that says what the vehicle and its policy were about at the chosen moment.

/** Goals are queued: the vehicle flies to the first of those that are open, and then to the next. */
function nextGoalAt(run, t) {
  const open = run.goals.filter((g) => g.t <= t && (g.until === null || t < g.until));
  return open[1] || null;
}

function goalPanel(t) {
  const goal = goalAt(data, t), next = nextGoalAt(data, t);
  if (!goal) return [make("div", { className: "quiet" }, "none")];
  const end = goal.until !== null && goal.fate ? `${goal.fate} at ${clockText(goal.until)}` : null;
  return [
    make("div", { className: "why" }, tied(goal.why || "(the policy gave no reason)")),
    rows([["number", String(data.goals.indexOf(goal) + 1)], ["score", typeof goal.score === "number" ? numberText(goal.score) : undefined],
          ["at", placeText(goal.position) || undefined], ["since", clockText(goal.t)], ["then", end],
          ["because", goal.fate_reason || null],
          ["after it", next ? `goal ${data.goals.indexOf(next) + 1}, ${placeText(next.position)}` : null]]),
  ];
}

/** A goal of a ranked list: its score, frontier, place and speed limit; the policy's reason; what became of it, where it
 *  was accepted with `queued`. */
function rankedGoal(g, queued) {
  const facts = [typeof g.score === "number" ? "score " + numberText(g.score) : "", g.frontier ? "frontier " + g.frontier : "",
                 placeText(g.position), g.max_speed ? `at most ${withUnit(g.max_speed, "m/s", 2)}` : ""].filter(Boolean);
  return make("li", { className: /^refused/.test(g.fate) ? "refused" : g.fate === "accepted" ? "accepted" : "" },
              make("div", {}, tied(g.why || "(no reason given)")), make("div", { className: "quiet" }, facts.join(" · ")),
              make("div", {}, tied(g.fate + (g.fate === "accepted" ? queued : ""))));
}

/** What to add to the decision's accepted goal at t: where the vehicle flies to another one first. */
function queuedText(decided, t) {
  const next = nextGoalAt(data, t);
  return next && next.t === decided ? ": next, after the goal under way" : "";
}

function answerPanel(answer, queued) {
  const head = answer.request ? `request ${answer.request}` : "";
  if (!answer.goals)
    return [make("div", {}, `${head}: ${answer.failure ? "the policy failed: " + answer.failure : answer.text}`)];
  const shown = answer.goals.map((g) => rankedGoal(g, queued)), parts = [];
  if (head) parts.push(make("div", { className: "quiet" }, `${head}: ${shown.length ? "best first" : answer.outcome || "no goals"}`));
  if (shown.length) parts.push(make("ol", { className: "goals" }, ...shown));
  if (answer.left_out) parts.push(make("div", { className: "quiet" }, `and ${answer.left_out} more`));
  return parts;
}

/** All goals that were offered at `decided`; without requests.bin those that were tried. `t` is the moment shown. */
function choicePanel(decided, t) {
  const choice = choiceAt(data.choices, decided), queued = queuedText(decided, t);
  if (!choice) return [];
  const note = choice.recorded ? []
    : [make("div", { className: "quiet" }, "Goals that were not tried are not recorded: fly with --record-requests to see all.")];
  return [make("h3", {}, "Its goals, ranked"), ...choice.answers.flatMap((a) => answerPanel(a, queued)), ...note];
}

function decisionPanel(t) {
  const i = lastAt(decisions.length, (k) => decisions[k].t, t);
  if (i < 0) return [make("div", { className: "quiet" }, "none yet")];
  const d = decisions[i], choice = choiceAt(data.choices, d.t), count = (n) => n === undefined || n === null ? undefined : String(n);
  return [
    rows([["number", String(d.sequence ?? i + 1)], ["at", clockText(d.t)],
          ["by", d.policy && d.policy !== data.metrics.policy ? choice?.by ?? d.policy : null], ["outcome", choice?.result ?? count(d.outcome)],
          ["goals offered", count(d.goals)], ["frontiers", count(d.frontiers)]]),
    make("div", {}, tied(choice?.result ? "" : d.reason || "")),
    ...choicePanel(d.t, t),
  ];
}
const decisions = data.events.filter((e) => e.kind === "decision");

/** Whether it stands on the ground after the flight: speed and clearance at touchdown say nothing of that. */
function isDown(phase) { return phase === "done" && /^(landed|stuck)$/.test(data.metrics.outcome); }

function startMomentPanel() {
  const box = element("moment");
  moment.listeners.push((t) => {
    const c = data.curves, phase = phaseAt(data, t), down = isDown(phase);
    box.replaceChildren(
      make("h3", {}, "Now"),
      make("div", { className: "phase" }, down ? "done, on the ground" : phase || "no phase yet"),
      rows([["speed", down ? null : withUnit(curveAt(c.speed, t), "m/s", 2)],
            ["explored", withUnit(curveAt(c.volume, t), "m³", 4)],
            ...isReplay ? [] : [["battery", withUnit(curveAt(c.battery, t), "%", 2)],
                                ["clearance", down ? null : withUnit(curveAt(c.clearance, t), "m", 2)]],
            ["from the start", withUnit(curveAt(c.distance, t), "m", 3)]]),
      ...isReplay ? [] : [make("h3", {}, "Goal"), ...goalPanel(t), make("h3", {}, "Last decision"), ...decisionPanel(t)]);
  });
}
