# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Caplet: a path tracer of exact solids on any OpenCL device.

    import caplet
    scene = caplet.Scene()
    scene.add_capsules(p0, p1, radius, color=(0.8, 0.3, 0.1))   # (n, 3), (n, 3), (n,)
    caplet.render(scene, spp=64, size=(960, 540)).save("picture.png")

docs/python.md has more.
"""


def _check_interpreter():
    """The binding is of one interpreter of a process: a second one would take it away from the first."""
    import importlib
    for name in ("_interpreters", "_xxsubinterpreters"):  # since Python 3.13, and before
        try:
            interpreters = importlib.import_module(name)
        except ImportError:
            continue
        if interpreters.get_current() != interpreters.get_main():
            raise ImportError("caplet works in the main interpreter of a process alone")
        return


_check_interpreter()


def _find_denoiser():
    """Tells the library where the package pyoidn has Open Image Denoise, unless it is told already."""
    import importlib.util
    import os
    import pathlib
    found = importlib.util.find_spec("pyoidn")
    if found is not None and found.origin:
        library = pathlib.Path(found.origin).parent / "oidn/lib/libOpenImageDenoise.so.2"
        if library.exists():
            os.environ.setdefault("CAPLET_OIDN", str(library))


_find_denoiser()

from . import errors
from .errors import Error, InputError, RunError
from . import _caplet, bridges, cameras, lights, materials, media, textures
from ._caplet import formats, set_log_level
from .bridges import (denoise, from_gemmi, from_meshio, from_morphio, from_mujoco, from_neuroml, from_nibabel, from_pyvista, from_sonata, from_trimesh, lidar,
                      to_xarray)
from .colors import color_map
from .image import Image, load_film
from .named import Blackbody, Camera, Light, Material, Medium, Texture
from .rendering import CROSSING, Report, Session, devices, pick, render, trace, verify
from .scene import Scene, Shape, Shapes, load
from . import sensors
from .batches import Batch, render_batch
from .viewing import Viewer, _own_program, view

_caplet.set_program(_own_program() or "")  # it compiles kernels


def shape_types():
    """The types that Scene.add takes."""
    return _caplet.statement_types("shape")


def shape_parameters(type):
    """The parameters of a type of shape: [(name, types of values)]."""
    return [(one["name"], tuple(one["types"])) for one in _caplet.statement_parameters("shape", type)]


__all__ = ["Batch", "Blackbody", "CROSSING", "Camera", "Error", "Image", "InputError", "Light", "Material", "Medium", "Report", "RunError", "Scene",
           "Session", "Shape", "Shapes", "Texture", "Viewer", "cameras", "color_map", "denoise", "devices", "errors", "formats", "from_gemmi",
           "from_meshio", "from_morphio", "from_mujoco", "from_neuroml", "from_nibabel", "from_pyvista", "from_sonata", "from_trimesh", "lidar", "lights", "load",
           "load_film", "materials", "media", "pick", "render", "render_batch", "sensors", "set_log_level", "shape_parameters", "shape_types", "textures", "to_xarray", "trace", "verify", "view"]
__version__ = "0.1.0"
