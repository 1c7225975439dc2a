# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Neurons that MorphIO has read."""
import numpy as np

from .. import materials
from ..errors import InputError
from ..scene import Scene
from .cells import OTHER_COLOR, TYPE_COLORS
from .chains import along
from ..spelling import keywords


def soma_of(soma):
    """Spheres: centers (n, 3) and radii (n,)."""
    points = np.asarray(soma.points, dtype=np.float64).reshape(-1, 3)
    radii = np.asarray(soma.diameters, dtype=np.float64) / 2
    if not len(points):
        return points, radii
    if "CONTOUR" in str(soma.type):  # an outline: the sphere of its mean distance
        center = points.mean(axis=0, keepdims=True)
        return center, np.linalg.norm(points - center, axis=1).mean(keepdims=True)
    if "CYLINDERS" in str(soma.type):
        return points, radii
    return points[:1], radii[:1]


def neurites(morphology):
    """Segments of all sections, as (p0, p1, radii, sections, types, u)."""
    p0, p1, radii, sections, types = [np.empty((0, 3))], [np.empty((0, 3))], [np.empty((0, 2))], [np.empty(0, int)], [np.empty(0, int)]
    u = [np.empty((0, 2))]
    for section in morphology.iter():
        points = np.asarray(section.points, dtype=np.float64)
        ends = np.asarray(section.diameters, dtype=np.float64) / 2
        p0.append(points[:-1])
        p1.append(points[1:])
        radii.append(np.stack([ends[:-1], ends[1:]], 1))
        sections.append(np.full(len(points) - 1, section.id))
        types.append(np.full(len(points) - 1, int(section.type)))
        u.append(along(points))
    return tuple(map(np.concatenate, (p0, p1, radii, sections, types, u)))


@keywords
def from_morphio(morphology):
    """A scene of a morphio.Morphology, in its units (micrometres): shapes "soma" (spheres) and "neurites" (tapered capsules, one a
    segment), coloured by type as files of neurons are; u runs from 0 to 1 along each section.

    A soma of one point or three is a sphere, an outline the sphere of its mean distance, a chain of cylinders a sphere a point.
    scene.info: "section" and "type" of each capsule of the neurites. Segments of no radius at both ends are left out.
    """
    scene = Scene()
    centers, balls = soma_of(morphology.soma)
    shown = balls > 0
    if shown.any():
        scene.add_spheres(centers[shown], balls[shown], color=TYPE_COLORS[1], name="soma")
    p0, p1, radii, sections, types, u = neurites(morphology)
    kept = radii.max(axis=1) > 0
    if kept.any():
        kinds, which = np.unique(types[kept], return_inverse=True)
        colors = np.array([TYPE_COLORS.get(int(kind), OTHER_COLOR) for kind in kinds])
        scene.add_capsules(p0[kept], p1[kept], radii[kept], u=u[kept], color=colors[which], material=materials.diffuse(), name="neurites")
        scene.info.update(section=sections[kept], type=types[kept])
    if not scene.shapes:
        raise InputError("the morphology has nothing to show")
    return scene
