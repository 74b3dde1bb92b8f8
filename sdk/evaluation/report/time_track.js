// Bands of the phases and ticks of the decisions above and below the time slider.
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
