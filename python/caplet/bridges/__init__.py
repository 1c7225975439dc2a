# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""From and to other packages, which are imported when they are asked for."""
from .gemmi import from_gemmi
from .images import to_xarray
from .meshes import from_trimesh
from .mujoco import from_mujoco, update_mujoco
from .streamlines import from_nibabel

__all__ = ["from_gemmi", "from_mujoco", "from_nibabel", "from_trimesh", "to_xarray", "update_mujoco"]
