// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// This table says what each key does; the help lists it.
export const KEYS = [
  ["select", "V"], ["move", "G"], ["turn", "R"], ["scale", "S"], ["measure", "M"], ["label", "T"], ["inspect", "I"],
  ["frame", "F"], ["all", "Home"], ["scene_camera", "0"], ["parallel", "5"],
  ["front", "1"], ["right", "3"], ["top", "7"], ["rear", "Shift 1"], ["left", "Shift 3"], ["below", "Shift 7"],
  ["nearer", "+", "="], ["farther", "-"], ["last_view", ","], ["next_view", "."],
  ["undo", "Ctrl Z"], ["redo", "Ctrl Shift Z", "Ctrl Y"], ["add", "Shift A"], ["duplicate", "Ctrl D", "Shift D"], ["delete", "Delete", "X"],
  ["hide", "H"], ["isolate", "Shift H"], ["show_all", "Alt H"],
  ["denoise", "D"], ["panel", "N"], ["nothing", "Escape"], ["help", "?"],
];
const actions = new Map(KEYS.flatMap(([action, ...keys]) => keys.map((key) => [key, action])));

/// Returns the action of a key event, or nothing.
export function action_of(event) {
  const digit = /^(?:Digit|Numpad)(\d)$/.exec(event.code ?? "")?.[1];
  const is_letter = /^[a-z]$/i.test(event.key), key = digit && event.key !== "=" ? digit : is_letter ? event.key.toUpperCase() : event.key;
  const shifts = event.shiftKey && (is_letter || digit || key.length > 1);
  return actions.get(`${event.ctrlKey || event.metaKey ? "Ctrl " : ""}${event.altKey ? "Alt " : ""}${shifts ? "Shift " : ""}${key}`) ?? actions.get(event.ctrlKey || event.altKey ? "" : event.key);
}

/// Returns whether keys belong to what has the focus, as to a field that is typed in.
export function is_taken(event) {
  const of = event.target;
  if (document.querySelector("dialog[open]")) return true;
  if (of.closest?.("[role=menu]")) return true;
  return of.matches?.("select, option, textarea, input:not([type=range], [type=checkbox])") ?? false;
}
