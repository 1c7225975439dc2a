# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Lidars: firings in any pattern at their times, with ranges, intensities and returns."""
import io
import os

import numpy as np

from .bridges.cells import package
from .bridges.lidar import NOTHING
from .errors import InputError
from .files import ply_bytes, replace_file
from .rendering import trace
from .spelling import keywords

RETURN = np.dtype([("t", np.float64), ("firing", np.uint32), ("ring", np.uint16), ("number", np.uint8), ("count", np.uint8), ("shape", np.uint32),
                   ("range", np.float32), ("intensity", np.float32), ("point", np.float32, 3), ("world", np.float64, 3)])
_MODES = ("first", "last", "strongest", "dual", "all")


@keywords
class Scanner:
    """A lidar: laser pulses, each in a direction at a time.

    directions: (n, 3), of any length, in the scanner's space: x forwards, y to its left, z up. times: seconds, one or (n,). rings:
    the number of the laser, one or (n,). near, far: the ranges that it measures, in scene units.

    >>> Scanner([(1, 0, 0), (1, 0.01, 0)], times=[0, 1e-5]).directions.shape
    (2, 3)
    """

    def __init__(self, directions, times=0.0, rings=0, near=0.0, far=np.inf):
        directions = np.asarray(directions, dtype=np.float64)
        if directions.ndim != 2 or directions.shape[1] != 3 or not np.isfinite(directions).all() or not directions.any(axis=1).all():
            raise InputError(f"directions: (n, 3) finite numbers, no row of zeros, are needed, not {directions.shape}")
        self.directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
        self.times, self.rings = _of_each("times", times, len(directions)), _of_each("rings", rings, len(directions)).astype(np.uint16)
        self.near, self.far = float(near), float(far)
        if not 0 <= self.near < self.far:
            raise InputError(f"near and far: 0 <= near < far is needed, not {near} and {far}")

    @classmethod
    def spinning(cls, elevations, steps, rate=10.0, turns=1, azimuths=0.0, delays=0.0, start=0.0, near=0.0, far=np.inf):
        """A scanner that turns from x towards y, `rate` turns a second; its lasers fire `steps` times a turn.

        elevations: degrees above its horizon, one a laser, which is its ring. azimuths: degrees by which lasers look ahead. delays:
        seconds after the beginning of a step at which each fires; it turns on meanwhile. start: degrees, where it begins at time 0.

        >>> scanner = Scanner.spinning(elevations=[-15, 0, 15], steps=4, rate=10, delays=[0, 1e-3, 2e-3])
        >>> scanner.rings[:4].tolist(), scanner.times[:4].round(6).tolist()
        ([0, 1, 2, 0], [0.0, 0.001, 0.002, 0.025])
        """
        above = np.asarray(elevations, dtype=np.float64)
        if above.ndim != 1 or not above.size or not np.isfinite(above).all():
            raise InputError("elevations: (n,) degrees are needed")
        if not (0 < rate < np.inf):
            raise InputError(f"rate: a positive number of turns a second is needed, not {rate!r}")
        if not (steps >= 1 and turns > 0 and steps * turns * above.size < 2**31):
            raise InputError(f"steps and turns: positive numbers of fewer than 2^31 firings are needed, not {steps} and {turns}")
        ahead, late = _of_each("azimuths", azimuths, above.size), _of_each("delays", delays, above.size)
        times = (np.arange(int(round(steps * turns)))[:, None] / (steps * rate) + late).ravel()
        laser = np.tile(np.arange(above.size), int(round(steps * turns)))
        around, up = np.deg2rad(start + 360 * rate * times + ahead[laser]), np.deg2rad(above[laser])
        ways = np.stack([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)], axis=1)
        return cls(ways, times, laser, near, far)

    @classmethod
    def from_table(cls, path, near=0.0, far=np.inf):
        """A scanner of any pattern, by a table of its firings: text with a row each, columns between commas or blanks, and a first row
        that names them: `time` (seconds), `azimuth` and `elevation` (degrees) or `zenith` (degrees from straight up), or `x`, `y` and
        `z`, and `ring`. Names may have a unit ("Time/s", "Azimuth/deg", "zenith_rad"): s, ms, us or ns; deg or rad. Without times all
        fire at 0. Livox's tables, which simulators share, are such.
        """
        file = os.fspath(path)
        try:
            with open(file, encoding="utf-8-sig") as text:
                names = text.readline().replace(",", " ").split()
                lines = [line.replace(",", " ") for line in text if line.strip()]
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{file}: {getattr(error, 'strerror', None) or 'is no text'}") from None
        columns = {}
        for place, name in enumerate(names):
            what, unit = _column_of(name)
            if what in columns:
                raise InputError(f"{file}:1: two columns are {what}")
            columns[what] = (place, unit)
        rows = np.empty((len(lines), len(names)))
        for number, line in enumerate(lines):
            try:
                rows[number] = [float(value) for value in line.split()]
            except ValueError:
                raise InputError(f"{file}:{number + 2}: {len(names)} numbers are needed") from None
        column = lambda what: rows[:, columns[what][0]] * columns[what][1]
        if {"x", "y", "z"} <= columns.keys():
            ways = np.stack([column(axis) for axis in "xyz"], axis=1)
        elif "azimuth" in columns and columns.keys() & {"elevation", "zenith"}:
            around = column("azimuth")
            above = column("elevation") if "elevation" in columns else np.pi / 2 - column("zenith")
            ways = np.stack([np.cos(above) * np.cos(around), np.cos(above) * np.sin(around), np.sin(above)], axis=1)
        else:
            raise InputError(f"{file}:1: columns azimuth and elevation or zenith, or x, y and z, are needed, not {', '.join(names) or 'none'}")
        rings = column("ring") if "ring" in columns else 0
        if not len(rows):
            raise InputError(f"{file}: has no firings")
        return cls(ways, column("time") if "time" in columns else 0.0, rings, near, far)


_UNITS = {"time": {"s": 1, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}, "azimuth": {"deg": np.pi / 180, "rad": 1.0}, "ring": {}, "x": {}, "y": {}, "z": {}}
_UNITS["elevation"] = _UNITS["zenith"] = _UNITS["azimuth"]


def _column_of(name):
    """What a column of a table is, and the factor to seconds or radians; other columns keep their names."""
    what, _, unit = name.strip().lower().replace("/", "_").partition("_")
    units = _UNITS.get(what)
    if units is None or not (unit in units or not unit):
        return name, 1.0
    return what, float(units[unit] if unit else next(iter(units.values()), 1.0))


def _of_each(name, value, count):
    value = np.asarray(value, dtype=np.float64)
    if value.shape not in ((), (count,)) or not np.isfinite(value).all():
        raise InputError(f"{name}: a finite number or {count} of them are needed, not {value.shape}")
    return np.broadcast_to(value, count).copy()


def _poses(pose, times):
    given = np.asarray(pose(times) if callable(pose) else pose, dtype=np.float64)
    if given.shape not in ((4, 4), (len(times), 4, 4)) or not np.isfinite(given).all():
        raise InputError(f"pose: a finite 4 x 4 matrix, world from scanner, or one for each of the {len(times)} firings is needed, not {given.shape}")
    return np.broadcast_to(given, (len(times), 4, 4))


def _of_shapes(name, value, shapes):
    value = np.asarray(value, dtype=np.float64)
    if value.shape not in ((), (shapes,)) or not ((value >= 0) & (value <= 1)).all():
        raise InputError(f"{name}: a number from 0 to 1, or one for each of the {shapes} shapes, is needed, not {value.shape}")
    return np.broadcast_to(value, shapes)


@keywords
def scan(scene, scanner, pose, *, mode="strongest", reflectance=1.0, transmittance=0.0, threshold=0.0, dropout=0.0, noise=0.0, quantum=0.0,
         seed=0, most=256, device=None):
    """What a lidar measures: an array of RETURN, by firings, nearer ones first.

    pose: 4 x 4, world from scanner, or a function of times (n,) that returns (n, 4, 4), for one that moves. What moves in the scene is
    where it is at each firing's time (scanner.times, while the shutter is open).
    mode: which returns of a firing are told: "first", "last", "strongest", "dual" (the strongest and the last, once where they are
    one) or "all". reflectance, transmittance: 0 to 1, one or of each shape of scene.shapes. A surface reflects
    energy * reflectance * cos(angle) / range^2, its intensity (1: a white wall that faces the scanner 1 unit away), and lets
    energy * transmittance through. threshold: weaker returns are lost. dropout: the chance that one is lost, a number or a function
    of intensities. noise: standard deviation of ranges in scene units, a number or a function of true ranges; quantum: the step that
    ranges are rounded to. most: crossings of one firing.

    Fields: t, firing, ring; number and count, of the returns that the firing has, from 1; shape, as in Scene.shapes; range,
    intensity; point, in the scanner's space at its time; world, in the scene's.

    >>> from caplet import Scene
    >>> scene = Scene()
    >>> ball = scene.add_spheres((5, 0, 0), 1)
    >>> scan(scene, Scanner([(1, 0, 0), (0, 1, 0)]), np.eye(4))["range"].tolist()
    [4.0]
    """
    if mode not in _MODES:
        raise InputError(f"mode: one of {', '.join(_MODES)} is needed, not {mode!r}")
    reflectance, transmittance = (_of_shapes(name, value, len(scene.shapes)) for name, value in
                                  (("reflectance", reflectance), ("transmittance", transmittance)))
    poses = _poses(pose, scanner.times)
    ways = np.einsum("nij,nj->ni", poses[:, :3, :3], scanner.directions)
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    if not len(ways) or not len(scene.shapes):
        return np.empty(0, RETURN)
    rays = dict(t_max=scanner.far, time=scanner.times, device=device)
    if transmittance.any():
        hits = trace(scene, poses[:, :3, 3], ways, mode="all", most=most, **rays)
    else:
        hits = trace(scene, poses[:, :3, 3], ways, **rays)
        hits["ray"] = np.arange(len(hits))
        hits = hits[np.isfinite(hits["t"])]
    made = np.zeros(len(hits), RETURN)
    made["firing"], made["shape"] = hits["ray"], hits["shape"]
    ranges = hits["t"].astype(np.float64)
    cosine = np.abs(np.einsum("ni,ni->n", hits["normal"], ways[hits["ray"]]))
    made["intensity"] = _energies(hits["ray"], transmittance[hits["shape"]], len(ways)) * reflectance[hits["shape"]] * cosine / ranges**2
    random = np.random.default_rng(seed)
    chance = dropout(made["intensity"]) if callable(dropout) else dropout
    kept = (made["intensity"] > 0) & (made["intensity"] >= threshold) & (ranges >= scanner.near) & (random.random(len(made)) >= chance)
    made, ranges = made[kept], ranges[kept]
    told = _told(made, mode)
    made, ranges = made[told], ranges[told]
    if callable(noise) or noise:
        ranges = ranges + random.standard_normal(len(ranges)) * (noise(ranges) if callable(noise) else noise)
    if quantum:
        ranges = np.rint(ranges / quantum) * quantum
    of = made["firing"]
    made["t"], made["ring"], made["range"] = scanner.times[of], scanner.rings[of], ranges
    made["point"] = scanner.directions[of] * ranges[:, None]
    made["world"] = poses[of, :3, 3] + ways[of] * ranges[:, None]
    return made


def _ranks(of):
    """The place of each entry among those of its number; equal numbers are neighbours."""
    starts = np.flatnonzero(np.diff(of, prepend=-1))
    counts = np.diff(np.append(starts, len(of)))
    return np.arange(len(of)) - np.repeat(starts, counts), np.repeat(counts, counts)


def _energies(of, through, firings):
    """What reaches each crossing of what its firing sent; crossings are by firings and in order."""
    energy, out = np.ones(firings), np.empty(len(of))
    ranks, _ = _ranks(of.astype(np.int64))
    for rank in range(ranks.max(initial=-1) + 1):
        rows = np.flatnonzero(ranks == rank)
        out[rows] = energy[of[rows]]
        energy[of[rows]] *= through[rows]
    return out


def _told(made, mode):
    """Which returns are told; numbers those of each firing."""
    ranks, counts = _ranks(made["firing"].astype(np.int64))
    made["number"], made["count"] = np.minimum(ranks + 1, 255), np.minimum(counts, 255)
    is_first, is_last = ranks == 0, ranks == counts - 1
    if mode == "all":
        return np.ones(len(made), bool)
    if mode in ("first", "last"):
        return is_first if mode == "first" else is_last
    order = np.lexsort((ranks, -made["intensity"].astype(np.float64), made["firing"]))  # of equals the nearer is the strongest
    is_strongest = np.zeros(len(made), bool)
    is_strongest[order[_ranks(made["firing"][order].astype(np.int64))[0] == 0]] = True
    return is_strongest if mode == "strongest" else is_strongest | is_last


@keywords
def save_returns(path, returns, world=False):
    """Writes returns: `.npy` (all fields), `.bin` as KITTI's (x, y, z and intensity), `.ply` (binary, with intensity, ring and t), or
    `.las` and `.laz` (LAS 1.4, format 6; needs the package laspy, .laz also its lazrs). world: places in the scene's space, not in the
    scanner's. LAS holds places in steps of 0.001 and intensities as shares of the largest."""
    returns = np.asarray(returns)
    if returns.dtype != RETURN or returns.ndim != 1:
        raise InputError("returns: an array of RETURN is needed, as scan makes")
    points, ending, out = returns["world" if world else "point"], os.path.splitext(os.fspath(path))[1], io.BytesIO()
    if ending == ".npy":
        np.save(out, returns)
    elif ending == ".bin":
        out.write(np.column_stack([points, returns["intensity"]]).astype("<f4").tobytes())
    elif ending == ".ply":
        row = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("ring", "<u2"), ("t", "<f8")])
        rows = np.empty(len(returns), row)
        rows["x"], rows["y"], rows["z"] = points.T
        for name in ("intensity", "ring", "t"):
            rows[name] = returns[name]
        out.write(ply_bytes(rows))
    elif ending in (".las", ".laz"):
        _write_las(package("laspy", "sensors.save_returns"), returns, points, out, ending == ".laz")
    else:
        raise InputError(f"{os.fspath(path)!r}: .npy, .bin, .ply, .las or .laz is needed")
    replace_file(path, out.getvalue())


def _write_las(laspy, returns, points, out, is_packed):
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales = np.full(3, 0.001)
    header.offsets = np.floor(points.min(axis=0)) if len(points) else np.zeros(3)
    las = laspy.LasData(header)
    las.x, las.y, las.z = points.astype(np.float64).T
    largest = returns["intensity"].max(initial=0)
    las.intensity = np.rint(returns["intensity"] * (65535 / largest if largest > 0 else 0)).astype(np.uint16)
    # The format counts up to 15 returns.
    las.return_number, las.number_of_returns = np.minimum(returns["number"], 15), np.minimum(returns["count"], 15)
    las.gps_time, las.point_source_id = returns["t"], returns["ring"]
    las.write(out, do_compress=is_packed)
