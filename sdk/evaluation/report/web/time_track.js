// Bands of the phases and ticks of the decisions above and below the time slider.
const shareOfTime = (t) => 100 * Math.min(1, Math.max(0, t / data.duration_s));

function drawPhases(box, phases) {
  for (const [name, begin, end] of phases) {
    const band = make("span", { textContent: name, title: `${name} ${clockText(begin)} to ${clockText(end)}` });
    const width = shareOfTime(end) - shareOfTime(begin);
    band.style.left = shareOfTime(begin) + "%";
    band.style.width = width + "%";
    band.style.background = phaseColour(name);
    band.style.color = "#101418";
    if (width < 3.5) band.textContent = "";
    box.append(band);
  }
}

function drawTicks() {
  for (const e of data.events) {
    const bad = isTrouble(e);
    if (e.kind !== "decision" && !bad) continue;
    const tick = make("i", { className: bad ? "bad" : "", title: clockText(e.t) + " " + eventText(e) });
    tick.style.left = shareOfTime(e.t) + "%";
    element("ticks").append(tick);
  }
}
