// The map's cells as points, drawn by a shader that knows each cell's time, so that moving in time costs nothing.
const cloudVertexShader = `
  attribute float from, until;
  attribute vec3 facing;
  uniform float now, clip, size, pixels, low, high, last, mode;
  uniform bool inside;
  uniform sampler2D ramp;
  uniform vec3 background;
  uniform float nearFog, farFog;
  varying vec3 colour;
  void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    vec3 towards = normalize(cameraPosition - world.xyz);
    float turned = dot(facing, towards);
    bool there = from <= now && now < until && world.z <= clip && !(inside && turned < -0.05);
    vec4 eye = viewMatrix * world;
    gl_Position = there ? projectionMatrix * eye : vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = max(1.6, size * pixels / max(0.1, -eye.z));
    float along = mode < 0.5 ? (world.z - low) / (high - low) : from / last;
    vec3 base = mode > 1.5 ? vec3(0.62, 0.64, 0.66) : texture2D(ramp, vec2(clamp(along, 0.01, 0.99), 0.5)).rgb;
    float light = 0.42 + 0.46 * abs(turned) + 0.22 * abs(dot(facing, normalize(vec3(0.35, 0.25, 0.9))));
    float haze = 0.55 * smoothstep(nearFog, farFog, -eye.z);
    colour = mix(base * light, background, haze);
  }`;
const cloudFragmentShader = `
  uniform float opacity;
  varying vec3 colour;
  void main() { gl_FragColor = vec4(colour, opacity); }`;

function rampTexture() {
  const canvas = make("canvas", { width: 256, height: 1 });
  const context = canvas.getContext("2d");
  const gradient = context.createLinearGradient(0, 0, 256, 0);
  ramp.forEach((c, i) => gradient.addColorStop(i / (ramp.length - 1), c));
  context.fillStyle = gradient;
  context.fillRect(0, 0, 256, 1);
  const texture = new THREE.CanvasTexture(canvas);
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  return texture;
}

/** Value at a share of the sorted samples. */
function quantile(sorted, share) { return sorted[Math.round(share * (sorted.length - 1))]; }

/** The arrays of a cloud that carries them as base64 (docs/report.md). */
function decodeCloud(c) {
  return c && { ...c, cells: decode(c.cells, Int16Array), from: decode(c.from, Uint16Array),
                until: decode(c.until, Uint16Array), normals: decode(c.normals, Int8Array) };
}

/** { object, low, high, sample, setTime(t), uniforms } or null without a map. `sample`: some points, world frame. */
function makeCloud(c) {
  if (!c) return null;
  const cells = c.cells;
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(cells, 3));
  geometry.setAttribute("from", new THREE.BufferAttribute(c.from, 1));
  geometry.setAttribute("until", new THREE.BufferAttribute(c.until, 1));
  geometry.setAttribute("facing", new THREE.BufferAttribute(c.normals, 3, true));

  const sample = [], heights = [];
  const stride = Math.max(1, Math.floor(c.count / 4000));
  for (let i = 0; i < c.count; i += stride)
    sample.push(new THREE.Vector3(...c.origin.map((o, a) => o + c.cell_m * cells[3 * i + a])));
  for (const p of sample) heights.push(p.z);
  heights.sort((a, b) => a - b);
  let low = quantile(heights, 0.01), high = quantile(heights, 0.99);
  if (high - low < 1) { low -= 0.5; high += 0.5; }
  const top = heights[heights.length - 1] + c.cell_m;

  const uniforms = {
    now: { value: 65534 }, clip: { value: top }, size: { value: 1.2 }, pixels: { value: 1 }, low: { value: low },
    high: { value: high }, last: { value: 65534 }, mode: { value: 0 }, inside: { value: true },
    ramp: { value: rampTexture() }, background: { value: new THREE.Color() }, nearFog: { value: 0 },
    farFog: { value: 1 }, opacity: { value: 1 },
  };
  const material = new THREE.ShaderMaterial({
    uniforms, vertexShader: cloudVertexShader, fragmentShader: cloudFragmentShader });
  const object = new THREE.Points(geometry, material);
  object.scale.setScalar(c.cell_m);
  object.position.set(...c.origin);
  object.frustumCulled = false;
  return {
    object, low, high, top, bottom: heights[0], sample, uniforms, cell_m: c.cell_m,
    setTime(t) { uniforms.now.value = Math.min(65534, t / c.tick_s); },
    setOpacity(v) {
      uniforms.opacity.value = v;
      material.transparent = v < 0.999;
      material.depthWrite = v >= 0.999;
      material.needsUpdate = true;
    },
  };
}
