# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""From and to other packages, which are imported when they are asked for."""
from .gemmi import from_gemmi
from .images import denoise, to_xarray
from .lidar import lidar
from .meshes import from_meshio, from_trimesh
from .mujoco import from_mujoco, mujoco_camera, mujoco_worlds, update_mujoco
from .neuroml import from_neuroml
from .neurons import from_morphio
from .pyvista import from_pyvista
from .sonata import from_sonata
from .streamlines import from_nibabel

__all__ = ["denoise", "from_gemmi", "from_meshio", "from_morphio", "from_mujoco", "from_neuroml", "from_nibabel", "from_pyvista", "from_sonata",
           "from_trimesh", "lidar", "mujoco_camera", "mujoco_worlds", "to_xarray", "update_mujoco"]
