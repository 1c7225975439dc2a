# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Many worlds: poses of one scene, as cameras see them, by the thousand."""
from __future__ import annotations

import numpy as np

from . import _caplet, arrays
from .errors import InputError
from .image import Image
from .named import Material
from .rendering import _count, _devices, _scene
from .sensors import Pinhole
from .spelling import keywords

_LAYERS = {"depth": ("t", np.float32), "shape": ("shape", np.uint32), "instance": ("instance", np.uint32), "primitive": ("primitive", np.uint32),
           "material_id": ("material_id", np.uint32), "normal": ("normal", np.float32), "point": ("point", np.float32)}
_MODES = ("rays", "direct", "paths")
_FLIP = np.diag([1.0, -1, 1, 1])  # to a Pinhole's axes, y down, from those of cameras in scenes


def _numbers(scene, which, name):
    """Numbers of shapes, which are given by names or numbers."""
    count, out = len(scene.shapes), []
    for one in [which] if isinstance(which, (str, int, np.integer)) else which:
        if isinstance(one, str):
            one = scene._native.shape(one)
        elif isinstance(one, bool) or not isinstance(one, (int, np.integer)) or not 0 <= one < count:
            raise InputError(f"{name}: names of shapes, or numbers below {count}, are needed, not {one!r}")
        out.append(int(one))
    return out


def _moving(scene, moving):
    if moving is None:
        return [i for i in range(len(scene.shapes)) if scene.shape(i).object == ""]
    return _numbers(scene, moving, "moving")


def _of_shapes(ends):
    if ends is not None and not isinstance(ends, dict):
        raise InputError(f"ends: a dict of shapes is needed, not {type(ends).__name__}")
    return ends or {}


class _Deforming:
    """The shapes whose capsules change from world to world, with those that the scene has: (k, 8): p0, p1, both radii."""

    def __init__(self, scene, which):
        self.numbers = _numbers(scene, which, "deforming")
        self.own = []
        for number in self.numbers:
            shape = scene.shape(number)
            if not len(shape):
                raise InputError(f"deforming: shape {number} is not one of capsules")
            if shape.times:
                raise InputError(f"deforming: the capsules of shape {number} move while the shutter is open, and worlds stand still")
            self.own.append(np.hstack([shape.p0, shape.p1, shape.radius]).astype(np.float32))

    def ends(self, scene, given, worlds):
        """The capsules of each shape in each world, (worlds, k, 8): those of `given`, {shape: (p0, p1) or (p0, p1, radius)}; else its own."""
        given = _of_shapes(given)
        numbers = dict(zip(_numbers(scene, list(given), "ends"), given.items()))
        if len(numbers) < len(given):
            raise InputError("ends: a shape is there twice, by name and by number")
        for number, (which, _) in numbers.items():
            if number not in self.numbers:
                raise InputError(f"ends: shape {which!r} is not among those that deform")
        out = []
        for number, own in zip(self.numbers, self.own):
            ends = np.tile(own, (worlds, 1, 1))
            if number in numbers:
                which, arrays_of = numbers[number]
                self._fill(ends, which, arrays_of)
            out.append(ends)
        return out

    @staticmethod
    def _fill(ends, which, given):
        if not isinstance(given, (tuple, list)) or len(given) not in (2, 3):
            raise InputError(f"ends: (p0, p1) or (p0, p1, radius) are needed of shape {which!r}")
        worlds, count = ends.shape[:2]
        for name, at, array in zip(("p0", "p1"), (slice(0, 3), slice(3, 6)), given):
            array = arrays.floats(array, f"{name} of {which!r}")
            if array.shape != (worlds, count, 3):
                raise InputError(f"{name} of {which!r}: shape ({worlds}, {count}, 3) is needed, not {array.shape}")
            ends[:, :, at] = array
        if len(given) == 3:
            radius = arrays.floats(given[2], f"radius of {which!r}")
            if radius.ndim and radius.shape[-1] == count and radius.shape[-2:] != (count, 2):
                radius = radius[..., np.newaxis]
            try:
                ends[:, :, 6:] = np.broadcast_to(radius, (worlds, count, 2))
            except ValueError:
                raise InputError(f"radius of {which!r}: one, shape ({count},), ({worlds}, {count}) or ({worlds}, {count}, 2) is needed, "
                                 f"not {np.shape(given[2])}") from None


def _matrices(value, name, shapes):
    """An array of matrices as (..., 12) of 64-bit floats. `shapes`: what their number may look like, by dimensions."""
    array = arrays.floats(value, name)
    if array.ndim - 2 not in shapes or array.shape[-2:] not in ((4, 4), (3, 4)):
        raise InputError(f"{name}: shape {' or '.join(f'({one}4, 4)' for one in shapes.values())} is needed, not {array.shape}")
    return arrays.transforms(array.reshape(-1, *array.shape[-2:]), name).reshape(*array.shape[:-2], 12)


class _Views:
    """Checks what worlds and poses are: the worlds' matrices (n, m, 12), the cameras' (n, c, 12), and the shape of what is seen."""

    def __init__(self, worlds, moving, camera, poses):
        if not isinstance(camera, Pinhole):
            raise InputError(f"camera: a caplet.sensors.Pinhole is needed, not {type(camera).__name__}")
        self.worlds = _matrices(worlds, "worlds", {2: "n, m, "})
        count = len(self.worlds)
        if self.worlds.shape[1] != moving:
            raise InputError(f"worlds: {self.worlds.shape[1]} transforms each, and {moving} shapes move")
        poses = _matrices(poses, "poses", {0: "", 1: "n, ", 2: "n, c, "})
        if poses.ndim > 1 and len(poses) != count:
            raise InputError(f"poses: {len(poses)} of them, and {count} worlds")
        if not np.isfinite(poses).all():
            raise InputError("poses: finite numbers are needed")
        self.shape = (count, *poses.shape[1:-1], camera.height, camera.width)
        poses = np.broadcast_to(poses, (count, *poses.shape[1:]) if poses.ndim > 1 else (count, 12))
        self.cameras = np.ascontiguousarray(poses if poses.ndim == 3 else poses[:, np.newaxis])


@keywords
class Batch:
    """The shapes of a scene on a device, once for many worlds. In each world some shapes are elsewhere.

    moving: names or numbers of those shapes, each once; None: all that are not of an object. The scene stays as it is here: later
    changes do not come along. Shapes of a scene that moves while its shutter is open cannot be seen so. deforming: names or numbers of
    shapes of capsules, whose ends and radii may be others in each world; they may be moving ones, too.

    >>> from caplet import Scene
    >>> scene = Scene()
    >>> ball = scene.add_spheres((0, 0, 0), 1, name="ball")
    >>> worlds = np.tile(np.eye(4), (3, 1, 1, 1))
    >>> worlds[:, 0, 2, 3] = 5, 6, 7
    >>> seen = Batch(scene, "ball").look(worlds, Pinhole(3, 3, fx=10), np.eye(4))
    >>> seen["depth"].shape, seen["depth"][:, 1, 1].tolist()
    ((3, 3, 3), [4.0, 5.0, 6.0])
    """

    def __init__(self, scene, moving=None, device=None, deforming=()):
        self._scene = _scene(scene).copy()
        self.moving = _moving(scene, moving)
        self._deforming = _Deforming(scene, deforming)
        self.deforming = self._deforming.numbers
        self._native = _caplet.Batch(scene._native, self.moving, _devices(device)[0], self.deforming)

    def __repr__(self):
        return f"<caplet.Batch: {len(self.moving)} shapes move, {len(self.deforming)} deform>"

    def look(self, worlds, camera, poses, layers=("depth", "shape"), kind="planar", ends=None) -> dict[str, np.ndarray]:
        """What one ray through the middle of each pixel meets in each world: a dict of arrays (n, height, width), by layer.

        worlds: (n, m, 4, 4), world from object of each moving shape, as Shape.transform is. camera: a caplet.sensors.Pinhole. poses:
        world from camera, (4, 4), one a world (n, 4, 4), or c of them (n, c, 4, 4), which makes arrays of (n, c, height, width).
        layers: of "depth" (NaN where nothing is; kind: "planar", along z, or "range", along the ray), "shape" (index of
        Scene.shapes), "instance", "primitive", "material_id" (2^32 - 1 where there is none), "normal" and "point" (world, with a
        last dimension of 3; 0 where nothing is). ends: {shape: (p0, p1) or (p0, p1, radius)} of shapes that deform: p0, p1 (n, k, 3) of
        its k capsules in its own space; radius: one, (k,), (n, k), or (n, k, 2) of both ends. What is not given is as in the scene.

        >>> from caplet import Scene
        >>> scene = Scene()
        >>> rod = scene.add_capsules((-1, 0, 9), (1, 0, 9), 0.5, name="rod")
        >>> p0 = np.array([[[-1, 0, 5]], [[0, 0, 7]]])
        >>> seen = Batch(scene, [], deforming="rod").look(np.zeros((2, 0, 4, 4)), Pinhole(3, 3, fx=10), np.eye(4), ends={"rod": (p0, -p0 * (1, 1, -1))})
        >>> seen["depth"][:, 1, 1].tolist()
        [4.5, 6.5]
        """
        if kind not in ("planar", "range"):
            raise InputError(f'kind: "planar" or "range" is needed, not {kind!r}')
        layers = [layers] if isinstance(layers, str) else list(layers)
        for layer in layers:
            if layer not in _LAYERS:
                raise InputError(f"layers: {', '.join(_LAYERS)} are there, not {layer!r}")
        views = _Views(worlds, len(self.moving), camera, poses)
        directions = camera.unproject(camera.pixels())
        if kind == "range":
            directions /= np.linalg.norm(directions, axis=1)[:, None]
        out = {layer: np.empty(views.shape + ((3,) if layer in ("normal", "point") else ()), _LAYERS[layer][1]) for layer in layers}
        rooms = {_LAYERS[layer][0]: room.reshape(-1) for layer, room in out.items()}
        rest = dict.fromkeys((room for room, _ in _LAYERS.values()))
        count = len(views.worlds)
        capsules = np.concatenate([np.empty((count, 0, 8), np.float32), *self._deforming.ends(self._scene, ends, count)], axis=1)
        self._native.nearest(count, views.worlds.reshape(-1, 12), views.cameras.reshape(-1, 12), np.ascontiguousarray(directions, dtype=np.float32),
                             np.ascontiguousarray(capsules.reshape(-1, 8)), **{**rest, **rooms})
        if "depth" in out:
            out["depth"][np.isinf(out["depth"])] = np.nan
        return out


def _materials(scene, materials, count):
    """For each world (number, type, parameters) of the materials that it has in the place of the scene's."""
    out = [[] for _ in range(count)]
    for which, each in ({} if materials is None else dict(materials)).items():
        number, each = scene._material(which), list(each)
        if not 0 <= number < len(scene.materials):
            raise InputError(f"materials: numbers below {len(scene.materials)}, or names, are needed, not {which!r}")
        if len(each) != count:
            raise InputError(f"materials: {len(each)} of {which!r}, and {count} worlds")
        for world, material in zip(out, each):
            if not isinstance(material, Material):
                raise InputError(f"materials: ones of caplet.materials are needed, not {type(material).__name__}")
            world.append((number, material.type, scene._parameters(material.parameters)))
    return out


def _pictures(scene, moving, views, camera, mode, spp, seed, device, materials, ends):
    deforming = _Deforming(scene, _of_shapes(ends))
    capsules = deforming.ends(scene, ends, len(views.worlds))
    looks = _materials(_scene(scene), materials, len(views.worlds))
    native = scene._native.copy()
    held = {number: [array if len(array) else None for array in native.capsule_arrays(number)[4:6]] for number in deforming.numbers}
    native.set_size(camera.width, camera.height)
    if mode == "direct":
        native.max_depth = 1
    if seed is not None:
        native.seed = int(seed)
    k1, k2, p1, p2, k3, k4, k5, k6 = camera.distortion.tolist()
    lens = {"fx": camera.fx, "fy": camera.fy, "cx": camera.cx, "cy": camera.cy,
            "k1": k1, "k2": k2, "k3": k3, "k4": k4, "k5": k5, "k6": k6, "p1": p1, "p2": p2}
    out, session, shown = np.empty(views.shape + (3,), np.float32), None, None
    pictures = out.reshape(*views.cameras.shape[:2], camera.height, camera.width, 3)
    for w, places in enumerate(views.worlds):
        for shape, place in zip(moving, places):
            native.set_transform(shape, place)
        for number, own in zip(deforming.numbers, capsules):
            p0, p1, r0, r1 = (np.ascontiguousarray(column) for column in (own[w, :, :3], own[w, :, 3:6], own[w, :, 6], own[w, :, 7]))
            rows, u = held[number]
            native.set_capsules(number, len(own[w]), p0, p1, r0, r1, rows, u, [])
        for number, kind, parameters in looks[w]:
            native.set_material(number, kind, parameters)
        for c, pose in enumerate(views.cameras[w]):
            if shown is None or not np.array_equal(shown, pose):
                pose_4 = np.vstack([pose.reshape(3, 4), [0, 0, 0, 1]]) @ _FLIP
                native.set_camera("opencv", lens, arrays.transform(pose_4))
                shown = pose
            if session is None:
                session = _caplet.Session(native, _devices(device), none=True)
            else:
                session.update(native)
            session.render(spp, None, None)
            pictures[w, c] = Image(session.film()).rgb
    return out


@keywords
def render_batch(scene, worlds, camera, poses, moving=None, mode="rays", layers=None, spp=16, seed=None, device=None, materials=None, ends=None) -> dict[str, np.ndarray]:
    """What cameras see of many worlds of one scene: a dict of arrays, as Batch.look returns them.

    scene, worlds, camera, poses, moving: as in Batch. mode: "rays", one a pixel, without shading (layers: "depth" and "shape", or
    as in Batch.look); "direct", pictures lit by what comes from lights without a detour, and "paths", by all of it: layer "rgb", linear
    sRGB (n, height, width, 3), with `spp` samples a pixel and the scene's seed or another. materials: of pictures, by name or number
    in the scene, n of caplet.materials, one a world, in its place. ends: capsules of each world, as in Batch.look.

    >>> from caplet import Scene
    >>> scene = Scene()
    >>> ball = scene.add_spheres((0, 0, 0), 1, name="ball")
    >>> worlds = np.tile(np.eye(4), (2, 1, 1, 1))
    >>> worlds[:, 0, 2, 3] = 5, 6
    >>> render_batch(scene, worlds, Pinhole(16, 9, fx=20), np.eye(4), mode="direct")["rgb"].shape
    (2, 9, 16, 3)
    """
    if mode not in _MODES:
        raise InputError(f"mode: one of {', '.join(_MODES)} is needed, not {mode!r}")
    if mode == "rays":
        if materials is not None:
            raise InputError("materials: rays see none, only their numbers; modes \"direct\" and \"paths\" show them")
        batch = Batch(scene, moving, device, list(_of_shapes(ends)))
        return batch.look(worlds, camera, poses, ("depth", "shape") if layers is None else layers, ends=ends)
    if layers is not None and list(layers) != ["rgb"]:
        raise InputError('layers: pictures have "rgb" alone')
    numbers = _moving(_scene(scene), moving)
    views = _Views(worlds, len(numbers), camera, poses)
    return {"rgb": _pictures(scene, numbers, views, camera, mode, _count(spp, "spp", 1 << 24), seed, device, materials, ends)}
