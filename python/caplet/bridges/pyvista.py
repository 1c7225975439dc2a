# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Datasets of PyVista: lines, surfaces, clouds of points."""
import numpy as np

from .. import arrays, colors, materials, textures
from ..errors import InputError
from ..scene import Scene
from .chains import along
from ..spelling import keywords

_RADIUS, _SCALARS = "caplet radius", "caplet scalars"  # of arrays that are given beside the dataset
_THIN = 300  # the extent over the radius that no one has said


def _blocks(pyvista, dataset, name=""):
    """(name, PolyData with its point and cell arrays) of all that a dataset holds."""
    if isinstance(dataset, pyvista.MultiBlock):
        for key, block in zip(dataset.keys(), dataset):
            if block is not None:
                yield from _blocks(pyvista, block, f"{name}{key} ")
        return
    if isinstance(dataset, pyvista.DataSet):
        surface = dataset if isinstance(dataset, pyvista.PolyData) else dataset.extract_surface(algorithm="dataset_surface")
        if surface.n_points:
            yield name, surface
        return
    raise InputError(f"dataset: one of PyVista's is needed, not {type(dataset).__name__}")


def _with(dataset, given, name, what):
    """The dataset with an array of its own under `name`, and that name; as it is where a name or nothing is given."""
    if given is None or isinstance(given, str):
        return dataset, given
    values = np.asarray(given)
    for table, count in (("point_data", getattr(dataset, "n_points", -1)), ("cell_data", getattr(dataset, "n_cells", -1))):
        if values.ndim and len(values) == count:
            dataset = dataset.copy(deep=False)
            getattr(dataset, table)[name] = values
            return dataset, name
    raise InputError(f"{what}: the name of an array, or one with an entry for each point or cell is needed, not shape {values.shape}")


def _array(poly, name, what):
    """("point" or "cell", values) of an array by its name."""
    for where, table in (("point", poly.point_data), ("cell", poly.cell_data)):
        if name in table:
            return where, np.asarray(table[name])
    raise InputError(f"{what}: the dataset has no array {name!r}; it has {', '.join(map(repr, poly.array_names)) or 'none'}")


def _values(poly, name):
    """("point" or "cell", numbers (n,) or colours (n, 3)): of vectors their lengths, of three or four bytes a screen's colour."""
    where, values = _array(poly, name, "scalars")
    if values.dtype.kind not in "fiub":
        raise InputError(f"scalars: {name!r} holds no numbers")
    if values.ndim == 2 and values.shape[1] in (3, 4) and values.dtype == np.uint8:
        return where, arrays.pixels(values[np.newaxis, :, :3], name)[0]
    values = values.astype(np.float64)
    return where, np.linalg.norm(values, axis=1) if values.ndim == 2 else values


def _cells(padded):
    """(points one cell behind the other, how many each has) of VTK's [count, point, point, ...]."""
    padded = np.asarray(padded, dtype=np.int64)
    held, starts, at = padded.tolist(), [], 0
    while at < len(held):
        starts.append(at)
        at += held[at] + 1
    starts = np.array(starts, dtype=np.int64)
    return np.delete(padded, starts), padded[starts]


class _Look:
    """Radii and colours of one PolyData."""

    def __init__(self, poly, radius, scalars, range_of_all, color):
        self.poly, self.color = poly, color
        self.points = np.asarray(poly.points, dtype=np.float64)
        self.range = range_of_all
        self.where, self.values = (None, None) if scalars is None else _values(poly, scalars)
        self.radius_where, self.radii = ("all", float(radius)) if not isinstance(radius, str) else _array(poly, radius, "radius")

    def radius(self, points, cells):
        return self.radii if self.radius_where == "all" else self.radii[points if self.radius_where == "point" else cells]

    def mean(self, points, cells):
        """Colours of capsules between points (n, k), of the cells with these numbers: those of the points' mean value."""
        if self.values is None:
            return self.color
        values = self.values[cells] if self.where == "cell" else self.values[points].mean(axis=1)
        return values if values.ndim == 2 else colors.color_map(values, *self.range)

    def lines(self, scene, name):
        points, sizes = _cells(self.poly.lines)
        if not len(points):
            return
        line = np.repeat(np.arange(len(sizes)), sizes)
        first = np.flatnonzero(line[:-1] == line[1:])
        ends, cells = np.stack([points[first], points[first + 1]], axis=1), self.poly.n_verts + line[first]
        if not len(ends):
            return
        radius = self.radius(ends, cells)
        u = np.concatenate([along(self.points[one]) for one in np.split(points, np.cumsum(sizes)[:-1]) if len(one) > 1])
        scene.add_capsules(self.points[ends[:, 0]], self.points[ends[:, 1]], radius, u=u, color=self.mean(ends, cells),
                           material=materials.diffuse(), name=f"{name}lines")
        scene.info[f"{name}lines"] = line[first]

    def balls(self, scene, name):
        points, sizes = _cells(self.poly.verts)
        if not len(points):
            return
        cells = np.repeat(np.arange(len(sizes)), sizes)
        scene.add_spheres(self.points[points], self.radius(points, cells), color=self.mean(points[:, np.newaxis], cells),
                          material=materials.diffuse(), name=f"{name}points")
        scene.info[f"{name}points"] = points

    def faces(self, scene, name):
        poly = self.poly
        if not poly.n_faces and not poly.n_strips:
            return
        if self.values is not None and self.values.ndim == 2:
            raise InputError("scalars: colours are of lines and points; surfaces are coloured by numbers")
        made = poly.copy(deep=False)
        made.cell_data["caplet cell"] = np.arange(poly.n_cells)
        made = made.triangulate()
        triangles, cells = made.regular_faces, np.asarray(made.cell_data["caplet cell"])
        cells = cells[len(cells) - len(triangles):]  # behind those of vertices and lines
        normals = made.point_data.active_normals
        if normals is not None and not (np.isfinite(normals).all() and (np.linalg.norm(normals, axis=1) > 0).all()):
            normals = None
        corners = np.asarray(made.points, dtype=np.float64)
        if self.values is None:
            scene.add_mesh(corners, triangles, normals=normals, color=self.color, material=materials.diffuse(), name=f"{name}faces")
            return
        if self.where == "cell":  # each has its own corners
            values = np.repeat(self.values[cells], 3)
            corners, normals = corners[triangles.reshape(-1)], None if normals is None else normals[triangles.reshape(-1)]
            triangles = np.arange(len(corners)).reshape(-1, 3)
        else:
            values = self.values
        part = colors.parts(values, *self.range)
        known = ~np.isnan(part[triangles]).any(axis=1)
        if known.any():
            u = (0.5 + (colors.STEPS - 1) * np.nan_to_num(part)) / colors.STEPS  # from the first texel's middle to the last one's
            image = textures.imagemap(pixels=colors.TABLE[np.newaxis], wrap="clamp")
            scene.add_mesh(corners, triangles[known], normals=normals, uv=np.stack([u, np.full_like(u, 0.5)], axis=1),
                           material=materials.diffuse(reflectance=image), name=f"{name}faces")
        if not known.all():
            scene.add_mesh(corners, triangles[~known], normals=normals, color=colors.UNKNOWN, name=f"{name}faces without values")


@keywords
def from_pyvista(dataset, radius=None, scalars=None, low=None, high=None, color=None):
    """A scene of a dataset of PyVista: lines as chains of capsules ("lines"), polygons and strips as triangles ("faces"), vertices as
    spheres ("points"). Of others than PolyData the surface is taken; a MultiBlock's names stand before these.

    radius: of lines and points: one of all, the name of a point or cell array, or such an array (lines between points of different
    radii are tapered); None: 1/300 of the extent. scalars: the name of an array, or one, whose values are told by caplet.color_map
    between low and high (None: its own range) and by a colour bar; of vectors the lengths; of three bytes each, colours of a screen.
    On surfaces values of points are interpolated; a capsule has the mean of its ends; NaN is grey. color: of all, in place of scalars.

    scene.info: "lines": the line of each capsule; "points": the point of each sphere.
    """
    import pyvista
    if scalars is not None and color is not None:
        raise InputError("color: goes without scalars")
    if not (radius is None or isinstance(radius, str) or np.ndim(radius)):
        dataset, radius = dataset, float(radius)
    else:
        dataset, radius = _with(dataset, radius, _RADIUS, "radius")
    named = scalars if isinstance(scalars, str) else "scalars"
    dataset, scalars = _with(dataset, scalars, _SCALARS, "scalars")
    blocks = list(_blocks(pyvista, dataset))
    if not blocks:
        raise InputError("dataset: there are no points")
    if radius is None:
        bounds = np.array([poly.bounds for _, poly in blocks]).reshape(-1, 3, 2)
        radius = max(float(np.linalg.norm(bounds[:, :, 1].max(axis=0) - bounds[:, :, 0].min(axis=0))) / _THIN, 1e-6)
    every = [] if scalars is None else [_values(poly, scalars)[1] for _, poly in blocks]
    is_told = bool(every) and all(values.ndim == 1 for values in every)
    range_of_all = colors.ends(np.concatenate(every), low, high) if is_told else None
    scene = Scene()
    for name, poly in blocks:
        look = _Look(poly, radius, scalars, range_of_all, color)
        look.faces(scene, name)
        look.lines(scene, name)
        look.balls(scene, name)
    if not scene.shapes:
        raise InputError("dataset: there are no lines, faces or vertices")
    if is_told:
        scene.set_color_bar(named, *range_of_all)
    return scene
