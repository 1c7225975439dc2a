// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// A camera in the program's form: world_from_camera as columns right, up, forward and eye. It is left- or right-handed as in the
// file.
export const add = (a, b) => a.map((v, i) => v + b[i]);
export const sub = (a, b) => a.map((v, i) => v - b[i]);
export const mul = (a, s) => a.map((v) => v * s);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a) => Math.hypot(...a);
export const unit = (a) => mul(a, 1 / (length(a) || 1));
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// Rotates `v` about a unit axis (Rodrigues).
export function turned(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle), x = cross(axis, v), along = dot(axis, v) * (1 - c);
  return v.map((value, i) => value * c + x[i] * s + axis[i] * along);
}

export class Camera {
  constructor(from) {
    const m = from.world_from_camera, column = (i) => [m[i], m[4 + i], m[8 + i]];
    this.right = column(0); this.up = column(1); this.forward = column(2); this.eye = column(3);
    this.fov = from.fov; this.lens_radius = from.lens_radius; this.focal_distance = from.focal_distance;
    this.target = null;
    this.separation = from.separation ?? 0; this.convergence = from.convergence ?? 0;
    this.clip = from.clip ?? null;
    this.parallel = from.orthographic > 0;
    // This is the distance at which a perspective camera has the same frame.
    if (this.parallel) this.target = add(this.eye, mul(unit(this.forward), from.orthographic / Math.tan(this.fov / 2)));
  }
  copy() {
    const out = Object.create(Camera.prototype);
    return Object.assign(out, this, { right: [...this.right], up: [...this.up], forward: [...this.forward], eye: [...this.eye], target: this.target && [...this.target] });
  }
  matrix() {
    return [0, 1, 2].flatMap((i) => [this.right[i], this.up[i], this.forward[i], this.eye[i]]).concat([0, 0, 0, 1]);
  }
  // Returns half the shorter side of the view at the target's distance, where both kinds of camera have the same frame.
  half() { return this.distance() * Math.tan(this.fov / 2); }
  distance() { return length(sub(this.target, this.eye)); }
  turn(axis, angle) {
    for (const name of ["right", "up", "forward"]) this[name] = turned(this[name], axis, angle);
    this.eye = add(this.target, turned(sub(this.eye, this.target), axis, angle));
  }
  // Rotates by angles about the world's up axis and the picture's right axis, but never over the pole.
  orbit(about, over, world_up) {
    const forward = unit(this.forward), up = Math.asin(Math.max(-1, Math.min(1, dot(forward, world_up))));
    const hand = Math.sign(dot(cross(this.right, this.up), this.forward)) || 1;
    const limit = Math.PI / 2 - 0.01, next = Math.max(-limit, Math.min(limit, up - over));
    this.turn(world_up, hand * about);
    if (Math.abs(up) < limit || Math.abs(next) < Math.abs(up)) this.turn(unit(this.right), -hand * (next - up));
  }
  pan(right, up) {
    const by = add(mul(unit(this.right), right), mul(unit(this.up), up));
    this.eye = add(this.eye, by);
    this.target = add(this.target, by);
  }
  // Steps back until the box between two corners lies in a view of these sides.
  hold([low, high], sides) {
    const edge = sides.map((side) => Math.tan(this.fov / 2) * side / Math.min(...sides)), axes = [this.right, this.up, this.forward].map(unit);
    let from = 0;
    for (let k = 0; k < 8; ++k) {
      const at = sub([0, 1, 2].map((i) => (k >> i & 1 ? high : low)[i]), this.eye), [x, y, z] = axes.map((axis) => dot(at, axis));
      from = Math.max(from, ...[x / edge[0], y / edge[1]].map((depth) => Math.abs(depth) - (this.parallel ? this.distance() : z)));
    }
    this.eye = sub(this.eye, mul(axes[2], from));
  }
  dolly(factor) { this.eye = add(this.target, mul(sub(this.eye, this.target), factor)); }
  // Looks along `forward`, with `up` upward if possible, from a distance at which a ball fills the picture.
  look(forward, up, center, radius) {
    const hand = Math.sign(dot(cross(this.right, this.up), this.forward)) || 1;
    this.forward = unit(forward);
    this.right = mul(unit(cross(up, this.forward)), hand);
    this.up = unit(mul(cross(this.forward, this.right), hand));
    this.fit(center, radius);
  }
  fit(center, radius) {
    this.target = [...center];
    this.eye = sub(center, mul(unit(this.forward), radius / Math.sin(this.fov / 2)));
  }
}
