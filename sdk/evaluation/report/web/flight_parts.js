// What a flight is drawn with: lines of constant width, marks, icons, and tracks.

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

/** Round marks with sizes in pixels, of one colour where setMarks() names no others. */
function roundMarks(colour) {
  const material = new THREE.ShaderMaterial({
    uniforms: { ratio: { value: window.devicePixelRatio } },
    transparent: true, depthTest: false,
    vertexShader: `attribute float size; attribute vec3 tint; uniform float ratio; varying vec3 colour;
      void main() { colour = tint; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
                    gl_PointSize = size * ratio; }`,
    fragmentShader: `varying vec3 colour;
      void main() { float r = length(gl_PointCoord - 0.5); if (r > 0.5) discard;
                    gl_FragColor = vec4(r > 0.4 ? colour * 0.45 : colour, 0.85); }` });
  const points = new THREE.Points(new THREE.BufferGeometry(), material);
  points.frustumCulled = false;
  points.userData.tint = new THREE.Color(colour).toArray();
  return points;
}
function setMarks(points, xyz, sizes, tints = sizes.map(() => points.userData.tint)) {
  points.geometry.dispose();
  points.geometry = new THREE.BufferGeometry();
  points.geometry.setAttribute("position", new THREE.Float32BufferAttribute(xyz, 3));
  points.geometry.setAttribute("size", new THREE.Float32BufferAttribute(sizes, 1));
  points.geometry.setAttribute("tint", new THREE.Float32BufferAttribute(tints.flat(), 3));
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
function vehicleArrow(fill = 0xffffff) {
  const group = new THREE.Group();
  for (const [scale, colour, order] of [[1.35, 0x111111, 20], [1, new THREE.Color(fill), 21]]) {
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
/** Places along the path to where the vehicle is now: at most 200, the last one included. */
function pathPlaces(track, now) {
  const step = Math.max(1, Math.ceil(now.index / 199)), places = [];
  for (let i = 0; i < now.index; i += step) places.push(new THREE.Vector3(track.xyz[3 * i], track.xyz[3 * i + 1], track.xyz[3 * i + 2]));
  return [...places, now.position];
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
