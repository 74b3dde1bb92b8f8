// What moves in the map: the flown path, the vehicle, its goal and plan, the frontiers, what the policy drew.

/** A line of constant width in pixels through `xyz`, of which the first n segments can be shown. */
function thickLine(xyz, width, colour, segmentColours) {
  const geometry = new THREE.LineGeometry();
  geometry.setPositions(xyz);
  if (segmentColours) geometry.setColors(segmentColours);
  const material = new THREE.LineMaterial({
    color: segmentColours ? 0xffffff : new THREE.Color(colour).getHex(), linewidth: width, depthTest: false,
    transparent: true, vertexColors: segmentColours ? THREE.VertexColors : THREE.NoColors });
  const line = new THREE.Line2(geometry, material);
  line.frustumCulled = false;
  return line;
}

/** Round marks with sizes in pixels. */
function roundMarks(colour) {
  const material = new THREE.ShaderMaterial({
    uniforms: { colour: { value: new THREE.Color(colour) }, ratio: { value: window.devicePixelRatio } },
    transparent: true, depthTest: false,
    vertexShader: `attribute float size; uniform float ratio;
      void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
                    gl_PointSize = size * ratio; }`,
    fragmentShader: `uniform vec3 colour;
      void main() { float r = length(gl_PointCoord - 0.5); if (r > 0.5) discard;
                    gl_FragColor = vec4(r > 0.4 ? colour * 0.45 : colour, 0.85); }` });
  const points = new THREE.Points(new THREE.BufferGeometry(), material);
  points.frustumCulled = false;
  return points;
}
function setMarks(points, xyz, sizes) {
  points.geometry.dispose();
  points.geometry = new THREE.BufferGeometry();
  points.geometry.setAttribute("position", new THREE.Float32BufferAttribute(xyz, 3));
  points.geometry.setAttribute("size", new THREE.Float32BufferAttribute(sizes, 1));
}

/** An icon of constant size on the screen, drawn by `draw(context)` on 64 x 64. */
function icon(draw, scale) {
  const canvas = make("canvas", { width: 64, height: 64 });
  draw(canvas.getContext("2d"));
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({
    map: new THREE.CanvasTexture(canvas), depthTest: false, sizeAttenuation: false, transparent: true }));
  sprite.scale.setScalar(scale);
  return sprite;
}
function goalIcon() {
  return icon((c) => {
    for (const [width, colour] of [[13, "#111"], [7, colours.goal]]) {
      c.strokeStyle = colour; c.lineWidth = width;
      c.beginPath(); c.arc(32, 32, 20, 0, 2 * Math.PI); c.stroke();
    }
    c.fillStyle = "#111"; c.beginPath(); c.arc(32, 32, 8, 0, 2 * Math.PI); c.fill();
    c.fillStyle = colours.goal; c.beginPath(); c.arc(32, 32, 5, 0, 2 * Math.PI); c.fill();
  }, 0.042);
}

/** A flat arrow that points where the vehicle does. */
function vehicleArrow() {
  const group = new THREE.Group();
  for (const [scale, colour, order] of [[1.35, 0x111111, 20], [1, 0xffffff, 21]]) {
    const shape = new THREE.Shape();
    shape.moveTo(1, 0); shape.lineTo(-0.75, 0.7); shape.lineTo(-0.4, 0); shape.lineTo(-0.75, -0.7);
    const mesh = new THREE.Mesh(new THREE.ShapeBufferGeometry(shape), new THREE.MeshBasicMaterial({
      color: colour, side: THREE.DoubleSide, depthTest: false, transparent: true }));
    mesh.scale.setScalar(scale);
    mesh.renderOrder = order;
    group.add(mesh);
  }
  return group;
}

function decodeTrack(track) {
  if (!track) return null;
  return { count: track.count, t: decode(track.t, Float32Array), xyz: decode(track.xyz, Float32Array),
           heading: decode(track.heading, Float32Array) };
}
/** Where the vehicle is at t: { position, heading, index }. */
function poseAt(track, t) {
  const i = Math.max(0, lastAt(track.count, (k) => track.t[k], t));
  const j = Math.min(i + 1, track.count - 1);
  const span = track.t[j] - track.t[i];
  const s = span > 0 ? Math.min(1, Math.max(0, (t - track.t[i]) / span)) : 0;
  const at = (k) => new THREE.Vector3(track.xyz[3 * k], track.xyz[3 * k + 1], track.xyz[3 * k + 2]);
  const turn = Math.atan2(Math.sin(track.heading[j] - track.heading[i]), Math.cos(track.heading[j] - track.heading[i]));
  return { position: at(i).lerp(at(j), s), heading: track.heading[i] + s * turn, index: i };
}

function phaseAt(t) {
  for (const [name, begin, end] of data.phases) if (t >= begin && t < end) return name;
  return data.phases.length && t >= data.phases[data.phases.length - 1][2] ? "done" : "";
}
function goalAt(t) {
  return data.goals.find((g) => g.t <= t && (g.until === null || t < g.until)) || null;
}

/** The policy's drawings of one moment as an object, and its texts as labels. */
function makeDrawings(drawings) {
  const group = new THREE.Group(), labels = [];
  for (const d of drawings) {
    if (d.shape === "text") {
      if (d.points.length) labels.push({ position: new THREE.Vector3(...d.points[0]), text: d.text });
      continue;
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute([].concat(...d.points), 3));
    const look = { color: d.rgb, depthTest: false, transparent: true };
    const object = d.shape === "lines" ? new THREE.LineSegments(geometry, new THREE.LineBasicMaterial(look))
      : new THREE.Points(geometry, new THREE.PointsMaterial({ ...look, size: 6, sizeAttenuation: false }));
    object.frustumCulled = false;
    object.renderOrder = 4;
    group.add(object);
  }
  return { group, labels };
}

/** { object, layers: {name: {object, ...}}, setTime(t), setResolution(w, h), labels, vehicle } */
function makeFlight() {
  const track = decodeTrack(data.track), truth = decodeTrack(data.true_track);
  const object = new THREE.Group(), lines = [];
  const layer = {};
  const add = (name, child, order) => {
    child.renderOrder = order;
    (layer[name] = layer[name] || new THREE.Group()).add(child);
    object.add(layer[name]);
    return child;
  };
  const addLine = (name, line, order) => { lines.push(line); return add(name, line, order); };

  const flown = [];
  if (track && track.count > 1) {
    const tints = [];
    for (let i = 0; i < track.count; ++i) tints.push(...new THREE.Color(phaseColour(phaseAt(track.t[i]))).toArray());
    flown.push(addLine("path", thickLine(track.xyz, 5, "#101418"), 2));
    flown.push(addLine("path", thickLine(track.xyz, 3, "", tints), 3));
  }
  let trueLine = null;
  if (truth && truth.count > 1) trueLine = addLine("true path", thickLine(truth.xyz, 1.5, colours.truth), 3);
  const frontiers = add("frontiers", roundMarks(colours.frontier), 5);
  const goal = add("goal", goalIcon(), 8);
  const vehicle = add("vehicle", vehicleArrow(), 9);
  layer.plan = new THREE.Group();
  layer.drawings = new THREE.Group();
  object.add(layer.plan, layer.drawings);

  let shownPlan, shownFrontiers, shownDrawings, drawingLabels = [], resolution = [1, 1];
  const view = { object, layer, labels: [], vehicle, track, now: { position: new THREE.Vector3(), heading: 0 } };
  const withResolution = (line) => { line.material.resolution.set(...resolution); return line; };

  view.setResolution = (w, h) => {
    resolution = [w, h];
    lines.forEach(withResolution);
    layer.plan.children.forEach(withResolution);
  };
  view.setTime = (t) => {
    if (track) {
      view.now = poseAt(track, t);
      vehicle.position.copy(view.now.position);
      vehicle.rotation.z = view.now.heading;
      for (const line of flown) line.geometry.maxInstancedCount = view.now.index;
    }
    vehicle.visible = Boolean(track);
    if (trueLine) trueLine.geometry.maxInstancedCount = Math.max(0, lastAt(truth.count, (k) => truth.t[k], t));

    const active = goalAt(t);
    goal.visible = Boolean(active && active.position);
    if (goal.visible) goal.position.set(...active.position);

    const plan = phaseAt(t) === "done" ? null : entryAt(data.plans, t);
    if (plan !== shownPlan) {
      shownPlan = plan;
      layer.plan.children.forEach((c) => { c.geometry.dispose(); c.material.dispose(); });
      layer.plan.remove(...layer.plan.children);
      if (plan && plan[1].length > 1) {
        const line = withResolution(thickLine([].concat(...plan[1].map((p) => p.slice(0, 3))), 2.5, colours.plan));
        line.renderOrder = 4;
        layer.plan.add(line);
      }
    }
    const clusters = entryAt(data.frontiers, t);
    if (clusters !== shownFrontiers) {
      shownFrontiers = clusters;
      const list = clusters ? clusters[1] : [];
      setMarks(frontiers, [].concat(...list.map((c) => c.slice(0, 3))),
               list.map((c) => Math.min(11, 3.5 + 0.3 * Math.sqrt(c[3]))));
    }
    const drawings = /^(home|land|done)$/.test(phaseAt(t)) ? null : entryAt(data.drawings, t);
    if (drawings !== shownDrawings) {
      shownDrawings = drawings;
      layer.drawings.children.forEach((g) => g.children.forEach((c) => { c.geometry.dispose(); c.material.dispose(); }));
      layer.drawings.remove(...layer.drawings.children);
      const made = makeDrawings(drawings ? drawings[1] : []);
      layer.drawings.add(made.group);
      drawingLabels = made.labels;
    }
    view.labels = [];
    if (track) view.labels.push({ position: new THREE.Vector3(...track.xyz.slice(0, 3)), text: "start" });
    if (goal.visible && layer.goal.visible)
      view.labels.push({ position: goal.position, text: active.why ? "goal: " + active.why : "goal" });
    if (layer.drawings.visible) view.labels.push(...drawingLabels);
  };
  return view;
}
