/** A slider that shows its value as `text` and hands it to `apply`, at once and at every move. */
function connectSlider(id, text, apply) {
  const slider = element(id), output = element(id + "-text");
  const change = () => { output.textContent = text(Number(slider.value)); apply(Number(slider.value)); };
  slider.addEventListener("input", change);
  change();
}
