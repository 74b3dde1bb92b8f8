startTheme();
startTables();
startTimeline();
startMomentPanel();
startPlots();
const caveView = startCaveView();
moment.listeners.push((t) => caveView.setTime(t));
setMoment(data.duration_s);
document.documentElement.dataset.ready = "yes";
