// Where the camera stands to show a cave, the grid below it, and labels over it.

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
