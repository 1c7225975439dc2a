// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// The rail of tools, and what they leave on the picture: measured distances and angles, labels, and the inspected ray.
import { add, dot, length, mul, sub, unit } from "./camera.js";
import { icon } from "./icons.js";
import { texts } from "./texts.js";

const NS = "http://www.w3.org/2000/svg";
const make = (name, attributes, text) => {
  const out = document.createElementNS(NS, name);
  for (const [key, value] of Object.entries(attributes)) out.setAttribute(key, value);
  if (text) out.textContent = text;
  return out;
};
export const TOOLS = [["select", "V"], ["move", "G"], ["turn", "R"], ["scale", "S"], ["measure", "M"], ["label", "T"], ["inspect", "I"]];

export class Tools {
  /// `changed` is called when another tool is taken.
  constructor(rail, changed) {
    Object.assign(this, { rail, changed, now: "select" });
    rail.setAttribute("aria-label", texts.tools);
    for (const [name, key] of TOOLS) {
      const button = Object.assign(document.createElement("button"), { id: `tool-${name}`, className: "icon", title: `${texts.tool_names[name]} (${key})`, onclick: () => this.take(name) });
      button.setAttribute("aria-label", texts.tool_names[name]);
      button.append(icon(name));
      if (["move", "turn", "scale"].includes(name)) button.classList.add("edits");
      rail.append(button);
    }
    this.take("select");
  }
  take(name) {
    this.now = name;
    for (const [one] of TOOLS) document.getElementById(`tool-${one}`).setAttribute("aria-pressed", String(one === name));
    this.changed(name);
  }
}

const short = (v) => String(+v.toPrecision(4));

export class Notes {
  /// `project` converts a point of the world to pixels of the stage, or to null.
  constructor(stage, project, hint, forget) {
    Object.assign(this, { project, hint, forget, points: [], measures: [], labels: [], ray: null, unit: "" });
    this.stage = stage;
    this.svg = stage.appendChild(make("svg", { id: "notes", "aria-hidden": "true" }));
    forget.onclick = () => { this.measures = []; this.points = []; this.labels = []; this.draw(); };
  }
  /// Asks at a point for its words; none, or Escape, make no label.
  label(point) {
    this.input?.remove();
    const [x, y] = this.project(point) ?? [0, 0];
    const input = this.input = this.stage.appendChild(Object.assign(document.createElement("input"), { id: "label-words", autocomplete: "off", maxLength: 80, placeholder: texts.label_words }));
    input.setAttribute("aria-label", texts.label_words);
    for (const name of ["pointerdown", "dblclick", "wheel"]) input.addEventListener(name, (event) => event.stopPropagation());
    input.style.left = `${x}px`;
    input.style.top = `${y}px`;
    const done = (words) => {
      if (this.input !== input) return;
      this.input = null;
      input.remove();
      if (words) this.labels.push({ point, words });
      this.draw();
    };
    input.onkeydown = (event) => {
      if (event.key === "Enter") done(input.value.trim());
      if (event.key === "Escape") done("");
    };
    input.onblur = () => done(input.value.trim());
    input.focus();
  }
  /// Returns the labels as `caplet render --label` takes them.
  label_text() { return this.labels.map(({ point, words }) => `${point.map((v) => +v.toPrecision(7)).join(",")} ${words.replaceAll(";", ",")}`).join("; "); }
  /// Takes a point of a surface: the second ends a distance; a third with `is_angle` makes an angle at the second.
  measure(point, is_angle) {
    const last = this.measures.at(-1);
    if (is_angle && last?.length === 2 && !this.points.length) last.push(point);
    else this.points.push(point);
    if (this.points.length === 2) { this.measures.push(this.points); this.points = []; }
    this.draw();
  }
  /// Returns what a measure says.
  words([a, b, c]) {
    if (!c) return `${short(length(sub(b, a)))}${this.unit ? ` ${this.unit}` : ""}`;
    const cosine = dot(unit(sub(a, b)), unit(sub(c, b)));
    return `${(Math.acos(Math.max(-1, Math.min(1, cosine))) * 180 / Math.PI).toFixed(1)}°`;
  }
  draw(is_shown = true) {
    this.svg.replaceChildren();
    this.forget.hidden = !this.measures.length && !this.points.length && !this.labels.length;
    if (!is_shown) return;
    for (const points of [...this.measures, this.points]) {
      const at = points.map((p) => this.project(p));
      at.forEach((p, i) => {
        if (p && i && at[i - 1]) this.svg.append(make("line", { x1: at[i - 1][0], y1: at[i - 1][1], x2: p[0], y2: p[1] }));
      });
      for (const p of at) if (p) this.svg.append(make("circle", { cx: p[0], cy: p[1], r: 4 }));
      const middle = points.length === 3 ? at[1] : points.length === 2 && at[0] && at[1] ? mul(add(at[0], at[1]), 0.5) : null;
      if (middle) this.svg.append(make("text", { x: middle[0], y: middle[1] - 8 }, this.words(points)));
    }
    for (const { point, words } of this.labels) {
      const p = this.project(point);
      if (p) this.svg.append(make("line", { x1: p[0], y1: p[1], x2: p[0] + 16, y2: p[1] - 16 }), make("circle", { cx: p[0], cy: p[1], r: 4 }), make("text", { x: p[0] + 18, y: p[1] - 18, class: "label" }, words));
    }
    this.draw_ray();
  }
  // The ray from before its first crossing to behind its last one, thick where it is inside a solid.
  draw_ray() {
    if (!this.ray?.crossings.length) return;
    const { origin, direction, crossings, inside } = this.ray, first = crossings[0].t, last = crossings.at(-1).t, more = 0.1 * (last - first) || 0.05 * first;
    const at = (t) => this.project(add(origin, mul(direction, t)));
    const line = (from, to, name) => {
      const a = at(from), b = at(to);
      if (a && b) this.svg.append(make("line", { x1: a[0], y1: a[1], x2: b[0], y2: b[1], class: name }));
    };
    line(Math.max(0, first - more), last + more, "ray");
    for (const [from, to] of inside) line(from, to ?? last, "ray inside");
    for (const { t } of crossings) {
      const p = at(t);
      if (p) this.svg.append(make("circle", { cx: p[0], cy: p[1], r: 3, class: "ray-in" }));
    }
  }
}
