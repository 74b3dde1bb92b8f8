// The time slider: one moment for the whole page.
const moment = { t: data.duration_s, listeners: [] };
function setMoment(t) {
  moment.t = Math.min(data.duration_s, Math.max(0, t));
  for (const listener of moment.listeners) listener(moment.t);
}

/** Bands of the phases and ticks of the decisions above and below the slider. */
function drawTrack() {
  const share = (t) => 100 * Math.min(1, Math.max(0, t / data.duration_s));
  for (const [name, begin, end] of data.phases) {
    const band = make("span", { textContent: name, title: `${name} ${clockText(begin)} to ${clockText(end)}` });
    band.style.left = share(begin) + "%";
    band.style.width = share(end) - share(begin) + "%";
    band.style.background = phaseColour(name);
    band.style.color = "#101418";
    if (share(end) - share(begin) < 3.5) band.textContent = "";
    element("phases").append(band);
  }
  for (const e of data.events) {
    const bad = isTrouble(e);
    if (e.kind !== "decision" && !bad) continue;
    const tick = make("i", { className: bad ? "bad" : "", title: clockText(e.t) + " " + eventText(e) });
    tick.style.left = share(e.t) + "%";
    element("ticks").append(tick);
  }
}

function startTimeline() {
  const slider = element("time"), play = element("play"), clock = element("clock");
  slider.max = data.duration_s;
  drawTrack();
  moment.listeners.push((t) => {
    slider.value = t;
    clock.textContent = clockText(t) + " / " + clockText(data.duration_s);
  });
  let last = null;
  const show = () => { play.textContent = last === null ? "▶" : "❚❚"; };
  const tick = (now) => {
    if (last === null) return;
    setMoment(moment.t + (now - last) / 1000 * Number(element("rate").value));
    last = moment.t >= data.duration_s ? null : now;
    if (last === null) show(); else requestAnimationFrame(tick);
  };
  const toggle = () => {
    if (last !== null) { last = null; show(); return; }
    if (moment.t >= data.duration_s) setMoment(data.begin_s);
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
