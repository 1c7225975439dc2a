# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What a render gives: a picture with its layers as arrays."""
from __future__ import annotations

import inspect
import numbers
import os
import tempfile
from typing import Any

import numpy as np

from . import _caplet
from .errors import InputError
from .spelling import keywords


_OVERLAYS = {name: (values, help) for name, values, help in _caplet.overlays()}  # the program's own, by their names


def _drawn(overlays):
    """What the library takes: {name: text}, of the usual value an empty one."""
    out = {}
    for keyword, value in overlays.items():
        name = keyword.replace("_", "-")
        if name not in _OVERLAYS:
            raise TypeError(f"there is no overlay {keyword!r}; there are {', '.join(one.replace('-', '_') for one in _OVERLAYS)}")
        if value is None or (isinstance(value, (bool, np.bool_)) and not value):
            continue
        if isinstance(value, (bool, np.bool_)):
            out[name] = ""
        elif isinstance(value, numbers.Real):
            out[name] = repr(float(value))
        elif isinstance(value, str) and value:
            out[name] = value
        elif isinstance(value, (list, tuple)) and value and all(isinstance(one, str) for one in value):
            out[name] = "\n".join(value)
        else:
            raise InputError(f"{keyword}: True, a number or a text is needed, not {value!r}")
    return out


def _describe(method, first):
    """Gives a method that takes overlays their names and words."""
    given = [inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD) for name in first]
    method.__signature__ = inspect.Signature(given + [
        inspect.Parameter(name.replace("-", "_"), inspect.Parameter.KEYWORD_ONLY, default=None) for name in _OVERLAYS])
    said = [f"{name.replace('-', '_')}: {help}" for name, (_, help) in _OVERLAYS.items()]
    method.__doc__ = inspect.cleandoc(method.__doc__) + "\n\n" + "\n".join(said)


@keywords
class Image:
    """A picture and its layers: arrays of (height, width) or (height, width, 3), from the top left.

    rgb: scene-linear float32. alpha: what is covered, 0 to 1. depth: along the view, scene units. normal: unit, world.
    position: world. albedo. variance: of each pixel's mean. object_id, primitive_id: uint32, 2^32 - 1 where nothing is.
    In a notebook it shows itself.
    """

    def __init__(self, film):
        self._film = film
        self._cache = {}
        self._png = None

    @property
    def channels(self) -> list[str]:
        """Names of all channels: "R", "albedo.G", "object.id"..."""
        return self._film.channels()

    def __getitem__(self, name):
        """One channel by its name, (height, width)."""
        if not isinstance(name, str):
            raise InputError(f"a channel's name is needed, not {name!r}")
        if name not in self._cache:
            self._cache[name] = self._film.ids(name) if name.endswith(".id") or name == "samples" else self._film.values(name)
        return self._cache[name]

    def _layer(self, *names):
        key = ",".join(names)
        if key not in self._cache:
            self._cache[key] = np.stack([self[name] for name in names], axis=2)
        return self._cache[key]

    @property
    def rgb(self) -> np.ndarray:
        return self._layer("R", "G", "B")

    @property
    def alpha(self) -> np.ndarray:
        return self["A"]

    @property
    def depth(self) -> np.ndarray:
        return self["Z"]

    @property
    def normal(self) -> np.ndarray:
        return self._layer("N.X", "N.Y", "N.Z")

    @property
    def position(self) -> np.ndarray:
        return self._layer("P.X", "P.Y", "P.Z")

    @property
    def albedo(self) -> np.ndarray:
        return self._layer("albedo.R", "albedo.G", "albedo.B")

    @property
    def variance(self) -> np.ndarray:
        return self._layer("variance.R", "variance.G", "variance.B")

    @property
    def object_id(self) -> np.ndarray:
        return self["object.id"]

    @property
    def primitive_id(self) -> np.ndarray:
        return self["primitive.id"]

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        return self._film.width, self._film.height

    @property
    def shape(self) -> tuple[int, int]:
        """(height, width)"""
        return self._film.height, self._film.width

    @property
    def spp(self) -> int:
        """Samples a pixel that were finished."""
        return self._film.spp

    @property
    def samples(self):
        """Which they are: [(first, count)]."""
        return self._film.samples()

    def save(self, path: str | os.PathLike[str], **overlays: Any) -> None:
        """`.exr`: all layers. `.png` and others: tone-mapped, 8 bits a channel, with what is drawn on it (docs/pictures.md).

        Each of these is True for its usual value, or that; None and False are none. The picture itself stays as it is."""
        path, drawn = os.fspath(path), _drawn(overlays)
        if not path.lower().endswith(".exr"):
            self._film.write_preview(path, drawn)
        elif drawn:
            raise InputError(f"{', '.join(drawn)}: drawn on tone-mapped pictures alone, not on .exr")
        else:
            self._film.write_exr(path)

    def matte_names(self, by="object"):
        """The names that a matte tells apart: by "object", "material" or "asset" (the file of a shape). Of a render with cryptomatte=True."""
        return self._film.matte_names(by)

    def matte(self, name, by="object") -> np.ndarray:
        """The share of each pixel that what has this name covers: (height, width), 0 to 1, antialiased as alpha is."""
        return self._film.matte(by, name)

    def save_deep(self, path) -> None:
        """A deep EXR, of a render with deep=True: alpha and distance of all that each pixel shows, near to far."""
        self._film.write_deep_exr(os.fspath(path))

    def save_film(self, path) -> None:
        """The exact sums as an EXR file, which load_film takes, and Session.resume goes on with."""
        self._film.save(os.fspath(path))

    def __add__(self, other):
        """The samples of both, of the same scene and view."""
        if not isinstance(other, Image):
            return NotImplemented
        film = self._film.copy()
        film.add(other._film)
        return Image(film)

    def png(self, **overlays) -> bytes:
        """The bytes of a PNG, tone-mapped, with what is drawn on it as of `save`."""
        drawn = _drawn(overlays)
        if drawn:
            return self._png_of(drawn)
        if self._png is None:
            self._png = self._png_of({})
        return self._png

    def _png_of(self, drawn):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "image.png")
            self._film.write_preview(file, drawn)
            with open(file, "rb") as held:
                return held.read()

    def _repr_png_(self):
        try:
            return self.png()
        except InputError:  # of a library without PNG
            return None

    def __repr__(self):
        return f"<caplet.Image {self.size[0]} x {self.size[1]}, {self.spp} samples a pixel>"


_describe(Image.save, ("self", "path"))
_describe(Image.png, ("self",))


@keywords
def load_film(path: str | os.PathLike[str], scene: Any = None) -> Image:
    """Loads a film that save_film, or `caplet render --film`, wrote. scene: its scene, for overlays; its exposure and colours are then
    this scene's, else those of the film."""
    if scene is None:
        return Image(_caplet.Film.load(os.fspath(path)))
    native = getattr(scene, "_native", None)
    if not isinstance(native, _caplet.Scene):
        raise InputError(f"scene: a caplet.Scene is needed, not {type(scene).__name__}")
    return Image(_caplet.Film.load(os.fspath(path), native))
