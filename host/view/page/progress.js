// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// How much of a picture is done, and how long the rest takes at the present rate.
export class Progress {
  constructor() { this.view = -1; this.samples = 0; }

  /// Takes what is shown; returns {share, seconds}, where seconds is null as long as it is not known.
  sees(picture, target, noise, now) {
    if (picture.view !== this.view || picture.samples < this.samples || picture.scale > 1) {
      this.view = picture.view;
      this.from = null;
    }
    this.samples = picture.samples;
    if (picture.scale > 1) return { share: 0, seconds: null };
    // Variance falls as samples grow, so a noise is reached after (noise now / noise wanted)^2 times as many.
    const of_noise = noise && picture.noise > 0 ? Math.min(1, (noise / picture.noise) ** 2) : 0;
    const share = Math.min(1, Math.max(of_noise, target ? picture.samples / target : 0));
    this.from ??= { share, now };
    const gone = now - this.from.now, done = share - this.from.share;
    return { share, seconds: share < 1 && gone > 1 && done > 0 ? gone * (1 - share) / done : null };
  }
}
