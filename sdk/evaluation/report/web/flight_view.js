// What moves in the map: the flown path, the vehicle, its goal and plan, the frontiers, what the policy drew.

function phaseAt(run, t) {
  for (const [name, begin, end] of run.phases) if (t >= begin && t < end) return name;
  return run.phases.length && t >= run.phases[run.phases.length - 1][2] ? "done" : "";
}
function goalAt(run, t) {
  return run.goals.find((g) => g.t <= t && (g.until === null || t < g.until)) || null;
}

/** A goal's label: short, as its reason stands in the panel. */
function goalText(run, goal) {
  return `goal ${run.goals.indexOf(goal) + 1}` + (typeof goal.score === "number" ? `, score ${numberText(goal.score)}` : "");
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

/** The edges of the region's bodies, as pairs of points one after another; the sides of those to keep out of are
 *  crossed. */
function regionEdges(bodies) {
  const points = [];
  for (const { keep, outline, low, high } of bodies)
    outline.forEach((a, i) => {
      const b = outline[(i + 1) % outline.length];
      points.push(...a, low, ...b, low, ...a, high, ...b, high, ...a, low, ...a, high);
      if (keep === "out") points.push(...a, low, ...b, high, ...a, high, ...b, low);
    });
  return points;
}

/** { object, layer: {name: object}, choices: names of layers to be shown or hidden, setTime(t), setResolution(w, h), labels, vehicles } of a run with phases, goals,
 *  plans, frontiers, choices, drawings, and tracks or null. `scores` is what showScoreScale() shows. */
function makeFlight(run) {
  const track = decodeTrack(run.track), truth = decodeTrack(run.true_track), odometry = decodeTrack(run.odometry_track);
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
    for (let i = 0; i < track.count; ++i) tints.push(...new THREE.Color(phaseColour(phaseAt(run, track.t[i]))).toArray());
    flown.push(addLine("path", thickLine(track.xyz, 5, "#101418"), 2));
    flown.push(addLine("path", thickLine(track.xyz, 3, "", tints), 3));
  }
  let trueLine = null;
  if (truth && truth.count > 1) trueLine = addLine("true path", thickLine(truth.xyz, 1.5, colours.truth), 3);
  if (odometry && odometry.count > 1) addLine("path before loops", thickLine(odometry.xyz, 7, colours.odometry), 1);  // a border where both are one
  if (run.loops) {
    const mark = (name, colour, closures) => {
      if (closures.length) setMarks(add(name, roundMarks(colour), 6), [].concat(...closures.map((c) => c[1])), closures.map(() => 10));
    };
    mark("loops closed", colours.loop, run.loops.filter((c) => c[2]));
    mark("closures not used", colours.object, run.loops.filter((c) => !c[2]));
  }
  for (const [name, keep, colour] of [["keep in", "in", colours.keepIn], ["keep out", "out", colours.keepOut]]) {
    const bodies = (run.region || []).filter((b) => b.keep === keep);
    if (!bodies.length) continue;
    const edges = new THREE.BufferGeometry();
    edges.setAttribute("position", new THREE.Float32BufferAttribute(regionEdges(bodies), 3));
    add(name, new THREE.LineSegments(edges, new THREE.LineBasicMaterial({ color: colour })), 1);
  }
  const frontiers = add("frontiers", roundMarks(colours.frontier), 5);
  const objects = add("objects", roundMarks(colours.object), 6);
  const goal = add("goal", goalIcon(), 8);
  const vehicle = add("vehicle", vehicleArrow(), 9);
  layer.plan = new THREE.Group();
  layer.drawings = new THREE.Group();
  object.add(layer.plan, layer.drawings);

  let shownPlan, shownFrontiers, shownObjects, shownDrawings, drawingLabels = [], clusterPlaces = [], resolution = [1, 1];
  const used = { plan: run.plans.length, goal: run.goals.length, frontiers: run.frontiers.length, objects: run.objects.length,
                 drawings: run.drawings.some((d) => d[1].length) };
  const choices = ["path", "path before loops", "loops closed", "closures not used", "true path", "keep in", "keep out", "plan", "goal", "frontiers", "objects", "drawings"].filter((n) => layer[n] && (used[n] ?? true));
  const view = { object, layer, choices, labels: [], avoid: [], scores: null, vehicles: [vehicle], track, now: { position: new THREE.Vector3(), heading: 0 } };
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

    const active = goalAt(run, t);
    goal.visible = Boolean(active && active.position);
    if (goal.visible) goal.position.set(...active.position);

    const plan = phaseAt(run, t) === "done" ? null : entryAt(run.plans, t);
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
    const clusters = entryAt(run.frontiers, t);
    if (clusters !== shownFrontiers) {
      shownFrontiers = clusters;
      const list = clusters ? clusters[1] : [];
      const { tints, range, unknown } = scoreTints(list, clusters && choiceAt(run.choices, clusters[0]));
      setMarks(frontiers, [].concat(...list.map((c) => c.slice(0, 3))),
               list.map((c) => Math.min(11, 3.5 + 0.3 * Math.sqrt(c[3]))), tints);
      view.scores = list.length ? { range, unknown } : null;
      clusterPlaces = list.map((c) => new THREE.Vector3(...c.slice(0, 3)));
    }
    const found = entryAt(run.objects, t);
    if (found !== shownObjects) {
      shownObjects = found;
      const list = found ? found[1] : [];
      setMarks(objects, [].concat(...list.map((o) => o.slice(0, 3))), list.map(() => 11));
    }
    const drawings = /^(home|land|done)$/.test(phaseAt(run, t)) ? null : entryAt(run.drawings, t);
    if (drawings !== shownDrawings) {
      shownDrawings = drawings;
      layer.drawings.children.forEach((g) => g.children.forEach((c) => { c.geometry.dispose(); c.material.dispose(); }));
      layer.drawings.remove(...layer.drawings.children);
      const made = makeDrawings(drawings ? drawings[1] : []);
      layer.drawings.add(made.group);
      drawingLabels = made.labels;
    }
    view.avoid = [...clusterPlaces, ...track ? pathPlaces(track, view.now) : [], ...plan ? plan[1].map((p) => new THREE.Vector3(...p.slice(0, 3))) : []];
    view.labels = [];
    if (track) view.labels.push({ position: new THREE.Vector3(...track.xyz.slice(0, 3)), text: "start" });
    if (goal.visible && layer.goal.visible)
      view.labels.push({ position: goal.position, text: goalText(run, active), beside: true });
    if (layer.objects.visible && shownObjects)
      for (const o of shownObjects[1]) view.labels.push({ position: new THREE.Vector3(...o.slice(0, 3)), text: o[3] });
    if (layer.drawings.visible) view.labels.push(...drawingLabels);
  };
  return view;
}
