#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Random walks that expectations of the tests of media come from, with nothing of Caplet's: the part of the light that has come into half of
space behind a smooth boundary that goes out again, and what a rough glass ball lets see of a white surrounding. Needs numpy."""

import numpy as np

rng = np.random.default_rng(1)


def fres(c, eta):  # the cosine on this side; the index beyond over that of here
    s2 = (1 - c * c) / eta**2
    t = np.sqrt(np.maximum(0, 1 - s2))
    a = (eta * c - t) / (eta * c + t)
    b = (c - eta * t) / (c + eta * t)
    return np.where(s2 >= 1, 1.0, 0.5 * (a * a + b * b))


def half_of_space(albedo, eta, g, even, n=200000):
    if even:
        mu0 = np.sqrt(1 - rng.random(n))
        w = 1 - fres(mu0, eta)
        mu = np.sqrt(1 - (1 - mu0**2) / eta**2)
    else:
        mu = np.ones(n)
        w = np.full(n, 1 - fres(1.0, eta))
    inn = w.sum()
    z = np.zeros(n)
    out = 0.0
    while len(w):
        step = -np.log(1 - rng.random(len(w)))
        z2 = z + mu * step
        # reaches the boundary: partial transmission, continues reflected with weight F
        hit = z2 < 0
        F = fres(np.abs(mu), 1 / eta)
        if hit.any():
            out += (w * (1 - F))[hit].sum()
        w = np.where(hit, w * F, w)
        # after reflection: start at boundary, mu flips, new free flight (memoryless)
        z = np.where(hit, 0.0, z2)
        mu = np.where(hit, -mu, mu)
        sc = ~hit
        w = np.where(sc, w * albedo, w)
        m = sc.sum()
        if g == 0:
            nm = 2 * rng.random(m) - 1
        else:
            u = rng.random(m)
            c = (1 + g * g - ((1 - g * g) / (1 - g + 2 * g * u)) ** 2) / (2 * g)
            ph = 2 * np.pi * rng.random(m)
            mm = mu[sc]
            nm = mm * c + np.sqrt(np.maximum(0, (1 - mm * mm) * (1 - c * c))) * np.cos(ph)
        mu[sc] = nm
        # roulette
        low = w < 0.05
        kill = low & (rng.random(len(w)) < 0.75)
        w = np.where(low, w * 4, w)
        keep = ~kill
        z, mu, w = z[keep], mu[keep], w[keep]
    return out / inn


def rough_ball(alpha, eta, sigma, n=200000):
    x = 2 * rng.random(n) - 1
    y = 2 * rng.random(n) - 1
    inside = x * x + y * y < 1
    total = (~inside).sum()
    x, y = x[inside], y[inside]
    p = np.stack([x, y, -np.sqrt(1 - x * x - y * y)], -1)
    d = np.tile([0.0, 0, 1], (len(x), 1))
    w = np.ones(len(x))
    ins = np.zeros(len(x), bool)
    out = 0.0
    norm = lambda v: v / np.sqrt((v * v).sum(-1, keepdims=True))
    dot = lambda a, b: (a * b).sum(-1)
    lam = lambda v: (np.sqrt(1 + alpha**2 * np.maximum(0, 1 - v[:, 2] ** 2) / np.maximum(v[:, 2] ** 2, 1e-30)) - 1) / 2
    for depth in range(2000):
        if not len(w):
            break
        N = np.where(ins[:, None], -p, p)
        N = norm(N)  # towards wo's side
        wo = -d
        # frame
        a = np.where(np.abs(N[:, :1]) > 0.5, np.array([[0.0, 1, 0]]), np.array([[1.0, 0, 0]]))
        T = norm(np.cross(a, N))
        B = np.cross(N, T)
        o = np.stack([dot(wo, T), dot(wo, B), dot(wo, N)], -1)
        # Heitz 2018 vndf
        v = norm(o * [alpha, alpha, 1])
        l = v[:, 0] ** 2 + v[:, 1] ** 2
        t1 = np.where(
            l[:, None] > 1e-14,
            np.stack([-v[:, 1], v[:, 0], 0 * l], -1) / np.sqrt(np.maximum(l, 1e-14))[:, None],
            np.array([[1.0, 0, 0]]),
        )
        t2 = np.cross(v, t1)
        r = np.sqrt(rng.random(len(w)))
        ph = 2 * np.pi * rng.random(len(w))
        a1 = r * np.cos(ph)
        a2 = r * np.sin(ph)
        s = 0.5 * (1 + v[:, 2])
        a2 = (1 - s) * np.sqrt(np.maximum(0, 1 - a1 * a1)) + s * a2
        h = a1[:, None] * t1 + a2[:, None] * t2 + np.sqrt(np.maximum(0, 1 - a1 * a1 - a2 * a2))[:, None] * v
        m = norm(np.stack([alpha * h[:, 0], alpha * h[:, 1], np.maximum(1e-9, h[:, 2])], -1))
        e = np.where(ins, 1 / eta, eta)
        c = dot(o, m)
        s2 = (1 - c * c) / e**2
        ct = np.sqrt(np.maximum(0, 1 - s2))
        F = np.where(s2 >= 1, 1.0, 0.5 * (((e * c - ct) / (e * c + ct)) ** 2 + ((c - e * ct) / (c + e * ct)) ** 2))
        refl = rng.random(len(w)) < F
        wi = np.where(refl[:, None], 2 * c[:, None] * m - o, -o / e[:, None] + (c / e - ct)[:, None] * m)
        ok = np.where(refl, wi[:, 2] > 0, wi[:, 2] < 0)
        w = w * (1 + lam(o)) / (1 + lam(o) + lam(wi)) * ok  # height-correlated masking (docs/materials.md)
        wi = norm(wi)
        d = wi[:, :1] * T + wi[:, 1:2] * B + wi[:, 2:] * N
        ins = np.where(refl, ins, ~ins)
        gone = ~ins & ok
        out += w[gone].sum()
        k = ins & (w > 1e-4)
        p, d, w, ins = p[k], d[k], w[k], ins[k]
        if not len(w):
            break
        going = np.ones(len(w), bool)
        while going.any():
            b = dot(p, d)
            t = -b + np.sqrt(np.maximum(0, b * b - (dot(p, p) - 1)))
            s = -np.log(1 - rng.random(len(w))) / sigma
            sc = going & (s < t)
            arrive = going & ~sc
            p = np.where(arrive[:, None], norm(p + t[:, None] * d), np.where(sc[:, None], p + s[:, None] * d, p))
            q = norm(rng.normal(size=(len(w), 3)))
            d = np.where(sc[:, None], q, d)
            going = sc
    return (total + out) / n


if __name__ == "__main__":
    mean = lambda of, *arguments: np.mean([of(*arguments) for _ in range(4)])
    for g in (0, 0.7):
        for albedo in (0.5, 0.8, 0.93, 0.98, 0.995):
            print(
                "index 1.33, g",
                g,
                "albedo",
                albedo,
                "of even light %.4f, of light from straight above %.4f"
                % tuple(mean(half_of_space, albedo, 1.33, g, even) for even in (True, False)),
                flush=True,
            )
    for albedo in (0.62810, 0.90284, 0.97050, 0.99725, 0.99986):
        print(
            "index 1.33, albedo",
            albedo,
            "of even light %.4f, of light from straight above %.4f"
            % tuple(mean(half_of_space, albedo, 1.33, 0, even) for even in (True, False)),
            flush=True,
        )
    for sigma in (1e-9, 1):
        print("rough glass 0.5, index 1.4, scattering", sigma, "seen %.4f" % mean(rough_ball, 0.5, 1.4, sigma), flush=True)
