// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
import { Camera, add, dot, length, mul, sub, unit } from "./camera.js";
import { Edits } from "./edit.js";
import { Forms } from "./forms.js";
import { inspect } from "./inspector.js";
import { Keep } from "./keep.js";
import { Picture } from "./picture.js";
import { LAYOUTS, arranged, share, view_pixel } from "./stereo.js";
import { texts } from "./texts.js";

const $ = (id) => document.getElementById(id);
const stage = $("stage"), picture_canvas = $("picture"), marks = $("marks");
const picture = new Picture(), right_picture = new Picture(), chosen = new Set(), waiting = new Map();
let scene = null, camera = null, world_up = [0, 0, 1], center = [0, 0, 0], radius = 1;
let socket = null, number = 0, past = [], future = [], kept = [], under_asked = false, under_next = null, under_hit = null;

// --- Words ---

for (const node of document.querySelectorAll("[data-text]")) node.textContent = texts[node.dataset.text];
stage.setAttribute("aria-label", texts.picture);
$("search").placeholder = texts.search;
$("search").setAttribute("aria-label", texts.search);
$("axis").setAttribute("aria-label", texts.axis);
$("kept").setAttribute("aria-label", texts.kept);
$("tree").setAttribute("aria-label", texts.things);
for (const [id, text] of [["light", "light"], ["texture", "texture"], ["new-light", "new_light"], ["new-texture", "new_texture"], ["new-material", "new_material"], ["palette", "palette"], ["hidden", "hide"]]) $(id).setAttribute("aria-label", texts[text]);
$("palette").setAttribute("role", "group");
for (const [value, text] of Object.entries(texts.axes)) $("axis").add(new Option(text, value));
for (const value of LAYOUTS) $("stereo").add(new Option(texts.stereos[value], value));
for (const [value, text] of Object.entries(texts.curves)) $("curve").add(new Option(text, value));
for (const [key, what] of texts.list) $("list").append(Object.assign(document.createElement("dt"), { textContent: key }), Object.assign(document.createElement("dd"), { textContent: what }));

// --- The program ---

const say = (message) => { if (socket?.readyState === 1) socket.send(JSON.stringify(message)); };

function ask(pixel, all, reference, done) {
  waiting.set(++number, done);
  say({ type: "ask", number, x: pixel[0], y: pixel[1], eye: pixel[2] ?? 0, all, reference });
}

function edit(what, goes_on = false, done = () => {}) {
  waiting.set(++number, done);
  say({ type: "edit", number, goes_on, ...what });
}

const forms = new Forms({
  edit, find: $, chosen: () => [...chosen], select: (ids) => choose_all(ids),
  ask: (part, done) => { waiting.set(++number, done); say({ type: "form", number, ...part }); },
  // New things appear on the surface under the cursor, or where the camera looks.
  place: (hit) => {
    const size = camera.distance() * Math.tan(camera.fov / 2) * 0.2;
    if (hit) return { at: add(hit.point, mul(unit(hit.normal), size)), size };
    return { at: camera.target, size };
  },
  // New lights stand above the camera and shine at its target.
  lamp: () => {
    const at = add(camera.eye, mul(unit(camera.up), 0.3 * camera.distance()));
    return { at, size: camera.distance(), towards: sub(camera.target, at) };
  },
});

const edits = new Edits({
  shown: (...what) => forms.thing(...what), click: (event) => click(event),
  say, view: () => camera, stage, find: $,
  describe: (id, primitive, done) => { waiting.set(++number, done); say({ type: "describe", number, id, primitive }); },
});

const keep = new Keep({
  say, stage, tools: $("tools"), aside: document.querySelector("aside"),
  title: (unsaved) => { if (scene) document.title = `${unsaved ? "• " : ""}${scene.name} - Caplet`; $("name").textContent = `${unsaved ? "• " : ""}${scene?.name ?? ""}`; },
});

let lost_since = 0;
function connect() {
  const opened = new WebSocket(location.href.replace(/^http/, "ws").replace(/[^/]*$/, "") + "socket");
  opened.binaryType = "arraybuffer";
  let turn = Promise.resolve(), came = false;
  opened.onopen = () => { socket = opened; came = true; $("lost").hidden = true; lost_since = 0; waiting.clear(); under_asked = edits.busy = false; say({ type: "seen", seen: !document.hidden }); };
  opened.onmessage = ({ data }) => {
    turn = turn.then(() => typeof data === "string" ? told(JSON.parse(data)) : binary(data)).catch((error) => console.error(error));
  };
  opened.onclose = () => {
    socket = null;
    if (came || !lost_since) lost_since = performance.now();
    // A restart takes a while.
    $("lost").textContent = performance.now() - lost_since < 20000 && scene ? texts.lost : texts.closed;
    $("lost").hidden = false;
    setTimeout(connect, 1000);
  };
}

function told(message) {
  if (message.type === "scene") return begin(message);
  if (message.type === "denoise") return denoises(message.on);
  if (message.type === "looked") return void (camera && camera_of(message));
  if (message.type === "error") {
    keep.failed(message.text);
    $("state").textContent = message.text;
    waiting.get(message.number)?.({ error: message.text });
    return void waiting.delete(message.number);
  }
  if (message.type === "saved") return keep.saved(message);
  if (message.type === "save_asks") return keep.asks(message);
  if (message.type === "edited") return edited(message);
  const done = waiting.get(message.number);
  waiting.delete(message.number);
  if (done) done(message.type === "made" ? message : message.pick ?? message.thing ?? message.form);
}

async function binary(data) {
  const is_right = data.byteLength >= 40 && new DataView(data).getUint32(28, true) & 4;
  if (await (is_right ? right_picture : picture).take(data)) return draw();
  save(new Blob([data], { type: "image/x-exr" }), `${scene.name}.exr`);
}

function save(blob, name) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function edited(message) {
  $("back").disabled = !message.can_undo;
  $("again").disabled = !message.can_redo;
  keep.told(message.keep);
  if (message.scene) {
    const { camera: _, ...now } = message.scene;
    Object.assign(scene, now);
    if (message.renumbered) choose(null, false);
    fill_tree();
  }
  scene.samples = message.samples;
  if (message.home) scene.home = message.home;
  forms.told(message.parts);
  edits.refresh();
  stage.dataset.edits = (+stage.dataset.edits || 0) + 1;
}

function begin(message) {
  const again = scene?.name === message.name, restarted = again && scene.session !== message.session;
  scene = message;
  const [low, high] = scene.bounds;
  center = mul(add(low, high), 0.5);
  radius = length(sub(high, low)) / 2 || 1;
  if (again && camera) {
    if (restarted) { choose(null, false); looked = ""; }  // the new program must know what this page looks at
    else camera_of(scene.camera);
  } else {
    camera = new Camera(scene.camera);
    // Orbiting turns about the world axis that is nearest to the picture's up.
    const up = unit(camera.up), axis = up.map(Math.abs).indexOf(Math.max(...up.map(Math.abs)));
    world_up = [0, 0, 0];
    world_up[axis] = Math.sign(up[axis]);
    const along = dot(sub(center, camera.eye), unit(camera.forward));
    if (!camera.parallel) camera.target = add(camera.eye, mul(unit(camera.forward), along > 0 ? along : radius));
    past = []; future = []; chosen.clear();
  }
  edits.read_only = scene.read_only;
  document.body.classList.toggle("read-only", scene.read_only);
  denoises(scene.denoise);
  forms.begin(scene.lists);
  forms.told(scene.parts);
  forms.reset();
  $("back").disabled = !scene.can_undo;
  $("again").disabled = !scene.can_redo;
  keep.begin(scene);
  fill_tree();
  look();
  draw();
}

// Absent: the program has no denoiser.
function denoises(on) {
  $("denoise").hidden = on === undefined;
  $("denoise").setAttribute("aria-pressed", String(on === true));
}

// --- The camera ---

// Takes the view of another page.
function camera_of(message) {
  const now = new Camera(message);
  if (!now.parallel) now.target = add(now.eye, mul(unit(now.forward), camera.distance()));
  camera = now;
  edits.draw();
  show_lens();
}

function show_lens() {
  if (!camera.separation && $("stereo").value !== "off") $("stereo").value = "off";
  if (camera.separation && $("stereo").value === "off") $("stereo").value = "sbs";
  $("pair").hidden = !camera.separation;
  $("separation").value = +camera.separation.toPrecision(6);
  $("convergence").value = +camera.convergence.toPrecision(6);
  $("parallel").setAttribute("aria-pressed", String(camera.parallel));
  $("fov").value = (camera.fov * 180 / Math.PI).toFixed(1);
  $("radius").value = +camera.lens_radius.toPrecision(6);
  $("focus").value = +camera.focal_distance.toPrecision(6);
}

let looked = "";
function look() {
  if (!camera) return;
  const scale = window.devicePixelRatio || 1, most = 4096;
  const [across, down] = share(camera.separation > 0 ? $("stereo").value : "off");
  const width = Math.min(most, Math.max(1, Math.round(stage.clientWidth * scale / across))), height = Math.min(most, Math.max(1, Math.round(stage.clientHeight * scale / down)));
  const message = { type: "look", width, height, world_from_camera: camera.matrix(), fov: camera.fov, lens_radius: camera.lens_radius, focal_distance: camera.focal_distance, orthographic: camera.parallel ? camera.half() : 0, separation: camera.separation, convergence: camera.convergence };
  const text = JSON.stringify(message);
  edits.draw();
  show_lens();
  $("undo").disabled = !past.length;
  $("redo").disabled = !future.length;
  if (text === looked && socket) return;
  looked = text;
  say(message);
}

// Records the camera before it changes, for undo; the changes of one gesture count as one.
function remember() { past.push(camera.copy()); future = []; if (past.length > 1000) past.shift(); }
function change(what) { remember(); what(); look(); }
function undo(from, to) { if (!from.length) return; to.push(camera.copy()); camera = from.pop(); look(); }
const home = () => change(() => { const target = camera.target; camera = new Camera(scene.home); if (!camera.parallel) camera.target = target; });
const fit = () => change(() => camera.fit(center, radius));
function along(name) {
  if (!name) return;
  const axis = "xyz".indexOf(name[1]), from = [0, 0, 0];
  from[axis] = name[0] === "+" ? -1 : 1;
  const up = Math.abs(dot(from, world_up)) > 0.5 ? [0, 1, 0, 0].slice(axis === 1 ? 1 : 0).slice(0, 3) : world_up;
  change(() => camera.look(from, up, center, radius));
}

// --- The picture ---

const layout = () => camera?.separation > 0 ? $("stereo").value : "off";
const has_right = () => right_picture.view === picture.view && right_picture.width === picture.width && right_picture.height === picture.height;

function draw() {
  const { width, height } = picture;
  if (!scene || !width) return;
  const shown = (of) => of.shown(+$("exposure").value, $("curve").value);
  const [across, down, bytes] = arranged(layout(), width, height, shown(picture), has_right() ? shown(right_picture) : null);
  picture_canvas.width = across;
  picture_canvas.height = down;
  picture_canvas.getContext("2d").putImageData(new ImageData(bytes, across, down), 0, 0);
  mark();
  $("state").textContent = picture.scale > 1 ? texts.coarse(picture, scene.device) : texts.state(picture, `${width} × ${height}`, scene.samples, scene.noise, scene.device);
  stage.dataset.samples = picture.scale > 1 ? 0 : picture.samples;
  stage.dataset.view = picture.view;
  stage.dataset.right = has_right() && right_picture.scale === 1 ? right_picture.samples : 0;
}

function mark() {
  if (picture.scale !== 1 && picture.width) { marks.getContext("2d").clearRect(0, 0, marks.width, marks.height); return; }
  if (!picture.width) return;
  const is_on = chosen.size && picture.objects;
  const [width, height, bytes] = arranged(layout() === "anaglyph" ? "off" : layout(), picture.width, picture.height, is_on ? picture.outline(chosen) : new Uint8ClampedArray(4 * picture.width * picture.height),
    is_on && has_right() && right_picture.objects ? right_picture.outline(chosen) : null);
  marks.width = width;
  marks.height = height;
  if (is_on) marks.getContext("2d").putImageData(new ImageData(bytes, width, height), 0, 0);
}

// --- What is under the cursor ---

function pixel_at(event) {
  const box = stage.getBoundingClientRect(), scale = window.devicePixelRatio || 1;
  return view_pixel(layout(), picture.width, picture.height, [Math.floor((event.clientX - box.left) * scale), Math.floor((event.clientY - box.top) * scale)].map((v) => Math.max(0, v)));
}

// Only one query runs at a time: the next one starts after the last answer.
function hover(pixel) {
  under_next = pixel;
  if (under_asked || !under_next) return;
  under_asked = true;
  under_next = null;
  ask(pixel, false, false, (told_of) => {
    under_asked = false;
    const hit = told_of.crossings[0];
    under_hit = hit;
    $("under").textContent = hit ? texts.under(hit) : texts.nothing;
    if (under_next) hover(under_next);
  });
}

function choose_all(ids) {
  chosen.clear();
  for (const id of ids) chosen.add(id);
  for (const item of $("tree").children) item.setAttribute("aria-selected", chosen.has(+item.dataset.id));
  edits.select([...chosen].sort((a, b) => a - b), 0);
  mark();
}

function choose(id, more, primitive = 0) {
  if (!more) chosen.clear();
  if (id !== null) chosen.has(id) && more ? chosen.delete(id) : chosen.add(id);
  for (const item of $("tree").children) item.setAttribute("aria-selected", chosen.has(+item.dataset.id));
  edits.select([...chosen].sort((a, b) => a - b), primitive);
  mark();
}

function click(event) {
  const pixel = pixel_at(event);
  ask(pixel, false, false, (told_of) => {
    const hit = told_of.crossings[0];
    if (event.altKey && hit) return change(() => { camera.focal_distance = Math.max(1e-6, dot(sub(hit.point, camera.eye), unit(camera.forward))); });
    choose(hit ? hit.object_id : null, event.shiftKey, hit ? hit.primitive : 0);
  });
  ask(pixel, true, true, (told_of) => {
    inspect(told_of, $("asked"), $("intervals"), $("table"));
    $("table").dataset.pixel = pixel.slice(0, 2).join();
  });
}

// --- The scene's tree ---

function fill_tree() {
  const words = $("search").value.toLowerCase(), rows = [];
  let found = 0;
  scene.things.forEach((thing, id) => {
    if (!thing.name.toLowerCase().includes(words) || ++found > 500) return;
    const item = document.createElement("li"), small = document.createElement("small");
    item.role = "option";
    item.id = `thing${id}`;
    item.dataset.id = id;
    item.setAttribute("aria-selected", chosen.has(id));
    small.textContent = thing.material ? ` ${thing.material}${thing.primitives > 1 ? `, ${thing.primitives}` : ""}` : "";
    item.append(thing.name, small);
    rows.push(item);
  });
  $("tree").replaceChildren(...rows);
  $("more").textContent = texts.more(rows.length, scene.thing_count);
}

// --- Mouse, touch and keys ---

const pointers = new Map();
let moved = 0, spread = 0;
const pixel_length = () => 2 * camera.distance() * Math.tan(camera.fov / 2) / Math.min(stage.clientWidth, stage.clientHeight);

stage.addEventListener("pointerdown", (event) => {
  if (!camera) return;
  stage.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, event);
  if (pointers.size === 1) { moved = 0; remember(); }
  spread = 0;
});
stage.addEventListener("pointermove", (event) => {
  if (!camera) return;
  const before = pointers.get(event.pointerId);
  if (!before) return hover(pixel_at(event));
  pointers.set(event.pointerId, event);
  const dx = event.clientX - before.clientX, dy = event.clientY - before.clientY;
  moved += Math.hypot(dx, dy);
  if (moved < 4) return;
  if (pointers.size === 2) {
    const [a, b] = [...pointers.values()], now = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
    if (spread) camera.dolly(spread / Math.max(1, now));
    spread = now;
    camera.pan(-dx / 2 * pixel_length(), dy / 2 * pixel_length());
  } else if (event.buttons & 6 || event.shiftKey) {
    camera.pan(-dx * pixel_length(), dy * pixel_length());
  } else {
    camera.orbit(-dx * 0.006, -dy * 0.006, world_up);
  }
  look();
});
const ended = (event) => {
  if (!pointers.delete(event.pointerId) || pointers.size) return;
  if (moved < 4) { past.pop(); if (event.type === "pointerup" && event.button === 0) click(event); }
  look();
};
stage.addEventListener("pointerup", ended);
stage.addEventListener("pointercancel", ended);
stage.addEventListener("contextmenu", (event) => event.preventDefault());
stage.addEventListener("dblclick", (event) => ask(pixel_at(event), false, false, (told_of) => {
  const hit = told_of.crossings[0];
  if (hit) change(() => { const by = sub(hit.point, camera.target); camera.target = hit.point; camera.eye = add(camera.eye, by); });
}));
let wheel_at = 0;
stage.addEventListener("wheel", (event) => {
  event.preventDefault();
  if (!camera) return;
  if (event.timeStamp - wheel_at > 500) remember();
  wheel_at = event.timeStamp;
  const factor = Math.exp(Math.max(-0.5, Math.min(0.5, event.deltaY * (event.deltaMode ? 0.05 : 0.0015))));
  if (event.ctrlKey) camera.fov = Math.min(2.9, Math.max(0.02, camera.fov * factor));
  else camera.dolly(factor);
  look();
}, { passive: false });

const axes = { 1: "+x", 2: "-x", 3: "+y", 4: "-y", 5: "+z", 6: "-z" };
stage.addEventListener("keydown", (event) => {
  if (!camera || event.ctrlKey || event.metaKey) return;
  const step = 0.08, way = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
  if (way) change(() => event.shiftKey ? camera.pan(...mul(way, -40 * pixel_length())) : camera.orbit(way[0] * step, way[1] * step, world_up));
  else if (event.key === "+" || event.key === "=") change(() => camera.dolly(0.9));
  else if (event.key === "-") change(() => camera.dolly(1 / 0.9));
  else if (event.key === "f") fit();
  else if (event.key === "h") home();
  else if (event.key === "z") undo(past, future);
  else if (event.key === "y") undo(future, past);
  else if (event.key === "u") $("back").click();
  else if (event.key === "r") $("again").click();
  else if (event.key === "d") $("duplicate").click();
  else if (event.key === "Delete") $("delete").click();
  else if (event.key === "s") { $("stereo").selectedIndex = ($("stereo").selectedIndex + 1) % LAYOUTS.length; $("stereo").dispatchEvent(new Event("change")); }
  else if (event.key === "o") $("parallel").click();
  else if (event.key === "c" && !$("denoise").hidden) $("denoise").click();
  else if (event.key === "n") forms.add_shape(forms.last_shape ?? forms.lists.shape[0], under_hit);
  else if (event.key === "x") hide(false);
  else if (event.key === "i") hide(true);
  else if (event.key === "a") $("show-all").click();
  else if (event.key === "Escape") choose(null, false);
  else if (event.key === "?") $("keys").showModal();
  else if (axes[event.key]) along(axes[event.key]);
  else return;
  event.preventDefault();
});

const hide = (others) => { if (chosen.size) edit({ what: "hide", ids: [...chosen], others }, false, (made) => { if (others && made.ids) choose_all(made.ids); }); };
$("parallel").onclick = () => { if (camera) change(() => { camera.parallel = !camera.parallel; }); };
$("hide").onclick = () => hide(false);
$("isolate").onclick = () => hide(true);
$("show-all").onclick = () => { if (!$("hidden-box").hidden) edit({ what: "show", hidden: null }); };
$("back").onclick = () => say({ type: "undo", again: false });
$("again").onclick = () => say({ type: "undo", again: true });
$("fit").onclick = fit;
$("home").onclick = home;
$("undo").onclick = () => undo(past, future);
$("redo").onclick = () => undo(future, past);
$("axis").onchange = (event) => { along(event.target.value); event.target.value = ""; };
$("help").onclick = () => $("keys").showModal();
$("exposure").oninput = () => { $("stops").value = $("exposure").value; draw(); };
$("curve").onchange = draw;
$("denoise").onclick = () => { const on = $("denoise").getAttribute("aria-pressed") !== "true"; denoises(on); say({ type: "denoise", on }); };
$("exr").onclick = () => say({ type: "snapshot" });
$("png").onclick = () => picture_canvas.toBlob((blob) => save(blob, `${scene.name}.png`));
const fill_kept = () => $("kept").replaceChildren(new Option(texts.kept, ""), ...kept.map((_, i) => new Option(String(i + 1), String(i))));
$("keep").onclick = () => { if (camera) { kept.push(camera.copy()); fill_kept(); } };
$("kept").onchange = (event) => { const view = kept[+event.target.value]; if (event.target.value !== "" && view) change(() => { camera = view.copy(); }); event.target.value = ""; };
fill_kept();
const bounded = (id, least, most, set) => { $(id).onchange = (event) => { const value = +event.target.value; if (camera && value >= least && value <= most) change(() => set(value)); else look(); }; };
bounded("fov", 1, 170, (value) => { camera.fov = value * Math.PI / 180; });
bounded("radius", 0, 1e9, (value) => { camera.lens_radius = value; });
bounded("separation", 1e-9, 1e9, (value) => { camera.separation = value; });
bounded("convergence", 0, 1e12, (value) => { camera.convergence = value; });
$("stereo").onchange = (event) => {
  if (!camera) return;
  const layout = event.target.value;
  change(() => {
    if (layout === "off") camera.separation = 0;
    else if (!camera.separation) { camera.separation = +(camera.distance() / 30).toPrecision(3); camera.convergence = +camera.distance().toPrecision(3); }
  });
  event.target.value = layout;
  look();
  draw();
};
bounded("focus", 1e-6, 1e12, (value) => { camera.focal_distance = value; });
$("search").oninput = () => { if (scene) fill_tree(); };
$("tree").onclick = (event) => { const item = event.target.closest("li"); if (item) choose(+item.dataset.id, event.shiftKey || event.ctrlKey); };
$("tree").onkeydown = (event) => {
  if (event.key !== "ArrowDown" && event.key !== "ArrowUp") return;
  const items = [...$("tree").children], at = items.findIndex((item) => item.getAttribute("aria-selected") === "true");
  const next = items[Math.max(0, Math.min(items.length - 1, at + (event.key === "ArrowDown" ? 1 : -1)))];
  if (next) { choose(+next.dataset.id, false); next.scrollIntoView({ block: "nearest" }); $("tree").setAttribute("aria-activedescendant", next.id); }
  event.preventDefault();
};
document.addEventListener("visibilitychange", () => say({ type: "seen", seen: !document.hidden }));
new ResizeObserver(look).observe(stage);
connect();
