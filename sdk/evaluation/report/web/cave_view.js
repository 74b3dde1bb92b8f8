// The 3D view of the run, and the controls over it.

/** { setTime(t), setView(name) }; shows what there is, and says so where there is nothing. */
function startCaveView(flight) {
  const empty = element("view-empty");
  foldWhereNarrow(element("view-panel"));
  const refuse = (text) => {
    empty.textContent = text;
    empty.hidden = false;
    for (const id of ["view-panel", "scales", "north"]) element(id).style.display = "none";
    return { setTime() {}, setView() {} };
  };
  if (!data.cloud && !flight.track) return refuse("This run recorded neither a map nor a trajectory.");
  const buttons = document.querySelectorAll("[data-view]");
  const stage = makeStage(element("view"), element("labels"), () => narrowWindow.matches ? 0 : element("view-panel").offsetWidth + 10, {
    viewed: (name) => { for (const b of buttons) b.classList.toggle("on", b.dataset.view === name); },
  });
  if (!stage) return refuse("This browser cannot draw in 3D (no WebGL). Plots and tables are below.");
  const cloud = makeCloud(decodeCloud(data.cloud));
  const { grid, step } = stage.show(cloud, flight, samplePoints(cloud, flight));
  for (const b of buttons) b.addEventListener("click", () => stage.setView(b.dataset.view));
  connectControls(cloud, flight, grid, step, stage.redraw);
  return { ...stage, setTime(t) { stage.setTime(t); showScoreScale(flight.scores || null); } };
}
