// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Shows every crossing along a ray beside the cursor: a table, and a diagram of the solids along it, beside the reference's result.
import { tell } from "./dialog.js";
import { texts } from "./texts.js";

const $ = (id) => document.getElementById(id);
const svg = (name, attributes) => {
  const out = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) out.setAttribute(key, value);
  return out;
};
const cell = (name, text) => Object.assign(document.createElement(name), { textContent: text });

// Returns the intervals inside solids: a crossing that leaves ends the last one that entered the same solid.
function stretches(crossings) {
  const out = [];
  for (const c of crossings) {
    const key = `${c.object_id} ${c.primitive} ${c.instance}`;
    const open = out.findLast((s) => s.key === key && s.to === null);
    if (c.entering) out.push({ key, name: String(c.object), from: c.t, to: null });
    else if (open) open.to = c.t;
    else out.push({ key, name: String(c.object), from: 0, to: c.t });
  }
  return out;
}

function diagram(node, crossings) {
  node.replaceChildren();
  const rows = stretches(crossings).slice(0, 60), height = 16, last = crossings.at(-1)?.t ?? 1, within = rows.some((row) => row.from === 0);
  const near = within ? 0 : (crossings[0]?.t ?? 0) - 0.02 * (last - (crossings[0]?.t ?? 0)), width = last - near || 1;
  node.setAttribute("height", rows.length * height + 4);
  node.setAttribute("aria-label", texts.intervals(crossings.length));
  const place = (t) => `${2 + 96 * (t - near) / width}%`, colors = ["#e8743b", "#3b8ee8", "#5aa83c", "#b358c9", "#c9a227", "#2aa198"];
  rows.forEach((row, i) => {
    const y = i * height + 2, end = row.to ?? last;
    node.append(svg("rect", { x: place(row.from), y, width: `${Math.max(0.4, 96 * (end - row.from) / width)}%`, height: height - 4, rx: 3, fill: colors[i % colors.length] }));
    const late = row.from - near > 0.7 * width;
    const label = svg("text", { x: place(row.from), dx: late ? -3 : 3, y: y + height - 6, "font-size": 10, "text-anchor": late ? "end" : "start", fill: "currentColor" });
    label.textContent = row.name;
    node.append(label);
  });
}

export class Inspector {
  /// `shown` receives the ray that is shown, with where it is inside solids; null: none.
  constructor(shown) {
    this.shown = shown;
    this.box = $("inspector");
    this.is_placed = false;  // somebody has dragged it to its place
    $("table").setAttribute("aria-label", texts.crossings_table);
    $("close-ray").onclick = () => this.close();
    $("copy-ray").onclick = () => {
      navigator.clipboard?.writeText(JSON.stringify(this.told, null, 1)).then(() => tell(texts.copied), (error) => tell(String(error)));
    };
    const head = this.box.querySelector(".head");
    head.addEventListener("pointerdown", (start) => {
      if (start.target.closest("button")) return;
      head.setPointerCapture(start.pointerId);
      const { left, top } = this.box.getBoundingClientRect();
      const go = (move) => { this.is_placed = true; this.put(left + move.clientX - start.clientX, top + move.clientY - start.clientY); };
      head.addEventListener("pointermove", go);
      head.addEventListener("pointerup", () => head.removeEventListener("pointermove", go), { once: true });
    });
  }
  get is_open() { return !this.box.hidden; }
  put(x, y) {
    const { width, height } = this.box.getBoundingClientRect();
    this.box.style.left = `${Math.max(8, Math.min(window.innerWidth - width - 8, x))}px`;
    this.box.style.top = `${Math.max(8, Math.min(window.innerHeight - height - 8, y))}px`;
  }
  close() {
    this.box.hidden = true;
    this.is_placed = false;
    this.shown(null);
  }
  /// Shows an answer of the program near a point of the window.
  show(told, x, y) {
    this.told = told;
    const { crossings } = told, reference = told.reference ?? [], t = texts.crossings;
    $("asked").textContent = `${texts.intervals(crossings.length)}; (${told.ray.origin.map((v) => v.toPrecision(5)).join(", ")}) → (${told.ray.direction.map((v) => v.toFixed(4)).join(", ")})`;
    diagram($("intervals"), crossings);
    const table = document.createElement("table"), head = table.createTHead().insertRow(), body = table.createTBody();
    for (const name of Object.values(t)) head.append(Object.assign(cell("th", name), { scope: "col" }));
    for (let i = 0; i < Math.max(crossings.length, reference.length); ++i) {
      const row = body.insertRow(), c = crossings[i], w = reference[i];
      for (const text of c ? [c.t.toPrecision(7), c.entering ? texts.entering : texts.leaving, c.object, c.surface, c.material] : ["", "", "", "", ""]) row.append(cell("td", text));
      row.append(cell("td", w ? `${w.t.toPrecision(9)}${c && (w.object_id !== c.object_id || w.entering !== c.entering) ? ` ${w.object} ${w.entering ? texts.entering : texts.leaving}` : ""}` : texts.nothing));
    }
    $("table").replaceChildren(table);
    $("table").dataset.pixel = told.pixel.join();
    this.box.hidden = false;
    const { width } = this.box.getBoundingClientRect();
    if (!this.is_placed) this.put(x + width + 40 > window.innerWidth ? x - width - 24 : x + 24, y - 24);
    this.shown({ origin: told.ray.origin, direction: told.ray.direction, crossings, inside: stretches(crossings).map((s) => [s.from, s.to]) });
  }
}
