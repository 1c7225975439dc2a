# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Files that are written as a whole or not at all."""
import os

from .errors import InputError


def replace_file(path, data):
    """Writes bytes to a file. One that is there already stays as it is until all are written, and where they cannot be (InputError)."""
    path = os.fspath(path)
    beside = f"{path}.{os.getpid()}.part"
    try:
        with open(beside, "wb") as file:
            file.write(data)
        os.replace(beside, path)
    except OSError as error:
        if os.path.exists(beside):
            os.unlink(beside)
        raise InputError(f"{path}: {error.strerror}") from error


def ply_bytes(rows):
    """A binary PLY file of points: each field of a structured array, of <f4, <f8 or <u2, is a property."""
    kinds = {"<f4": "float", "<f8": "double", "<u2": "ushort"}
    names = "".join(f"property {kinds[kind]} {name}\n" for name, kind in rows.dtype.descr)
    return f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n{names}end_header\n".encode() + rows.tobytes()
