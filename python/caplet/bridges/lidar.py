# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""A scanner that turns: distances in a grid of directions."""
import numpy as np

from .. import arrays
from ..errors import InputError
from ..rendering import trace
from ..spelling import keywords

NOTHING = 2**32 - 1


@keywords
def lidar(scene, pose, azimuth, elevation, reach=np.inf, device=None):
    """What a scanner sees: distances (len(elevation), len(azimuth)) in scene units, infinite where nothing is within `reach`, and
    the numbers of the shapes that are seen, 2^32 - 1 where there is nothing.

    pose: where it stands, (3,), or 4 x 4 from its own space: x forwards, y to its left, z up. azimuth: degrees, from x towards y.
    elevation: degrees above its horizon. Of a robot (from_mujoco), scene.info["geom"][shapes] are MuJoCo's geoms; a site's pose is
    its site_xpos and site_xmat.
    """
    place = np.asarray(pose, dtype=np.float64)
    if place.shape == (3,):
        at, place = place, np.eye(4)
        place[:3, 3] = at
    elif place.shape != (4, 4):
        raise InputError(f"pose: (3,) or (4, 4) is needed, not {place.shape}")
    around, above = np.deg2rad(np.asarray(azimuth, dtype=np.float64)), np.deg2rad(np.asarray(elevation, dtype=np.float64))
    if around.ndim != 1 or above.ndim != 1:
        raise InputError("azimuth and elevation: (n,) is needed")
    up, turn = np.meshgrid(above, around, indexing="ij")
    own = np.stack([np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)], axis=2).reshape(-1, 3)
    way = own @ place[:3, :3].T
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    hits = trace(scene, place[:3, 3], way, device=device)
    seen = hits["t"] <= reach
    shape = (len(above), len(around))
    return np.where(seen, hits["t"], np.inf).reshape(shape), np.where(seen, hits["shape"], NOTHING).astype(np.uint32).reshape(shape)
