# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Pictures for other packages."""
import numpy as np


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
