#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Figures of docs/performance.md, "From Python", beside other packages: embreex on a mesh, MuJoCo on a robot.

usage: python_peers.py ROBOT.xml [RAYS [ROUNDS]]    (caplet, embreex and mujoco are to be importable; defaults 1000000 7)

The ways take turns, from arrays to arrays, with the scene built; medians are printed. embreex asks Embree for one ray at a time on one thread,
and so does MuJoCo (mj_multiRay, all rays from one point); Caplet uses its device's cores.
"""
import statistics
import sys
import time

import numpy as np

import caplet


def timed(work):
    begin = time.perf_counter()
    out = work()
    return time.perf_counter() - begin, out


def in_turns(ways, rounds):
    """Medians of seconds, and the last answers."""
    spent, answers = {name: [] for name in ways}, {}
    for one in range(rounds + 1):
        for name, work in ways.items():
            seconds, answers[name] = timed(work)
            if one:  # the first compiles and warms
                spent[name].append(seconds)
    return {name: statistics.median(times) for name, times in spent.items()}, answers


def ball(steps):
    """A bumpy sphere of 2 x steps x steps triangles, about."""
    up, around = np.meshgrid(np.linspace(0, np.pi, steps + 1), np.linspace(0, 2 * np.pi, steps + 1), indexing="ij")
    radius = 1 + 0.1 * np.sin(9 * up) * np.sin(7 * around)
    points = (radius[..., None] * np.stack([np.sin(up) * np.cos(around), np.sin(up) * np.sin(around), np.cos(up)], 2)).reshape(-1, 3)
    n = np.arange((steps + 1)**2).reshape(steps + 1, steps + 1)
    a, b, c, d = (part.reshape(-1) for part in (n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]))
    return points.astype(np.float32), np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype(np.int32)


def towards(rng, count, at, center, spread):
    way = center + spread * rng.uniform(-1, 1, (count, 3)) - at
    return (way / np.linalg.norm(way, axis=1, keepdims=True)).astype(np.float32)


def report(what, seconds, peer, rays, t, other):
    both = np.isfinite(t) & np.isfinite(other)
    same = np.mean(np.isfinite(t) == np.isfinite(other)), np.max(np.abs(t[both] - other[both]), initial=0)
    print(f"{what}: caplet {rays / seconds['caplet'] / 1e6:.3g} Mrays/s, {peer} {rays / seconds[peer] / 1e6:.3g} Mrays/s, "
          f"{peer} over caplet {seconds[peer] / seconds['caplet']:.3g}; hits agree {same[0]:.6f}, t within {same[1]:.2g}")


def mesh(rays, rounds):
    from embreex import rtcore_scene
    from embreex.mesh_construction import TriangleMesh
    points, faces = ball(350)
    rng = np.random.default_rng(3)
    origins = (3 * towards(rng, rays, np.zeros(3), np.zeros(3), 1)).astype(np.float32)
    directions = towards(rng, rays, origins, np.zeros(3), 1)
    other = rtcore_scene.EmbreeScene()
    TriangleMesh(other, points, faces)
    scene = caplet.Scene()
    scene.add_mesh(points, faces)
    seconds, got = in_turns({"caplet": lambda: caplet.trace(scene, origins, directions),
                             "embreex": lambda: other.run(origins, directions, query="DISTANCE")}, rounds)
    t = got["embreex"]
    report(f"mesh of {len(faces)} triangles", seconds, "embreex", rays, got["caplet"]["t"], np.where(t < 1e30, t, np.inf))


def robot(path, rays, rounds):
    import mujoco
    # Without this MuJoCo writes its warnings into MUJOCO_LOG.TXT in the working folder.
    mujoco.set_mju_user_warning(lambda text: print(f"mujoco: {text}", file=sys.stderr))
    model = mujoco.MjModel.from_xml_path(path)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    scene = caplet.from_mujoco(model, data)
    at = np.array(model.stat.center) + [3 * model.stat.extent, 0, 0.5 * model.stat.extent]
    directions = towards(np.random.default_rng(4), rays, at, np.array(model.stat.center), 0.6 * model.stat.extent)
    way, t, geoms = directions.astype(np.float64).reshape(-1), np.empty(rays), np.empty(rays, np.int32)
    shown = np.array([1, 1, 1, 0, 0, 0], np.uint8)

    def peer():
        optional = {"normal": None} if "normal" in (mujoco.mj_multiRay.__doc__ or "") else {}
        mujoco.mj_multiRay(m=model, d=data, pnt=at, vec=way, geomgroup=shown, flg_static=1, bodyexclude=-1, geomid=geoms, dist=t, nray=rays,
                           cutoff=1e10, **optional)
        return np.where(t < 0, np.inf, t)

    seconds, got = in_turns({"caplet": lambda: caplet.trace(scene, at, directions), "mujoco": peer}, rounds)
    report(f"{path.rsplit('/', 1)[-1]}, {len(scene.shapes)} geoms", seconds, "mujoco", rays, got["caplet"]["t"], got["mujoco"])


if __name__ == "__main__":
    asked, turns = int(sys.argv[2]) if len(sys.argv) > 2 else 1_000_000, int(sys.argv[3]) if len(sys.argv) > 3 else 7
    mesh(asked, turns)
    robot(sys.argv[1], asked, turns)
