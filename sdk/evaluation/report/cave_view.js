// The 3D view: camera, cells, flight, and the controls over it.

/** The frame that shows all `points` from unit vector `direction` (from target to camera) in the middle `clear`
 *  share of the width: { target, distance }. */
function frameFor(points, direction, up, camera, clear) {
  const right = new THREE.Vector3().crossVectors(up, direction).normalize();
  const above = new THREE.Vector3().crossVectors(direction, right);
  const range = (axis) => {
    let low = Infinity, high = -Infinity;
    for (const p of points) { const v = p.dot(axis); low = Math.min(low, v); high = Math.max(high, v); }
    return (low + high) / 2;
  };
  const target = right.clone().multiplyScalar(range(right)).addScaledVector(above, range(above))
    .addScaledVector(direction, range(direction));
  const tanV = Math.tan(THREE.Math.degToRad(camera.fov / 2)), tanH = tanV * camera.aspect * clear;
  let distance = 5;
  for (const p of points) {
    const d = p.clone().sub(target);
    distance = Math.max(distance, d.dot(direction) + Math.max(Math.abs(d.dot(right)) / tanH, Math.abs(d.dot(above)) / tanV));
  }
  return { target, distance: distance * 1.06 };
}

/** Horizontal direction across the cave's long extent, so that it fills the width of the window. */
function broadside(points) {
  let x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (const p of points) { x += p.x; y += p.y; }
  x /= points.length; y /= points.length;
  for (const p of points) { xx += (p.x - x) ** 2; xy += (p.x - x) * (p.y - y); yy += (p.y - y) ** 2; }
  const along = 0.5 * Math.atan2(2 * xy, xx - yy);
  const across = new THREE.Vector3(Math.sin(along), -Math.cos(along), 0);
  return across.y > 0 ? across.negate() : across;  // from the south where there is a choice
}

function niceStep(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [1, 2, 5, 10].map((f) => f * power).find((s) => s >= length);
}

function makeGrid(points, z) {
  const box = new THREE.Box3().setFromPoints(points);
  const extent = Math.max(box.max.x - box.min.x, box.max.y - box.min.y, 5);
  const step = niceStep(extent / 12), half = Math.ceil(extent * 0.65 / step) * step;
  const centre = new THREE.Vector3().addVectors(box.min, box.max).multiplyScalar(0.5);
  const grid = new THREE.GridHelper(2 * half, Math.round(2 * half / step), 0x888888, 0x888888);
  grid.rotation.x = Math.PI / 2;
  grid.position.set(Math.round(centre.x / step) * step, Math.round(centre.y / step) * step, z);
  grid.material.transparent = true;
  grid.material.opacity = 0.22;
  grid.material.depthWrite = false;
  return { grid, step };
}

/** Puts labels where their positions appear; of those that would overlap, the earlier one stays. */
function placeLabels(box, labels, camera, width, height) {
  box.textContent = "";
  const taken = [];
  for (const { position, text } of labels) {
    const p = position.clone().project(camera);
    if (p.z > 1 || Math.abs(p.x) > 1 || Math.abs(p.y) > 1) continue;
    const label = make("span", { textContent: text, title: text });
    box.append(label);
    const w = label.offsetWidth, h = label.offsetHeight;
    const x = Math.min((p.x + 1) / 2 * width + 14, width - w - 4), y = (1 - p.y) / 2 * height - h / 2;
    const overlaps = taken.some((r) => x < r.x + r.w && r.x < x + w && y < r.y + r.h && r.y < y + h);
    if (overlaps) { label.remove(); continue; }
    taken.push({ x, y, w, h });
    label.style.left = x + "px";
    label.style.top = y + "px";
  }
}

/** Null where the browser has no WebGL. */
function makeRenderer(box) {
  try {
    const renderer = new THREE.WebGLRenderer({ antialias: true });
    renderer.setPixelRatio(window.devicePixelRatio);
    box.prepend(renderer.domElement);
    return renderer;
  } catch (e) {
    return null;
  }
}

/** { setTime(t), setView(name) }; shows what there is, and says so where there is nothing. */
function startCaveView() {
  const box = element("view"), empty = element("view-empty");
  const refuse = (text) => {
    empty.textContent = text;
    empty.hidden = false;
    element("view-controls").hidden = element("scale").hidden = true;
    element("view-controls").style.display = "none";
    return { setTime() {}, setView() {} };
  };
  if (!data.cloud && !data.track) return refuse("This run recorded neither a map nor a trajectory.");
  const renderer = makeRenderer(box);
  if (!renderer) return refuse("This browser cannot draw in 3D (no WebGL). Plots and tables are below.");

  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(45, 1, 0.1, 5000);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.screenSpacePanning = true;
  const cloud = makeCloud(), flight = makeFlight();
  if (cloud) scene.add(cloud.object);
  scene.add(flight.object);
  const points = cloud ? cloud.sample.slice() : [];
  if (flight.track)
    for (let i = 0; i < flight.track.count; i += 20) points.push(new THREE.Vector3(...flight.track.xyz.slice(3 * i, 3 * i + 3)));
  const { grid, step } = makeGrid(points, Math.min(...points.map((p) => p.z)) - 0.5);
  scene.add(grid);
  const across = broadside(points);
  const directions = {
    oblique: across.clone().multiplyScalar(0.75).setZ(0.66).normalize(),
    top: new THREE.Vector3(0, -0.002, 1).normalize(),  // north up
    side: across.clone().setZ(0.02).normalize(),
  };

  const beside = element("view-controls").offsetWidth + 10;
  let size = [1, 1], frame = 0, follow = false, touched = false, view = "oblique";
  const draw = () => {
    frame = 0;
    const distance = camera.position.distanceTo(controls.target);
    camera.near = Math.max(0.05, distance / 500);
    camera.far = distance * 6 + 2000;
    camera.updateProjectionMatrix();
    flight.vehicle.scale.setScalar(Math.max(0.35, camera.position.distanceTo(flight.now.position) * 0.016));
    if (cloud) {
      cloud.uniforms.nearFog.value = distance * 0.8;
      cloud.uniforms.farFog.value = distance * 3.2;
    }
    renderer.render(scene, camera);
    placeLabels(element("labels"), flight.labels, camera, ...size);
  };
  const redraw = () => { if (!frame) frame = requestAnimationFrame(draw); };

  const setView = (name) => {
    view = name;
    touched = false;
    follow = name === "follow";
    const pose = flight.now;
    if (follow) {
      controls.target.copy(pose.position);
      camera.position.copy(pose.position)
        .add(new THREE.Vector3(-11 * Math.cos(pose.heading), -11 * Math.sin(pose.heading), 6));
    } else {
      const { target, distance } = frameFor(points, directions[name], camera.up, camera, 1 - beside / size[0]);
      controls.target.copy(target);
      camera.position.copy(target).addScaledVector(directions[name], distance);
    }
    controls.update();
    for (const b of document.querySelectorAll("[data-view]")) b.classList.toggle("on", b.dataset.view === name);
    redraw();
  };

  const resize = () => {
    size = [box.clientWidth, box.clientHeight];
    renderer.setSize(...size);
    camera.setViewOffset(...size, -beside / 2, 0, ...size);  // the middle of what the controls leave free
    camera.aspect = size[0] / size[1];
    camera.updateProjectionMatrix();
    flight.setResolution(...size);
    if (cloud) {
      cloud.pixelsPerMetre = size[1] * window.devicePixelRatio / (2 * Math.tan(THREE.Math.degToRad(camera.fov / 2)));
      cloud.uniforms.pixels.value = cloud.pixelsPerMetre * data.cloud.cell_m;
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
  controls.addEventListener("change", redraw);
  controls.addEventListener("start", () => { touched = true; });
  new ResizeObserver(resize).observe(box);
  for (const b of document.querySelectorAll("[data-view]")) b.addEventListener("click", () => setView(b.dataset.view));
  connectControls(cloud, flight, grid, step, redraw);
  recolour();
  resize();

  return {
    setView(name) { if (name === "follow" || directions[name]) setView(name); },
    setTime(t) {
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
    },
  };
}
