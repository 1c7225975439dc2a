# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Neurons that MorphIO has read."""
import numpy as np

from .. import materials
from ..errors import InputError
from ..scene import Scene

# As of files that the program reads (docs/formats/swc.md).
_COLORS = {1: (0.86, 0.62, 0.22), 2: (0.20, 0.62, 0.95), 3: (0.95, 0.36, 0.18), 4: (0.66, 0.22, 0.66)}
_OTHER = (0.55, 0.56, 0.52)


def _soma(soma):
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


def from_morphio(morphology):
    """A scene of a morphio.Morphology, in its units (micrometres): shapes "soma" (spheres) and "neurites" (tapered capsules, one a
    segment), coloured by type as files of neurons are.

    A soma of one point or three is a sphere, an outline the sphere of its mean distance, a chain of cylinders a sphere a point.
    scene.info: "section" and "type" of each capsule of the neurites. Segments of no radius at both ends are left out.
    """
    p0, p1, radii, sections, types = [], [], [], [], []
    for section in morphology.iter():
        points = np.asarray(section.points, dtype=np.float64)
        ends = np.asarray(section.diameters, dtype=np.float64) / 2
        p0.append(points[:-1])
        p1.append(points[1:])
        radii.append(np.stack([ends[:-1], ends[1:]], 1))
        sections.append(np.full(len(points) - 1, section.id))
        types.append(np.full(len(points) - 1, int(section.type)))
    scene = Scene()
    centers, balls = _soma(morphology.soma)
    shown = balls > 0
    if shown.any():
        scene.add_spheres(centers[shown], balls[shown], color=_COLORS[1], name="soma")
    if p0:
        radii = np.concatenate(radii)
        kept = radii.max(axis=1) > 0
        types, sections = np.concatenate(types)[kept], np.concatenate(sections)[kept]
        kinds, which = np.unique(types, return_inverse=True)
        colors = np.array([_COLORS.get(int(kind), _OTHER) for kind in kinds])
        if kept.any():
            scene.add_capsules(np.concatenate(p0)[kept], np.concatenate(p1)[kept], radii[kept], color=colors[which],
                               material=materials.diffuse(), name="neurites")
            scene.info.update(section=sections, type=types)
    if not scene.shapes:
        raise InputError("the morphology has nothing to show")
    return scene
