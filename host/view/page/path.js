// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// A camera's way through saved views: played in the page, and saved as poses with times for `caplet render --poses`. Both are
// the same curve (host/present/smooth_curve.h).
import { add, cross, dot, length, mul, sub, unit } from "./camera.js";
import { texts } from "./texts.js";

const line = {
  towards: (from, to) => sub(to, from),
  moved: (from, by, factor) => add(from, mul(by, factor)),
};
// Unit vectors; `towards` is a tangent whose length is the angle.
const sphere = {
  towards(from, to) {
    const cosine = dot(from, to), across = sub(to, mul(from, cosine)), sine = length(across);
    return mul(across, sine > 1e-12 ? Math.atan2(sine, cosine) / sine : 1);
  },
  moved(from, by, factor) {
    const angle = length(by);
    return unit(add(mul(from, Math.cos(factor * angle)), mul(unit(by), Math.sin(factor * angle))));
  },
};

// Returns the point of a smooth curve through `points`, at 0, 1, 2 ...
export function point_at(space, points, time) {
  const last = points.length - 1, i = Math.max(0, Math.min(Math.floor(time), last - 1)), u = Math.max(0, Math.min(time - i, 1));
  if (last === 0) return points[0];
  const velocity = (k) => {
    const on = k < last ? space.towards(points[k], points[k + 1]) : null, back = k > 0 ? space.towards(points[k], points[k - 1]) : null;
    if (!on || !back) return on ?? mul(back, -1);
    return length(on) && length(back) ? mul(sub(on, back), 0.5) : mul(on, 0);
  };
  let curve = [points[i], space.moved(points[i], velocity(i), 1 / 3), space.moved(points[i + 1], velocity(i + 1), -1 / 3), points[i + 1]];
  while (curve.length > 1) curve = curve.slice(1).map((b, k) => space.moved(curve[k], space.towards(curve[k], b), u));
  return curve[0];
}

const target_of = (view) => view.target ?? add(view.eye, unit(view.forward));
const away_of = (view) => sub(view.eye, target_of(view));

// Returns the camera at a time: what the views say at 0, 1, 2 ... All else is the first view's.
export function camera_at(views, time) {
  const through = (space, of) => point_at(space, views.map(of), time);
  const out = views[0].copy(), hand = Math.sign(dot(cross(out.right, out.up), out.forward)) || 1;
  out.target = through(line, target_of);
  const away = through(sphere, (view) => unit(away_of(view))), up = through(sphere, (view) => unit(view.up));
  out.eye = add(out.target, mul(away, Math.exp(through(line, (view) => [Math.log(length(away_of(view)))])[0])));
  out.fov = through(line, (view) => [view.fov])[0];
  out.forward = mul(away, -1);
  out.right = mul(unit(cross(up, out.forward)), hand);
  out.up = unit(mul(cross(out.forward, out.right), hand));
  return out;
}

// Returns poses with times, a line for each view, `seconds` apart.
export function poses_of(views, seconds) {
  return views.map((view, i) => `${JSON.stringify({ time: i * seconds, camera: { eye: view.eye, target: target_of(view), up: unit(view.up), fov: view.fov * 180 / Math.PI } })}\n`).join("");
}

export class Path {
  // `views` returns the saved views; `show` draws a camera, and `begin` is called before the first.
  constructor({ views, begin, show, save, name }) {
    Object.assign(this, { views, begin, show });
    this.row = document.getElementById("path");
    this.button = document.getElementById("play");
    this.seconds = document.getElementById("path-seconds");
    this.button.onclick = () => this.playing ? this.stop() : this.play();
    document.getElementById("save-path").onclick = () => save(new Blob([poses_of(views(), this.each())]), `${name()}.path.jsonl`);
    for (const event of ["pointerdown", "wheel", "keydown"]) document.addEventListener(event, ({ target }) => { if (target !== this.button) this.stop(); }, { capture: true, passive: true });
    this.changed();
  }
  each() { return Math.max(0.1, Math.min(Number(this.seconds.value) || 2, 600)); }
  changed() { this.stop(); this.row.hidden = this.views().length < 2; }
  play() {
    const views = this.views(), each = this.each() * 1000;
    this.begin();
    let began = null;
    const step = (now) => {
      began ??= now;
      const time = (now - began) / each;
      this.show(camera_at(views, time));
      if (time >= views.length - 1) this.stop();
      else this.playing = requestAnimationFrame(step);
    };
    this.playing = requestAnimationFrame(step);
    this.button.textContent = texts.stop;
  }
  stop() {
    cancelAnimationFrame(this.playing);
    this.playing = 0;
    this.button.textContent = texts.play;
  }
}
