# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Scenes: read, built from arrays, edited in place, written."""
from __future__ import annotations

import numbers as _numbers
import os
from typing import Any

import numpy as np

from . import _caplet, arrays
from .errors import InputError
from .named import Blackbody, Camera, Light, Material, Medium, Texture, color as as_color
from .spelling import keywords

_MOST_COLORS = 4096  # that are materials of their own


@keywords
class Shape:
    """A shape of a scene, to look at and to change in place.

    index: its number among those of the world, or of its object definition.
    """

    def __init__(self, scene, index, object=""):
        self._scene, self.index, self.object = scene, index, object

    @property
    def number(self) -> int:
        """Its number among all shapes, which `trace` gives as "shape"."""
        return self._scene._native.shape_in(self.object, self.index)

    @property
    def name(self) -> str:
        return self._scene._native.shapes()[self.number]

    @property
    def transform(self):
        """4 x 4: world (or object) space from the shape's. Set it to move the shape."""
        return self._scene._native.transform(self.number)

    @transform.setter
    def transform(self, to):
        self._scene._native.set_transform(self.number, arrays.transform(to))
        self._scene._changed()

    def __len__(self):
        """How many capsules it has."""
        return self._scene._native.capsules(self.number)

    def __bool__(self):
        return True

    def _arrays(self):
        return self._scene._native.capsule_arrays(self.number)

    def _at_times(self, array, times):
        return array.reshape(len(times), -1, *array.shape[1:]) if times else array

    @property
    def p0(self) -> np.ndarray:
        """The capsules' first ends, float32 (n, 3), or (k, n, 3) at k times, in the shape's space; a copy: `set` changes them."""
        now = self._arrays()
        return self._at_times(now[0], now[6])

    @property
    def p1(self) -> np.ndarray:
        """The other ends, float32 (n, 3) or (k, n, 3)."""
        now = self._arrays()
        return self._at_times(now[1], now[6])

    @property
    def radius(self) -> np.ndarray:
        """Of both ends, float32 (n, 2) or (k, n, 2), scene units."""
        now = self._arrays()
        return self._at_times(np.stack([now[2], now[3]], axis=1), now[6])

    @property
    def u(self) -> np.ndarray:
        """Of capsules of a chain: what the texture coordinate u is at p0 and at p1, float32 (n, 2); none of others, (0, 2)."""
        return self._arrays()[5]

    def _mesh(self):
        return self._scene._native.mesh_arrays(self.number)

    @property
    def vertices(self) -> np.ndarray:
        """A mesh's vertices, float32 (v, 3), or (k, v, 3) at k times, in the shape's space; a copy."""
        now = self._mesh()
        return self._at_times(now[0], now[4])

    @property
    def faces(self) -> np.ndarray:
        """A mesh's triangles, uint32 (n, 3): numbers of vertices."""
        return self._mesh()[1]

    @property
    def normals(self) -> np.ndarray | None:
        """Normals at a mesh's vertices, float32 (v, 3) or (k, v, 3); none of others, (0, 3)."""
        now = self._mesh()
        return self._at_times(now[2], now[4]) if len(now[2]) else now[2]

    @property
    def times(self):
        """The times (seconds) between which the capsules or a mesh's vertices move; none where they rest."""
        return self._arrays()[6] if len(self) else self._mesh()[4]

    def animate(self, times, p0=None, p1=None, radius=None, *, vertices=None, normals=None) -> None:
        """Moves the capsules' ends while the shutter is open, and changes their radii; or moves a mesh's vertices.

        times: k times (seconds, rising), two or more. Capsules: p0, p1: (k, n, 3); radius: one, (n,), (k, n), or (k, n, 2) of both ends.
        A mesh: vertices: (k, v, 3); normals: (k, v, 3), which a mesh with normals needs. What else is not given stays as it is, or as it
        is at the first time. Between two times all goes straight and evenly; before the first and after the last one it rests. With no
        times the shape rests as it is at the first one. The shutter is that of the camera: `shutteropen`, `shutterclose` (0 and 1 second).
        """
        times = arrays.floats(times, "times").astype(np.float64)
        if times.ndim != 1:
            raise InputError(f"times: shape (k,) is needed, not {times.shape}")
        keys, count = max(1, len(times)), len(self)

        def at_times(value, name, shape, now):
            given = arrays.floats(now if value is None else value, name)
            if name == "radius" and given.ndim in (1, 2) and given.shape[-1] == count:
                given = given[..., np.newaxis]
            try:
                return np.broadcast_to(given, (keys, *shape)).reshape(keys * shape[0], shape[1])
            except ValueError:
                raise InputError(f"{name}: shape {(keys, *shape)} is needed, not {np.shape(now if value is None else value)}") from None

        def first(array):
            return array[0] if self.times else array

        if not count:
            if p0 is not None or p1 is not None or radius is not None:
                raise InputError("animate: p0, p1 and radius are of capsules, and this shape has none")
            try:
                held = self._mesh()
            except InputError:
                raise InputError("animate: the shape is neither of capsules nor a mesh; other shapes move with an instance") from None
            points = first(self.vertices)
            if len(held[2]) and vertices is not None and normals is None:
                raise InputError("animate: a mesh with normals needs those at the new vertices too")
            held_normals = first(self.normals) if len(held[2]) else None
            turned = None if normals is None and held_normals is None else at_times(normals, "normals", points.shape, held_normals)
            self._scene._native.set_mesh(self.number, at_times(vertices, "vertices", points.shape, points), held[1].reshape(-1), turned,
                                         held[3] if len(held[3]) else None, times.tolist())
            self._scene._changed()
            return
        if vertices is not None or normals is not None:
            raise InputError("animate: vertices and normals are of a mesh, and this shape has capsules")
        ends = at_times(radius, "radius", (count, 2), first(self.radius))
        materials, u = self._arrays()[4:6]
        self._scene._native.set_capsules(
            self.number, keys * count, at_times(p0, "p0", (count, 3), first(self.p0)), at_times(p1, "p1", (count, 3), first(self.p1)),
            ends[:, 0], ends[:, 1], materials if len(materials) else None, u if len(u) else None, times.tolist())
        self._scene._changed()

    def animate_operand(self, operand, times, transforms) -> None:
        """Moves an operand of a csg, counted from 0: transforms (n, 4, 4) at n times (seconds, rising), two or more, take its space to the csg's.

        Between them it moves as `Scene.animate_instance` has it, about its origin. With empty lists it rests where it is at the first time.
        """
        self._scene._native.set_operand_motion(self.number, operand, *Scene._keys(times, transforms))
        self._scene._changed()

    def set(self, p0=None, p1=None, radius=None, u=None) -> None:
        """Other capsules: what is not given stays. Shapes as in Scene.add_capsules; their number may change with all three (materials and u,
        where it is not given, then go)."""
        now = self._arrays()
        if now[6]:
            raise InputError("the capsules move: animate changes them")
        one, two, ends, more, given, count = _capsules(now[0] if p0 is None else p0, now[1] if p1 is None else p1,
                                                       np.stack(now[2:4], axis=1) if radius is None else radius, u=u)
        materials = now[4] if len(now[4]) == count else None
        if u is None and len(now[5]) == count:
            given = now[5]
        self._scene._native.set_capsules(self.number, count, one, two, ends, more, materials, given, [])
        self._scene._changed()

    def set_material(self, material) -> None:
        """A material of all of it, or a list of them, one a surface."""
        given = material if isinstance(material, (list, tuple)) else [material]
        self._scene._native.set_shape_materials(self.number, [self._scene._material(one) for one in given])
        self._scene._changed()

    def set_emission(self, L, scale=1.0) -> None:
        """Of a shape that emits: its radiance (linear sRGB or grey)."""
        self._scene._native.set_emission(self.number, _rgb(L, "L"), float(scale))
        self._scene._changed()

    def __repr__(self):
        return f"<caplet.Shape {self.number} {self.name!r}>"


@keywords
class Shapes:
    """Shapes that were added together: a sequence."""

    def __init__(self, scene, first, count, object=""):
        self._scene, self._range, self.object = scene, range(first, first + count), object

    def __len__(self):
        return len(self._range)

    def __getitem__(self, i):
        if isinstance(i, slice):
            return [Shape(self._scene, number, self.object) for number in self._range[i]]
        return Shape(self._scene, self._range[i], self.object)

    def __repr__(self):
        return f"<caplet.Shapes {self._range.start} to {self._range.stop - 1}>"


def _rgb(value, name):
    value = arrays.floats(as_color(value, name), name).astype(np.float64)
    if value.shape not in ((), (1,), (3,)):
        raise InputError(f"{name}: one number or three are needed, not shape {value.shape}")
    return [float(one) for one in np.broadcast_to(value, 3)]


def _ends(radius):
    """Radii (n,) or one, or (n, 2) of both ends: two arrays, the second None where all are the same."""
    array = arrays.floats(radius, "radius")
    if array.ndim == 2:
        array = arrays.rows(array, "radius", 2)
        return array[:, 0], array[:, 1]
    return arrays.scalars(array, "radius"), None


def _capsules(p0, p1, radius, radius1=None, u=None):
    p0, p1 = arrays.rows(p0, "p0", 3), arrays.rows(p1, "p1", 3)
    radius0, other = _ends(radius)
    if radius1 is not None:
        if other is not None:
            raise InputError("radius: of both ends already; leave radius1 out")
        other = arrays.scalars(radius1, "radius1")
    u = None if u is None else arrays.rows(u, "u", 2)
    count = arrays.common(p0=p0, p1=p1, radius=radius0, radius1=other, u=u)
    return p0, p1, radius0, other, u, count


@keywords
class Scene:
    """A scene: shapes, materials, lights, a camera.

    What is left open, the camera and light, is chosen when it is rendered: a view that frames the shapes (y is up) and soft studio
    light. Lengths are scene units, angles degrees, colours linear sRGB, from 0 to 1 where they are reflectances. Transforms are
    arrays of 4 x 4 that map column vectors. Wrong input is an InputError, and changes nothing.

    >>> scene = Scene()
    >>> shape = scene.add_capsules([[0, 0, 0], [1, 0, 0]], [[0, 1, 0], [1, 1, 0]], 0.1, color=(0.8, 0.3, 0.1))
    >>> scene.primitives
    {'capsule': 2}
    """

    def __init__(self, _native=None):
        self._native = _caplet.Scene() if _native is None else _native
        self._materials, self._textures, self._media = {}, {}, {}
        self._pickers = {}
        self.info = {}  # for bridges: what its numbers are where it came from

    def _changed(self):
        self._pickers = {}  # a new one: another thread may be about to add what it has made of the scene as it was

    def copy(self) -> Scene:
        """Another one, which shares memory with this until one of them is changed."""
        out = Scene(self._native.copy())
        out._materials, out._textures, out._media = dict(self._materials), dict(self._textures), dict(self._media)
        out.info = dict(self.info)
        return out

    __copy__ = copy

    def __deepcopy__(self, memo):
        return self.copy()

    def __repr__(self):
        held = ", ".join(f"{count} {kind}{'' if count == 1 else 'es' if kind.endswith(('x', 'h')) else 's'}" for kind, count in self.primitives.items())
        return f"<caplet.Scene: {held or 'empty'}>"

    # --- What it holds ---

    @property
    def bounds(self) -> np.ndarray:
        """The corners of a box around all shapes: (2, 3), scene units. The first is above the second where there are none."""
        return np.array(self._native.bounds())

    @property
    def primitives(self) -> dict[str, int]:
        """How many there are by kind; instances count as often as they are placed."""
        return dict(self._native.primitives())

    @property
    def shapes(self) -> list[str]:
        """Names by number."""
        return self._native.shapes()

    @property
    def materials(self) -> list[str]:
        """Names by number."""
        return self._native.materials()

    @property
    def objects(self) -> list[str]:
        """Names of the object definitions."""
        return self._native.objects()

    def shape(self, which) -> Shape:
        """The shape of a name, or of a number among all."""
        object, index = self._native.place(self._native.shape(which) if isinstance(which, str) else int(which))
        return Shape(self, index, object)

    __getitem__ = shape

    # --- The picture ---

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        return self._native.width, self._native.height

    @size.setter
    def size(self, to):
        self._native.set_size(*arrays.size(to))
        self._changed()

    def crop(self, x0, y0, x1, y1):
        """Only these pixels are rendered, from the top left; x1 and y1 excluded."""
        self._native.set_crop(x0, y0, x1, y1)
        self._changed()

    @property
    def spp(self) -> int:
        """Samples a pixel, from 1 to 2^24; where the picture is rendered to a noise the most of one. Setting it ends that."""
        return self._native.spp

    @spp.setter
    def spp(self, to):
        self._native.spp = int(to)

    @property
    def noise(self):
        """The noise that the picture is rendered to, with at most spp samples a pixel: what its file asks for, or 0.05 of files of
        formats without samples; 0: none."""
        return self._native.noise

    @property
    def max_depth(self) -> int:
        """Most scattering events of a path."""
        return self._native.max_depth

    @max_depth.setter
    def max_depth(self, to):
        self._native.max_depth = int(to)

    @property
    def seed(self) -> int:
        """Of the samples: the same seed makes the same picture."""
        return self._native.seed

    @seed.setter
    def seed(self, to):
        self._native.seed = int(to)

    @property
    def unit(self) -> str:
        """Of lengths, as people write it: "um"; empty where it is not known. Scale bars tell it."""
        return self._native.unit

    @unit.setter
    def unit(self, to):
        if not isinstance(to, str):
            raise InputError(f"unit: a text is needed, not {to!r}")
        self._native.unit = to
        self._changed()

    def set_color_bar(self, title, low, high, unit=""):
        """What colours of caplet.color_map tell, from `low` to `high`: Image.save(path, color_bar=True) shows it."""
        self._native.set_color_bar(str(title), str(unit), float(low), float(high))
        self._changed()

    def film(self, type="rgb", **parameters):
        """The film's settings, as scene files name them (docs/formats/pbrt.md): iso=, whitebalance=, ..."""
        self._option("film", type, {"xresolution": self.size[0], "yresolution": self.size[1], **parameters})

    def filter(self, type, **parameters):
        """The pixel filter: "gaussian", "box", ... with xradius=, yradius=, sigma= (pixels)."""
        self._option("filter", type, parameters)

    def sampler(self, type, **parameters):
        """The sampler, as scene files name it: pixelsamples=, seed=."""
        self._option("sampler", type, parameters)

    def integrator(self, type, **parameters):
        """The integrator, as scene files name it: maxdepth=."""
        self._option("integrator", type, parameters)

    def _option(self, kind, type, parameters):
        self._native.set_option(kind, type, self._parameters(parameters))
        self._changed()

    # --- The camera ---

    @property
    def camera(self):
        """4 x 4: world space from the camera's, whose +x is right, +y up and +z forward. May be set to one of caplet.cameras."""
        return self._native.camera()

    @camera.setter
    def camera(self, camera):
        if not isinstance(camera, Camera):
            raise InputError("camera: one of caplet.cameras is needed")
        eye, target = getattr(camera, "eye", None), getattr(camera, "target", None)
        if camera.transform is None and (eye is None) != (target is None):
            raise InputError("camera: eye and target go together")
        if camera.transform is None:  # with an eye: what look_at shows unmirrored
            place = arrays.IDENTITY if eye is None else np.diag([-1.0, 1, 1, 1])
        else:
            place = camera.transform
        made = self._native.copy()
        made.set_camera(camera.type, self._parameters(camera.parameters), arrays.transform(place))
        if camera.transform is None and eye is not None:
            made.look_at(*(_point(value, name) for value, name in ((eye, "eye"), (target, "target"), (camera.up, "up"))))
        self._native = made
        self._changed()

    def look_at(self, eye, target, up=(0, 1, 0)) -> None:
        """Puts the camera at `eye`, looking at `target`; scene units. A right-handed world is not mirrored, unless the camera of a file
        has it so."""
        self._native.look_at(_point(eye, "eye"), _point(target, "target"), _point(up, "up"))
        self._changed()

    @property
    def fov(self) -> float:
        """The field of view of the picture's shorter side, degrees."""
        return self._native.fov

    @fov.setter
    def fov(self, degrees):
        self._native.set_fov(float(degrees))
        self._changed()

    # --- Materials, textures, media ---

    def _parameters(self, given):
        return {name: self._value(name, value) for name, value in given.items()}

    def _value(self, name, value):
        if isinstance(value, Texture):
            return "texture", self._texture(value)
        if name == "pixels":
            return "pixels", arrays.pixels(value, name)
        if isinstance(value, Blackbody):
            return "blackbody", value.kelvin
        if isinstance(value, (bool, np.bool_)):
            return bool(value)
        if isinstance(value, _numbers.Real):
            return float(value)
        if isinstance(value, os.PathLike):
            return os.fspath(value)
        if isinstance(value, str):
            return tuple(["rgb", *as_color(value, name)]) if value.startswith("#") else value
        if isinstance(value, (list, tuple)) and len(value) and all(isinstance(one, str) for one in value):
            return list(value)
        if isinstance(value, (list, tuple)) and len(value) == 2 and all(isinstance(one, Material) for one in value):
            return "materials", self._material(value[0]), self._material(value[1])
        array = np.ravel(arrays.floats(value, name))
        if array.size == 0:
            raise InputError(f"{name}: has no value")
        return np.ascontiguousarray(array, dtype=np.float64)

    def _place(self, named):
        return arrays.transform(arrays.IDENTITY if named.transform is None else named.transform)

    def _kept(self, table, named, make):
        found = table.get(id(named))
        if found is None or found[1] is not named:
            found = table[id(named)] = make(), named
        return found[0]

    def _texture(self, texture):
        return self._kept(self._textures, texture, lambda: self._native.add_texture(
            texture.type, texture.is_float, self._parameters(texture.parameters), self._place(texture)))

    def _material(self, material):
        """The number of a material: of one made by caplet.materials, of a name, or that number itself."""
        if isinstance(material, (int, np.integer)):
            return int(material)
        if isinstance(material, str):
            names = self._native.materials()
            if material not in names:
                raise InputError(f"there is no material {material!r}; there are {', '.join(map(repr, names)) or 'none'}")
            return names.index(material)
        if not isinstance(material, Material):
            raise InputError(f"material: one of caplet.materials is needed, not {type(material).__name__}")
        return self._kept(self._materials, material, lambda: self._native.add_material(
            material.name or "", material.type, self._parameters(material.parameters)))

    def _medium(self, medium):
        if medium is None or isinstance(medium, (int, np.integer)):
            return medium
        if not isinstance(medium, Medium):
            raise InputError(f"a medium: one of caplet.media is needed, not {type(medium).__name__}")
        return self._kept(self._media, medium, lambda: self._native.add_medium(
            medium.name or f"medium {len(self._native.media())}", medium.type, self._parameters(medium.parameters), self._place(medium)))

    def set_material(self, which, material):
        """Another material in the place of one, by number or name; its shapes have it at once."""
        if not isinstance(material, Material):
            raise InputError(f"material: one of caplet.materials is needed, not {type(material).__name__}")
        self._native.set_material(self._material(which), material.type, self._parameters(material.parameters))
        self._changed()

    def camera_in(self, medium):
        """The medium that the camera is in where no solid holds it; None: empty space."""
        self._native.set_camera_medium(self._medium(medium))
        self._changed()

    # --- Lights ---

    def add_light(self, light):
        """One of caplet.lights. The studio light goes. Returns its number."""
        if not isinstance(light, Light):
            raise InputError(f"light: one of caplet.lights is needed, not {type(light).__name__}")
        number = self._native.add_light(light.type, self._parameters(light.parameters), self._place(light))
        self._changed()
        return number

    def remove_lights(self):
        """All but shapes that emit; the studio light does not come back."""
        self._native.remove_lights()
        self._changed()

    def set_light(self, number, color, scale=1.0):
        """Another colour (linear sRGB or grey) and scale of a light in place."""
        self._native.set_light(int(number), _rgb(color, "color"), float(scale))
        self._changed()

    # --- Shapes ---

    def _options(self, name, transform, material, emission, inside, outside, object, reverse_orientation):
        given = [] if material is None else list(material) if isinstance(material, (list, tuple)) else [material]
        options = {"name": name or "", "object": object or "", "materials": [self._material(one) for one in given],
                   "transform": None if transform is None else arrays.transform(transform), "inside": self._medium(inside),
                   "outside": self._medium(outside), "reverse_orientation": bool(reverse_orientation)}
        if emission is not None:
            options["emission"] = self._parameters(emission if isinstance(emission, dict) else {"L": emission})
        return options

    def _colored(self, color, material, count):
        """(material for all, numbers of materials or None): of one colour, or of (count, 3) of them."""
        if color is None:
            return material, None
        if isinstance(material, (list, tuple)):
            raise InputError("color: goes with one material, not with several")
        base = Material("diffuse", {}) if material is None else material
        if not isinstance(base, Material):
            raise InputError("color: goes with a material of caplet.materials, or with none")
        array = arrays.floats(as_color(color), "color")
        if array.shape in ((), (3,)) or count == 1:
            if array.size not in (1, 3):
                raise InputError(f"color: shape (3,) or ({count}, 3) is needed, not {array.shape}")
            return base.with_color(tuple(_rgb(array.reshape(-1), "color"))), None
        if array.shape != (count, 3):
            raise InputError(f"color: shape (3,) or ({count}, 3) is needed, not {array.shape}")
        if not (np.isfinite(array).all() and array.min() >= 0 and array.max() <= 1):
            raise InputError("color: reflectances from 0 to 1 are needed")
        colors, which = _distinct(array)
        numbers = np.array([self._material(base.with_color(tuple(map(float, one)))) for one in colors], dtype=np.uint32)
        return int(numbers[0]), np.ascontiguousarray(numbers[which.reshape(-1)])

    def add_capsules(self, p0, p1, radius, radius1=None, *, u=None, color=None, material=None, name=None, transform=None, emission=None,
                     inside=None, outside=None, object=None, reverse_orientation=False) -> Shape:
        """Capsules: the convex hulls of two spheres each, all of them one shape.

        p0, p1: (n, 3) or (3,), the ends. radius: one, (n,), or (n, 2) of both ends; radius1: the radius at p1. One of anything
        stands for all. Arrays of float32 and float64 are taken as they lie; scene units.

        u: (n, 2), of capsules that make chains: what the texture coordinate u is at p0 and at p1. It is linear between, and v runs across
        as it does on pbrt's curves. Without it u runs around each capsule and v along it, from 0 to 1.

        color: linear sRGB, (3,) or (n, 3) (more than 4096 different ones are rounded to 1/15 of the square root); of a grey
        diffuse material, or of `material`. material: one of caplet.materials, a name or a number. transform: (4, 4).
        emission: a radiance, or the parameters of an area light. inside, outside: of caplet.media. object: the name of an object
        definition, to be placed by add_instances.

        Returns the Shape. In `trace`, "primitive" is the capsule's row.
        """
        p0, p1, radius0, radius1, u, count = _capsules(p0, p1, radius, radius1, u)
        material, each = self._colored(color, material, count)
        number = self._native.add_capsules(count, p0, p1, radius0, radius1, each, u, self._options(
            name, transform, material, emission, inside, outside, object, reverse_orientation))
        return self._one(number, object)

    def add_spheres(self, center, radius, **options) -> Shape:
        """Spheres, all of them one shape. center: (n, 3); radius: one or (n,). Options as of add_capsules."""
        return self.add_capsules(center, center, radius, **options)

    def add_molecular_surface(self, center, radius, probe=1.4, *, color=None, material=None, name=None, transform=None, emission=None,
                              inside=None, outside=None, object=None, reverse_orientation=False) -> Shape:
        """The solvent-excluded surface of balls, one shape: what a ball of radius `probe` cannot reach (docs/shapes.md).

        center: (n, 3); radius: one or (n,), above 0. color: (3,) or (n, 3); each patch has that of the ball that it is nearest to.
        Options as of add_capsules.

        >>> Scene().add_molecular_surface([[0, 0, 0], [2, 0, 0]], [1.5, 1.2], name="dimer").name
        'dimer'
        """
        center = arrays.rows(center, "center", 3)
        radius = arrays.scalars(radius, "radius")
        count = arrays.common(center=center, radius=radius)
        probe = arrays.scalars(probe, "probe")
        if probe.size != 1:
            raise InputError(f"probe: one radius is needed, not shape {probe.shape}")
        material, each = self._colored(color, material, count)
        number = self._native.add_molecular_surface(count, center, radius, float(probe.reshape(-1)[0]), each, self._options(
            name, transform, material, emission, inside, outside, object, reverse_orientation))
        return self._one(number, object)

    def add_mesh(self, vertices, faces, normals=None, uv=None, *, color=None, material=None, name=None, transform=None, emission=None,
                 inside=None, outside=None, object=None, reverse_orientation=False) -> Shape:
        """Triangles. vertices: (v, 3); faces: (n, 3) of whole numbers, counter-clockwise from outside; normals: (v, 3); uv: (v, 2)."""
        vertices = arrays.rows(vertices, "vertices", 3)
        faces = arrays.numbers(faces, "faces")
        if faces.ndim != 2 or faces.shape[1] != 3:
            raise InputError(f"faces: shape (n, 3) is needed, not {faces.shape}")
        normals = None if normals is None else arrays.rows(normals, "normals", 3)
        uv = None if uv is None else arrays.rows(uv, "uv", 2)
        material, each = self._colored(color, material, 1)
        number = self._native.add_mesh(vertices, faces.reshape(-1), normals, uv, self._options(
            name, transform, material, emission, inside, outside, object, reverse_orientation))
        return self._one(number, object)

    def add(self, type, *, color=None, material=None, name=None, transform=None, emission=None, inside=None, outside=None, object=None,
            reverse_orientation=False, **parameters) -> Shape:
        """One shape of any type of `caplet.shape_types()`, with its parameters as scene files name them (docs/formats/pbrt.md).

        material: may be a list, one a surface. Other options as of add_capsules.

        >>> Scene().add("box", p0=(0, 0, 0), p1=(1, 2, 3), name="crate").name
        'crate'
        """
        material, _ = self._colored(color, material, 1)
        number = self._native.add_shape(type, self._parameters({key.rstrip("_"): value for key, value in parameters.items()}), self._options(
            name, transform, material, emission, inside, outside, object, reverse_orientation))
        return self._one(number, object)

    def add_many(self, type, count, *, each=None, color=None, material=None, name=None, transform=None, emission=None, inside=None,
                 outside=None, object=None, reverse_orientation=False, **parameters) -> Shapes:
        """`count` shapes of one type, each with an id of its own. Returns Shapes.

        each: arrays by the parameters' names whose first dimension is `count`. transform: (4, 4) or (count, 4, 4). color: (3,) or
        (count, 3). `parameters` are common to all.
        """
        count = int(count)
        if count < 1:
            raise InputError(f"{type}: there are none")
        held = {}
        if not (each is None or isinstance(each, dict)):
            raise InputError(f"each: arrays by the parameters' names are needed, not {type(each).__name__}")
        for key, value in (each or {}).items():
            array = arrays.floats(value, key)
            if array.ndim < 1 or array.shape[0] != count:
                raise InputError(f"{key}: {count} rows are needed, not shape {array.shape}")
            held[key.rstrip("_")] = np.ascontiguousarray(array, dtype=np.float64).reshape(-1)
        places = None
        if transform is not None and np.ndim(transform) == 3:
            places = arrays.transforms(transform)
            if len(places) != count:
                raise InputError(f"transform: {count} are needed, not {len(places)}")
            transform = None
        elif transform is not None:
            places = np.ascontiguousarray(np.broadcast_to(arrays.transform(transform), (count, 12)))
        material, numbers = self._colored(color, material, count)
        number = self._native.add_shapes(type, count, self._parameters(parameters), held, places, numbers, self._options(
            name, None, material, emission, inside, outside, object, reverse_orientation))
        first = number - self._first(object)
        self._changed()
        return Shapes(self, first, count, object or "")

    def _many(self, type, wide, options):
        """Of one number a shape, or of `wide`: name -> (value, width)."""
        held = {name: arrays.rows(value, name, width) if width > 1 else arrays.scalars(value, name)
                for name, (value, width) in wide.items() if value is not None}
        count = arrays.common(**held)
        turns = options.get("transform")
        if count == 1 and turns is not None and np.ndim(turns) == 3:
            count = len(turns)
        return self.add_many(type, count, each={name: np.broadcast_to(value, (count, *value.shape[1:])) for name, value in held.items()},
                             **options)

    def add_cylinders(self, p0, p1, radius, **options) -> Shapes:
        """Closed cylinders, each a shape: p0, p1 (n, 3), radius one or (n,). caps="flat", "round" or "open"; options of add_many."""
        return self._many("cylinder", {"p0": (p0, 3), "p1": (p1, 3), "radius": (radius, 1)}, options)

    def add_cones(self, p0, p1, radius, **options) -> Shapes:
        """Cones and frusta, each a shape: p0, p1 (n, 3), radius (n, 2) of both ends, or (n,) of the first. caps= as of cylinders."""
        radius = arrays.floats(radius, "radius")
        width = 2 if radius.ndim == 2 else 1
        return self._many("cone", {"p0": (p0, 3), "p1": (p1, 3), "radius": (radius, width)}, options)

    def add_boxes(self, p0, p1, **options) -> Shapes:
        """Boxes along the axes (of `transform`), each a shape: opposite corners p0, p1 (n, 3)."""
        return self._many("box", {"p0": (p0, 3), "p1": (p1, 3)}, options)

    def add_disks(self, radius, **options) -> Shapes:
        """Disks in the plane z = height of `transform`, each a shape. height=, innerradius=, phimax= (degrees)."""
        return self._many("disk", {"radius": (radius, 1)}, options)

    def add_ellipsoids(self, center, radii, rotation=None, **options) -> Shapes:
        """Ellipsoids, each a shape: center (n, 3), radii (n, 3) along the axes of rotation, (n, 3, 3) or (3, 3)."""
        center, radii = arrays.rows(center, "center", 3), arrays.rows(radii, "radii", 3)
        turns = arrays.floats(np.eye(3) if rotation is None else rotation, "rotation").astype(np.float64)
        if turns.shape[-2:] != (3, 3) or turns.ndim > 3:
            raise InputError(f"rotation: shape (n, 3, 3) or (3, 3) is needed, not {turns.shape}")
        turns = turns.reshape(-1, 3, 3)
        count = arrays.common(center=center, radii=radii, rotation=turns)
        places = np.zeros((count, 4, 4))
        places[:, :3, :3] = turns * radii[:, np.newaxis, :]
        places[:, :3, 3] = center
        places[:, 3, 3] = 1
        return self.add_many("sphere", count, transform=places, **options)

    def add_polyhedron(self, points, normals, **options) -> Shape:
        """The solid within planes: points on them (n, 3) and outward normals (n, 3). Options as of `add`."""
        return self.add("polyhedron", P=arrays.rows(points, "points", 3), N=arrays.rows(normals, "normals", 3), **options)

    def add_csg(self, operation, operands, **options) -> Shape:
        """"union", "intersection" or "difference" of object definitions (by name) that hold one closed shape each."""
        return self.add("csg", operation=operation, operands=list(operands), **options)

    def add_instances(self, object, transforms) -> range:
        """Places an object definition: (n, 4, 4) or (4, 4). Returns the numbers of the instances."""
        transforms = arrays.transforms(transforms)
        first = self._native.add_instances(object, transforms)
        self._changed()
        return range(first, first + len(transforms))

    @property
    def instances(self) -> int:
        """How many there are."""
        return self._native.instances

    def instance(self, number):
        """Where an instance is: 4 x 4."""
        return self._native.instance(number)

    def set_instance(self, number, transform):
        """Puts an instance elsewhere; its motion goes along."""
        self._native.set_instance(number, arrays.transform(transform))
        self._changed()

    def animate_instance(self, number, times, transforms, pivot=(0, 0, 0)):
        """Moves an instance while the shutter is open: transforms (n, 4, 4) at n times (seconds, rising), two or more.

        Between them it shifts, turns and stretches evenly, as in pbrt, and the pivot, a point of the object, goes straight
        on. With empty lists it rests. The shutter is that of the camera: `shutteropen`, `shutterclose` (0 and 1 second).
        """
        self._native.set_instance_motion(number, *self._keys(times, transforms), _point(pivot, "pivot"))
        self._changed()

    def animate_camera(self, times, transforms):
        """Moves the camera likewise; transforms take its space (x right, y up, z forward) to the world."""
        self._native.set_camera_motion(*self._keys(times, transforms))
        self._changed()

    def shutter(self, open, close):
        """Opens the camera's shutter from one time to another (seconds). Pictures stay as bright as they are."""
        self._native.set_shutter(float(open), float(close))
        self._changed()

    @staticmethod
    def _keys(times, transforms):
        times = arrays.floats(times, "times").astype(np.float64, copy=False)
        if times.ndim != 1:
            raise InputError(f"times: shape (n,) is needed, not {times.shape}")
        return times.tolist(), arrays.transforms(transforms if len(times) else np.zeros((0, 4, 4)))

    def _first(self, object):
        return self._native.shape_in(object, 0) if object else 0

    def _one(self, number, object):
        self._changed()
        return Shape(self, number - self._first(object), object or "")

    # --- Files ---

    def save(self, path) -> None:
        """Writes pbrt text (`.pbrt`) that gives the same picture, bit for bit."""
        self._present()
        self._native.save(os.fspath(path))

    def _present(self):
        self._native.present()


def _point(value, name):
    array = arrays.rows(value, name, 3)
    if len(array) != 1:
        raise InputError(f"{name}: one point is needed, not {len(array)}")
    return [float(one) for one in array[0]]


def _distinct(colors):
    """Different colours and which each row has; rounded in their square roots where there are more than can be materials."""
    for steps in (65535, 15):
        key = np.round(np.sqrt(colors.astype(np.float64)) * steps).astype(np.uint64)
        key = (key[:, 0] << np.uint64(32)) | (key[:, 1] << np.uint64(16)) | key[:, 2]
        _, first, which = np.unique(key, return_index=True, return_inverse=True)
        if len(first) <= _MOST_COLORS:
            return colors[first], which
    raise AssertionError("16^3 colours are not more than 4096")


def _option(value):
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    if isinstance(value, (list, tuple)) and value and all(isinstance(one, str) for one in value):
        return "\n".join(value)
    return value if isinstance(value, str) else ",".join(repr(float(v)) for v in value) if np.ndim(value) else str(value)


@keywords
def load(path: str | os.PathLike[str], **options: Any) -> Scene:
    """Reads a scene of any of `caplet.formats()`. Every mistake is told with its file, line and column (InputError).

    options: what the program takes as --NAME VALUE of a file and its picture, with _ for -: view="top" or a direction, up="z",
    projection="orthographic", light="flat", background="white", least_width=1.5, style="sticks",
    show=["polymer: cartoon", "ligand: sticks"]... no_outside=True, for scenes of strangers: the file may name others in its own
    folder and below it alone. The package xacro, where it is installed, expands `.xacro` files of robots.
    """
    if os.fspath(path).endswith(".xacro"):
        from .bridges.xacro import load_xacro
        return load_xacro(os.fspath(path), lambda file: load(file, **options), bool(options.get("no_outside")))
    try:
        return Scene(_caplet.load(os.fspath(path), {name.replace("_", "-"): _option(value) for name, value in options.items()}))
    except InputError as error:
        if error.file is None:  # of the file as a whole
            error.file = os.fspath(path)
        raise
