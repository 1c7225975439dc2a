# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Sensors of robots: depth cameras, lidars, segmentation, flow and events. Depths, ids and flow are those of the ray through each pixel's
middle, without shading."""
import io
import json
import os
import struct
import zlib

import numpy as np

from .bridges.lidar import NOTHING
from .errors import InputError
from .files import ply_bytes, replace_file
from .rendering import carry, trace
from .scanner import RETURN, Scanner, save_returns, scan
from .spelling import keywords

__all__ = ["EVENT", "Frame", "Pinhole", "RETURN", "Scanner", "coco", "depth_camera", "events", "flow", "save_returns", "scan", "segment"]
EVENT = np.dtype([("t", np.float64), ("x", np.uint16), ("y", np.uint16), ("polarity", np.int8)])
_MOST_SIDE = 65535


@keywords
class Pinhole:
    """A calibrated camera, by OpenCV's model and axes: it looks along +z, x is to the right and y down, (0, 0) is the middle of the
    first pixel.

    width, height: pixels. fx, fy, cx, cy: pixels; without fy it is fx, without cx and cy the middle. distortion: OpenCV's
    (k1, k2, p1, p2), then k3, then k4, k5, k6.

    >>> camera = Pinhole(640, 480, fx=500)
    >>> camera.project([(0, 0, 2), (1, 0, 2)]).tolist()
    [[319.5, 239.5], [569.5, 239.5]]
    """

    def __init__(self, width, height, fx, fy=None, cx=None, cy=None, distortion=()):
        for name, side in (("width", width), ("height", height)):
            if not (isinstance(side, (int, np.integer)) and 1 <= side <= _MOST_SIDE):
                raise InputError(f"{name}: a whole number from 1 to {_MOST_SIDE} is needed, not {side!r}")
        self.width, self.height = int(width), int(height)
        self.fx, self.fy = float(fx), float(fx if fy is None else fy)
        if not (0 < self.fx < np.inf and 0 < self.fy < np.inf):
            raise InputError(f"fx and fy: positive numbers are needed, not {self.fx} and {self.fy}")
        self.cx, self.cy = float((width - 1) / 2 if cx is None else cx), float((height - 1) / 2 if cy is None else cy)
        given = np.asarray(distortion, dtype=np.float64).ravel()
        if given.size not in (0, 4, 5, 8) or not np.isfinite(given).all():
            raise InputError(f"distortion: 0, 4, 5 or 8 finite numbers are needed, not {given.tolist()}")
        self.distortion = np.zeros(8)
        self.distortion[:given.size] = given

    def _distorted(self, x, y):
        """Where an undistorted place of the plane z = 1 is seen, and the derivatives there (xx, xy, yy; the matrix is symmetric)."""
        k1, k2, p1, p2, k3, k4, k5, k6 = self.distortion
        r2 = x * x + y * y
        over, under = 1 + r2 * (k1 + r2 * (k2 + r2 * k3)), 1 + r2 * (k4 + r2 * (k5 + r2 * k6))
        g = over / under
        slope = ((k1 + r2 * (2 * k2 + 3 * r2 * k3)) - g * (k4 + r2 * (2 * k5 + 3 * r2 * k6))) / under
        seen = x * g + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * g + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
        return seen, (g + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x, 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y,
                      g + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x)

    def project(self, points):
        """Pixels (n, 2) of points (n, 3) in the camera's space; NaN of points that are not before it."""
        points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
        z = np.where(points[:, 2] > 0, points[:, 2], np.nan)
        (x, y), _ = self._distorted(points[:, 0] / z, points[:, 1] / z)
        return np.stack([self.fx * x + self.cx, self.fy * y + self.cy], axis=1)

    def unproject(self, pixels):
        """Directions (n, 3) with z = 1 of pixels (n, 2), which may lie between pixels' middles; NaN of those that no direction is seen at.

        Newton's method from the distorted place, until the place is right to 1e-12 of the focal length.
        """
        pixels = np.asarray(pixels, dtype=np.float64).reshape(-1, 2)
        to_x, to_y = (pixels[:, 0] - self.cx) / self.fx, (pixels[:, 1] - self.cy) / self.fy
        x, y = to_x.copy(), to_y.copy()
        if self.distortion.any():
            with np.errstate(all="ignore"):
                for _ in range(50):
                    (seen_x, seen_y), (xx, xy, yy) = self._distorted(x, y)
                    off_x, off_y, det = to_x - seen_x, to_y - seen_y, xx * yy - xy * xy
                    x, y = x + (yy * off_x - xy * off_y) / det, y + (xx * off_y - xy * off_x) / det
                    if not (np.hypot(off_x, off_y) > 1e-14).any():
                        break
                (seen_x, seen_y), (xx, xy, yy) = self._distorted(x, y)
                # Behind the fold of a distortion the picture is mirrored: nobody sees that.
                is_right = (np.hypot(to_x - seen_x, to_y - seen_y) <= 1e-12) & (xx * yy - xy * xy > 0)
            x, y = np.where(is_right, x, np.nan), np.where(is_right, y, np.nan)
        return np.stack([x, y, np.ones_like(x)], axis=1)

    def pixels(self):
        """The middles of all pixels, (height * width, 2), by rows."""
        y, x = np.mgrid[:self.height, :self.width]
        return np.stack([x.ravel(), y.ravel()], axis=1).astype(np.float64)


def _pose(pose, name="pose"):
    pose = np.asarray(pose, dtype=np.float64)
    if pose.shape != (4, 4) or not np.isfinite(pose).all() or np.linalg.det(pose[:3, :3]) == 0:
        raise InputError(f"{name}: an invertible 4 x 4 matrix, world from camera, is needed")
    return pose


def _rays(camera, pose):
    """Where the camera is, its pixels' directions in the world (t counts depth along z), and which pixels have one."""
    own = camera.unproject(camera.pixels())
    is_seen = np.isfinite(own).all(axis=1)
    return pose[:3, 3], np.where(is_seen[:, None], own, [0, 0, 1]) @ pose[:3, :3].T, is_seen, own


@keywords
class Frame:
    """What a depth camera sees: arrays of (height, width).

    depth: float32, scene units, NaN where nothing is. shape: index of Scene.shapes, primitive, instance, material_id: uint32,
    2^32 - 1 where nothing is. normal: (height, width, 3), unit, world. points: (height, width, 3), in the camera's space, as
    measured. camera, pose: as given.
    """

    def __init__(self, camera, pose, kind, depth, points, hits):
        self.camera, self.pose, self.kind, self.depth, self.points = camera, pose, kind, depth, points
        size = depth.shape
        self.shape, self.primitive, self.instance, self.material_id = (hits[name].reshape(size) for name in ("shape", "primitive", "instance", "material_id"))
        self.normal = hits["normal"].reshape(*size, 3)

    def save_png(self, path, unit=0.001):
        """Writes 16-bit grey: depth in steps of `unit` scene units (0.001: millimetres of metres), 0 where nothing is or beyond 65535."""
        if not 0 < unit < np.inf:
            raise InputError(f"unit: a positive number is needed, not {unit!r}")
        steps = np.rint(np.nan_to_num(self.depth.astype(np.float64) / unit, nan=0, posinf=0, neginf=0))
        replace_file(path, _grey_png(np.where((steps < 0) | (steps > 65535), 0, steps).astype(np.uint16)))

    def save_points(self, path, world=False):
        """Writes the points that were measured: `.npy` (n, 3), `.ply` (binary, with normals in the world), or `.bin` as KITTI's
        (x, y, z and a reflectance of 0). world: in the world, not in the camera's space."""
        is_there = np.isfinite(self.depth)
        points = self.points[is_there].astype(np.float64)
        if world:
            points = points @ self.pose[:3, :3].T + self.pose[:3, 3]
        points, ending = points.astype("<f4"), os.path.splitext(os.fspath(path))[1]
        if ending == ".npy":
            out = io.BytesIO()
            np.save(out, points)
            replace_file(path, out.getvalue())
        elif ending == ".bin":
            replace_file(path, np.hstack([points, np.zeros((len(points), 1), "<f4")]).tobytes())
        elif ending == ".ply":
            rows = np.hstack([points, self.normal[is_there].astype("<f4")])
            replace_file(path, ply_bytes(rows.view([(name, "<f4") for name in ("x", "y", "z", "nx", "ny", "nz")]).ravel()))
        else:
            raise InputError(f"{os.fspath(path)!r}: .npy, .ply or .bin is needed")


def _grey_png(values):
    """PNG (ISO 15948) of 16-bit grey."""
    height, width = values.shape
    rows = np.zeros((height, 1 + 2 * width), np.uint8)  # each row begins with its filter, none
    rows[:, 1:] = values.astype(">u2").view(np.uint8).reshape(height, 2 * width)

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b""))


@keywords
def depth_camera(scene, camera, pose, *, kind="planar", near=0.0, far=np.inf, noise=0.0, quantum=0.0, seed=0, device=None):
    """What a depth camera at `pose` (4 x 4, world from camera) measures: a Frame.

    kind: "planar" (along z, as ROS and MuJoCo have it) or "range" (along the ray). near, far: what it measures, in that kind.
    noise: standard deviation in scene units, a number or a function of the true depths; quantum: the step depths are rounded to.

    >>> from caplet import Scene
    >>> scene = Scene()
    >>> ball = scene.add_spheres((0, 0, 5), 1)
    >>> float(depth_camera(scene, Pinhole(3, 3, fx=10), np.eye(4)).depth[1, 1])
    4.0
    """
    if kind not in ("planar", "range"):
        raise InputError(f'kind: "planar" or "range" is needed, not {kind!r}')
    pose, size = _pose(pose), (camera.height, camera.width)
    eye, ways, is_seen, own = _rays(camera, pose)
    hits = trace(scene, eye, ways, device=device)
    lengths = np.linalg.norm(own, axis=1) if kind == "range" else 1.0
    depth = np.where(is_seen & np.isfinite(hits["t"]), hits["t"].astype(np.float64) * lengths, np.nan)
    depth[~((depth >= near) & (depth <= far))] = np.nan
    hits = hits.copy()
    for name in ("shape", "primitive", "instance", "material_id"):
        hits[name][np.isnan(depth)] = NOTHING
    if callable(noise) or noise:
        spread = noise(depth) if callable(noise) else noise
        depth = depth + np.random.default_rng(seed).standard_normal(depth.shape) * spread
    if quantum:
        depth = np.rint(depth / quantum) * quantum
    points = own * (depth / lengths)[:, None]
    return Frame(camera, pose, kind, depth.reshape(size).astype(np.float32), points.reshape(*size, 3).astype(np.float32), hits)


def _box(x, y):
    return [int(x.min()), int(y.min()), int(x.max() - x.min() + 1), int(y.max() - y.min() + 1)]


def _run_lengths(mask):
    """Lengths of runs, first of zeros, by columns: COCO's uncompressed RLE."""
    flat = np.concatenate([[0], mask.ravel(order="F").astype(np.int8), [0]])
    edges = np.flatnonzero(np.diff(flat))
    ends = np.concatenate([edges, [mask.size]]) if len(edges) == 0 or edges[-1] != mask.size else edges
    return np.diff(np.concatenate([[0], ends])).astype(int).tolist()


@keywords
def segment(scene, camera, pose, *, amodal=True, most=256, device=None, of=None):
    """The shapes that a camera sees, a dict each, by index: shape, name, mask (bool, (height, width)), box [x, y, width, height]
    and area (pixels) of what is visible; with `amodal` also amodal_mask, amodal_box and amodal_area of all of it within the picture,
    hidden or not. Shapes that are hidden wholly have area 0 and no box. most: crossings of one ray.

    of: a number for each shape, 0 or more: shapes of one number are one thing, whose `shape` is that number and whose name is that of
    its first shape. Of a robot (from_mujoco), model.geom_bodyid[scene.info["geom"]] makes things of MuJoCo's bodies.
    """
    pose, size = _pose(pose), (camera.height, camera.width)
    eye, ways, is_seen, _ = _rays(camera, pose)
    kept = np.flatnonzero(is_seen)
    names, pixels, found = scene.shapes, camera.pixels().astype(int), {}
    if of is not None:
        of = np.asarray(of)
        if of.shape != (len(names),) or of.dtype.kind not in "iu" or of.min(initial=0) < 0:
            raise InputError(f"of: a whole number, 0 or more, for each of the {len(names)} shapes is needed")
        names = {int(number): names[int(np.flatnonzero(of == number)[0])] for number in np.unique(of)}

    def put(kind, shapes, rays):
        shapes = shapes if of is None else of[shapes].astype(np.int64)
        order = np.argsort(shapes, kind="stable")
        starts = np.flatnonzero(np.diff(shapes[order], prepend=-1))
        for rows in np.split(order, starts[1:]) if len(order) else ():
            shape, at = int(shapes[rows[0]]), np.unique(kept[rays[rows]])
            one = found.setdefault(shape, {"shape": shape, "name": names[shape], "mask": np.zeros(size, bool), "box": None, "area": 0})
            mask = np.zeros(size, bool)
            mask[pixels[at, 1], pixels[at, 0]] = True
            one[kind + "mask"], one[kind + "box"], one[kind + "area"] = mask, _box(pixels[at, 0], pixels[at, 1]), len(at)
    hits = trace(scene, eye, ways[kept], device=device)
    is_hit = np.isfinite(hits["t"])
    put("", hits["shape"][is_hit].astype(np.int64), np.flatnonzero(is_hit))
    if amodal:
        crossings = trace(scene, eye, ways[kept], mode="all", most=most, device=device)
        put("amodal_", crossings["shape"].astype(np.int64), crossings["ray"].astype(np.int64))
    return [found[shape] for shape in sorted(found)]


@keywords
def coco(frames, path=None, categories=None):
    """COCO's object detection JSON of frames, a list of (file name, camera, segments of `segment`); written to `path` if given.

    categories: {shape's name: category's name}; without it each name is a category of its own. Masks are uncompressed RLE.
    """
    of = (lambda name: categories.get(name)) if categories else (lambda name: name)
    kinds = sorted({of(one["name"]) for _, _, segments in frames for one in segments if of(one["name"]) is not None})
    number = {kind: i + 1 for i, kind in enumerate(kinds)}
    out = {"images": [], "annotations": [], "categories": [{"id": number[kind], "name": kind} for kind in kinds]}
    for i, (file, camera, segments) in enumerate(frames):
        out["images"].append({"id": i + 1, "file_name": os.fspath(file), "width": camera.width, "height": camera.height})
        for one in segments:
            if of(one["name"]) is None or not one["area"]:
                continue
            row = {"id": len(out["annotations"]) + 1, "image_id": i + 1, "category_id": number[of(one["name"])], "bbox": one["box"], "area": one["area"],
                   "iscrowd": 0, "segmentation": {"size": [camera.height, camera.width], "counts": _run_lengths(one["mask"])}}
            if "amodal_box" in one:
                row["amodal_bbox"], row["amodal_area"] = one["amodal_box"], one["amodal_area"]
            out["annotations"].append(row)
    if path is not None:
        replace_file(path, json.dumps(out).encode())
    return out


@keywords
def flow(scene, camera, pose, next_pose, *, times=None, moved=None, next_camera=None, device=None):
    """Where what each pixel sees goes until the next picture: optical flow (height, width, 2) in pixels, x then y, and scene flow
    (height, width, 3) in the world; NaN where nothing is, and optical flow where it goes behind the camera.

    times: (seconds of this picture, of the next one), for scenes that move. Points of a mesh keep their barycentric coordinates,
    those of a capsule their share of its axis and, turned and stretched with it, their offset from it. moved: {index of a shape:
    4 x 4, world from world}, what moves meanwhile otherwise. What hides the point later is not asked.
    """
    pose, then, size = _pose(pose), _pose(next_pose, "next_pose"), (camera.height, camera.width)
    start, end = (0.0, 0.0) if times is None else _times(times)
    eye, ways, is_seen, _ = _rays(camera, pose)
    hits = trace(scene, eye, ways, device=device, time=start)
    is_there = is_seen & np.isfinite(hits["t"])
    points = np.where(is_there[:, None], eye + ways * np.where(is_there, hits["t"], 0)[:, None].astype(np.float64), np.nan)
    after = points.copy()
    if times is not None:
        after[is_there] = carry(scene, hits[is_there], points[is_there], start, end, device=device)
    for shape, matrix in (moved or {}).items():
        matrix, rows = _pose(matrix, f"moved[{shape}]"), is_there & (hits["shape"] == shape)
        after[rows] = after[rows] @ matrix[:3, :3].T + matrix[:3, 3]
    own = (after - then[:3, 3]) @ np.linalg.inv(then[:3, :3]).T
    optical = (next_camera or camera).project(own) - camera.pixels()
    return optical.reshape(*size, 2).astype(np.float32), (after - points).reshape(*size, 3).astype(np.float32)


def _times(times):
    found = np.asarray(times, dtype=np.float64)
    if found.shape != (2,) or not np.isfinite(found).all():
        raise InputError(f"times: two finite numbers are needed, not {times!r}")
    return float(found[0]), float(found[1])


@keywords
def events(pictures, times, threshold=0.2, floor=1e-3):
    """What an event camera sees between pictures: an array of EVENT, in order of time.

    pictures: luminances (n, height, width), scene-linear, or Image's (n, height, width, 3). times: (n,), ascending. threshold: the
    difference of log luminance that makes an event. floor: is added to luminances. Between two pictures log luminance is linear in
    time (Rebecq, Gehrig and Scaramuzza 2018, "ESIM"), so pictures must be close in time.
    """
    pictures, times = np.asarray(pictures, dtype=np.float64), np.asarray(times, dtype=np.float64)
    if pictures.ndim == 4 and pictures.shape[3] == 3:
        pictures = pictures @ [0.2126, 0.7152, 0.0722]
    if pictures.ndim != 3 or times.shape != pictures.shape[:1] or not (np.diff(times) > 0).all():
        raise InputError(f"pictures (n, height, width) and n ascending times are needed, not {pictures.shape} and {times.shape}")
    if not threshold > 0 or not floor > 0:
        raise InputError(f"threshold and floor: positive numbers are needed, not {threshold} and {floor}")
    logs = np.log(np.maximum(pictures, 0) + floor)
    level, out = logs[0].copy(), []
    for before, after, start, end in zip(logs, logs[1:], times, times[1:]):
        way = after - before
        sign = np.where(way >= 0, 1.0, -1.0)
        # A count a little below a whole number is that number: luminances have about 7 digits.
        count = np.maximum(0, np.floor(sign * (after - level) / threshold + 1e-6)).astype(np.int64)
        count[way == 0] = 0
        y, x = np.nonzero(count)
        times_of = count[y, x]
        rows = np.repeat(np.arange(len(y)), times_of)
        step = np.arange(len(rows)) - np.repeat(np.cumsum(times_of) - times_of, times_of) + 1
        at = level[y, x][rows] + sign[y, x][rows] * step * threshold
        share = np.clip((at - before[y, x][rows]) / way[y, x][rows], 0, 1)
        made = np.empty(len(rows), EVENT)
        made["t"], made["x"], made["y"], made["polarity"] = start + share * (end - start), x[rows], y[rows], sign[y, x][rows]
        out.append(made[np.argsort(made["t"], kind="stable")])
        level += sign * count * threshold
    return np.concatenate(out) if out else np.empty(0, EVENT)
