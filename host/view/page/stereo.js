// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Shows two pictures as one: side by side, one above the other, or red of the left with green and blue of the right.
export const LAYOUTS = ["off", "sbs", "over-under", "anaglyph"];

// Returns the share of the stage that a view has, across and down.
export const share = (layout) => [layout === "sbs" ? 2 : 1, layout === "over-under" ? 2 : 1];

// Returns [width, height, bytes] of the combined R G B A, of equally sized pictures; the left stands for a missing right one.
export function arranged(layout, width, height, left, right) {
  if (layout === "off") return [width, height, left];
  right ??= left;
  if (layout === "anaglyph") {
    const out = right.slice();
    for (let i = 0; i < out.length; i += 4) out[i] = left[i];
    return [width, height, out];
  }
  if (layout === "over-under") {
    const out = new Uint8ClampedArray(2 * left.length);
    out.set(left);
    out.set(right, left.length);
    return [width, 2 * height, out];
  }
  const out = new Uint8ClampedArray(2 * left.length), row = 4 * width;
  for (let y = 0; y < height; ++y) {
    out.set(left.subarray(y * row, (y + 1) * row), 2 * y * row);
    out.set(right.subarray(y * row, (y + 1) * row), (2 * y + 1) * row);
  }
  return [2 * width, height, out];
}

// Converts a pixel of the whole to a pixel of a view, and says which view.
export function view_pixel(layout, width, height, [x, y]) {
  if (layout === "sbs" && x >= width) return [x - width, y, 1];
  if (layout === "over-under" && y >= height) return [x, y - height, 1];
  return [x, y, 0];
}
