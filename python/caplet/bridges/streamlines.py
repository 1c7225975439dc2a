# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Streamlines that nibabel has read."""
import numpy as np

from .. import arrays, materials
from ..errors import InputError
from ..scene import Scene
from .chains import along
from ..spelling import keywords


@keywords
def from_nibabel(tractogram, radius=0.1, color="direction"):
    """A scene of streamlines as chains of capsules, in their world space (millimetres): one shape, "streamlines".

    tractogram: what nibabel.streamlines.load gives, its .tractogram or its .streamlines. radius: of all, or one a streamline.
    color: "direction" (red, green and blue are the axes), or a colour of all. scene.info["streamline"]: that of each capsule.
    """
    lines = getattr(tractogram, "streamlines", tractogram)
    if isinstance(lines, np.ndarray) and lines.ndim != 3:
        raise InputError(f"streamlines: a sequence of (n, 3) is needed, not an array of shape {lines.shape}")
    if isinstance(lines, np.ndarray) and len(lines) > arrays.MOST:
        raise InputError(f"streamlines: {len(lines)}; at most {arrays.MOST}")
    try:
        lines = [arrays.rows(line, "streamlines", 3).astype(np.float32) if len(line) else np.empty((0, 3), np.float32) for line in lines]
    except NotImplementedError as problem:  # of buffers that Python does not take apart
        raise InputError(f"streamlines: {problem}") from None
    held = [(i, line) for i, line in enumerate(lines) if len(line) > 1]
    if not held:
        raise InputError("there are no streamlines of two points or more")
    p0 = np.concatenate([line[:-1] for _, line in held])
    p1 = np.concatenate([line[1:] for _, line in held])
    which = np.repeat([i for i, _ in held], [len(line) - 1 for _, line in held])
    u = np.concatenate([along(line) for _, line in held])
    radii = np.broadcast_to(np.asarray(radius, dtype=np.float64), len(lines))[which]
    if isinstance(color, str) and color == "direction":
        axes = np.abs(p1 - p0)
        length = np.linalg.norm(axes, axis=1, keepdims=True)
        color = np.clip(np.divide(axes, length, out=np.full_like(axes, 0.5), where=length > 0), 0.02, 0.9)
    scene = Scene()
    scene.add_capsules(p0, p1, radii, u=u, color=color, material=materials.diffuse(), name="streamlines")
    scene.info["streamline"] = which
    return scene
