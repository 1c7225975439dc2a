# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Meshes that trimesh has read."""
import numpy as np

from .. import materials
from ..errors import InputError
from ..scene import Scene
from ..spelling import keywords


def _material(mesh):
    color = getattr(mesh.visual, "main_color", None)
    if color is None:
        return materials.diffuse()
    screen = np.asarray(color[:3]) / 255
    return materials.diffuse(reflectance=tuple(np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055)**2.4)))


@keywords
def from_trimesh(mesh):
    """A scene of a trimesh.Trimesh, or of a trimesh.Scene: each geometry is an object definition, each node an instance.

    Vertices and faces are taken as they are, in their units; a mesh has its main colour.
    """
    import trimesh
    scene = Scene()
    if isinstance(mesh, trimesh.Trimesh):
        scene.add_mesh(mesh.vertices, mesh.faces, material=_material(mesh), name="mesh")
        return scene
    if not isinstance(mesh, trimesh.Scene):
        raise InputError(f"mesh: a trimesh.Trimesh or trimesh.Scene is needed, not {type(mesh).__name__}")
    placed = {}
    for node in mesh.graph.nodes_geometry:
        place, name = mesh.graph[node]
        placed.setdefault(name, []).append(place)
    for name, places in placed.items():
        part = mesh.geometry[name]
        if not isinstance(part, trimesh.Trimesh) or not len(part.faces):
            continue
        scene.add_mesh(part.vertices, part.faces, material=_material(part), name=name, object=name)
        scene.add_instances(name, np.array(places))
    if not scene.objects:
        raise InputError("the trimesh scene has no triangles")
    return scene


_CELLS = {"tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
          "hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
          "wedge": ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
          "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4))}


def _boundary(cells, faces):
    """Triangles of the faces that a single cell has."""
    out = []
    for corners in {len(face) for face in faces}:
        every = np.concatenate([cells[:, list(face)] for face in faces if len(face) == corners])
        _, first, count = np.unique(np.sort(every, axis=1), axis=0, return_index=True, return_counts=True)
        alone = every[np.sort(first[count == 1])]
        out += [alone[:, [0, k, k + 1]] for k in range(1, corners - 1)]
    return np.concatenate(out)


@keywords
def from_meshio(mesh, radius=None):
    """A scene of a meshio.Mesh (of pyvista by pyvista.to_meshio): lines as capsules, triangles and quadrilaterals as triangles, of
    tetrahedra, hexahedra, wedges and pyramids the faces that one of them has.

    radius: of lines; None: 1/300 of the mesh's extent. Points of two dimensions lie at z = 0.
    """
    points = np.asarray(mesh.points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] not in (2, 3) or not len(points):
        raise InputError("mesh: points of two or three dimensions are needed")
    points = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
    triangles, lines = [], []
    for block in mesh.cells:
        cells = np.asarray(block.data)
        if not len(cells):
            continue
        if block.type == "line":
            lines.append(cells)
        elif block.type in ("triangle", "quad"):
            triangles += [cells[:, [0, k, k + 1]] for k in range(1, cells.shape[1] - 1)]
        elif block.type in _CELLS:
            triangles.append(_boundary(cells, _CELLS[block.type]))
        elif block.type != "vertex":
            raise InputError(f"mesh: cells of type {block.type} are not read")
    if not triangles and not lines:
        raise InputError("mesh: there are no lines and no faces")
    scene = Scene()
    if triangles:
        scene.add_mesh(points, np.concatenate(triangles), material=materials.diffuse(), name="faces")
    if lines:
        ends = np.concatenate(lines)
        extent = np.linalg.norm(points.max(axis=0) - points.min(axis=0))
        scene.add_capsules(points[ends[:, 0]], points[ends[:, 1]], max(extent / 300, 1e-6) if radius is None else radius, name="lines")
    return scene
