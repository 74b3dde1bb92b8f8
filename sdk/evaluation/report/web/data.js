// The run's data, and small functions to read it.
const data = JSON.parse(document.getElementById("data").textContent);
/** A replay has a recording's scans, and no policy, goals or battery. */
const isReplay = typeof data.metrics?.recording === "string";
const element = (id) => document.getElementById(id);

/** A typed array from base64 of little-endian numbers. */
function decode(text, Type) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return new Type(bytes.buffer);
}

/** Index of the last entry whose time is at or before t, or -1; `time` gives an index's time. */
function lastAt(count, time, t) {
  let low = 0, high = count;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (time(middle) <= t) low = middle + 1; else high = middle;
  }
  return low - 1;
}
/** The last [t, ...] of a list at or before t, or null. */
function entryAt(list, t) {
  const i = list ? lastAt(list.length, (k) => list[k][0], t) : -1;
  return i < 0 ? null : list[i];
}

/** Whole seconds, halves to the even one: as the sentences of a flight round them. */
function wholeSeconds(t) {
  const s = Math.round(t);
  return Math.max(0, s - t === 0.5 && s % 2 !== 0 ? s - 1 : s);
}
function clockText(t) {
  const s = wholeSeconds(t);
  const two = (v) => String(v).padStart(2, "0");
  const h = Math.floor(s / 3600);
  return (h ? h + ":" + two(Math.floor(s / 60) % 60) : Math.floor(s / 60)) + ":" + two(s % 60);
}
/** A duration as [text, unit]: ["5", "s"], ["2:57", "min"], ["1:02:57", "h"]. */
function durationParts(t) {
  const s = wholeSeconds(t);
  return s < 60 ? [String(s), "s"] : [clockText(s), s < 3600 ? "min" : "h"];
}
/** A metric's unit for people: "m³" for "m^3". */
function unitText(unit) { return (unit || "").replace("^3", "³"); }
/** A sentence whose numbers stay in a line with their units. */
function tied(text) { return text.replace(/(\d) (?=(?:%|m³|m\/s|m|s|min|h|kB|Wh|points)(?![\w³]))/g, "$1\u00a0"); }
/** A number for people: three or four significant digits, thin groups; an en dash for what is not known. */
function numberText(v, digits = 3) {
  if (typeof v !== "number" || !isFinite(v)) return "–";
  const whole = Math.max(0, digits - 1 - Math.floor(Math.log10(Math.max(Math.abs(v), 1e-12))));
  const text = v.toFixed(Math.abs(v) < 1e-9 ? 0 : Math.min(whole, digits));
  const [integer, fraction] = text.split(".");
  const grouped = integer.length > 4 ? integer.replace(/\B(?=(\d{3})+$)/g, "\u202f") : integer;
  return fraction === undefined ? grouped : grouped + "." + fraction;
}
/** An element with text and children; never markup from the data. */
function make(tag, properties = {}, ...children) {
  const e = Object.assign(document.createElement(tag), properties);
  e.append(...children);
  return e;
}
