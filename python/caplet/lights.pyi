# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
# Written by tools/python_stubs.py from the library's lists.
from collections.abc import Sequence
from os import PathLike
from typing import Any

from numpy.typing import ArrayLike

from .named import Blackbody, Camera, Light, Material, Medium, Texture

Value = float | bool | str | PathLike[str] | ArrayLike | Sequence[str] | Blackbody | Texture | tuple[Material, Material] | None

def distant(
    *,
    L: ArrayLike | str | Blackbody | float | None = None,
    from_: ArrayLike | None = None,
    illuminance: float | ArrayLike | None = None,
    scale: float | ArrayLike | None = None,
    to: ArrayLike | None = None,
    transform: ArrayLike | None = None,
) -> Light: ...

def goniometric(
    *,
    I: ArrayLike | str | Blackbody | float | None = None,
    filename: str | PathLike[str] | Sequence[str] | None = None,
    power: float | ArrayLike | None = None,
    scale: float | ArrayLike | None = None,
    transform: ArrayLike | None = None,
) -> Light: ...

def ies(
    *,
    I: ArrayLike | str | Blackbody | float | None = None,
    filename: str | PathLike[str] | Sequence[str] | None = None,
    power: float | ArrayLike | None = None,
    scale: float | ArrayLike | None = None,
    transform: ArrayLike | None = None,
) -> Light: ...

def infinite(
    *,
    L: ArrayLike | str | Blackbody | float | None = None,
    filename: str | PathLike[str] | Sequence[str] | None = None,
    illuminance: float | ArrayLike | None = None,
    portal: ArrayLike | None = None,
    preset: str | PathLike[str] | Sequence[str] | None = None,
    scale: float | ArrayLike | None = None,
    transform: ArrayLike | None = None,
) -> Light: ...

def point(
    *,
    I: ArrayLike | str | Blackbody | float | None = None,
    from_: ArrayLike | None = None,
    power: float | ArrayLike | None = None,
    scale: float | ArrayLike | None = None,
    transform: ArrayLike | None = None,
) -> Light: ...

def projection(
    *,
    filename: str | PathLike[str] | Sequence[str] | None = None,
    fov: float | ArrayLike | None = None,
    power: float | ArrayLike | None = None,
    scale: float | ArrayLike | None = None,
    transform: ArrayLike | None = None,
) -> Light: ...

def spot(
    *,
    I: ArrayLike | str | Blackbody | float | None = None,
    coneangle: float | ArrayLike | None = None,
    conedeltaangle: float | ArrayLike | None = None,
    from_: ArrayLike | None = None,
    power: float | ArrayLike | None = None,
    scale: float | ArrayLike | None = None,
    to: ArrayLike | None = None,
    transform: ArrayLike | None = None,
) -> Light: ...

__all__: list[str]
