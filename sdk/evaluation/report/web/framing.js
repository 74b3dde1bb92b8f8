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

/** Corners of a label of w x h about a point of the window: close to it, or `beside` it at the end of a line. */
function labelCorners(x, y, w, h, beside) {
  if (!beside)
    return [[x + 14, y - h / 2], [x + 14, y - 1.6 * h], [x + 14, y + 0.6 * h], [x - 14 - w, y - h / 2], [x - w / 2, y - 14 - h],
            [x - w / 2, y + 14], [x - 14 - w, y - 1.6 * h], [x - 14 - w, y + 0.6 * h]];
  const corners = [];
  for (const [dx, dy] of [[30, 30], [70, 60], [110, 100]])
    for (const [right, below] of [[1, 0], [1, 1], [0, 0], [0, 1]])
      corners.push([right ? x + dx : x - dx - w, below ? y + dy : y - dy - h]);
  return corners;
}

/** A thin line from a point of the window to a label's nearest edge. */
function labelLine(x, y, r) {
  const toX = Math.min(Math.max(x, r.x), r.x + r.w), toY = Math.min(Math.max(y, r.y), r.y + r.h), line = make("i");
  Object.assign(line.style, { left: x + "px", top: y + "px", width: Math.hypot(toX - x, toY - y) + "px",
                              transform: `rotate(${Math.atan2(toY - y, toX - x)}rad)` });
  return line;
}

/** Puts labels where their positions appear: { position, text, beside }. Each goes to the place about its position that
 *  overlaps no earlier label; one `beside` it hides the fewest points of `avoid`. Without such a place it is left out. */
function placeLabels(box, labels, camera, width, height, avoid = []) {
  box.textContent = "";
  const taken = [], inWindow = (place) => {
    const p = place.clone().project(camera);
    return p.z > 1 || Math.abs(p.x) > 1 || Math.abs(p.y) > 1 ? null : [(p.x + 1) / 2 * width, (1 - p.y) / 2 * height];
  };
  const points = labels.some((l) => l.beside) ? avoid.map(inWindow).filter(Boolean) : [];
  const hidden = (r) => points.filter(([x, y]) => x > r.x - 6 && x < r.x + r.w + 6 && y > r.y - 6 && y < r.y + r.h + 6).length;
  for (const { position, text, beside } of labels) {
    const p = inWindow(position);
    if (!p) continue;
    const label = make("span", { textContent: text, title: text });
    box.append(label);
    const w = label.offsetWidth, h = label.offsetHeight;
    const free = labelCorners(...p, w, h, beside)
      .map(([x, y]) => ({ x: Math.min(x, width - w - 4), y, w, h }))
      .filter((r) => r.x >= 0 && !taken.some((o) => r.x < o.x + o.w && o.x < r.x + r.w && r.y < o.y + o.h && o.y < r.y + r.h));
    const place = beside ? free.filter((r) => r.y >= 0 && r.y + h <= height).sort((a, b) => hidden(a) - hidden(b))[0] : free[0];
    if (!place) { label.remove(); continue; }
    taken.push(place);
    label.style.left = place.x + "px";
    label.style.top = place.y + "px";
    if (beside) box.append(labelLine(...p, place));
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
