startTheme();
showHeader();
startTables();
setTimeRange(data.begin_s, data.duration_s);
drawPhases(element("phases"), data.phases);
drawTicks();
startTimeline();
startMomentPanel();
startCharts(addRunPlots);
startErrors();
showCaveDrawings();
const caveView = startCaveView(makeFlight(data));
moment.listeners.push((t) => caveView.setTime(t));
startPictures(caveView);
const asked = new URLSearchParams(location.hash.slice(1));  // report.html#t=63.5&view=top&theme=dark
if (asked.get("theme")) setTheme(asked.get("theme") === "dark");
setMoment(asked.has("t") ? Number(asked.get("t")) || 0 : data.duration_s);
if (asked.get("view")) caveView.setView(asked.get("view"));
document.documentElement.dataset.ready = "yes";
