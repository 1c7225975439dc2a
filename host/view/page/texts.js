// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Every word of the page, for translation.
export const texts = {
  fit: "Fit all", home: "Scene's camera", undo: "Last view", redo: "Next view", keep: "Save view", kept: "Saved views", axis: "Look along",
  axes: { "": "Look along…", "+x": "from +x", "-x": "from −x", "+y": "from +y", "-y": "from −y", "+z": "from +z", "-z": "from −z" },
  exposure: "Exposure", curve: "Tone", curves: { film: "film", srgb: "sRGB", linear: "linear" },
  png: "PNG", exr: "EXR", help: "? Help", things: "Scene", search: "Search by name", lens: "Lens",
  fov: "Field of view, degrees", radius: "Lens radius", focus: "Distance in focus",
  edit: "Selected", duplicate: "Duplicate", delete: "Delete", back: "Undo", again: "Redo", surface: "Surface", material: "Material",
  move: "Move by", turn: "Turn about axis", scale: "Scale by", p0: "End 0", p1: "End 1", radius0: "Radius 0", radius1: "Radius 1",
  all_surfaces: "all", surface_number: (i) => String(i), mixed: "several",
  inspector: "Ray inspector", ask: "Click in the picture: every crossing along that ray.",
  keys: "Mouse, touch and keys", close: "Close",
  picture: "The scene as it is rendered. Arrow keys orbit, plus and minus come nearer and go away.",
  more: (shown, all) => `${shown} of ${all}`,
  state: (p, size, target, device) => `${p.samples} of ${target} samples, ${size}, ${p.samples > 1 ? `noise ${+(100 * p.noise).toPrecision(2)} %, ` : ""}${device}`,
  coarse: (p, device) => `coarse (1 of ${p.scale * p.scale} pixels), ${device}`,
  nothing: "nothing", lost: "The connection to the program is lost. Trying again…", closed: "This address is no longer served. Start `caplet view` again and open the address that it prints.",
  under: (h) => `${h.object} · primitive ${h.primitive} · surface ${h.surface} · ${h.material} · t ${h.t.toPrecision(6)} · (${h.point.map((v) => v.toPrecision(5)).join(", ")}) · normal (${h.normal.map((v) => v.toFixed(3)).join(", ")})`,
  crossings: { t: "t", side: "", object: "solid", surface: "surface", material: "material", witness: "witness t" },
  entering: "enters", leaving: "leaves",
  intervals: (n) => `${n} crossings along the ray, nearest at the left`,
  list: [["drag", "orbit"], ["right or Shift drag", "pan"], ["wheel, pinch, + −", "come nearer, go away"], ["Ctrl wheel", "zoom (field of view)"],
    ["click", "select, and inspect the ray"], ["Shift click", "select several"], ["double click", "turn about this point"],
    ["Alt click", "focus here"], ["arrows", "orbit (Shift: pan)"], ["f", "fit all"], ["h", "scene's camera"], ["z, y", "last view, next view"],
    ["1 to 6", "look along an axis"], ["u, r", "undo, redo a change"], ["d, Del", "duplicate, delete"], ["handles", "move; yellow: an end (Shift: in steps)"], ["Esc", "select nothing"], ["?", "this list"]],
};
