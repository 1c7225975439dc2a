// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Decodes the program's pictures (docs/viewer.md) and displays them.
const TILE = 64, WHOLE = 1, IDS = 2, DENOISED = 8, ALPHA = 16;

const NOTHING = 0xffffffff;  // the id of what is not an object
const BINS = 16, STOPS = 80;  // of the exposure meter: bins a stop, stops in all
const CHECKS = [[0.32, 0.32, 0.32], [0.6, 0.6, 0.6]];  // under what is transparent

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

// Returns sums over 5 x 5 pixels (fewer at the edge) of one of three interleaved channels.
function box_sums(values, width, height) {
  const rows = new Float32Array(width * height), out = new Float32Array(width * height), reach = 2;
  const pass = (from, to, count, step, lines, stride) => {
    for (let line = 0; line < lines; ++line) {
      let sum = 0;
      const at = (i) => from[line * stride + i * step];
      for (let i = 0; i < Math.min(reach, count); ++i) sum += at(i);
      for (let i = 0; i < count; ++i) {
        if (i + reach < count) sum += at(i + reach);
        if (i > reach) sum -= at(i - reach - 1);
        to[line * stride + i * step] = sum;
      }
    }
  };
  pass(values, rows, width, 1, height, width);
  pass(rows, out, height, width, width, 1);
  return out;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export class Picture {
  constructor() { this.width = this.height = 0; this.color = this.alpha = null; this.objects = this.primitives = null; this.view = 0; this.scale = 1; this.samples = 0; this.noise = 0; this.is_denoised = false; }

  // Takes a message; messages must be passed in order, one at a time.
  async take(buffer) {
    const head = new DataView(buffer, 0, 40), at = (i) => head.getUint32(4 * i, true);
    if (at(0) !== 0x464c5043) return false;
    const [view, width, height, scale, samples] = [at(1), at(2), at(3), at(4), at(5)], flags = at(7), count = at(8);
    const data = await inflated(new Uint8Array(buffer, 40));
    if (flags & WHOLE) { this.width = width; this.height = height; this.color = new Uint16Array(3 * width * height); this.alpha = flags & ALPHA ? new Uint16Array(width * height) : null; }
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
    const channels = flags & ALPHA ? 4 : 3, high = place, low = place + channels * pixels;
    let k = 0;
    for (let c = 0; c < channels; ++c) {
      const [to, step, first] = c < 3 ? [this.color, 3, c] : [this.alpha, 1, 0];
      for (const [x0, y0, x1, y1] of boxes)
        for (let y = y0; y < y1; ++y)
          for (let x = x0, o = step * (y * width + x0) + first; x < x1; ++x, ++k, o += step) {
            word = word + (data[high + k] << 8 | data[low + k]) & 65535;
            to[o] = word;
          }
    }
    place += 2 * channels * pixels;
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

  // Returns the colours (linear, three a pixel). One sample's hue is mostly noise, so each pixel has that of its 5 x 5
  // neighbours at its own brightness.
  linear() {
    const n = this.width * this.height, out = new Float32Array(3 * n);
    for (let i = 0; i < 3 * n; ++i) out[i] = float_of_half[this.color[i]];
    if (this.samples > 1 || this.is_denoised) return out;
    const channel = new Float32Array(n), sums = [0, 1, 2].map((c) => {
      for (let i = 0; i < n; ++i) channel[i] = out[3 * i + c];
      return box_sums(channel, this.width, this.height);
    });
    for (let i = 0; i < n; ++i) {
      const own = 0.2126 * out[3 * i] + 0.7152 * out[3 * i + 1] + 0.0722 * out[3 * i + 2], near = 0.2126 * sums[0][i] + 0.7152 * sums[1][i] + 0.0722 * sums[2][i];
      for (let c = 0; c < 3; ++c) out[3 * i + c] = near > 0 ? own * Math.max(0, sums[c][i]) / near : own;
    }
    return out;
  }

  // Returns by how many stops the picture is to be brighter, as ExposureMeter says it (host/film/preview.h).
  metered() {
    const weights = new Float64Array(BINS * STOPS), { alpha, objects } = this;
    let sum = 0;
    for (let i = 0; i < this.width * this.height; ++i) {
      const a = alpha ? float_of_half[alpha[i]] : objects && objects[i] === NOTHING ? 0 : 1;
      const light = Math.max(float_of_half[this.color[3 * i]], float_of_half[this.color[3 * i + 1]], float_of_half[this.color[3 * i + 2]]) / (alpha ? a : 1);
      if (!(a > 0 && light > 0 && light < Infinity)) continue;
      const bin = Math.floor((Math.log2(light) + STOPS / 2) * BINS);
      if (bin < 0) continue;
      weights[Math.min(bin, weights.length - 1)] += a;
      sum += a;
    }
    if (!sum) return 0;
    let bin = weights.length;
    for (let above = 0; above < 0.05 * sum && bin > 0;) above += weights[--bin];
    return Math.log2(0.8) - (bin + 0.5) / BINS + STOPS / 2;
  }

  // Returns R G B A bytes for the screen. "film": as in the program's previews (docs/output.md). `backdrop`, a colour as it
  // is displayed or "transparent", lies under the light of shapes by their coverage; exposure and curve are those of shapes.
  shown(exposure, curve, backdrop) {
    const n = this.width * this.height, out = new Uint8ClampedArray(4 * n), color = this.linear(), { alpha } = this;
    for (let i = 0; i < n; ++i) {
      const a = alpha ? float_of_half[alpha[i]] : 1, gain = a > 0 ? 2 ** exposure / a : 0;
      let r = gain * color[3 * i], g = gain * color[3 * i + 1], b = gain * color[3 * i + 2];
      if (curve === "film") {
        const m = Math.max(r, g, b);
        if (m > 0.5) {
          const to = 1 - Math.exp(-(2 * m - 1)) / 2, white = 1 - 1 / (1 + (m - to) / 8), s = to / m * (1 - white), w = to * white;
          r = r * s + w; g = g * s + w; b = b * s + w;
        }
      }
      if (a < 1) {
        const [u, v, w] = backdrop === "transparent" ? CHECKS[(i % this.width >> 3) + (i / this.width >> 3) & 1] : backdrop ?? [0, 0, 0];
        r = a * Math.min(1, r) + (1 - a) * u; g = a * Math.min(1, g) + (1 - a) * v; b = a * Math.min(1, b) + (1 - a) * w;
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

  // Marks where things of `chosen` (object ids) end: their pixels next to others; in white the thing that is hovered over.
  outline(chosen, hovered = null) {
    const { width, height, objects } = this, out = new Uint8ClampedArray(4 * width * height);
    if (!objects) return out;
    const is = (x, y) => x >= 0 && y >= 0 && x < width && y < height;
    for (let y = 0; y < height; ++y)
      for (let x = 0; x < width; ++x) {
        const i = y * width + x;
        const is_chosen = chosen.has(objects[i]);
        if (!is_chosen && objects[i] !== hovered) continue;
        const o = objects[i], near = (dx, dy) => is(x + dx, y + dy) && objects[(y + dy) * width + x + dx] === o;
        if (near(1, 0) && near(-1, 0) && near(0, 1) && near(0, -1)) continue;
        out.set(is_chosen ? [255, 157, 59, 255] : [255, 255, 255, 150], 4 * i);
      }
    return out;
  }
}
