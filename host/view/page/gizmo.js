// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// The axes of the world at the picture's corner; a click at a tip looks from there.
import { dot, unit } from "./camera.js";
import { texts } from "./texts.js";

const NS = "http://www.w3.org/2000/svg", COLORS = { x: "#e5484d", y: "#46a758", z: "#3e63dd" };
const make = (name, attributes) => {
  const out = document.createElementNS(NS, name);
  for (const [key, value] of Object.entries(attributes)) out.setAttribute(key, value);
  return out;
};

export class Gizmo {
  /// `look_from` receives "+x" and so on.
  constructor(svg, look_from) {
    this.svg = svg;
    svg.setAttribute("aria-label", texts.axis);
    this.tips = ["+x", "-x", "+y", "-y", "+z", "-z"].map((name) => {
      const color = COLORS[name[1]], group = make("g", { role: "button", tabindex: 0, "aria-label": texts.axes[name] });
      const line = make("line", { stroke: color, x1: 0, y1: 0 }), ball = make("circle", { r: 8, stroke: color, fill: name[0] === "+" ? color : "#0008" }), text = make("text", {});
      if (name[0] === "+") { text.textContent = name[1].toUpperCase(); group.append(line); }
      group.append(ball, text);
      group.addEventListener("click", () => look_from(name));
      group.addEventListener("keydown", (event) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); look_from(name); } });
      svg.append(group);
      return { name, line, ball, text, group };
    });
  }
  draw(camera) {
    const right = unit(camera.right), up = unit(camera.up), forward = unit(camera.forward);
    for (const tip of this.tips) {
      const axis = [0, 0, 0];
      axis["xyz".indexOf(tip.name[1])] = tip.name[0] === "+" ? 1 : -1;
      const x = 28 * dot(axis, right), y = -28 * dot(axis, up);
      tip.depth = dot(axis, forward);
      tip.line.setAttribute("x2", x); tip.line.setAttribute("y2", y);
      tip.ball.setAttribute("cx", x); tip.ball.setAttribute("cy", y);
      tip.text.setAttribute("x", x); tip.text.setAttribute("y", y);
    }
    // Near tips are drawn last; nodes that are in order stay, so that none loses the focus.
    const order = [...this.tips].sort((a, b) => b.depth - a.depth).map((tip) => tip.group);
    if (order.some((group, i) => this.svg.children[i] !== group) && !this.svg.contains(document.activeElement)) this.svg.replaceChildren(...order);
  }
}
