startTheme();
showTeamHeader();
startTables();
setTimeRange(data.begin_s, data.duration_s);
drawTeamTrack();
startTimeline();
startTeamPanel();
showCaveDrawings();
startCharts(addTeamPlots);
const team = makeTeam();
const caveView = startCaveView(team);
showRobots((robot) => { team.follow(robot); setMoment(moment.t); caveView.setView("follow"); });
moment.listeners.push((t) => caveView.setTime(t));
const asked = new URLSearchParams(location.hash.slice(1));  // report.html#t=63.5&view=top&theme=dark
if (asked.get("theme")) setTheme(asked.get("theme") === "dark");
setMoment(asked.has("t") ? Number(asked.get("t")) || 0 : data.duration_s);
if (asked.get("view")) caveView.setView(asked.get("view"));
document.documentElement.dataset.ready = "yes";
