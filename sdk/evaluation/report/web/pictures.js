// The colour camera's pictures: the one of the moment, those around it, and a click on the flown path.

/** `stage` may lack a camera (no 3D): then there is nothing to click on. */
function startPictures(stage) {
  const shown = data.pictures ? data.pictures.shown : [];
  element("pictures").hidden = shown.length === 0;
  if (shown.length === 0) return;
  const source = (p) => "data:image/jpeg;base64," + p.jpeg;
  element("picture-count").textContent = shown.length < data.pictures.taken
    ? `${shown.length} of ${data.pictures.taken}` : String(shown.length);
  const image = make("img", { alt: "what the camera saw" }), link = make("a", { target: "_blank" }, image);
  const caption = make("figcaption", { className: "quiet" });
  element("picture").append(link, caption);
  const strip = element("picture-strip"), small = [];
  for (const p of shown) {
    const button = make("button", { type: "button", title: clockText(p.t) },
                        make("img", { src: source(p), alt: "", loading: "lazy" }));
    button.addEventListener("click", () => setMoment(p.t));
    small.push(button);
    strip.append(button);
  }
  let current = -1;
  moment.listeners.push((t) => {
    const i = Math.max(0, lastAt(shown.length, (k) => shown[k].t, t + 1e-6));
    if (i === current) return;
    if (current >= 0) small[current].classList.remove("on");
    current = i;
    const p = shown[i];
    image.src = source(p);
    link.href = p.file;
    caption.textContent = `${clockText(p.t)} · from ${placeText(p.position)} · ${p.file}`;
    small[i].classList.add("on");
    strip.scrollLeft = small[i].offsetLeft - strip.offsetLeft - (strip.clientWidth - small[i].clientWidth) / 2;
  });
  if (stage.camera) pickOnPath(stage, shown);
}

/** A click (no drag) near where a picture was taken goes to it. */
function pickOnPath(stage, shown) {
  const view = element("view"), kNear = 14;
  let down = null;
  view.addEventListener("pointerdown", (e) => { down = [e.clientX, e.clientY]; }, true);
  view.addEventListener("pointerup", (e) => {
    if (!down || e.target.tagName !== "CANVAS" || Math.hypot(e.clientX - down[0], e.clientY - down[1]) > 4) return;
    const box = e.target.getBoundingClientRect();
    let best = null, least = kNear;
    for (const p of shown) {
      const at = new THREE.Vector3(...p.position).project(stage.camera);
      if (at.z > 1) continue;
      const x = box.left + (at.x + 1) / 2 * box.width, y = box.top + (1 - at.y) / 2 * box.height;
      const d = Math.hypot(x - e.clientX, y - e.clientY);
      if (d < least) [best, least] = [p, d];
    }
    if (best) setMoment(best.t);
  }, true);
}
