// One 3D window: camera, cells, flight, grid and labels.

/** Some of the points a cloud and a flight take up: what a frame must hold. */
function samplePoints(cloud, flight) {
  const points = cloud ? cloud.sample.slice() : [];
  if (flight.track)
    for (let i = 0; i < flight.track.count; i += 20)
      points.push(new THREE.Vector3(...flight.track.xyz.slice(3 * i, 3 * i + 3)));
  return points;
}

/** By how many degrees an arrow that points up turns, clockwise, to point north (+y) for this camera. */
function northTurn(camera, target) {
  const ahead = target.clone().sub(camera.position);
  return Math.round(THREE.Math.radToDeg(Math.atan2(-ahead.x, ahead.y))) + 0;  // no -0
}

/** A window in `box`, of which the left `beside()` pixels lie under controls; null where the browser has no WebGL.
 *  `changed(stage)` hears of every turn of the camera, `viewed(name)` of every view taken. The
 *  north arrow in `box` turns with the camera. */
function makeStage(box, labels, beside, { changed = () => {}, viewed = () => {} } = {}) {
  const renderer = makeRenderer(box);
  if (!renderer) return null;
  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(45, 1, 0.1, 5000);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.screenSpacePanning = true;
  let cloud = null, flight = null, grid = null, points = [], directions = {};
  let size = [1, 1], frame = 0, follow = false, touched = false, view = "oblique";

  const draw = () => {
    frame = 0;
    if (!flight) return;
    const distance = camera.position.distanceTo(controls.target);
    camera.near = Math.max(0.05, distance / 500);
    camera.far = distance * 6 + 2000;
    camera.updateProjectionMatrix();
    for (const vehicle of flight.vehicles)
      vehicle.scale.setScalar(Math.max(0.35, camera.position.distanceTo(vehicle.position) * 0.016));
    if (cloud) {
      cloud.uniforms.nearFog.value = distance * 0.8;
      cloud.uniforms.farFog.value = distance * 3.2;
    }
    renderer.render(scene, camera);
    placeLabels(labels, flight.labels, camera, ...size, flight.avoid);
  };
  const needle = box.querySelector(".north g");
  const redraw = () => {
    needle.setAttribute("transform", `rotate(${northTurn(camera, controls.target)})`);
    if (!frame) frame = requestAnimationFrame(draw);
  };

  const setView = (name) => {
    if (name !== "follow" && !directions[name]) return;
    view = name;
    touched = false;
    follow = name === "follow";
    const pose = flight.now;
    if (follow) {
      controls.target.copy(pose.position);
      camera.position.copy(pose.position)
        .add(new THREE.Vector3(-11 * Math.cos(pose.heading), -11 * Math.sin(pose.heading), 6));
    } else {
      const { target, distance } = frameFor(points, directions[name], camera.up, camera, 1 - beside() / size[0]);
      controls.target.copy(target);
      camera.position.copy(target).addScaledVector(directions[name], distance);
    }
    controls.update();
    viewed(name);
    redraw();
  };

  const resize = () => {
    size = [Math.max(1, box.clientWidth), Math.max(1, box.clientHeight)];
    renderer.setSize(...size);
    camera.setViewOffset(...size, -beside() / 2, 0, ...size);  // the middle of what the controls leave free
    camera.aspect = size[0] / size[1];
    camera.updateProjectionMatrix();
    if (!flight) return;
    flight.setResolution(...size);
    if (cloud) {
      const pixelsPerMetre = size[1] * window.devicePixelRatio / (2 * Math.tan(THREE.Math.degToRad(camera.fov / 2)));
      cloud.uniforms.pixels.value = pixelsPerMetre * cloud.cell_m;
    }
    if (!touched && !follow) setView(view);  // the frame depends on the window's shape
    draw();  // at once: setting the size has emptied the canvas
  };
  const recolour = () => {
    const background = new THREE.Color(cssColour("--stage"));
    scene.background = background;
    if (cloud) cloud.uniforms.background.value = background;
    redraw();
  };
  themeListeners.push(recolour);
  const stage = { camera, controls, redraw, setView };
  controls.addEventListener("change", () => { redraw(); changed(stage); });
  controls.addEventListener("start", () => { touched = true; });
  new ResizeObserver(resize).observe(box);

  /** Takes what there was away and shows these; the frame holds `points`. Gives { grid, step }. */
  stage.show = (newCloud, newFlight, newPoints) => {
    for (const object of [cloud && cloud.object, flight && flight.object, grid]) {
      if (!object) continue;
      scene.remove(object);
      object.traverse((o) => { if (o.geometry) o.geometry.dispose(); if (o.material) o.material.dispose(); });
    }
    [cloud, flight, points] = [newCloud, newFlight, newPoints];
    if (cloud) scene.add(cloud.object);
    scene.add(flight.object);
    const made = makeGrid(points, Math.min(...points.map((p) => p.z)) - 0.5);
    grid = made.grid;
    scene.add(grid);
    const across = broadside(points);
    directions = {
      oblique: across.clone().multiplyScalar(0.75).setZ(0.66).normalize(),
      top: new THREE.Vector3(0, -0.002, 1).normalize(),  // north up
      side: across.clone().setZ(0.02).normalize(),
    };
    recolour();
    resize();
    return made;
  };
  stage.setTime = (t) => {
    if (!flight) return;
    const before = flight.now.position.clone();
    if (cloud) cloud.setTime(t);
    flight.setTime(t);
    if (follow) {
      const moved = flight.now.position.clone().sub(before);
      controls.target.add(moved);
      camera.position.add(moved);
      controls.update();
    }
    redraw();
  };
  return stage;
}
