// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
import { Camera, add, dot, length, mul, sub, unit } from "./camera.js";
import { Clip } from "./clip.js";
import { tell } from "./dialog.js";
import { Panel, dress, menu } from "./dock.js";
import { Edits } from "./edit.js";
import { Figure } from "./figure.js";
import { Forms } from "./forms.js";
import { Gizmo } from "./gizmo.js";
import { icon } from "./icons.js";
import { Inspector } from "./inspector.js";
import { Keep } from "./keep.js";
import { KEYS, action_of, is_taken } from "./keys.js";
import { complain, scrubs, trouble_with, value_of } from "./numbers.js";
import { Path } from "./path.js";
import { Picture } from "./picture.js";
import { Progress } from "./progress.js";
import { Redraw } from "./redraw.js";
import { LAYOUTS, arranged, share, view_pixel } from "./stereo.js";
import { texts } from "./texts.js";
import { Notes, Tools } from "./tools.js";

const $ = (id) => document.getElementById(id);
const stage = $("stage"), picture_canvas = $("picture"), marks = $("marks");
const picture = new Picture(), right_picture = new Picture(), chosen = new Set(), waiting = new Map(), progress = new Progress();
let scene = null, camera = null, world_up = [0, 0, 1], center = [0, 0, 0], radius = 1;
let socket = null, number = 0, past = [], future = [], kept = [], under_asked = false, under_next = null, under_hit = null, hovered = null;

// --- Words ---

dress();
stage.setAttribute("aria-label", texts.picture);
for (const [id, text] of [["search", "search"], ["tree", "things"], ["light", "light"], ["texture", "texture"], ["new-light", "new_light"], ["new-texture", "new_texture"], ["new-material", "new_material"], ["palette", "palette"], ["hidden", "hide"], ["file-tools", "menu"], ["view-tools", "lens"], ["done", "samples_done"], ["compass", "axis"]])
  $(id).setAttribute("aria-label", texts[text]);
$("search").placeholder = texts.search;
$("palette").setAttribute("role", "group");
for (const value of LAYOUTS) $("stereo").add(new Option(texts.stereos[value], value));
for (const [value, text] of Object.entries(texts.curves)) $("curve").add(new Option(text, value));
for (const [key, what] of [...texts.mouse, ...KEYS.map(([action, ...keys]) => [keys.join(", "), texts.actions[action]])])
  $("list").append(Object.assign(document.createElement("dt"), { textContent: key }), Object.assign(document.createElement("dd"), { textContent: what }));

const panel = new Panel();
const gizmo = new Gizmo($("gizmo"), (name) => along(name));

// --- The program ---

const say = (message) => { if (socket?.readyState === 1) socket.send(JSON.stringify(message)); };

function ask(pixel, all, reference, done) {
  waiting.set(++number, done);
  say({ type: "ask", number, x: pixel[0], y: pixel[1], eye: pixel[2] ?? 0, all, reference });
}

// The answer to a change that is refused is its error, which is said; `done` receives it too.
function edit(what, goes_on = false, done = () => {}) {
  waiting.set(++number, done);
  say({ type: "edit", number, goes_on, ...what });
}

const forms = new Forms({
  edit, find: $, chosen: () => [...chosen], adds_shape: (what) => edits.add(what), paints: (surface, material) => edits.paint(surface, material), under: () => under_hit,
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
  edit, shown: (...what) => forms.thing(...what), click: (event) => click(event), chose: (ids) => choose_all(ids),
  view: () => camera, stage, find: $, shape_count: () => scene.shape_count,
  describe: (id, primitive, done) => { waiting.set(++number, done); say({ type: "describe", number, id, primitive }); },
});
const notes = new Notes(stage, (p) => edits.project(p), $("hint"), $("forget-measures"));
const draw_notes = () => notes.draw(camera && !camera.separation);
const inspector = new Inspector((ray) => { notes.ray = ray; draw_notes(); });
const tools = new Tools($("rail"), (name) => {
  edits.tool = name;
  $("hint").hidden = !texts.hints[name];
  $("hint").firstChild.textContent = texts.hints[name] ?? "";
  $("forget-measures").hidden = !(name === "measure" && notes.measures.length) && !(name === "label" && notes.labels.length);
  if (camera) edits.draw();
});

const keep = new Keep({
  say, button: $("save"), banners: $("banners"),
  title: (unsaved) => { if (scene) document.title = `${unsaved ? "• " : ""}${scene.name} - Caplet`; $("name").textContent = `${unsaved ? "• " : ""}${scene?.name ?? ""}`; },
});

const figure = new Figure({
  ask: (message, done) => { waiting.set(++number, done); say({ ...message, number }); }, stop: () => say({ type: "end_figure" }),
  look: () => view_message(1, 1), size: () => [stage.clientWidth, stage.clientHeight], save: (blob, name) => save(blob, name), labels: () => notes.label_text(), file: () => keep.name.value.trim() || keep.now.name || scene.name,
  exposure: () => {
    const { stops, auto } = scene.exposure, slider = +$("exposure").value, is_auto = $("auto-exposure").checked;
    if (slider === 0 && is_auto === auto) return null;  // as the scene says
    return slider === 0 && is_auto ? "auto" : exposure().toFixed(2);
  },
});

let lost_since = 0;
function connect() {
  const opened = new WebSocket(location.href.replace(/^http/, "ws").replace(/[^/]*$/, "") + "socket");
  opened.binaryType = "arraybuffer";
  let turn = Promise.resolve(), came = false;
  opened.onopen = () => { socket = opened; came = true; $("lost").hidden = true; lost_since = 0; waiting.clear(); under_asked = false; edits.reset(); figure.lost(); say({ type: "seen", seen: !document.hidden }); };
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
    if (!keep.failed(message.text)) tell(message.text);
    waiting.get(message.number)?.({ error: message.text });
    return void waiting.delete(message.number);
  }
  if (message.type === "figuring") return figure.told(message);
  if (message.type === "saved") return keep.saved(message);
  if (message.type === "save_asks") return keep.asks(message);
  if (message.type === "edited") return edited(message);
  const done = waiting.get(message.number);
  waiting.delete(message.number);
  if (done) done(message.type === "made" ? message : message.pick ?? message.thing ?? message.form);
}

async function binary(data) {
  if (figure.take(data)) return;
  const is_right = data.byteLength >= 40 && new DataView(data).getUint32(28, true) & 4;
  if (await (is_right ? right_picture : picture).take(data)) return draw();
  save(new Blob([data], { type: "image/x-exr" }), `${scene.name}.exr`);
}

function save(blob, name) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// Shows the time at which the shutter opens, where the scene moves.
function show_time() {
  $("time-box").hidden = !scene.moves;
  if (!scene.moves || $("time").dataset.moving) return;
  [$("time").min, $("time").max] = scene.moves;
  $("time").value = scene.time;
  $("time-told").value = +scene.time.toPrecision(4);
}

// The scene's exposure is another one.
function expose(now) {
  if (now.auto !== scene.exposure.auto) $("auto-exposure").checked = now.auto;
  const is_new = now.stops !== scene.exposure.stops || now.auto !== scene.exposure.auto;
  scene.exposure = now;
  if (is_new) draw();
}

function edited(message) {
  $("back").disabled = !message.can_undo;
  $("again").disabled = !message.can_redo;
  keep.told(message.keep);
  if (message.scene) {
    const { camera: _, ...now } = message.scene;
    Object.assign(scene, now);
    if (message.renumbered) {
      picture.objects = right_picture.objects = hovered = null;  // they have the old numbers
      edits.renumber();
    }
    fill_tree();
    redraw.told(scene.options);
    notes.unit = scene.unit ?? "";
  }
  scene.samples = message.samples;
  scene.time = message.time;
  show_time();
  scene.backdrop = message.backdrop;
  expose(message.exposure);
  if (message.home) scene.home = message.home;
  forms.told(message.parts);
  edits.refresh();
  stage.dataset.edits = (+stage.dataset.edits || 0) + 1;
}

function begin(message) {
  const again = scene?.name === message.name, restarted = again && scene.session !== message.session;
  const before = scene?.exposure;
  scene = message;
  if (!again || restarted || before.auto !== scene.exposure.auto) $("auto-exposure").checked = scene.exposure.auto;
  const [low, high] = scene.bounds;
  center = mul(add(low, high), 0.5);
  radius = length(sub(high, low)) / 2 || 1;
  if (again && camera) {
    if (restarted) { choose(null, false); looked = ""; }  // the new program must know what this page looks at
    else camera_of(scene.camera);
  } else {
    camera = of_scene(scene.camera);
    // Orbiting turns about the world axis that is nearest to the picture's up.
    const up = unit(camera.up), axis = up.map(Math.abs).indexOf(Math.max(...up.map(Math.abs)));
    world_up = [0, 0, 0];
    world_up[axis] = Math.sign(up[axis]);
    past = []; future = []; chosen.clear();
    view_of_link();
  }
  notes.unit = scene.unit ?? "";
  edits.read_only = scene.read_only;
  document.body.classList.toggle("read-only", scene.read_only);
  denoises(scene.denoise);
  figure.begin(scene.overlays, scene.denoise, scene.samples);
  forms.begin(scene.lists);
  forms.told(scene.parts);
  forms.reset();
  $("back").disabled = !scene.can_undo;
  $("again").disabled = !scene.can_redo;
  keep.begin(scene);
  show_time();
  fill_tree();
  redraw.told(scene.options);
  look();
  draw();
}

// The program chose the camera of scenes without one for a picture of other sides: here it shows the whole scene too.
function of_scene(from) {
  const camera = new Camera(from), along = dot(sub(center, camera.eye), unit(camera.forward));
  if (!camera.parallel) camera.target = add(camera.eye, mul(unit(camera.forward), along > 0 ? along : radius));
  const { framed, ...home } = scene.home;
  const sides = [stage.clientWidth, stage.clientHeight], is_less = (i) => framed && sides[i] / Math.min(...sides) < framed[i] / Math.min(...framed);
  if ((is_less(0) || is_less(1)) && (from === scene.home || JSON.stringify(from) === JSON.stringify(home))) camera.hold(scene.bounds, sides);
  return camera;
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
  draw_notes();
  show_lens();
}

function show_lens() {
  if (!camera.separation && $("stereo").value !== "off") $("stereo").value = "off";
  if (camera.separation && $("stereo").value === "off") $("stereo").value = "sbs";
  $("pair").hidden = !camera.separation;
  // A number that is typed stays as it is.
  const put = (id, text) => { if (document.activeElement !== $(id) && !$(id).dataset.moving) $(id).value = text; };
  put("separation", +camera.separation.toPrecision(6));
  put("convergence", +camera.convergence.toPrecision(6));
  $("parallel").setAttribute("aria-pressed", String(camera.parallel));
  gizmo.draw(camera);
  put("fov", (camera.fov * 180 / Math.PI).toFixed(1));
  put("radius", +camera.lens_radius.toPrecision(6));
  put("focus", +camera.focal_distance.toPrecision(6));
  clip.draw();
}

const view_message = (width, height) => ({ type: "look", width, height, world_from_camera: camera.matrix(), fov: camera.fov, lens_radius: camera.lens_radius, focal_distance: camera.focal_distance, orthographic: camera.parallel ? camera.half() : 0, separation: camera.separation, convergence: camera.convergence, clip: camera.clip });

let looked = "";
function look() {
  if (!camera) return;
  const scale = window.devicePixelRatio || 1, most = 4096;
  const [across, down] = share(camera.separation > 0 ? $("stereo").value : "off");
  const width = Math.min(most, Math.max(1, Math.round(stage.clientWidth * scale / across))), height = Math.min(most, Math.max(1, Math.round(stage.clientHeight * scale / down)));
  const message = view_message(width, height);
  const text = JSON.stringify(message);
  edits.draw();
  draw_notes();
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
const home = () => change(() => { camera = of_scene(scene.home); });
const fit = () => change(() => camera.fit(center, radius));
// Frames what is selected, or everything.
function frame() {
  if (!edits.thing || !chosen.size) return fit();
  change(() => camera.fit(edits.center(), edits.size() * 1.2));
}
function along(name) {
  if (!camera) return;
  const axis = "xyz".indexOf(name[1]), from = [0, 0, 0];
  from[axis] = name[0] === "+" ? -1 : 1;
  const up = Math.abs(dot(from, world_up)) > 0.5 ? [0, 1, 0, 0].slice(axis === 1 ? 1 : 0).slice(0, 3) : world_up;
  change(() => camera.look(from, up, center, radius));
}
// Looks from a side that depends on which way is up: where z is, the front is -y; where y is, it is +z.
function side(name) {
  const up = "xyz"[world_up.map(Math.abs).indexOf(1)], opposite = (axis) => (axis[0] === "+" ? "-" : "+") + axis[1];
  const top = (world_up["xyz".indexOf(up)] > 0 ? "+" : "-") + up, front = { x: "+z", y: "+z", z: "-y" }[up], right = up === "x" ? "+y" : "+x";
  along({ top, below: opposite(top), front, rear: opposite(front), right, left: opposite(right) }[name]);
}
// A link's view is in its part behind #, which no server sees.
function view_of_link() {
  if (!location.hash.startsWith("#view=")) return;
  try { camera_of(JSON.parse(decodeURIComponent(location.hash.slice(6)))); } catch { tell(texts.bad_link); }
}
function copy_link() {
  const view = { world_from_camera: camera.matrix(), fov: camera.fov, lens_radius: camera.lens_radius, focal_distance: camera.focal_distance, orthographic: camera.parallel ? camera.half() : 0, clip: camera.clip };
  navigator.clipboard?.writeText(`${location.href.replace(/#.*/, "")}#view=${encodeURIComponent(JSON.stringify(view))}`).then(() => tell(texts.copied), (error) => tell(String(error)));
}

// --- The picture ---

const layout = () => camera?.separation > 0 ? $("stereo").value : "off";
const has_right = () => right_picture.view === picture.view && right_picture.width === picture.width && right_picture.height === picture.height;

// The exposure of the scene, or the picture's own, and that of the slider.
const exposure = () => +$("exposure").value + ($("auto-exposure").checked ? picture.metered() : scene.exposure.stops);

function draw() {
  const { width, height } = picture;
  if (!scene || !width) return;
  const stops = exposure(), shown = (of) => of.shown(stops, $("curve").value, scene.backdrop);
  const [across, down, bytes] = arranged(layout(), width, height, shown(picture), has_right() ? shown(right_picture) : null);
  picture_canvas.width = across;
  picture_canvas.height = down;
  picture_canvas.getContext("2d").putImageData(new ImageData(bytes, across, down), 0, 0);
  mark();
  const { share: done, seconds } = progress.sees(picture, scene.samples, scene.noise, performance.now() / 1000);
  $("state").textContent = picture.scale > 1 ? texts.coarse(picture, scene.device) : texts.state(picture, `${width} × ${height}`, scene.samples, scene.noise, seconds, scene.device);
  $("done").value = done;
  $("done").hidden = done >= 1;
  stage.dataset.samples = picture.scale > 1 ? 0 : picture.samples;
  stage.dataset.view = picture.view;
  stage.dataset.right = has_right() && right_picture.scale === 1 ? right_picture.samples : 0;
}

function mark() {
  if (picture.scale !== 1 && picture.width) { marks.getContext("2d").clearRect(0, 0, marks.width, marks.height); return; }
  if (!picture.width) return;
  const is_on = (chosen.size || hovered !== null) && picture.objects, shown = (of) => of.outline(chosen, hovered);
  const [width, height, bytes] = arranged(layout() === "anaglyph" ? "off" : layout(), picture.width, picture.height, is_on ? shown(picture) : new Uint8ClampedArray(4 * picture.width * picture.height),
    is_on && has_right() && right_picture.objects ? shown(right_picture) : null);
  marks.width = width;
  marks.height = height;
  if (is_on) marks.getContext("2d").putImageData(new ImageData(bytes, width, height), 0, 0);
}

// --- What is under the cursor ---

function pixel_at(event) {
  const box = stage.getBoundingClientRect(), scale = window.devicePixelRatio || 1;
  return view_pixel(layout(), picture.width, picture.height, [Math.floor((event.clientX - box.left) * scale), Math.floor((event.clientY - box.top) * scale)].map((v) => Math.max(0, v)));
}

// Returns what the picture's ids say is at a pixel, [object, primitive], where no object is null; null if it has no ids.
function known_at([x, y, eye]) {
  const of = eye ? right_picture : picture;
  if (!of.objects || of.scale !== 1 || x >= of.width || y >= of.height) return null;
  const i = y * of.width + x;
  return of.objects[i] < scene.thing_count ? [of.objects[i], of.primitives[i]] : [null, 0];
}

// Only one query runs at a time: the next one starts after the last answer.
function hover(pixel) {
  const over = known_at(pixel)?.[0] ?? null;
  if (over !== hovered) { hovered = over; mark(); }
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

function choose_all(ids, primitive = 0) {
  chosen.clear();
  for (const id of ids) chosen.add(id);
  let first = null;
  for (const item of $("tree").children) {
    const is_chosen = chosen.has(+item.dataset.id);
    item.setAttribute("aria-selected", is_chosen);
    if (is_chosen) first ??= item;
  }
  first?.scrollIntoView({ block: "nearest" });
  $("chosen-name").textContent = texts.chosen([...chosen].map((id) => scene.things[id]?.name ?? `#${id}`));
  edits.select([...chosen].sort((a, b) => a - b), primitive);
  mark();
}

function choose(id, more, primitive = 0) {
  const ids = new Set(more ? chosen : []);
  if (id !== null) ids.has(id) && more ? ids.delete(id) : ids.add(id);
  choose_all([...ids], primitive);
}

// The picture's ids answer at once. The program's answer is for the pixel's middle, and may differ at edges.
function click(event) {
  const pixel = pixel_at(event), more = event.shiftKey, { clientX, clientY } = event;
  if (tools.now === "inspect") inspect_at(pixel, clientX, clientY);
  const known = event.altKey || tools.now === "measure" || tools.now === "label" ? null : known_at(pixel);
  if (known) choose(known[0], more, known[1]);
  const { selection } = edits;
  ask(pixel, false, false, (told_of) => {
    const hit = told_of.crossings?.[0];
    if (event.altKey) return hit && change(() => { camera.focal_distance = Math.max(1e-6, dot(sub(hit.point, camera.eye), unit(camera.forward))); });
    if (tools.now === "measure") return hit && notes.measure(hit.point, more);
    if (tools.now === "label") return hit && notes.label(hit.point);
    const id = hit?.object_id ?? null, primitive = hit?.primitive ?? 0;
    if (!known) return choose(id, more, primitive);
    if ((known[0] !== id || known[1] !== primitive) && selection === edits.selection && !more) choose(id, false, primitive);
  });
}

function inspect_at(pixel, x, y) {
  ask(pixel, true, true, (told_of) => { if (told_of.crossings) inspector.show(told_of, x, y); });
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
    const name = Object.assign(document.createElement("span"), { textContent: thing.name });
    item.append(name, small);
    rows.push(item);
  });
  $("tree").replaceChildren(...rows);
  $("more").textContent = texts.more(rows.length, scene.thing_count);
}

// --- Mouse, touch and keys ---

const pointers = new Map();
let moved = 0, spread = 0, pressed = 0;
const pixel_length = () => 2 * camera.distance() * Math.tan(camera.fov / 2) / Math.min(stage.clientWidth, stage.clientHeight);

stage.addEventListener("pointerdown", (event) => {
  if (!camera) return;
  stage.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, event);
  if (pointers.size === 1) { moved = 0; remember(); }
  spread = 0;
  clearTimeout(pressed);
  if (event.pointerType === "touch" && pointers.size === 1) pressed = setTimeout(() => { if (moved < 4) { moved = Infinity; past.pop(); inspect_at(pixel_at(event), event.clientX, event.clientY); } }, 500);
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
  clearTimeout(pressed);
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

const arrows = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const press = (id) => () => { if (!$(id).hidden && !$(id).disabled) $(id).click(); };
const actions = {
  select: () => tools.take("select"), move: () => tools.take("move"), turn: () => tools.take("turn"), scale: () => tools.take("scale"), measure: () => tools.take("measure"), label: () => tools.take("label"), inspect: () => tools.take("inspect"),
  frame, all: fit, scene_camera: home, parallel: press("parallel"), ...Object.fromEntries(["front", "right", "top", "rear", "left", "below"].map((name) => [name, () => side(name)])),
  nearer: () => change(() => camera.dolly(0.9)), farther: () => change(() => camera.dolly(1 / 0.9)), last_view: () => undo(past, future), next_view: () => undo(future, past),
  undo: () => undo_edit(false), redo: () => undo_edit(true), add: () => forms.add_shape(forms.last_shape ?? forms.lists.shape[0], under_hit), duplicate: () => edits.duplicate(), delete: () => edits.remove(),
  hide: () => edits.hide(false), isolate: () => edits.hide(true), show_all: () => $("show-all").click(), denoise: press("denoise"), panel: () => panel.toggle(),
  nothing: () => { if (inspector.is_open) inspector.close(); else { choose(null, false); tools.take("select"); } }, help: () => $("keys").showModal(),
};
const changes = ["undo", "redo", "add", "duplicate", "delete", "hide", "isolate", "show_all", "move", "turn", "scale"];
document.addEventListener("keydown", (event) => {
  if (!camera || is_taken(event)) return;
  const way = arrows[event.key], action = action_of(event), is_free = event.target === stage || event.target === document.body;
  if (way && is_free && !event.ctrlKey && !event.altKey && !event.metaKey)
    change(() => event.shiftKey ? camera.pan(...mul(way, -40 * pixel_length())) : camera.orbit(0.08 * way[0], 0.08 * way[1], world_up));
  else if (action && !(scene.read_only && changes.includes(action))) actions[action]();
  else return;
  event.preventDefault();
});

$("parallel").onclick = () => { if (camera) change(() => { camera.parallel = !camera.parallel; }); };
$("hide").onclick = () => edits.hide(false);
$("isolate").onclick = () => edits.hide(true);
$("show-all").onclick = () => { if (!$("hidden-box").hidden) edit({ what: "show", hidden: null }); };
// Undone is what was asked for before, also if it waits.
const undo_edit = (again) => edits.after(() => say({ type: "undo", again }));
$("back").onclick = () => undo_edit(false);
$("again").onclick = () => undo_edit(true);
$("fit").onclick = fit;
$("home").onclick = home;
$("undo").onclick = () => undo(past, future);
$("redo").onclick = () => undo(future, past);
$("exposure").oninput = () => { $("stops").value = $("exposure").value; draw(); };
$("auto-exposure").onchange = draw;
$("curve").onchange = draw;
$("denoise").onclick = () => { const on = $("denoise").getAttribute("aria-pressed") !== "true"; denoises(on); say({ type: "denoise", on }); };
$("figure-open").onclick = () => { if (camera) figure.open(); };
$("exr").onclick = () => say({ type: "snapshot" });
$("png").onclick = () => picture_canvas.toBlob((blob) => save(blob, `${scene.name}.png`));
$("panel-button").onclick = () => panel.toggle();
for (const [id, text, keys, work] of [
  ["menu-save", "save_as", "Ctrl Shift S", () => keep.open()], ["discard", "discard", "", () => keep.drop()], ["menu-fit", "fit", "Home", fit], ["menu-home", "home", "0", home],
  ["menu-parallel", "parallel", "5", () => $("parallel").click()], ["menu-link", "link", "", copy_link], ["help", "keys", "?", () => $("keys").showModal()],
]) {
  const item = Object.assign(document.createElement("button"), { id, role: "menuitem", onclick: () => { if (camera) work(); } });
  item.append(texts[text], Object.assign(document.createElement("kbd"), { textContent: keys }));
  if (id === "menu-save" || id === "discard") item.classList.add("edits");
  $("menu").append(item);
}
menu($("menu-button"), $("menu"));
menu($("add-button"), $("add-menu"));
menu($("export-button"), $("export-menu"));
$("time").oninput = () => {
  const goes_on = $("time").dataset.moving === "1", time = +$("time").value;
  $("time").dataset.moving = "1";
  $("time-told").value = +time.toPrecision(4);
  edit({ what: "set", of: "film", field: "shutter opens", to: time }, goes_on);
};
$("time").onchange = () => { delete $("time").dataset.moving; };
const redraw = new Redraw({ edit: (what, done) => edit(what, false, done) });
const clip = new Clip({ camera: () => camera, bounds: () => scene.bounds, begin: remember, look });
const path = new Path({ views: () => kept, begin: remember, show: (next) => { camera = next; look(); }, save, name: () => keep.now.name || scene.name });
function fill_kept() {
  path.changed();
  $("kept").replaceChildren(...kept.map((view, i) => {
    const row = document.createElement("li"), go = document.createElement("button"), forget = document.createElement("button");
    Object.assign(go, { textContent: texts.saved_view(i + 1), onclick: () => change(() => { camera = view.copy(); }) });
    Object.assign(forget, { className: "icon", title: texts.forget_view(i + 1), onclick: () => { kept = kept.filter((other) => other !== view); fill_kept(); } });
    forget.setAttribute("aria-label", texts.forget_view(i + 1));
    forget.append(icon("close"));
    row.append(go, forget);
    return row;
  }));
}
$("keep").onclick = () => { if (camera) { kept.push(camera.copy()); fill_kept(); } };
function bounded(id, low, high, set) {
  const input = $(id);
  Object.assign(input.dataset, { low, high });
  input.onchange = () => {
    if (!camera) return;
    const trouble = trouble_with(input.value, 1), value = value_of(input.value);
    complain(input, trouble || (value < low || value > high ? texts.between(low, high) : ""));
    if (trouble || value < low || value > high) return;
    if (input.dataset.moving !== "1") remember();
    set(value);
    look();
  };
  scrubs(input.previousElementSibling, input);
}
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
// A window that moves to another screen may have other pixels, and the same size.
(function watch_pixels() {
  window.matchMedia(`(resolution: ${window.devicePixelRatio}dppx)`).addEventListener("change", () => { look(); watch_pixels(); }, { once: true });
})();
connect();
