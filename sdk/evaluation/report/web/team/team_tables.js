// Header and tables of a team.

function robotSwatch(robot) {
  const mark = make("i", { className: "swatch" });
  mark.style.background = robotColour(robot);
  return mark;
}

function showTeamHeader() {
  const m = data.metrics, share = (v) => typeof v === "number" ? [numberText(100 * v, 3), "%"] : ["–", ""];
  const unit = (v, u, digits) => typeof v === "number" ? [numberText(v, digits), u] : ["–", ""];
  showTitle([`team of ${data.robots.length}`, m.strategy]);
  showFigures([
    ["explore, mean", unit(m.exploration_time_s, "s")], ["explored", unit(m.explored_volume_m3, "m³", 4)],
    ["coverage", share(m.coverage)], ["half covered after", unit(m.t50_s, "s")], ["landed", share(m.robots_landed)],
    ["connected", share(m.robots_connected)], ["at the base", share(m.data_at_base_share)], ["contacts", unit(m.contacts, "")],
    ["path length", unit(m.path_length_m, "m")], ["over the air", unit(typeof m.bytes_on_air === "number" ? m.bytes_on_air / 1000 : null, "kB")]]);
  showProblems();
}

/** A row of bands for each robot above the time slider. */
function drawTeamTrack() {
  element("phases").classList.add("rows");
  data.robots.forEach((r, i) => {
    const row = make("div", { className: "phases row", title: `robot ${i + 1}` });
    drawPhases(row, r.phases);
    element("phases").append(row);
  });
  drawTicks();
}

function showRobots(follow) {
  const robots = Array.isArray(data.metrics.robots) ? data.metrics.robots : [];
  const head = ["robot", "start", "explored", "outcome", "battery left", "connected", "records told", "at the base", "why", ""];
  const body = make("tbody");
  data.robots.forEach((r, i) => {
    const m = robots[i] || {}, number = (text) => make("td", { className: "number" }, text);
    const link = r.reported ? make("a", { href: `./robot_${i + 1}/report.html`, textContent: "its flight" }) : "";
    const row = make("tr", {}, make("td", {}, robotSwatch(i + 1), String(i + 1)), number(clockText(m.start_s ?? 0)),
      number(withUnit(m.exploration_time_s, "s")), make("td", {}, m.outcome || "–"),
      number(withUnit(typeof m.battery_left === "number" ? 100 * m.battery_left : null, "%", 2)),
      make("td", {}, m.connected === undefined ? "–" : m.connected ? "yes" : "no"), number(String(m.records ?? "–")),
      number(String(m.records_at_base ?? "–")), make("td", {}, r.ending || m.reason || ""), make("td", {}, link));
    row.addEventListener("click", () => {
      for (const other of body.children) other.classList.toggle("on", other === row);
      follow(i + 1);
    });
    body.append(row);
  });
  element("robot-table").append(make("thead", {}, make("tr", {}, ...head.map((h) => make("th", {}, h)))), body);
  element("robots").hidden = false;
}
