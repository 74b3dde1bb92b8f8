// Header and tables of a team.

function robotSwatch(robot) {
  const mark = make("i", { className: "swatch" });
  mark.style.background = robotColour(robot);
  return mark;
}

function showTeamHeader() {
  const m = data.metrics;
  showTitle([`team of ${data.robots.length}`, m.strategy]);
  showFigures([
    ["explore, mean", figure(m.exploration_time_s, "s")], ["explored", figure(m.explored_volume_m3, "m³", 4)],
    ["coverage", figureShare(m.coverage)], ["half covered after", figure(m.t50_s, "s")], ["landed", figureShare(m.robots_landed)],
    ["connected", figureShare(m.robots_connected)], ["at the base", figureShare(m.data_at_base_share)], ["contacts", figure(m.contacts, "")],
    ["path length", figure(m.path_length_m, "m")], ["over the air", figure(typeof m.bytes_on_air === "number" ? m.bytes_on_air / 1000 : null, "kB")]]);
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
  const share = (v) => withUnit(typeof v === "number" ? 100 * v : null, "%", 2);
  const count = (n) => typeof n === "number" ? String(n) : undefined;
  const all = [  // title, text (undefined: not known), whether it is a number
    ["start", (m) => clockText(m.start_s ?? 0), true], ["explored", (m) => withUnit(m.exploration_time_s, "s"), true],
    ["outcome", (m) => m.outcome], ["battery left", (m) => share(m.battery_left), true],
    ["connected", (m) => m.connected === undefined || m.connected === null ? undefined : m.connected ? "yes" : "no"],
    ["records told", (m) => count(m.records), true], ["at the base", (m) => count(m.records_at_base), true],
    ["why", (m, r) => tied(r.ending || m.reason || "")]];
  const known = ([, text]) => data.robots.some((r, i) => text(robots[i] || {}, r));
  const columns = all.filter(known);
  element("robots-unknown").textContent = notKnown(all.filter((c) => !known(c)).map(([title]) => title));
  const head = ["robot", ...columns.map(([title]) => title), ""];
  const body = make("tbody");
  data.robots.forEach((r, i) => {
    const m = robots[i] || {};
    const link = r.reported ? make("a", { href: `./robot_${i + 1}/report.html`, textContent: "its flight" }) : "";
    const row = make("tr", {}, make("td", {}, robotSwatch(i + 1), String(i + 1)),
      ...columns.map(([, text, number]) => make("td", { className: number ? "number" : "" }, text(m, r) ?? "")), make("td", {}, link));
    row.addEventListener("click", () => {
      for (const other of body.children) other.classList.toggle("on", other === row);
      follow(i + 1);
    });
    body.append(row);
  });
  element("robot-table").append(make("thead", {}, make("tr", {}, ...head.map((h) => make("th", {}, h)))), body);
  element("robots").hidden = false;
}
