// What moves in a team's cave: the robots and their paths, the links between them, landed relays, how far the radio
// reaches, the homing tree and the objects found.

// Okabe and Ito's colours, safe for the colour-blind; labels carry the numbers, so that more robots can be told apart.
const robotColours = ["#e69f00", "#56b4e9", "#009e73", "#f0e442", "#cc79a7", "#d55e00", "#0072b2", "#dddddd"];
function robotColour(robot) { return robotColours[(robot - 1) % robotColours.length]; }

function robotPhase(robot, t) {
  const phases = data.robots[robot - 1].phases;
  const phase = phaseAt({ phases }, t), end = (data.metrics.robots || [])[robot - 1];
  return !phases.length ? "" : t < phases[0][1] ? "waiting" : phase === "done" && end ? end.outcome : phase;
}
/** The landed robots and the dropped nodes that stand as relays: a robot that came back to the base is none. */
function relaysOf(base) {
  const ends = data.metrics.robots || [], [x, y] = data.base.position || [NaN, NaN], kAtBase_m = 1;
  const isBack = ([radio, ...place]) => (ends[radio - 1] || {}).reason === "at the start" ||
    (radio <= data.robots.length && Math.hypot(place[0] - x, place[1] - y) < kAtBase_m);
  return base.relays.filter((r) => !isBack(r));
}
/** What the base knew at t, or null. */
function baseAt(t) { const moment = entryAt(data.base.moments, t); return moment && moment[1]; }

/** Colour of a link that takes so many transmissions a message: one is the best. */
function linkColour(transmissions) { return transmissions < 1.3 ? "#009e73" : transmissions < 2.5 ? "#f0e442" : "#d55e00"; }

/** Each node with the way it goes on, as of t: { name: [x, y, z, parent's name or null] }. */
function treeAt(t) {
  const nodes = new Map();
  for (const [time, rows] of data.tree) {
    if (time > t) break;
    for (const [robot, number, x, y, z, , toRobot, toNumber] of rows)
      nodes.set(`${robot}.${number}`, [x, y, z, toRobot === undefined ? null : `${toRobot}.${toNumber}`]);
  }
  return nodes;
}

/** The objects that events of a kind tell of as of t, each as last told and where it then lay, without withdrawn ones:
    { "robot.number": [x, y, z] }. "object" is what a robot found, "object_known" what the base knows. */
function objectsAt(kind, t) {
  const objects = new Map();
  for (const e of data.events) {
    if (e.kind !== kind || !(e.t <= t)) continue;
    const key = `${e.robot}.${e.number}`;
    if (e.state === "withdrawn") objects.delete(key);
    else if (Array.isArray(e.position) && e.position.length === 3 && e.position.every(Number.isFinite)) objects.set(key, e.position);
  }
  return objects;
}

function segments(width, opacity = 1) {
  const material = new THREE.LineMaterial({ color: 0xffffff, linewidth: width, depthTest: false, transparent: true,
                                            opacity, vertexColors: THREE.VertexColors });
  const line = new THREE.LineSegments2(new THREE.LineSegmentsGeometry(), material);
  line.frustumCulled = false;
  line.visible = false;
  return line;
}
/** Shows [[from, to, colour], ...]; points are [x, y, z]. */
function setSegments(line, list) {
  line.geometry.dispose();
  line.geometry = new THREE.LineSegmentsGeometry();
  line.visible = list.length > 0;
  if (!list.length) return;
  line.geometry.setPositions([].concat(...list.map(([a, b]) => [...a, ...b])));
  line.geometry.setColors([].concat(...list.map(([, , c]) => { const rgb = new THREE.Color(c).toArray(); return [...rgb, ...rgb]; })));
}

function reachSphere() {
  const object = new THREE.Mesh(new THREE.SphereBufferGeometry(data.base.reach_m, 40, 24), new THREE.MeshBasicMaterial({
    color: new THREE.Color(colours.home).getHex(), transparent: true, opacity: 0.07, depthWrite: false }));
  object.renderOrder = 1;
  return object;
}

function happened(kind) { return data.events.some((e) => e.kind === kind); }

/** The team in the manner of makeFlight(); `follow(robot)` chooses whom the camera follows. */
function makeTeam() {
  const object = new THREE.Group(), layer = {}, lines = [];
  const add = (name, child, order) => {
    child.renderOrder = order;
    (layer[name] = layer[name] || new THREE.Group()).add(child);
    object.add(layer[name]);
    return child;
  };
  const tracks = data.robots.map((r) => decodeTrack(r.track)), flown = [], vehicles = [];
  tracks.forEach((track, i) => {
    const own = [];
    if (track && track.count > 1)
      for (const [width, colour, order] of [[5, "#101418", 2], [3, robotColour(i + 1), 3]])
        own.push(add("paths", thickLine(track.xyz, width, colour), order));
    lines.push(...own);
    flown.push(own);
    vehicles.push(add("robots", vehicleArrow(robotColour(i + 1)), 9));
  });
  const links = add("links", segments(2.5), 6), tree = add("homing tree", segments(1.6, 0.75), 4);
  lines.push(links, tree);
  const relays = add("relays", roundMarks(colours.goal), 7), lost = add("relays", roundMarks(colours.other), 7);
  const found = add("objects", roundMarks(colours.object), 8), known = add("objects known at the base", roundMarks(colours.home), 9);
  layer.reach = new THREE.Group();
  object.add(layer.reach);
  const whole = tracks.filter(Boolean).flatMap((t) => Array.from(t.xyz));
  const choices = ["paths", "links", "relays", "reach", "homing tree", "objects", "objects known at the base"].filter((name) => layer[name] &&
    !(name === "objects" && !happened("object")) && !(name === "objects known at the base" && !happened("object_known")) && !(name === "reach" && !data.base.reach_m) && !(name === "homing tree" && !data.tree.length));

  let followed = 1, shownTree, poses = [];
  const view = { object, layer, choices, vehicles, labels: [], now: { position: new THREE.Vector3(), heading: 0 },
                 track: whole.length ? { count: whole.length / 3, xyz: whole } : null };
  view.follow = (robot) => { followed = robot; };
  view.setResolution = (w, h) => { for (const line of lines) line.material.resolution.set(w, h); };

  const placeOf = (radio, base) => {
    if (radio === 0) return data.base.position;
    if (radio <= poses.length) return poses[radio - 1] ? poses[radio - 1].position.toArray() : null;
    const node = base.relays.find((r) => r[0] === radio);  // dropped
    return node ? node.slice(1, 4) : null;
  };
  const showRelays = (base) => {
    const standing = base ? relaysOf(base) : [], fine = (r) => base.connected.includes(r[0]) && !base.dead.includes(r[0]);
    const put = (points, list) => setMarks(points, [].concat(...list.map((r) => r.slice(1, 4))), list.map(() => 13));
    put(relays, standing.filter(fine));
    put(lost, standing.filter((r) => !fine(r)));
    const centres = data.base.reach_m ? [data.base.position, ...standing.filter(fine).map((r) => r.slice(1, 4))].filter(Boolean) : [];
    while (layer.reach.children.length < centres.length) layer.reach.add(reachSphere());
    layer.reach.children.forEach((s, i) => { s.visible = i < centres.length; if (s.visible) s.position.set(...centres[i]); });
  };
  const showTree = (t) => {
    const newest = entryAt(data.tree, t);
    if (newest === shownTree) return;
    shownTree = newest;
    const nodes = treeAt(t);
    setSegments(tree, [...nodes.values()].filter((n) => n[3] && nodes.has(n[3]))
      .map((n) => [n.slice(0, 3), nodes.get(n[3]).slice(0, 3), colours.truth]));
  };
  const showObjects = (t) => {  // what the base knows is smaller and lies upon what was found
    for (const [points, kind, size] of [[found, "object", 12], [known, "object_known", 7]]) {
      const places = [...objectsAt(kind, t).values()];
      setMarks(points, places.flat(), places.map(() => size));
    }
  };
  view.setTime = (t) => {
    poses = tracks.map((track) => track && poseAt(track, t));
    poses.forEach((pose, i) => {
      vehicles[i].visible = Boolean(pose);
      if (!pose) return;
      vehicles[i].position.copy(pose.position);
      vehicles[i].rotation.z = pose.heading;
      const before = t < tracks[i].t[0];
      for (const line of flown[i]) line.geometry.maxInstancedCount = before ? 0 : pose.index;
    });
    view.now = poses[followed - 1] || poses.find(Boolean) || view.now;
    const base = baseAt(t);
    setSegments(links, (base ? base.links : []).map(([a, b, n]) => [placeOf(a, base), placeOf(b, base), linkColour(n)]).filter(([a, b]) => a && b));
    showRelays(base);
    showTree(t);
    showObjects(t);
    view.labels = poses.map((pose, i) => pose && { position: pose.position, text: `${i + 1} ${robotPhase(i + 1, t)}` }).filter(Boolean);
    if (data.base.position) view.labels.unshift({ position: new THREE.Vector3(...data.base.position), text: "base" });
  };
  return view;
}
