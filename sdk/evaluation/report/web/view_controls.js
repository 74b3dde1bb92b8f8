// The sliders, choices and layers over the 3D view.

/** The colour bar with what it stands for. */
function showScale(cloud, step, mode) {
  const box = element("scale");
  box.textContent = "";
  if (cloud && mode < 2) {
    const ends = mode === 0 ? [numberText(cloud.low, 2) + " m", numberText(cloud.high, 2) + " m"]
      : ["0:00", clockText(data.duration_s)];
    box.append(make("div", { textContent: mode === 0 ? "height z" : "time first seen" }));
    const bar = make("div", { className: "bar" });
    bar.style.background = `linear-gradient(90deg, ${ramp.join(",")})`;
    box.append(bar, make("div", { className: "ends" }, make("span", {}, ends[0]), make("span", {}, ends[1])));
  }
  box.append(make("div", { className: "quiet", textContent: `grid ${step} m` +
    (data.cloud ? `, cells ${numberText(data.cloud.cell_m, 2)} m` : "") }));
}

const layerMarks = {
  "map": ["", ""], "path": [colours.explore, ""], "true path": [colours.truth, ""],
  "path before loops": [colours.odometry, ""], "loops closed": [colours.loop, "dot"], "closures not used": [colours.object, "dot"], "keep in": [colours.keepIn, ""], "keep out": [colours.keepOut, "cross"], "plan": [colours.plan, ""],
  "goal": [colours.goal, "ring"], "frontiers": [colours.frontier, "dot"], "drawings": ["", ""], "grid": ["", ""],
  "paths": ["", ""], "links": ["#009e73", ""], "relays": [colours.goal, "ring"], "reach": [colours.home, "dot"],
  "homing tree": [colours.truth, ""], "objects": [colours.object, "dot"], "objects known at the base": [colours.home, "dot"],
};

function connectLayers(objects, redraw) {
  for (const [name, object] of Object.entries(objects)) {
    const box = make("input", { type: "checkbox", checked: name !== "true path" });
    object.visible = box.checked;
    box.addEventListener("change", () => { object.visible = box.checked; redraw(); });
    const label = make("label", {}, box);
    const [colour, shape] = layerMarks[name];
    if (colour) {
      const mark = make("i", { className: shape });
      mark.style.background = mark.style.borderColor = colour;
      label.append(mark);
    }
    const outAndHome = name === "path" && !isReplay;
    label.append(outAndHome ? "out" : name === "path" && data.odometry_track ? "path, corrected" : name);
    if (outAndHome) {
      const home = make("i");
      home.style.background = colours.home;
      home.style.marginLeft = "10px";
      label.append(home, "home");
    }
    element("layers").append(label);
  }
}

function connectControls(cloud, flight, grid, step, redraw) {
  const objects = {};
  if (cloud) objects.map = cloud.object;
  for (const name of flight.choices) objects[name] = flight.layer[name];
  objects.grid = grid;
  connectLayers(objects, redraw);
  showScale(cloud, step, 0);
  if (!cloud) {
    for (const e of document.querySelectorAll("#view-controls > label")) e.style.display = "none";
    return;
  }
  const { uniforms, top, bottom } = cloud;
  connectSlider("clip", (v) => v >= 1 ? "off" : numberText(bottom + v * (top - bottom), 2) + " m",
                (v) => { uniforms.clip.value = v >= 1 ? 1e9 : bottom + v * (top - bottom); redraw(); });
  connectSlider("size", (v) => Math.round(v * 100) + " %", (v) => { uniforms.size.value = v; redraw(); });
  connectSlider("opacity", (v) => Math.round(v * 100) + " %", (v) => { cloud.setOpacity(v); redraw(); });
  element("colour").addEventListener("change", (e) => {
    uniforms.mode.value = Number(e.target.value);
    showScale(cloud, step, uniforms.mode.value);
    redraw();
  });
  element("inside").addEventListener("change", (e) => { uniforms.inside.value = e.target.checked; redraw(); });
}
