#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Writes the type stubs of the modules that are made from the library's lists: python/CMakeLists.txt calls it when the package is built.

usage: python_stubs.py PACKAGE    writes PACKAGE/{materials,textures,lights,media,cameras}.pyi; PACKAGE has the built binding
"""
import importlib
import os
import pathlib
import sys
import types

HEAD = '''# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
# Written by tools/python_stubs.py from the library's lists when the package was built.
from collections.abc import Sequence
from os import PathLike
from typing import Any

from numpy.typing import ArrayLike

from .named import Blackbody, Camera, Light, Material, Medium, Texture

Value = float | bool | str | PathLike[str] | ArrayLike | Sequence[str] | Blackbody | Texture | tuple[Material, Material] | None
'''
EXTRA = {"is_float": "bool", "transform": "ArrayLike | None", "name": "str | None", "eye": "ArrayLike | None", "target": "ArrayLike | None",
         "up": "ArrayLike"}
OF_TYPES = {"float": "float", "integer": "int", "bool": "bool", "string": "str | PathLike[str] | Sequence[str]", "point3": "ArrayLike",
            "vector3": "ArrayLike", "normal": "ArrayLike", "point2": "ArrayLike", "rgb": "ArrayLike", "spectrum": "ArrayLike | str",
            "blackbody": "Blackbody", "texture": "Texture"}


def annotation(types):
    if not types:
        return "Value"
    parts = []
    for part in " | ".join(OF_TYPES[one] for one in types).split(" | "):
        if part not in parts:
            parts.append(part)
    if "float" in parts and "ArrayLike" not in parts:
        parts.append("ArrayLike")
    return " | ".join([*parts, "None"])


def lists_of(folder):
    """caplet.lists of the package in `folder`, without what the package needs beside it."""
    package = types.ModuleType("caplet")
    package.__path__ = [str(folder)]
    sys.modules["caplet"] = package
    return importlib.import_module("caplet.lists")


def text(lists, kind):
    lines = [HEAD]
    for type in lists.types(kind):
        asked = [f"    {key}: {annotation(types)} = None," for key, _, types in sorted(lists.signature(kind, type))]
        asked += [f"    {name}: {EXTRA[name]} = {value!r}," for name, value in lists.EXTRA.get(kind, ())]
        lines += [f"def {lists.spelled(type)}(", *(["    *,"] if asked else []), *asked, f") -> {kind.capitalize()}: ...", ""]
    lines.append("__all__: list[str]")
    return "\n".join(lines) + "\n"


def main(folder):
    lists = lists_of(folder)
    for kind, module in (("material", "materials"), ("texture", "textures"), ("light", "lights"), ("medium", "media"), ("camera", "cameras")):
        path = folder / f"{module}.pyi"
        new = path.with_suffix(".pyi.part")
        new.write_text(text(lists, kind))
        os.replace(new, path)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
