# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
# Written by tools/python_stubs.py from the library's lists.
from collections.abc import Sequence
from os import PathLike
from typing import Any

from numpy.typing import ArrayLike

from .named import Blackbody, Camera, Light, Material, Medium, Texture

Value = float | bool | str | PathLike[str] | ArrayLike | Sequence[str] | Blackbody | Texture | tuple[Material, Material] | None

def checkerboard(
    *,
    dimension: Value = None,
    mapping: Value = None,
    tex1: Value = None,
    tex2: Value = None,
    udelta: Value = None,
    uscale: Value = None,
    v1: Value = None,
    v2: Value = None,
    vdelta: Value = None,
    vscale: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def scale(
    *,
    scale: Value = None,
    tex: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def mix(
    *,
    amount: Value = None,
    tex1: Value = None,
    tex2: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def bilerp(
    *,
    mapping: Value = None,
    udelta: Value = None,
    uscale: Value = None,
    v00: Value = None,
    v01: Value = None,
    v1: Value = None,
    v10: Value = None,
    v11: Value = None,
    v2: Value = None,
    vdelta: Value = None,
    vscale: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def imagemap(
    *,
    encoding: Value = None,
    filename: Value = None,
    filter: Value = None,
    invert: Value = None,
    mapping: Value = None,
    maxanisotropy: Value = None,
    scale: Value = None,
    udelta: Value = None,
    uscale: Value = None,
    v1: Value = None,
    v2: Value = None,
    vdelta: Value = None,
    vscale: Value = None,
    wrap: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def directionmix(
    *,
    dir: Value = None,
    tex1: Value = None,
    tex2: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def dots(
    *,
    inside: Value = None,
    mapping: Value = None,
    outside: Value = None,
    udelta: Value = None,
    uscale: Value = None,
    v1: Value = None,
    v2: Value = None,
    vdelta: Value = None,
    vscale: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def fbm(
    *,
    octaves: Value = None,
    roughness: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def wrinkled(
    *,
    octaves: Value = None,
    roughness: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def windy(
    *,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def marble(
    *,
    octaves: Value = None,
    roughness: Value = None,
    scale: Value = None,
    variation: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def normalmap(
    *,
    encoding: Value = None,
    filename: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

def root(
    *,
    tex: Value = None,
    is_float: bool = False,
    transform: ArrayLike | None = None,
) -> Texture: ...

__all__: list[str]
