// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Decodes the program's pictures (docs/viewer.md) and displays them.
const TILE = 64, WHOLE = 1, IDS = 2, DENOISED = 8;

const float_of_half = new Float32Array(65536);
for (let h = 0; h < 65536; ++h) {
  const exponent = h >> 10 & 31, fraction = h & 1023;
  float_of_half[h] = (h & 32768 ? -1 : 1) * (exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : 2 ** -24 * fraction);
}
const STEPS = 4096, byte_of = new Uint8Array(STEPS + 1);  // sRGB transfer
for (let i = 0; i <= STEPS; ++i) {
  const v = i / STEPS;
  byte_of[i] = Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export class Picture {
  constructor() { this.width = this.height = 0; this.color = null; this.objects = this.primitives = null; this.view = 0; this.scale = 1; this.samples = 0; this.noise = 0; this.is_denoised = false; }

  // Takes a message; messages must be passed in order, one at a time.
  async take(buffer) {
    const head = new DataView(buffer, 0, 40), at = (i) => head.getUint32(4 * i, true);
    if (at(0) !== 0x464c5043) return false;
    const [view, width, height, scale, samples] = [at(1), at(2), at(3), at(4), at(5)], flags = at(7), count = at(8);
    const data = await inflated(new Uint8Array(buffer, 40));
    if (flags & WHOLE) { this.width = width; this.height = height; this.color = new Uint16Array(3 * width * height); }
    if (view !== this.view || scale !== this.scale) this.objects = this.primitives = null;
    Object.assign(this, { view, scale, samples, noise: head.getFloat32(24, true), is_denoised: (flags & DENOISED) > 0 });
    const tiles = new DataView(data.buffer, data.byteOffset, 4 * count), across = Math.ceil(width / TILE);
    const boxes = [];
    let pixels = 0;
    for (let i = 0; i < count; ++i) {
      const tile = tiles.getUint32(4 * i, true), x = tile % across * TILE, y = Math.floor(tile / across) * TILE;
      boxes.push([x, y, Math.min(x + TILE, width), Math.min(y + TILE, height)]);
      pixels += (boxes[i][2] - x) * (boxes[i][3] - y);
    }
    let place = 4 * count, word = 0;
    const high = place, low = place + 3 * pixels;
    let k = 0;
    for (let c = 0; c < 3; ++c)
      for (const [x0, y0, x1, y1] of boxes)
        for (let y = y0; y < y1; ++y)
          for (let x = x0, o = 3 * (y * width + x0) + c; x < x1; ++x, ++k, o += 3) {
            word = word + (data[high + k] << 8 | data[low + k]) & 65535;
            this.color[o] = word;
          }
    place += 6 * pixels;
    if (flags & IDS) {
      const n = width * height;
      for (const name of ["objects", "primitives"]) {
        const out = this[name] = new Uint32Array(n);
        let id = 0;
        for (let i = 0; i < n; ++i) {
          id = id + ((data[place + i] << 24 | data[place + n + i] << 16 | data[place + 2 * n + i] << 8 | data[place + 3 * n + i]) >>> 0) >>> 0;
          out[i] = id;
        }
        place += 4 * n;
      }
    }
    return true;
  }

  // Returns R G B A bytes for the screen. "film": as in the program's previews (docs/output.md).
  shown(exposure, curve) {
    const n = this.width * this.height, out = new Uint8ClampedArray(4 * n), gain = 2 ** exposure, color = this.color;
    for (let i = 0; i < n; ++i) {
      let r = gain * float_of_half[color[3 * i]], g = gain * float_of_half[color[3 * i + 1]], b = gain * float_of_half[color[3 * i + 2]];
      if (curve === "film") {
        const m = Math.max(r, g, b);
        if (m > 0.5) {
          const to = 1 - Math.exp(-(2 * m - 1)) / 2, white = 1 - 1 / (1 + (m - to) / 8), s = to / m * (1 - white), w = to * white;
          r = r * s + w; g = g * s + w; b = b * s + w;
        }
      }
      if (curve === "linear") {
        out[4 * i] = 255 * r; out[4 * i + 1] = 255 * g; out[4 * i + 2] = 255 * b;
      } else {
        out[4 * i] = byte_of[Math.min(STEPS, r * STEPS + 0.5) | 0]; out[4 * i + 1] = byte_of[Math.min(STEPS, g * STEPS + 0.5) | 0];
        out[4 * i + 2] = byte_of[Math.min(STEPS, b * STEPS + 0.5) | 0];
      }
      out[4 * i + 3] = 255;
    }
    return out;
  }

  // Marks where things of `chosen` (object ids) end: their pixels next to others.
  outline(chosen) {
    const { width, height, objects } = this, out = new Uint8ClampedArray(4 * width * height);
    if (!objects) return out;
    const is = (x, y) => x >= 0 && y >= 0 && x < width && y < height && chosen.has(objects[y * width + x]);
    for (let y = 0; y < height; ++y)
      for (let x = 0; x < width; ++x) {
        const i = y * width + x;
        if (!chosen.has(objects[i])) continue;
        const o = objects[i], near = (dx, dy) => is(x + dx, y + dy) && objects[(y + dy) * width + x + dx] === o;
        if (near(1, 0) && near(-1, 0) && near(0, 1) && near(0, -1)) continue;
        out.set([255, 140, 60, 255], 4 * i);
      }
    return out;
  }
}
