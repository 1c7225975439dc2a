// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// The page's icons: strokes on a grid of 16 pixels, in the colour of the text.
const paths = {
  menu: "M2 4h12M2 8h12M2 12h12",
  undo: "M6 3L3 6l3 3M3 6h6.5a3.5 3.5 0 0 1 0 7H7",
  redo: "M10 3l3 3-3 3M13 6H6.5a3.5 3.5 0 0 0 0 7H9",
  add: "M8 3v10M3 8h10",
  box: "M8 2l5.5 3v6L8 14l-5.5-3V5zM2.5 5L8 8l5.5-3M8 8v6",
  fit: "M2 6V2h4M10 2h4v4M14 10v4h-4M6 14H2v-4M8 6a2 2 0 1 0 .01 0",
  home: "M2 8l6-5.5L14 8M4 7v6.5h8V7",
  denoise: "M8 2l1.3 4.7L14 8l-4.7 1.3L8 14l-1.3-4.7L2 8l4.7-1.3zM13 2v2.4M11.8 3.2h2.4",
  save: "M2.5 2.5h9l2 2v9h-11zM5 2.5V6h5.5V2.5M5 13.5V9.5h6v4",
  picture: "M2 3h12v10H2zM2 11l3.5-3.5L9 11l2-2 3 3M10.5 6a1 1 0 1 0 .01 0",
  panel: "M2 3h12v10H2zM10 3v10",
  select: "M3.5 2l9 5.2-4 .9-1.6 4z",
  move: "M8 1.8v12.4M1.8 8h12.4M6.3 3.5L8 1.8l1.7 1.7M6.3 12.5L8 14.2l1.7-1.7M3.5 6.3L1.8 8l1.7 1.7M12.5 6.3L14.2 8l-1.7 1.7",
  turn: "M13 8a5 5 0 1 1-1.6-3.7M13.2 1.8v3h-3",
  scale: "M2.5 8v5.5H8V8zM9 2.5h4.5V7M13.5 2.5L9.5 6.5",
  label: "M3 4.2V3h10v1.2M8 3v10M6.2 13h3.6",
  measure: "M1.8 10.5L10.5 1.8l3.7 3.7-8.7 8.7zM4.2 8.1l1.6 1.6M6.4 5.9l1 1M8.6 3.7l1.6 1.6",
  inspect: "M1.8 14.2L5 11M11 5l3.2-3.2M8 3.5a4.5 4.5 0 1 0 .01 0M6.2 9.8a.6.6 0 1 0 .01 0M9.8 6.2a.6.6 0 1 0 .01 0",
  left: "M10 3L5 8l5 5",
  right: "M6 3l5 5-5 5",
  copy: "M5.5 5.5h8v8h-8zM3.5 10.5h-1v-8h8v1",
  close: "M3.5 3.5l9 9M12.5 3.5l-9 9",
  eye: "M1.5 8S4 3.5 8 3.5 14.5 8 14.5 8 12 12.5 8 12.5 1.5 8 1.5 8zM8 6.2a1.8 1.8 0 1 0 .01 0",
  help: "M8 1.8a6.2 6.2 0 1 0 .01 0M6 6.2a2 2 0 1 1 2.8 1.9c-.6.3-.8.7-.8 1.3M8 11.6v.4",
};

/// Returns an SVG element; readers of the screen skip it.
export function icon(name) {
  const out = document.createElementNS("http://www.w3.org/2000/svg", "svg"), path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  out.setAttribute("viewBox", "0 0 16 16");
  out.setAttribute("aria-hidden", "true");
  path.setAttribute("d", paths[name]);
  out.append(path);
  return out;
}
