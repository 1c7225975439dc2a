# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
# Written by tools/python_stubs.py from the library's lists.
from collections.abc import Sequence
from os import PathLike
from typing import Any

from numpy.typing import ArrayLike

from .named import Blackbody, Camera, Light, Material, Medium, Texture

Value = float | bool | str | PathLike[str] | ArrayLike | Sequence[str] | Blackbody | Texture | tuple[Material, Material] | None

def diffuse(
    *,
    displacement: Texture | None = None,
    normalmap: Texture | None = None,
    reflectance: Value = None,
    name: str | None = None,
) -> Material: ...

def conductor(
    *,
    alpha: Value = None,
    alpha_u: Value = None,
    alpha_v: Value = None,
    displacement: Texture | None = None,
    eta: Value = None,
    k: Value = None,
    normalmap: Texture | None = None,
    reflectance: Value = None,
    name: str | None = None,
) -> Material: ...

def dielectric(
    *,
    alpha: Value = None,
    alpha_u: Value = None,
    alpha_v: Value = None,
    displacement: Texture | None = None,
    eta: Value = None,
    normalmap: Texture | None = None,
    name: str | None = None,
) -> Material: ...

def thindielectric(
    *,
    displacement: Texture | None = None,
    eta: Value = None,
    normalmap: Texture | None = None,
    name: str | None = None,
) -> Material: ...

def diffusetransmission(
    *,
    displacement: Texture | None = None,
    normalmap: Texture | None = None,
    reflectance: Value = None,
    scale: Value = None,
    transmittance: Value = None,
    name: str | None = None,
) -> Material: ...

def coateddiffuse(
    *,
    albedo: Value = None,
    alpha: Value = None,
    alpha_u: Value = None,
    alpha_v: Value = None,
    displacement: Texture | None = None,
    eta: Value = None,
    g: Value = None,
    maxdepth: Value = None,
    normalmap: Texture | None = None,
    nsamples: Value = None,
    reflectance: Value = None,
    thickness: Value = None,
    name: str | None = None,
) -> Material: ...

def coatedconductor(
    *,
    albedo: Value = None,
    conductor_alpha_u: Value = None,
    conductor_alpha_v: Value = None,
    conductor_eta: Value = None,
    conductor_k: Value = None,
    displacement: Texture | None = None,
    g: Value = None,
    interface_alpha_u: Value = None,
    interface_alpha_v: Value = None,
    interface_eta: Value = None,
    maxdepth: Value = None,
    normalmap: Texture | None = None,
    nsamples: Value = None,
    reflectance: Value = None,
    thickness: Value = None,
    name: str | None = None,
) -> Material: ...

def mix(
    *,
    amount: Value = None,
    displacement: Texture | None = None,
    materials: Value = None,
    normalmap: Texture | None = None,
    name: str | None = None,
) -> Material: ...

def hair(
    *,
    alpha: Value = None,
    beta_m: Value = None,
    beta_n: Value = None,
    displacement: Texture | None = None,
    eta: Value = None,
    normalmap: Texture | None = None,
    reflectance: Value = None,
    sigma_a: Value = None,
    name: str | None = None,
) -> Material: ...

def principled(
    *,
    anisotropic: Value = None,
    base_color: Value = None,
    coat: Value = None,
    coat_color: Value = None,
    coat_eta: Value = None,
    coat_roughness: Value = None,
    displacement: Texture | None = None,
    eta: Value = None,
    metallic: Value = None,
    normalmap: Texture | None = None,
    roughness: Value = None,
    sheen: Value = None,
    sheen_tint: Value = None,
    spec_tint: Value = None,
    spec_trans: Value = None,
    name: str | None = None,
) -> Material: ...

def interface(
    *,
    displacement: Texture | None = None,
    normalmap: Texture | None = None,
    name: str | None = None,
) -> Material: ...

__all__: list[str]
