// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Shows every crossing along a ray: a table, and a diagram of the solids along it, beside the reference's result.
import { texts } from "./texts.js";

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

export function inspect(told, line, node, place) {
  const { crossings } = told, reference = told.reference ?? [], t = texts.crossings;
  line.textContent = `${texts.intervals(crossings.length)}; (${told.ray.origin.map((v) => v.toPrecision(5)).join(", ")}) → (${told.ray.direction.map((v) => v.toFixed(4)).join(", ")})`;
  diagram(node, crossings);
  const table = document.createElement("table"), head = table.createTHead().insertRow(), body = table.createTBody();
  for (const name of Object.values(t)) head.append(Object.assign(cell("th", name), { scope: "col" }));
  for (let i = 0; i < Math.max(crossings.length, reference.length); ++i) {
    const row = body.insertRow(), c = crossings[i], w = reference[i];
    for (const text of c ? [c.t.toPrecision(7), c.entering ? texts.entering : texts.leaving, c.object, c.surface, c.material] : ["", "", "", "", ""]) row.append(cell("td", text));
    row.append(cell("td", w ? `${w.t.toPrecision(9)}${c && (w.object_id !== c.object_id || w.entering !== c.entering) ? ` ${w.object} ${w.entering ? texts.entering : texts.leaving}` : ""}` : texts.nothing));
  }
  place.replaceChildren(table);
}
