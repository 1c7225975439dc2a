# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Materials, textures, lights, media, cameras: a type of the library's lists with parameters by name."""
import inspect

import numpy as np

from .errors import InputError
from .lists import EXTRA, described_parameters, known_parameters, meaning, signature, spelled, types
from .spelling import nearest

_FILES = "docs/formats/pbrt.md"


class Blackbody:
    """The light of a black body, as a spectrum. kelvin: its temperature."""

    def __init__(self, kelvin):
        self.kelvin = float(kelvin)

    def __repr__(self):
        return f"Blackbody({self.kelvin:g})"


class Named:
    """A type and its parameters; each is made by a function of the type's name in a module of this package."""

    def __init__(self, type, parameters, transform=None, name=None):
        self.type = type
        self.parameters = dict(parameters)
        self.transform = transform
        self.name = name

    def __repr__(self):
        said = ", ".join(f"{spelled(key)}={value!r}" for key, value in self.parameters.items())
        return f"{type(self).__name__.lower()}.{self.type}({said})"


class Material(Named):
    """What a surface is made of (caplet.materials)."""

    _COLORS = ("reflectance", "base_color", "color")

    def with_color(self, color):
        """The same material of another colour: its reflectance or base_color."""
        known = [name for name, _ in known_parameters("material", self.type)]
        for name in self._COLORS:
            if name in known:
                return Material(self.type, {**self.parameters, name: color}, name=self.name)
        raise InputError(f"{self.type} has no colour")


class Texture(Named):
    """What varies over surfaces (caplet.textures), in place of a number or a colour."""

    is_float = False


class Light(Named):
    """A light other than a shape that emits (caplet.lights)."""


class Medium(Named):
    """What fills space (caplet.media)."""


class Camera(Named):
    """caplet.cameras"""


_CLASSES = {"material": Material, "texture": Texture, "light": Light, "medium": Medium, "camera": Camera}


_SAID = {
    "is_float": "of numbers, not of colours",
    "transform": "4 x 4, world space from its own",
    "name": "what it is called",
    "eye": "where the camera is, scene units",
    "target": "a point that it looks at",
    "up": "the direction that is up in the picture",
}


def constructor(kind, type):
    """The function that makes one of this type."""
    asked = signature(kind, type)
    names = {key: name for key, name, _ in asked}
    extra = EXTRA.get(kind, ())
    made = _CLASSES[kind]

    def make(**given):
        own = {name: given.pop(name) for name, _ in extra if name in given}
        values = {}
        for key, value in given.items():
            if key not in names:
                raise TypeError(f"{type}() got an unexpected keyword argument {key!r}; {nearest(key, names)}")
            if value is not None:
                values[names[key]] = value
        if "alpha" in values and "alpha_u" in names:
            alpha = values.pop("alpha")
            values.setdefault("alpha_u", alpha)
            values.setdefault("alpha_v", alpha)
        if "up" in dict(extra):
            own.setdefault("up", (0, 1, 0))
        out = made(type, values, own.get("transform"), own.get("name"))
        for name in ("is_float", "eye", "target", "up"):
            if name in own:
                setattr(out, name, own[name])
        return out

    make.__name__ = make.__qualname__ = spelled(type)
    only = inspect.Parameter.KEYWORD_ONLY
    make.__signature__ = inspect.Signature([inspect.Parameter(key, only, default=None) for key in names] +
                                           [inspect.Parameter(key, only, default=value) for key, value in extra])
    lines = [f"The {kind} {type!r} ({_FILES}). What is left out is as in scene files that leave it out.", ""]
    said = {one["name"]: meaning(one) for one in described_parameters(kind, type)}
    for key, name, _ in asked:
        lines.append(f"{key}: {said.get(name, 'GGX alpha along both directions')}")
    lines += [f"{key}: {_SAID[key]}" for key, _ in extra]
    make.__doc__ = "\n".join(lines)
    return make


def fill(module, kind):
    """Gives a module a constructor for each type of a list."""
    module["__all__"] = []
    for type in types(kind):
        name = spelled(type)
        module[name] = constructor(kind, type)
        module[name].__module__ = module["__name__"]
        module["__all__"].append(name)

    def missing(name):
        raise AttributeError(f"module {module['__name__']!r} has no attribute {name!r}; {nearest(name, module['__all__'])}")

    module["__getattr__"] = missing


def color(value, name="color"):
    """A linear colour: three numbers, one for grey, or "#rrggbb" of a screen (sRGB)."""
    if isinstance(value, str) and value.startswith("#") and len(value) == 7:
        try:
            screen = np.array([int(value[i:i + 2], 16) for i in (1, 3, 5)]) / 255
        except ValueError:
            raise InputError(f"{name}: {value!r} is no colour") from None
        return np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055)**2.4)
    if isinstance(value, str):
        raise InputError(f"{name}: {value!r} is no colour: three numbers or '#rrggbb' is")
    return value
