// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Numbers as people type them: with + - * / and parentheses, and dragged sideways on their names.
import { texts } from "./texts.js";

/// Returns the value of an arithmetic expression; NaN if it is none.
export function value_of(text) {
  const pieces = text.match(/\s*(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?|[-+*/()])/gy)?.map((piece) => piece.trim()) ?? [];
  if (pieces.join("") !== text.replace(/\s/g, "")) return NaN;
  let at = 0;
  const factor = () => {
    const piece = pieces[at++];
    if (piece === "-") return -factor();
    if (piece === "+") return factor();
    if (piece !== "(") return piece === undefined ? NaN : Number(piece);
    const inside = sum();
    return pieces[at++] === ")" ? inside : NaN;
  };
  const product = () => {
    let out = factor();
    while (pieces[at] === "*" || pieces[at] === "/") out = pieces[at++] === "*" ? out * factor() : out / factor();
    return out;
  };
  const sum = () => {
    let out = product();
    while (pieces[at] === "+" || pieces[at] === "-") out = pieces[at++] === "+" ? out + product() : out - product();
    return out;
  };
  const out = sum();
  return at === pieces.length ? out : NaN;
}

/// Returns numbers that are separated by spaces or commas; a single one may have spaces in it.
export function values_of(text, count = 0) {
  if (count === 1) return [value_of(text)];
  return text.trim().split(/[\s,]+/).map(value_of);
}

/// Returns why a text is not `count` finite numbers, or nothing.
export function trouble_with(text, count) {
  const values = values_of(text, count);
  if (values.length !== count) return texts.wants_numbers(count, values.length);
  const wrong = values.findIndex((v) => !Number.isFinite(v));
  return wrong < 0 ? "" : texts.no_number(count === 1 ? text.trim() : text.trim().split(/[\s,]+/)[wrong]);
}

/// Says at an input what is wrong with it; an empty text takes that away.
export function complain(input, text) {
  let note = input.parentElement.querySelector(":scope > .error");
  if (!note && text) {
    note = Object.assign(document.createElement("small"), { className: "error", id: `${input.id}-error` });
    note.setAttribute("role", "alert");
    input.parentElement.append(note);
  }
  if (note) { note.textContent = text; note.hidden = !text; }
  if (!text) { input.removeAttribute("aria-invalid"); input.removeAttribute("aria-describedby"); return; }
  input.setAttribute("aria-invalid", "true");
  input.setAttribute("aria-describedby", note.id);
}

/// Lets the name of a number be dragged: one step a pixel, a tenth with Shift, ten with Ctrl. Escape takes the drag back.
export function scrubs(label, input) {
  label.classList.add("scrubs");
  label.addEventListener("pointerdown", (start) => {
    const first = value_of(input.value);
    if (!Number.isFinite(first) || start.button !== 0) return;
    start.preventDefault();
    label.setPointerCapture(start.pointerId);
    const step = (Math.abs(first) || 1) / 200;
    let value = first, x = start.clientX;
    const put = (to) => {
      const low = +(input.dataset.low ?? -Infinity), high = +(input.dataset.high ?? Infinity);
      value = Math.min(high, Math.max(low, to));
      input.value = String(+(input.dataset.whole ? Math.round(value) : value).toPrecision(6));
      input.dispatchEvent(new Event("change", { bubbles: true }));
      input.dataset.moving = "1";
    };
    const go = (move) => {
      if (move.clientX === x) return;
      put(value + (move.clientX - x) * step * (move.shiftKey ? 0.1 : move.ctrlKey ? 10 : 1));
      x = move.clientX;
    };
    const escape = (event) => { if (event.key === "Escape") { event.stopPropagation(); put(first); end(); } };
    const end = () => {
      // A drag is no click, which would begin typing.
      if (input.dataset.moving) label.addEventListener("click", (event) => event.preventDefault(), { once: true });
      label.removeEventListener("pointermove", go);
      document.removeEventListener("keydown", escape, true);
      delete input.dataset.moving;
    };
    label.addEventListener("pointermove", go);
    label.addEventListener("pointerup", end, { once: true });
    label.addEventListener("pointercancel", end, { once: true });
    document.addEventListener("keydown", escape, true);
  });
}
