// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// The clipping plane of the view: the direction that is cut away, and where. It is part of the camera, so that undo, saved views
// and links have it.
import { dot, mul, unit } from "./camera.js";
import { texts } from "./texts.js";

const AXES = { x: [1, 0, 0], "-x": [-1, 0, 0], y: [0, 1, 0], "-y": [0, -1, 0], z: [0, 0, 1], "-z": [0, 0, -1] };

// Returns the least and the greatest dot(normal, p) of a box.
export function extent(bounds, normal) {
  const ends = normal.map((n, i) => [n * bounds[0][i], n * bounds[1][i]]);
  return [ends.reduce((sum, of) => sum + Math.min(...of), 0), ends.reduce((sum, of) => sum + Math.max(...of), 0)];
}

// Returns the name in the list of a plane's direction: "off", an axis, or "view" for any other.
export function name_of(clip) {
  if (!clip) return "off";
  return Object.keys(AXES).find((name) => dot(AXES[name], clip.normal) > 1 - 1e-9) ?? "view";
}

// Returns the plane that keeps `share` of a box, from 0 to 1. `forward` is the camera's.
export function plane(name, share, bounds, forward) {
  if (name === "off") return null;
  const normal = AXES[name] ?? mul(unit(forward), -1), [low, high] = extent(bounds, normal);
  return { normal, offset: low + share * (high - low) };
}

export function share_of(clip, bounds) {
  const [low, high] = extent(bounds, clip.normal);
  return Math.max(0, Math.min(1, (clip.offset - low) / (high - low || 1)));
}

export class Clip {
  // `camera` returns the camera; `bounds` the scene's box; `begin` is called before a change, and `look` after it.
  constructor({ camera, bounds, begin, look }) {
    Object.assign(this, { camera, bounds });
    const find = (id) => document.getElementById(id);
    this.direction = find("clip");
    this.share = find("clip-share");
    this.box = find("clip-box");
    this.told = find("clip-told");
    for (const name of ["off", "view", ...Object.keys(AXES)]) this.direction.add(new Option(texts.clips[name] ?? name, name));
    this.direction.onchange = () => {
      if (!this.camera()) return;
      begin();
      this.camera().clip = plane(this.direction.value, this.camera().clip ? share_of(this.camera().clip, this.bounds()) : 0.5, this.bounds(), this.camera().forward);
      look();
    };
    let moves = false;
    this.share.oninput = () => {
      const camera = this.camera();
      if (!camera?.clip) return;
      if (!moves) begin();
      moves = true;
      const { normal } = camera.clip, [low, high] = extent(this.bounds(), normal);
      camera.clip = { normal, offset: low + this.share.value / 100 * (high - low) };
      look();
    };
    this.share.onchange = () => { moves = false; };
  }
  // Shows the camera's plane.
  draw() {
    const { clip } = this.camera();
    this.direction.value = name_of(clip);
    this.box.hidden = !clip;
    if (!clip) return;
    const share = Math.round(1000 * share_of(clip, this.bounds())) / 10;
    if (+this.share.value !== share) this.share.value = share;
    const name = name_of(clip), at = name.startsWith("-") ? -clip.offset : clip.offset;
    this.told.value = name === "view" ? `${share} %` : `${name.replace("-", "")} = ${+at.toPrecision(4)}`;
  }
}
