// What a phone's narrow window folds up.
const narrowWindow = window.matchMedia("(max-width: 600px)");

/** Closes a <details> where the window is narrow and opens it where it is wide; its user may do otherwise. */
function foldWhereNarrow(details) {
  const fold = () => { details.open = !narrowWindow.matches; };
  fold();
  narrowWindow.addEventListener("change", fold);
}
