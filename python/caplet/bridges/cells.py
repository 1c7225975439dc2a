# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What bridges of neurons share: colours, cells as object definitions that are placed by instances, errors that name files."""
import colorsys
import importlib

import numpy as np

from .. import arrays, colors, materials
from ..errors import InputError
from ..named import color as as_color

# As of files that the program reads (docs/formats/swc.md).
TYPE_COLORS = {1: (0.86, 0.62, 0.22), 2: (0.20, 0.62, 0.95), 3: (0.95, 0.36, 0.18), 4: (0.66, 0.22, 0.66)}
OTHER_COLOR = (0.55, 0.56, 0.52)
TYPE_NAMES = {0: "undefined", 1: "soma", 2: "axon", 3: "basal dendrite", 4: "apical dendrite"}
MOST_NODES = 10_000_000  # that are shown: 5 GB of instances while they are read
STEPS = 16  # of colours that tell numbers: a cell of each is an object definition of its own
_MOST_CLASSES = 256


def package(name, wanted_by, of=None):
    """The module `name`; of: the package that brings it, where it has another name."""
    try:
        return importlib.import_module(name)
    except ImportError as problem:
        if problem.name is not None and problem.name.split(".")[0] != name:
            raise  # it is there, and lacks something itself
        raise ModuleNotFoundError(f"caplet.{wanted_by} needs the package {of or name}: pip install {of or name}", name=name) from None


def wrong(path, text, line=None):
    """An InputError of a file, or of a line of it."""
    if line is not None:
        return InputError(f"{path}:{line}: {text}")
    error = InputError(f"{path}: {text}")
    error.file = str(path)
    return error


def categories(count):
    """Colours of a screen's palette that tell kinds apart, linear (count, 3): ten well known ones, then hues by the golden section."""
    first = ("1f77b4", "ff7f0e", "2ca02c", "d62728", "9467bd", "8c564b", "e377c2", "bcbd22", "17becf", "7f7f7f")
    screen = [[int(code[i:i + 2], 16) / 255 for i in (0, 2, 4)] for code in first[:count]]
    screen += [colorsys.hsv_to_rgb(k * 0.6180339887498949 % 1, 0.45 + 0.35 * (k % 2), 0.9 - 0.3 * (k % 3) / 2) for k in range(len(screen), count)]
    screen = np.array(screen).reshape(-1, 3)
    return np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055)**2.4)


class Look:
    """Materials: of segments by their types, or of whole cells by classes.

    classes: (n,) of each node, -1: by type. colors: (n, 3) of each node where it is shown as a sphere.
    """

    def __init__(self, classes, class_colors, node_colors, labels=None, told=None):
        self.classes, self.colors, self.told = classes, node_colors, told
        self.materials = [materials.diffuse(reflectance=tuple(map(float, one))) for one in class_colors]
        self.labels = {} if labels is None else dict(zip(labels, map(tuple, np.asarray(class_colors).tolist())))
        self._types = {}

    def name(self, cell_class):
        """What a class is called; empty where all cells are of one."""
        return "" if cell_class < 0 or len(self.materials) < 2 else list(self.labels)[cell_class] if self.labels else f"color {cell_class}"

    def of(self, cell_class, kind):
        if cell_class >= 0:
            return self.materials[cell_class]
        if kind not in self._types:
            self._types[kind] = materials.diffuse(reflectance=TYPE_COLORS.get(kind, OTHER_COLOR))
        return self._types[kind]

    @classmethod
    def by_type(cls, kinds, count):
        """kinds: (n,), by which spheres are told apart."""
        return cls(np.full(len(kinds), -1), [], categories(count)[kinds])

    @classmethod
    def by_kind(cls, kinds, labels):
        """kinds: (n,), numbers of labels, which are sorted; the empty one is grey."""
        nameless = int(bool(labels) and labels[0] == "")
        class_colors = np.concatenate([np.broadcast_to(colors.UNKNOWN, (nameless, 3)), categories(len(labels) - nameless)])
        return cls(kinds, class_colors, class_colors[kinds], labels)

    @classmethod
    def plain(cls, color, count):
        one = np.broadcast_to(arrays.floats(as_color(color), "color").astype(np.float64), 3)
        return cls(np.zeros(count, np.int64), [one], np.broadcast_to(one, (count, 3)))

    @classmethod
    def by_value(cls, values, low, high, title):
        """Numbers (n,), by caplet.color_map: of cells in 16 steps; NaN is grey."""
        low, high = colors.ends(values, low, high)
        part = colors.parts(values, low, high)
        known = ~np.isnan(part)
        steps = np.full(len(values), STEPS)
        steps[known] = np.round((STEPS - 1) * part[known])
        middle = [colors.TABLE[round((colors.STEPS - 1) * k / (STEPS - 1))] for k in range(STEPS)]
        return cls(steps, [*middle, colors.UNKNOWN], colors.color_map(values, low, high), told=(title, low, high))

    @classmethod
    def by_colors(cls, given):
        """Colours (n, 3) of cells, at most 256 different ones."""
        if not (np.isfinite(given).all() and given.min() >= 0 and given.max() <= 1):
            raise InputError("color: reflectances from 0 to 1 are needed")
        different, which = np.unique(given, axis=0, return_inverse=True)
        if len(different) > _MOST_CLASSES:
            raise InputError(f"color: {len(different)} different colours of cells; at most {_MOST_CLASSES}, as each is a copy of its morphology")
        return cls(which.reshape(-1), different, given)


def add_cell(scene, look, cell_class, name, p0, p1, radii, kinds, object=None, u=None):
    """Segments as capsules, a shape for each SWC type: (its name, rows of the segments that it shows). u: (n, 2), of all but somata."""
    shown = radii.max(axis=1) > 0
    for kind in np.unique(kinds[shown]):
        rows = np.flatnonzero(shown & (kinds == kind))
        shape = f"{name} {TYPE_NAMES.get(int(kind), f'type {kind}')}"
        scene.add_capsules(p0[rows], p1[rows], radii[rows], u=None if u is None or kind == 1 else u[rows],
                           material=look.of(cell_class, int(kind)), name=shape, object=object)
        yield shape, rows
