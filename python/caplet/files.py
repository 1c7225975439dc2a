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
