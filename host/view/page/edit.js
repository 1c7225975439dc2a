// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Changes the selected things with handles in the picture and numbers beside it. The program checks and makes all changes.
import { add, dot, length, mul, sub, unit } from "./camera.js";
import { complain, scrubs, trouble_with, values_of } from "./numbers.js";
import { texts } from "./texts.js";

const NS = "http://www.w3.org/2000/svg", COLORS = ["#ff5a4d", "#5fd35f", "#5a9bff"], AXES = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const ANGLE = Math.PI / 12;  // a step of rotations
const snaps = (event) => event.shiftKey || event.ctrlKey;
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const make = (name, attributes) => {
  const out = document.createElementNS(NS, name);
  for (const [key, value] of Object.entries(attributes)) out.setAttribute(key, value);
  return out;
};
// Returns the row-major matrix of x -> center + scale * R (x - center), where R rotates by an angle about an axis.
function about(center, axis, angle, scale) {
  const u = unit(axis), c = Math.cos(angle), s = Math.sin(angle), m = [];
  for (let i = 0; i < 3; ++i)
    for (let j = 0; j < 3; ++j) {
      const k = 3 - i - j, sign = i === j ? 0 : (j - i + 3) % 3 === 1 ? -1 : 1;
      m.push(scale * ((i === j ? c : 0) + (1 - c) * u[i] * u[j] + (sign ? sign * s * u[k] : 0)));
    }
  const moved = [0, 1, 2].map((i) => center[i] - (m[3 * i] * center[0] + m[3 * i + 1] * center[1] + m[3 * i + 2] * center[2]));
  return [...m.slice(0, 3), moved[0], ...m.slice(3, 6), moved[1], ...m.slice(6, 9), moved[2], 0, 0, 0, 1];
}
const middle = ({ bounds: [low, high] }) => mul(add(low, high), 0.5);
const extent = ({ bounds: [low, high] }) => length(sub(high, low)) / 2 || 1;
// Returns the numbers that things have when these are gone.
const without = (gone) => (id) => gone.includes(id) ? undefined : id - gone.filter((other) => other < id).length;
const shift = (by) => { const m = [...identity]; [m[3], m[7], m[11]] = by; return m; };

export class Edits {
  // `edit` makes a change and calls back with the program's answer, `describe` asks what a thing is, `view` returns the camera,
  // `stage` is the element that the picture fills, `chose` receives a selection that an action
  // made, `shape_count` returns how many shapes come before the instances.
  constructor({ edit, describe, view, stage, find, shown, click, chose, shape_count }) {
    Object.assign(this, { edit, describe, view, stage, find, shown, click, chose, shape_count });
    this.boxes = new Set();
    this.hold([], 0);
    this.thing = null;
    this.busy = false;
    this.tool = "select";
    this.reset();
    this.handles = stage.appendChild(make("svg", { id: "handles" }));
    const apply = (id, count, work) => {
      find(id).addEventListener("change", () => {
        const text = find(id).value, trouble = text.trim() ? trouble_with(text, count) : "";
        complain(find(id), trouble);
        if (text.trim() && !trouble) work(values_of(text, count), find(id).dataset.moving === "1");
      });
    };
    const place = (id, count, matrix) => apply(id, count, (values) => {
      find(id).value = "";
      this.act(async ({ ids }, thing) => { const m = matrix(values, middle(thing)); if (m) await this.make({ what: "move", ids, matrix: m }); });
    });
    place("move", 3, (by) => shift(by));
    place("turn", 4, ([x, y, z, degrees], center) => length([x, y, z]) && about(center, [x, y, z], degrees * Math.PI / 180, 1));
    place("scale", 1, ([factor], center) => factor > 0 && about(center, [0, 0, 1], 0, factor));
    for (const [name, count] of [["p0", 3], ["p1", 3], ["radius0", 1], ["radius1", 1]])
      apply(name, count, (values, goes_on) => this.reshape({ [name]: count === 1 ? values[0] : values }, goes_on));
    for (const name of ["radius0", "radius1"]) { find(name).dataset.low = 0; scrubs(find(name).previousElementSibling, find(name)); }
    find("duplicate").onclick = () => this.duplicate();
    find("delete").onclick = () => this.remove();
    find("material").onchange = (event) => {
      if (event.target.value === "") return;
      const surface = find("surface").value;
      this.paint(surface === "" ? null : +surface, +event.target.value);
    };
    find("surface").onchange = () => this.fill();
  }

  // --- Actions ---
  // They run one after the other. Each is for the things that were selected when it was asked for, or for what the
  // actions before it have made of these, and waits until it is known what they are. A selection is a box of ids, which
  // the actions that wait share; when things get other numbers, all boxes do.

  get ids() { return this.selection.ids; }
  hold(ids, primitive) {
    if (this.selection && !this.selection.waits) this.boxes.delete(this.selection);
    this.selection = { ids, primitive, waits: 0 };
    this.boxes.add(this.selection);
  }
  // A new connection begins a new line of actions.
  reset() { this.queue = Promise.resolve(); this.busy = false; this.number_of = null; }
  act(work) {
    const { selection } = this;
    ++selection.waits;
    this.queue = this.queue.then(async () => {
      --selection.waits;
      if (selection !== this.selection && !selection.waits) this.boxes.delete(selection);
      if (!selection.ids.length) return;
      const thing = await new Promise((done) => this.describe(selection.ids.at(-1), selection.primitive, done));
      if (thing?.bounds) await work(selection, thing);
    }).catch((error) => console.error(error));
  }
  // Does something that needs no selection behind the actions that wait.
  after(work) { this.queue = this.queue.then(work).catch((error) => console.error(error)); }
  // Adds a thing, which is the selection from now on.
  add(what) {
    this.chose([]);
    const { selection } = this;
    this.after(async () => {
      const shapes = this.shape_count(), made = await this.make(what, (id) => id < shapes ? id : id + 1);
      if (!made.ids?.length) return;
      selection.ids = made.ids;
      if (selection === this.selection) this.show(selection);
    });
  }
  // Makes a change; `number_of` says which number a thing has afterwards, undefined: none.
  async make(what, number_of = null) {
    this.number_of = number_of;
    const made = await new Promise((done) => this.edit(what, false, done));
    this.number_of = null;
    return made;
  }
  // Things have other numbers: those that the present action knows, or else unknown ones.
  renumber() {
    for (const box of this.boxes) box.ids = this.number_of ? box.ids.map(this.number_of).filter((id) => id !== undefined) : [];
    this.show(this.selection);
  }
  show(selection) { this.is_told = true; this.chose(selection.ids); this.is_told = false; }
  duplicate() {
    this.act(async (selection, thing) => {
      const { ids } = selection, shapes = this.shape_count(), copies = ids.filter((id) => id < shapes).length;
      const made = await this.make({ what: "duplicate", ids, by: mul(unit(this.view().right), extent(thing) * 1.1) }, (id) => id < shapes ? id : id + copies);
      if (!made.ids?.length) return;
      selection.ids = made.ids;
      if (selection === this.selection) this.show(selection);
    });
  }
  remove() { this.act(({ ids }) => this.make({ what: "delete", ids }, without(ids))); }
  hide(others) {
    this.act(({ ids }) => {
      const kept = [...ids].sort((a, b) => a - b), place = (id) => { const at = kept.indexOf(id); return at < 0 ? undefined : at; };
      return this.make({ what: "hide", ids, others }, others ? place : without(ids));
    });
  }
  paint(surface, material) { this.act(({ ids }) => this.make({ what: "paint", ids, surface, material })); }

  change(what, goes_on = false) { if (this.ids.length) this.edit(what, goes_on, () => {}); }
  reshape(what, goes_on) {
    const { number, ...capsule } = this.thing.capsule;
    this.change({ what: "reshape", id: this.ids[0], capsule: number, ...capsule, ...what }, goes_on);
  }

  // Sets the selection, and the primitive that was hit.
  select(ids, primitive) {
    if (!this.is_told) this.hold(ids, primitive);
    this.thing = null;
    this.refresh();
  }
  // Asks for the present description of the selection.
  refresh() {
    const is_shown = this.ids.length > 0 && !this.read_only;
    this.find("edit").hidden = !is_shown;
    this.find("nothing-chosen").hidden = is_shown || this.read_only;
    if (!this.ids.length) { this.shown(null, "", false); this.draw(); return; }
    if (this.busy) { this.again = true; return; }
    this.busy = true;
    this.describe(this.ids[this.ids.length - 1], this.selection.primitive, (thing) => {
      this.busy = false;
      this.thing = thing?.bounds ? thing : null;
      this.fill();
      this.draw();
      if (this.again) { this.again = false; this.refresh(); }
    });
  }
  center() { return middle(this.thing); }
  size() { return extent(this.thing); }

  fill() {
    const { thing, find } = this, capsule = thing?.capsule;
    const surface = find("surface").value, materials = thing?.materials ?? [];
    find("surface").replaceChildren(new Option(texts.all_surfaces, ""), ...materials.map((_, i) => new Option(texts.surface_number(i), String(i))));
    find("surface").value = +surface < materials.length ? surface : "";
    const now = surface === "" ? (new Set(materials).size === 1 ? materials[0] : "") : materials[+surface] ?? "";
    find("material").value = String(now);
    this.shown(this.ids.length === 1 ? this.ids[0] : null, now, materials.length > 0);
    find("material").disabled = find("surface").disabled = !materials.length;
    find("capsule").hidden = !capsule || this.ids.length !== 1;
    for (const name of ["p0", "p1", "radius0", "radius1"])
      if (capsule && document.activeElement !== find(name) && !find(name).dataset.moving) find(name).value = [capsule[name]].flat().map((v) => +v.toPrecision(7)).join(" ");
  }

  // --- Handles ---

  // Returns half the shorter side of the view at a distance.
  half(z) { const camera = this.view(); return camera.parallel ? camera.half() : z * Math.tan(camera.fov / 2); }
  // Projects a point of the world to the stage, in CSS pixels; null behind the camera.
  project(p) {
    const camera = this.view(), d = sub(p, camera.eye), z = dot(d, unit(camera.forward)) / length(camera.forward);
    if (z <= 0) return null;
    const { clientWidth: w, clientHeight: h } = this.stage, scale = Math.min(w, h) / 2 / this.half(z);
    return [w / 2 + scale * dot(d, unit(camera.right)), h / 2 - scale * dot(d, unit(camera.up)), z];
  }
  draw() {
    if (this.dragged) return;  // a handle that is removed loses the pointer
    this.handles.replaceChildren();
    if (!this.thing || !this.ids.length || this.read_only || this.view().separation > 0) return;
    const center = this.center(), at = this.project(center);
    if (!at) return;
    const camera = this.view(), reach = 70 * 2 * this.half(at[2]) / Math.min(this.stage.clientWidth, this.stage.clientHeight);
    const shows = (tool) => this.tool === "select" || this.tool === tool;
    if (!["select", "move", "turn", "scale"].includes(this.tool)) return;
    if (shows("move")) AXES.forEach((axis, i) => {
      const end = this.project(add(center, mul(axis, reach)));
      if (!end) return;
      this.handles.append(make("line", { x1: at[0], y1: at[1], x2: end[0], y2: end[1], stroke: COLORS[i], "stroke-width": 3 }));
      this.handle("rect", { x: end[0] - 6, y: end[1] - 6, width: 12, height: 12, fill: COLORS[i], "data-handle": "xyz"[i] }, (start, move) => this.along(center, axis, start, move));
    });
    if (shows("turn")) this.draw_rings(center, reach);
    if (shows("move")) this.draw_planes(center, reach);
    const diagonal = this.project(add(center, mul(add(unit(camera.right), unit(camera.up)), 0.85 * reach)));
    if (diagonal && shows("scale")) this.grip("path", { d: `M${diagonal[0]} ${diagonal[1] - 8}l8 8l-8 8l-8 -8z`, fill: "#fff", stroke: "#333", "data-handle": "scale" }, 1, (start, move) => {
      const box = this.stage.getBoundingClientRect(), far = (event) => Math.hypot(event.clientX - box.left - at[0], event.clientY - box.top - at[1]) || 1;
      const factor = Math.max(0.01, far(move) / far(start));
      return snaps(move) ? Math.max(0.1, Math.round(factor * 10) / 10) : factor;
    }, (now, gone) => about(center, [0, 0, 1], 0, now / gone));
    if (shows("move")) this.handle("circle", { cx: at[0], cy: at[1], r: 7, fill: "#fff", stroke: "#333", "data-handle": "plane" }, (start, move) => this.in_plane(center, start, move));
    const capsule = this.thing.capsule;
    if (!capsule || this.ids.length !== 1 || !shows("move")) return;
    for (const name of ["p0", "p1"]) {
      const end = this.project(capsule[name]);
      if (end) this.handle("circle", { cx: end[0], cy: end[1], r: 6, fill: "#ffd24d", stroke: "#333", "data-handle": name }, (start, move) => this.in_plane(capsule[name], start, move), (by) => this.reshape({ [name]: add(this.held[name], by) }, this.moved++ > 0));
    }
  }
  draw_rings(center, reach) {
    AXES.forEach((axis, i) => {
      const [u, v] = [AXES[(i + 1) % 3], AXES[(i + 2) % 3]], points = [];
      for (let k = 0; k <= 48; ++k) {
        const angle = k * Math.PI / 24, p = this.project(add(center, add(mul(u, 0.75 * reach * Math.cos(angle)), mul(v, 0.75 * reach * Math.sin(angle)))));
        if (!p) return;
        points.push(`${p[0].toFixed(1)},${p[1].toFixed(1)}`);
      }
      const angle_at = (event) => { const p = this.on_plane(center, axis, event); return p && Math.atan2(dot(sub(p, center), v), dot(sub(p, center), u)); };
      this.grip("polyline", { points: points.join(" "), fill: "none", stroke: COLORS[i], "stroke-width": 4, "stroke-opacity": 0.55, "pointer-events": "stroke", "data-handle": `turn-${"xyz"[i]}` }, 0, (start, move) => {
        const from = angle_at(start), to = angle_at(move);
        let angle = from === null || to === null ? (move.clientX - start.clientX) * 0.01 : to - from;
        angle -= 2 * Math.PI * Math.round(angle / (2 * Math.PI));
        return snaps(move) ? ANGLE * Math.round(angle / ANGLE) : angle;
      }, (now, gone) => about(center, axis, now - gone, 1));
    });
  }
  draw_planes(center, reach) {
    AXES.forEach((axis, i) => {
      const [u, v] = [AXES[(i + 1) % 3], AXES[(i + 2) % 3]];
      const corners = [[0.25, 0.25], [0.45, 0.25], [0.45, 0.45], [0.25, 0.45]].map(([a, b]) => this.project(add(center, add(mul(u, a * reach), mul(v, b * reach)))));
      if (corners.includes(null)) return;
      this.handle("polygon", { points: corners.map((p) => `${p[0].toFixed(1)},${p[1].toFixed(1)}`).join(" "), fill: COLORS[i], "fill-opacity": 0.5, stroke: COLORS[i], "data-handle": `plane-${"xyz"[i]}` }, (start, move) => {
        const from = this.on_plane(center, axis, start), to = this.on_plane(center, axis, move);
        return from && to ? sub(to, from) : [0, 0, 0];
      });
    });
  }
  // Intersects the ray under the pointer with the plane through a point; null if there is no well-defined intersection.
  on_plane(center, normal, event) {
    const camera = this.view(), box = this.stage.getBoundingClientRect(), pixel = 2 * this.half(1) / Math.min(box.width, box.height);
    const aside = add(mul(unit(camera.right), (event.clientX - box.left - box.width / 2) * pixel), mul(unit(camera.up), -(event.clientY - box.top - box.height / 2) * pixel));
    const forward = unit(camera.forward), way = camera.parallel ? forward : add(forward, aside), from = camera.parallel ? add(camera.eye, aside) : camera.eye;
    const along = dot(unit(way), normal);
    if (Math.abs(along) < 0.05) return null;
    const t = dot(sub(center, from), normal) / dot(way, normal);
    return t > 0 || camera.parallel ? add(from, mul(way, t)) : null;
  }
  // Adds a handle that moves along one number; `matrix` gives the transform of that number. A click without a drag goes through.
  grip(shape, attributes, first, way, matrix) {
    const node = this.handles.appendChild(make(shape, { ...attributes, tabindex: -1 }));
    node.addEventListener("pointerdown", (start) => {
      start.stopPropagation();
      node.setPointerCapture(start.pointerId);
      this.dragged = true;
      let gone = first, moved = 0;
      const go = (move) => {
        const now = way(start, move);
        if (now === gone) return;
        this.change({ what: "move", ids: this.ids, matrix: matrix(now, gone) }, moved++ > 0);
        gone = now;
      };
      const end = (event) => { this.dragged = false; node.removeEventListener("pointermove", go); this.refresh(); if (!moved && event.type === "pointerup") this.click(event); };
      node.addEventListener("pointermove", go);
      node.addEventListener("pointerup", end, { once: true });
      node.addEventListener("pointercancel", end, { once: true });
    });
  }
  // Returns the pointer's motion along an axis of the world, where it is defined.
  along(center, axis, start, move) {
    const a = this.project(center), b = this.project(add(center, mul(axis, this.size() * 0.1)));
    const way = [b[0] - a[0], b[1] - a[1]], square = way[0] ** 2 + way[1] ** 2 || 1;
    return mul(axis, this.size() * 0.1 * ((move.clientX - start.clientX) * way[0] + (move.clientY - start.clientY) * way[1]) / square);
  }
  in_plane(center, start, move) {
    const camera = this.view(), one = 2 * this.half(this.project(center)[2]) / Math.min(this.stage.clientWidth, this.stage.clientHeight);
    return add(mul(unit(camera.right), (move.clientX - start.clientX) * one), mul(unit(camera.up), -(move.clientY - start.clientY) * one));
  }
  handle(shape, attributes, way, put = (by) => this.change({ what: "move", ids: this.ids, matrix: shift(sub(by, this.gone)) }, this.moved++ > 0)) {
    const node = this.handles.appendChild(make(shape, { ...attributes, tabindex: -1 }));
    node.addEventListener("pointerdown", (start) => {
      start.stopPropagation();
      node.setPointerCapture(start.pointerId);
      this.dragged = true;
      this.moved = 0;
      this.gone = [0, 0, 0];
      this.held = this.thing.capsule && { ...this.thing.capsule };
      const step = 10 ** Math.floor(Math.log10(this.size()) - 0.5);
      const go = (move) => {
        let by = way(start, move);
        if (snaps(move)) by = by.map((v) => step * Math.round(v / step));
        if (length(sub(by, this.gone)) === 0) return;
        put(by);
        this.gone = by;
      };
      const end = (event) => { this.dragged = false; node.removeEventListener("pointermove", go); this.refresh(); if (!this.moved && event.type === "pointerup") this.click(event); };
      node.addEventListener("pointermove", go);
      node.addEventListener("pointerup", end, { once: true });
      node.addEventListener("pointercancel", end, { once: true });
    });
  }
}
