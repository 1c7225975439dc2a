# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
# Written by tools/python_stubs.py from the library's lists.
from collections.abc import Sequence
from os import PathLike
from typing import Any

from numpy.typing import ArrayLike

from .named import Blackbody, Camera, Light, Material, Medium, Texture

Value = float | bool | str | PathLike[str] | ArrayLike | Sequence[str] | Blackbody | Texture | tuple[Material, Material] | None

def cloud(
    *,
    density: float | ArrayLike | None = None,
    frequency: float | ArrayLike | None = None,
    g: float | ArrayLike | None = None,
    p0: ArrayLike | None = None,
    p1: ArrayLike | None = None,
    preset: str | PathLike[str] | Sequence[str] | None = None,
    scale: float | ArrayLike | None = None,
    sigma_a: ArrayLike | str | Blackbody | float | None = None,
    sigma_s: ArrayLike | str | Blackbody | float | None = None,
    wispiness: float | ArrayLike | None = None,
    transform: ArrayLike | None = None,
    name: str | None = None,
) -> Medium: ...

def homogeneous(
    *,
    Le: ArrayLike | str | Blackbody | float | None = None,
    Lescale: float | ArrayLike | None = None,
    g: float | ArrayLike | None = None,
    preset: str | PathLike[str] | Sequence[str] | None = None,
    scale: float | ArrayLike | None = None,
    sigma_a: ArrayLike | str | Blackbody | float | None = None,
    sigma_s: ArrayLike | str | Blackbody | float | None = None,
    transform: ArrayLike | None = None,
    name: str | None = None,
) -> Medium: ...

def nanovdb(
    *,
    LeScale: Value = None,
    Lescale: float | ArrayLike | None = None,
    filename: str | PathLike[str] | Sequence[str] | None = None,
    g: float | ArrayLike | None = None,
    preset: str | PathLike[str] | Sequence[str] | None = None,
    scale: float | ArrayLike | None = None,
    sigma_a: ArrayLike | str | Blackbody | float | None = None,
    sigma_s: ArrayLike | str | Blackbody | float | None = None,
    temperaturecutoff: Value = None,
    temperatureoffset: float | ArrayLike | None = None,
    temperaturescale: float | ArrayLike | None = None,
    transform: ArrayLike | None = None,
    name: str | None = None,
) -> Medium: ...

def rgbgrid(
    *,
    Le: ArrayLike | None = None,
    LeScale: Value = None,
    Lescale: float | ArrayLike | None = None,
    g: float | ArrayLike | None = None,
    nx: int | None = None,
    ny: int | None = None,
    nz: int | None = None,
    p0: ArrayLike | None = None,
    p1: ArrayLike | None = None,
    scale: float | ArrayLike | None = None,
    sigma_a: ArrayLike | None = None,
    sigma_s: ArrayLike | None = None,
    transform: ArrayLike | None = None,
    name: str | None = None,
) -> Medium: ...

def uniformgrid(
    *,
    Le: ArrayLike | str | Blackbody | float | None = None,
    Lescale: float | ArrayLike | None = None,
    density: float | ArrayLike | None = None,
    g: float | ArrayLike | None = None,
    nx: int | None = None,
    ny: int | None = None,
    nz: int | None = None,
    p0: ArrayLike | None = None,
    p1: ArrayLike | None = None,
    preset: str | PathLike[str] | Sequence[str] | None = None,
    scale: float | ArrayLike | None = None,
    sigma_a: ArrayLike | str | Blackbody | float | None = None,
    sigma_s: ArrayLike | str | Blackbody | float | None = None,
    temperature: float | ArrayLike | None = None,
    temperaturecutoff: Value = None,
    temperatureoffset: float | ArrayLike | None = None,
    temperaturescale: float | ArrayLike | None = None,
    transform: ArrayLike | None = None,
    name: str | None = None,
) -> Medium: ...

__all__: list[str]
