// Colours: Okabe and Ito's palette for marks, a cividis-like ramp for height (both safe for the colour-blind).
const colours = {
  explore: "#e8590c", home: "#56b4e9", other: "#8d96a0", plan: "#009e73", frontier: "#e07ab5", goal: "#ffd43b", object: "#d55e00",
  truth: "#b197fc", keepIn: "#66a80f", keepOut: "#e03131", blue: "#0072b2", odometry: "#56b4e9", loop: "#ffd43b",
};
const ramp = ["#2b57a5", "#4b679b", "#66758e", "#7f8384", "#989178", "#b19f68", "#cab055", "#e3c542", "#fde333"];

const themeListeners = [];
function isDark() { return document.documentElement.dataset.theme === "dark"; }
function cssColour(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }

function setTheme(dark) {
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  for (const listener of themeListeners) listener();
}

function startTheme() {
  const preference = window.matchMedia("(prefers-color-scheme: dark)");
  setTheme(preference.matches);
  preference.addEventListener("change", (e) => setTheme(e.matches));
  element("theme").addEventListener("click", () => setTheme(!isDark()));
}

function phaseColour(name) {
  return { look: "#f4a261", explore: colours.explore, replay: colours.explore, home: colours.home }[name] || colours.other;
}
