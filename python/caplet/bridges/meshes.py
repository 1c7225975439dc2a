# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Meshes that trimesh has read."""
import numpy as np

from .. import materials
from ..errors import InputError
from ..scene import Scene


def _material(mesh):
    color = getattr(mesh.visual, "main_color", None)
    if color is None:
        return materials.diffuse()
    screen = np.asarray(color[:3]) / 255
    return materials.diffuse(reflectance=tuple(np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055)**2.4)))


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
