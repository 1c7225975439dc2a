# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Rays in arrays: what they hit is what the solids say; wrong arrays are told."""
import math

import numpy as np
import pytest

import caplet


def sphere_hits(origins, directions, centers, radii):
    """The nearest crossing of each ray with spheres, in double: (t, number), t infinite where there is none."""
    d = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    away = origins[:, None, :] - centers[None]
    b = np.einsum("rsk,rk->rs", away, d)
    c = np.einsum("rsk,rsk->rs", away, away) - radii**2
    root = b * b - c
    near = np.where(root > 0, -b - np.sqrt(np.maximum(root, 0)), np.inf)
    far = np.where(root > 0, -b + np.sqrt(np.maximum(root, 0)), np.inf)
    t = np.where(near > 0, near, np.where(far > 0, far, np.inf))
    return t.min(axis=1) / np.linalg.norm(directions, axis=1), t.argmin(axis=1)


def test_hits_are_those_of_the_spheres(rng):
    centers, radii = rng.random((40, 3)) * 4, rng.random(40) * 0.4 + 0.05
    scene = caplet.Scene()
    scene.add_spheres(centers, radii, name="balls")
    origins, directions = rng.random((5000, 3)) * 8 - 2, rng.standard_normal((5000, 3))
    hits = caplet.trace(scene, origins, directions)
    t, which = sphere_hits(origins.astype(np.float32).astype(float), directions.astype(np.float32).astype(float),
                           centers.astype(np.float32).astype(float), radii.astype(np.float32).astype(float))
    found = np.isfinite(t)
    clear = np.abs(np.where(found, t, 0) - np.where(np.isfinite(hits["t"]), hits["t"], 0)) < 1e-3
    assert clear.mean() > 0.999 and 0.02 < found.mean() < 0.9
    same = found & clear & np.isfinite(hits["t"])
    assert np.array_equal(hits["primitive"][same], which[same]) and (hits["shape"][same] == 0).all()
    away = np.linalg.norm(hits["point"][same] - centers[which[same]], axis=1) - radii[which[same]]
    assert (np.abs(away) <= hits["error"][same] + 1e-6).all()
    assert np.allclose(np.linalg.norm(hits["normal"][same], axis=1), 1, atol=1e-5)
    miss = hits[~np.isfinite(hits["t"])]
    assert (miss["shape"] == 2**32 - 1).all() and np.array_equal(hits["ray"], np.arange(5000))
    assert np.array_equal(caplet.trace(scene, origins, directions, mode="any"), np.isfinite(hits["t"]))
    every = caplet.trace(scene, origins, directions, mode="all")
    assert np.array_equal(np.unique(every["ray"]), np.flatnonzero(np.isfinite(hits["t"])))
    first = np.unique(every["ray"], return_index=True)[1]
    assert np.array_equal(every["t"][first], hits["t"][np.isfinite(hits["t"])])
    assert (np.diff(every["ray"].astype(int)) >= 0).all()


def test_rays_in_several_pieces(row):
    """More than the binding asks at once (2^18, and 2^22 over `most` of lists): every one answers for itself."""
    n = (1 << 18) + 1000
    x = np.where(np.arange(n) % 3 == 1, 9.0, 2.0 * (np.arange(n) % 3))  # the first capsule, nothing, the third
    origins = np.stack([x, np.full(n, 0.5), np.full(n, 9.0)], axis=1)
    hits = caplet.trace(row, origins, (0, 0, -1))
    assert np.array_equal(hits["ray"], np.arange(n))
    assert np.array_equal(hits["primitive"], np.array([0, 2**32 - 1, 2])[np.arange(n) % 3])
    every = caplet.trace(row, origins[:40_000], (0, 0, -1), mode="all")
    assert np.array_equal(every["ray"], np.repeat(np.flatnonzero(np.arange(40_000) % 3 != 1), 2))


def test_crossings_in_order(row):
    hits = caplet.trace(row, (-5, 0.5, 0), (1, 0, 0), mode="all")
    assert hits["t"] == pytest.approx([4.75, 5.25, 6.75, 7.25, hits["t"][4], hits["t"][5]])
    assert hits["primitive"].tolist() == [0, 0, 1, 1, 2, 2] and hits["leaving"].tolist() == [0, 1] * 3
    assert caplet.trace(row, (-5, 0.5, 0), (1, 0, 0), t_min=5, t_max=7)["t"] == pytest.approx([5.25])
    assert caplet.trace(row, (-5, 0.5, 0), (2, 0, 0))["t"] == pytest.approx([4.75 / 2])
    with pytest.raises(caplet.RunError, match="more than 3"):
        caplet.trace(row, (-5, 0.5, 0), (1, 0, 0), mode="all", most=3)


@pytest.mark.parametrize("given", [lambda a: a.astype(np.float32), lambda a: a, np.asfortranarray, lambda a: np.repeat(a, 2, axis=0)[::2],
                                   lambda a: a[::-1].copy()[::-1], lambda a: a.astype(">f4"), lambda a: a.tolist(),
                                   lambda a: np.concatenate([a, a], axis=1)[:, :3]])
def test_arrays_of_every_kind(row, given):
    origins = np.array([[0, 0.5, 9], [2, 0.5, 9], [3, 0.5, 9], [4, 0.5, 9.0]])
    wanted = caplet.trace(row, origins, np.tile([0, 0, -1.0], (4, 1)))
    got = caplet.trace(row, given(origins), given(np.tile([0, 0, -1.0], (4, 1))))
    assert got.tobytes() == wanted.tobytes() and np.isfinite(got["t"]).tolist() == [True, True, False, True]


def test_read_only_arrays_stay_as_they_are(row):
    origins = np.array([[0, 0.5, 9.0]])
    origins.flags.writeable = False
    assert np.isfinite(caplet.trace(row, origins, np.broadcast_to([0, 0, -1.0], (1, 3)))["t"]).all()
    assert origins.tolist() == [[0, 0.5, 9.0]]


def test_no_rays_and_rays_that_are_none(row):
    for mode, dtype in (("nearest", caplet.CROSSING), ("all", caplet.CROSSING), ("any", bool)):
        out = caplet.trace(row, np.empty((0, 3)), (0, 0, 1), mode=mode)
        assert out.shape == (0,) and out.dtype == dtype
    odd = [(math.nan, 0, 1), (0, 0, 0), (math.inf, 0, 0), (0, 0, -math.inf), (0, 0, 1e300)]
    assert not np.isfinite(caplet.trace(row, (0, 0.5, -9), odd)["t"]).any()
    assert not caplet.trace(row, [(0, math.nan, 0), (math.inf, 0, 0)], (0, 0, 1), mode="any").any()


@pytest.mark.parametrize("arguments", [
    (np.zeros((4, 2)), np.zeros((4, 3))), (np.zeros((4, 3)), np.zeros((5, 3))), ("a", (0, 0, 1)), (np.zeros((4, 3), complex), (0, 0, 1)),
    (np.zeros((2, 2, 3)), (0, 0, 1)), (None, None), (np.zeros((4, 3)), (0, 0, 1), "some"), ([[1, 2], [3]], (0, 0, 1)),
    (np.array([object()] * 3), (0, 0, 1))])
def test_wrong_arrays_are_told(row, arguments):
    with pytest.raises(caplet.InputError):
        caplet.trace(row, *arguments)


def test_wrong_ends_are_told(row):
    for wrong in (dict(t_min=np.zeros(7)), dict(t_max=np.zeros((2, 2))), dict(t_min="a"), dict(most=0, mode="all"), dict(most=2**21, mode="all")):
        with pytest.raises(caplet.InputError):
            caplet.trace(row, np.zeros((3, 3)), (0, 0, 1), **wrong)
    with pytest.raises((MemoryError, caplet.InputError)):
        caplet.trace(row, np.broadcast_to(np.zeros(3), (2**40, 3)), (0, 0, 1))


def test_edits_are_seen(row):
    ray = (0, 0.5, 9), (0, 0, -1)
    before = caplet.trace(row, *ray)["t"][0]
    row.shape("row").transform = np.diag([1, 1, 2, 1])
    assert caplet.trace(row, *ray)["t"][0] == pytest.approx(before - 0.25)


def test_pixels_have_names(row):
    row.camera = caplet.cameras.perspective(eye=(2, 0.5, 9), target=(2, 0.5, 0), fov=30)
    row.size = 33, 33
    hit = caplet.pick(row, 16, 16)
    assert hit["object"] == "row" and hit["primitive"] == 1 and hit["t"] == pytest.approx(8.75) and hit["entering"]
    assert caplet.pick(row, 0, 0) is None
    with pytest.raises(caplet.InputError):
        caplet.pick(row, 33, 0)


def test_verify_counts(row):
    report = caplet.verify(row, rays=2000)
    assert report and report.agrees and report.devices[0]["rays"] >= 2000 and report.devices[0]["disagreements"] == 0
    assert "2" in str(report) and report.json.startswith("{")
    with pytest.raises(caplet.InputError):
        caplet.verify(row, rays=0)


def test_devices_are_told():
    assert caplet.devices() and {"name", "type", "compute_units", "global_bytes"} <= set(caplet.devices()[0])
