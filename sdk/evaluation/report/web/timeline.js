// The time slider: one moment for the whole page.
const moment = { t: 0, begin: 0, end: 1, listeners: [] };
function setMoment(t) {
  moment.t = Math.min(moment.end, Math.max(0, t));
  for (const listener of moment.listeners) listener(moment.t);
}
/** The slider's range, and where playing from the end begins again. */
function setTimeRange(begin, end) {
  Object.assign(moment, { begin, end });
  element("time").max = end;
}

function startTimeline() {
  const slider = element("time"), play = element("play"), clock = element("clock");
  moment.listeners.push((t) => {
    slider.value = t;
    clock.textContent = clockText(t) + " / " + clockText(moment.end);
    slider.setAttribute("aria-valuetext", clock.textContent);
  });
  let last = null;
  const show = () => { play.textContent = last === null ? "▶" : "❚❚"; };
  const tick = (now) => {
    if (last === null) return;
    setMoment(moment.t + (now - last) / 1000 * Number(element("rate").value));
    last = moment.t >= moment.end ? null : now;
    if (last === null) show(); else requestAnimationFrame(tick);
  };
  const toggle = () => {
    if (last !== null) { last = null; show(); return; }
    if (moment.t >= moment.end) setMoment(moment.begin);
    last = performance.now();
    show();
    requestAnimationFrame(tick);
  };
  play.addEventListener("click", toggle);
  slider.addEventListener("input", () => setMoment(Number(slider.value)));
  document.addEventListener("keydown", (e) => {
    if (e.code !== "Space" || /^(INPUT|SELECT|BUTTON|SUMMARY)$/.test(document.activeElement.tagName)) return;
    e.preventDefault();
    toggle();
  });
}
