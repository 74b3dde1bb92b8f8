// The plots of a team, and what the base knew at the chosen moment.

/** Robots that reach the base; dropped nodes have higher numbers. */
function robotsOf(radios) { return radios.filter((r) => r > 0 && r <= data.robots.length); }

function heldOf(base, robot) { const row = base.held.find((h) => h[0] === robot); return row ? row[1] : 0; }

function distance(a, b) { return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/** How far from the base the team's radio reaches, straight: the farthest connected relay's distance and its reach. */
function reachOf(base) {
  const from = data.base.position, own = data.base.reach_m || 0;
  const far = base.relays.filter((r) => base.connected.includes(r[0]) && !base.dead.includes(r[0])).map((r) => distance(r.slice(1, 4), from));
  return own + Math.max(0, ...far);
}

function addTeamPlots() {
  const robots = data.robots.map((r, i) => ({ ...r, label: `robot ${i + 1}`, colour: robotColour(i + 1) }));
  const moments = data.base.moments, over = (value) => moments.map(([t, base]) => [t, value(base)]);
  addPlot({ title: "Explored volume, m³", unit: "m³",
            sets: [{ label: "team", points: data.volume, colour: cssColour("--text"), fill: "rgba(120,130,140,.15)" },
                   ...robots.map((r) => ({ label: r.label, points: r.volume, colour: r.colour }))] });
  addPlot({ title: "Records of each robot that the base holds", unit: "records",
            sets: robots.map((r, i) => ({ label: r.label, colour: r.colour, points: over((base) => heldOf(base, i + 1)) })) });
  addPlot({ title: "Battery left, %", unit: "%", max: 100,
            sets: robots.map((r) => ({ label: r.label, points: r.battery, colour: r.colour })) });
  addPlot({ title: "Reach from the base over landed relays, m (straight)", unit: "m",
            sets: data.base.position && data.base.reach_m ? [{ label: "reach", colour: colours.home, points: over(reachOf) }] : [] });
  addPlot({ title: "Robots that reach the base, as it knows", unit: "robots", max: data.robots.length,
            sets: [{ label: "connected", colour: colours.plan, points: over((base) => robotsOf(base.connected).length) }] });
}

function startTeamPanel() {
  moment.listeners.push((t) => {
    const base = baseAt(t);
    const head = make("tr", {}, ...["robot", "", "battery", "at base"].map((h) => make("th", {}, h)));
    const list = data.robots.map((r, i) => make("tr", {}, make("td", {}, robotSwatch(i + 1), String(i + 1)), make("td", {}, robotPhase(i + 1, t)),
      make("td", { className: "number" }, t < (r.battery ? r.battery[0][0] : 0) ? "100 %" : withUnit(curveAt(r.battery, t), "%", 2) ?? ""),
      make("td", { className: "number" }, base ? String(heldOf(base, i + 1)) : "")));
    element("moment").replaceChildren(make("h3", {}, "Now"), make("table", {}, head, ...list),
      make("h3", {}, "Team"), rows([["explored", withUnit(curveAt(data.volume, t), "m³", 4)],
        ...(happened("object") ? [["finds, robot by robot", String(objectsAt("object", t).size)], ["known at the base", String(objectsAt("object_known", t).size)]] : [])]),
      make("h3", {}, "The base knows"),
      base ? rows([["reach it", robotsOf(base.connected).join(", ") || "none"],
                   ["stand as relays", robotsOf(relaysOf(base).map((r) => r[0])).join(", ") || "none"],
                   ...(happened("drop") ? [["dropped nodes that reach it", String(base.connected.filter((r) => r > data.robots.length).length)]] : []),
                   ["told dead", base.dead.join(", ") || "none"], ["links", String(base.links.length)],
                   ["reach", data.base.position ? withUnit(reachOf(base), "m", 3) : undefined]])
        : make("div", { className: "quiet" }, "nothing yet"));
  });
}
