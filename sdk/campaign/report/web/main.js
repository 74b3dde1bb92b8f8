startTheme();
const asked = new URLSearchParams(location.hash.slice(1));  // report.html#theme=dark&cave=0&seed=3&a=0&b=2&t=63.5&view=top
if (asked.get("theme")) setTheme(asked.get("theme") === "dark");
showHeader();
showVerdict();
startCurves();
const withPairs = startPairs();
function showStudy() {
  const m = choice("metric"), { meaning, better } = data.metrics[m];
  element("metric-meaning").textContent = meaning + (better === "neither" ? "" : `; ${better} is better`);
  showByCave(m);
  if (withPairs) showPairs(m);
  showSpread(m);
}
fillChoices("metric", data.metrics.map((_, m) => metricLabel(m)), Math.max(0, asked.has("metric") ? metricNames.indexOf(asked.get("metric")) : data.verdicts.metric));
fillLegend("figure-legend", contestantNames, false);
whenChosen(["metric"], showStudy);
if (withPairs) whenChosen(["pair-a", "pair-b"], () => showPairs(choice("metric")));
showStudy();
showWorst();
startTrials();
showMethod();
let beforePrint = false;  // paper is white
window.addEventListener("beforeprint", () => { beforePrint = isDark(); setTheme(false); });
window.addEventListener("afterprint", () => setTheme(beforePrint));
startReplay(asked).finally(() => { document.documentElement.dataset.ready = "yes"; });
