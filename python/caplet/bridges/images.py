# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Pictures for other packages."""
import numpy as np

from ..spelling import keywords


@keywords
def to_xarray(image):
    """An xarray.Dataset of the image's layers: dimensions y, x (pixels, from the top left) and channel."""
    import xarray
    layers = {"rgb": ("R", "G", "B"), "albedo": ("albedo.R", "albedo.G", "albedo.B"), "normal": ("N.X", "N.Y", "N.Z"),
              "position": ("P.X", "P.Y", "P.Z")}
    there = set(image.channels)
    held = {name: (("y", "x", "channel"), getattr(image, name)) for name, channels in layers.items() if there.issuperset(channels)}
    single = {"depth": "Z", "alpha": "A", "object_id": "object.id", "primitive_id": "primitive.id"}
    held.update({name: (("y", "x"), getattr(image, name)) for name, channel in single.items() if channel in there})
    height, width = image.shape
    return xarray.Dataset(held, coords={"y": np.arange(height), "x": np.arange(width)}, attrs={"samples_per_pixel": image.spp})


@keywords
def denoise(image, quality="high"):
    """The picture without noise, scene-linear float32 (height, width, 3), by Open Image Denoise (the package pyoidn).

    image: an Image with albedo and normals, by which edges and textures are kept. quality: "high", "balanced" or "fast".
    """
    import pyoidn
    guides = {"albedo": ("albedo.R", "albedo.G", "albedo.B"), "normal": ("N.X", "N.Y", "N.Z")}
    there = set(image.channels)
    given = {name: np.ascontiguousarray(getattr(image, name)) for name, channels in guides.items() if there.issuperset(channels)}
    if "albedo" not in given:
        given = {}  # normals alone are no guide
    return pyoidn.denoise(np.ascontiguousarray(image.rgb), hdr=True, quality=quality, **given)
