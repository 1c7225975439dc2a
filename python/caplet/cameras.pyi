# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
# Written by tools/python_stubs.py from the library's lists.
from collections.abc import Sequence
from os import PathLike
from typing import Any

from numpy.typing import ArrayLike

from .named import Blackbody, Camera, Light, Material, Medium, Texture

Value = float | bool | str | PathLike[str] | ArrayLike | Sequence[str] | Blackbody | Texture | tuple[Material, Material] | None

def perspective(
    *,
    automatic: bool | None = None,
    focaldistance: float | ArrayLike | None = None,
    fov: float | ArrayLike | None = None,
    frameaspectratio: float | ArrayLike | None = None,
    halffov: float | ArrayLike | None = None,
    lensradius: float | ArrayLike | None = None,
    noup: bool | None = None,
    screenwindow: float | ArrayLike | None = None,
    shutterclose: float | ArrayLike | None = None,
    shutteropen: float | ArrayLike | None = None,
    eye: ArrayLike | None = None,
    target: ArrayLike | None = None,
    up: ArrayLike = (0, 1, 0),
    transform: ArrayLike | None = None,
) -> Camera: ...

__all__: list[str]
