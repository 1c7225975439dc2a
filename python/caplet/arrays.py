# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Arrays as the binding takes them: 32- or 64-bit floats, of known shapes, with any strides; nothing is copied that need not be."""
import numpy as np

from .errors import InputError

MOST = 2**31 - 1  # of anything, in one array


def floats(value, name):
    """`value` as an array of 32- or 64-bit floats; those it has if it has them."""
    try:
        array = np.asarray(value)
    except (ValueError, TypeError) as problem:
        raise InputError(f"{name}: not an array of numbers ({problem})") from None
    if array.dtype.kind not in "fiu":
        raise InputError(f"{name}: an array of numbers is needed, not of {array.dtype}")
    if array.dtype not in (np.float32, np.float64):  # others, and those of the other byte order
        array = array.astype(np.float64)
    if any(stride % array.itemsize for stride in array.strides):  # fields of packed records
        array = np.ascontiguousarray(array)
    if array.size and not array.flags.aligned:
        array = array.copy()
    return array


def _small(array, name):
    if array.shape and array.shape[0] > MOST:
        raise InputError(f"{name}: {array.shape[0]} rows; at most {MOST}")
    return array


def rows(value, name, width):
    """(n, width), of one row as (1, width)."""
    array = floats(value, name)
    if array.ndim == 1 and array.shape[0] == width:
        array = array[np.newaxis]
    if array.ndim != 2 or array.shape[1] != width:
        raise InputError(f"{name}: shape (n, {width}) or ({width},) is needed, not {array.shape}")
    return _small(array, name)


def scalars(value, name):
    """(n,), of one number as (1,)."""
    array = floats(value, name)
    if array.ndim == 0:
        array = array[np.newaxis]
    if array.ndim != 1:
        raise InputError(f"{name}: shape (n,) or one number is needed, not {array.shape}")
    return _small(array, name)


def common(**arrays):
    """How many rows these have; one row stands for as many as there are."""
    count, first = 1, None
    for name, array in arrays.items():
        if array is None or array.shape[0] == 1:
            continue
        if first is not None and array.shape[0] != count:
            raise InputError(f"{name} has {array.shape[0]} entries, and {first} {count}")
        count, first = array.shape[0], name
    return count


def numbers(value, name):
    """Contiguous 32-bit unsigned integers of any shape."""
    array = np.asarray(value)
    if array.dtype.kind not in "iu":
        raise InputError(f"{name}: an array of whole numbers is needed, not of {array.dtype}")
    if array.size and (array.min() < 0 or array.max() > 2**32 - 1):
        raise InputError(f"{name}: numbers from 0 to 2^32 - 1 are needed")
    return np.ascontiguousarray(array, dtype=np.uint32)


def size(value, name="size"):
    """(width, height), two whole numbers."""
    array = floats(value, name)
    if array.shape != (2,) or not np.isfinite(array).all() or (array != np.floor(array)).any() or abs(array).max() > MOST:
        raise InputError(f"{name}: a width and a height, whole numbers of pixels, are needed, not {value!r}")
    return int(array[0]), int(array[1])


def pixels(value, name):
    """(height, width, channels) of 32-bit floats: of images of bytes, which are a screen's, the linear values; alpha is linear."""
    try:
        array = np.asarray(value)
    except (ValueError, TypeError) as problem:
        raise InputError(f"{name}: not an image ({problem})") from None
    if array.ndim == 2:
        array = array[:, :, np.newaxis]
    if array.ndim != 3 or array.shape[2] not in (1, 3, 4) or not array.size or max(array.shape) > 2**15:
        raise InputError(f"{name}: shape (height, width), (height, width, 3) or 4, of at most 32768 a side, is needed, not {array.shape}")
    if array.dtype == np.uint8:
        screen = np.arange(256) / 255
        linear = np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055)**2.4)
        out = linear[array]
        if array.shape[2] == 4:
            out[:, :, 3] = array[:, :, 3] / 255
        array = out
    with np.errstate(over="ignore"):  # what is infinite then is refused
        return np.ascontiguousarray(floats(array, name), dtype=np.float32)


def transform(value, name="transform"):
    """A matrix of 4 x 4, or its first 3 rows, that maps column vectors: 12 numbers."""
    return transforms(value, name, single=True)[0]


def transforms(value, name="transforms", single=False):
    """(n, 4, 4) or (n, 3, 4): n x 12 numbers."""
    array = floats(value, name).astype(np.float64, copy=False)
    if array.ndim == 2:
        array = array[np.newaxis]
    elif single:
        raise InputError(f"{name}: shape (4, 4) or (3, 4) is needed, not {array.shape}")
    if array.ndim != 3 or array.shape[1:] not in ((4, 4), (3, 4)):
        raise InputError(f"{name}: shape (4, 4), (3, 4) or a stack of them is needed, not {array.shape}")
    if array.shape[1] == 4 and not np.array_equal(array[:, 3], np.broadcast_to([0.0, 0, 0, 1], (len(array), 4))):
        raise InputError(f"{name}: the last row of an affine transform is 0 0 0 1")
    return np.ascontiguousarray(_small(array, name)[:, :3, :]).reshape(len(array), 12)


IDENTITY = np.eye(4)
