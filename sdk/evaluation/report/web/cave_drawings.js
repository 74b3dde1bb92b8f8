// The cave as cavers draw it: the pages that `karst draw` writes.

/** Several drawings stand in one document: their ids, and what refers to them, get a prefix. */
function prefixIds(svg, prefix) {
  const ids = new Set([...svg.querySelectorAll("[id]")].map((e) => e.id));
  if (ids.size === 0) return;
  const renamed = (text) => text.replace(/#([\w-]+)/g, (all, id) => ids.has(id) ? "#" + prefix + id : all);
  for (const e of svg.querySelectorAll("*")) {
    for (const a of [...e.attributes]) if (a.value.includes("#")) e.setAttribute(a.name, renamed(a.value));
    if (e.id) e.id = prefix + e.id;
  }
}

function showCaveDrawings() {
  const { pages = [], note = "" } = data.cave_drawings || {};
  element("cave-drawings").hidden = pages.length === 0 && note === "";
  element("cave-drawings-how").hidden = pages.length === 0;
  element("cave-drawings-note").textContent = note;
  pages.forEach((p, i) => {
    const holder = make("div");
    holder.innerHTML = p.svg;
    const svg = holder.querySelector("svg");
    if (!svg) return;
    prefixIds(svg, `drawing${i + 1}-`);
    const paper = svg.viewBox.baseVal;
    const figure = make("figure", { className: paper.width > paper.height ? "wide" : "upright" },
                        make("figcaption", { className: "quiet", textContent: p.title }), svg);
    element("cave-drawings-pages").append(figure);
  });
}
