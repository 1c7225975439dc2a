#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The densities of a cloud that points_test.cpp expects (its rows), with nothing of Caplet's: Pharr, Jakob and Humphreys 2023, 11.4.4, by gradient noise (Perlin 2002, with the
permutation published there; the last four of the sixteen gradients are those of pbrt-v4), in double. Needs numpy."""

import numpy as np

PERMUTATION = np.array([
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99, 37, 240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197,
    62, 94, 252, 219, 203, 117, 35, 11, 32, 57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231,
    83, 111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54, 65, 25, 63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200,
    196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186, 3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206, 59, 227, 47,
    16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9, 129, 22, 39, 253, 19, 98, 108, 110, 79, 113,
    224, 232, 178, 185, 112, 104, 218, 246, 97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181,
    199, 106, 157, 184, 84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93, 222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78, 66, 215, 61, 156, 180])
GRADIENTS = np.array([(x, y, 0) for y in (1, -1) for x in (1, -1)] + [(x, 0, z) for z in (1, -1) for x in (1, -1)]
                     + [(0, y, z) for z in (1, -1) for y in (1, -1)] + [(1, 1, 0), (-1, 1, 0), (0, 1, -1), (0, -1, -1)], float)


def noise(p):
    whole = np.floor(p)
    v = p - whole
    corner = whole.astype(np.int64)
    weight = v**3 * (v * (v * 6 - 15) + 10)
    out = np.zeros(p.shape[:-1])
    for offset in np.ndindex(2, 2, 2):
        at = corner + offset
        hash_ = 0
        for axis in range(3):
            hash_ = PERMUTATION[(hash_ + at[..., axis]) & 255]
        share = np.prod(np.where(np.array(offset) == 1, weight, 1 - weight), axis=-1)
        out += share * np.sum(GRADIENTS[hash_ & 15] * (v - offset), axis=-1)
    return out


def slope(p, step=0.01):
    here = noise(p)
    return np.stack([(noise(p + step * np.eye(3)[axis]) - here) / step for axis in range(3)], axis=-1)


def density(p, of, wispiness, frequency):
    at = frequency * p
    if wispiness > 0:
        for high, fine in ((0.05 * wispiness, 10), (0.025 * wispiness, 19.9)):
            at = at + high * slope(fine * at)
    octaves = sum(0.5 ** (i + 1) * noise(1.99**i * at) for i in range(5))
    y = p[..., 1]
    return np.clip(np.clip((1 - y) * 4.5 * of * octaves, 0, 1) + 2 * np.maximum(0, 0.5 - y), 0, 1)


def rows():
    """Points where a cloud is neither empty nor full, nor what it is without noise."""
    rng = np.random.default_rng(7)
    for of, wispiness, frequency in ((1, 0, 5), (0.6, 1, 5), (1.5, 3, 2), (0.4, 1, 9)):
        found = 0
        while found < 6:
            p = np.round(rng.uniform((-1, 0.1, -2), (3, 0.95, 4)), 3)
            value = float(density(p, of, wispiness, frequency))
            if 0.02 + 2 * max(0, 0.5 - p[1]) < value < 0.95:
                found += 1
                yield f"{{{of}, {wispiness}, {frequency}, {{{p[0]:.3f}F, {p[1]:.3f}F, {p[2]:.3f}F}}, {value:.6f}}},"


if __name__ == "__main__":
    print("\n".join(rows()))
