#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Writes the type stubs of the modules that are made from the library's lists; the package is to be importable.

usage: python_stubs.py            writes python/caplet/{materials,textures,lights,media,cameras}.pyi
       python_stubs.py --check    whether they are as they would be written; exit status 1 when not
"""
import pathlib
import sys

from caplet import named

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "python/caplet"
HEAD = '''# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
# Written by tools/python_stubs.py from the library's lists.
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


def text(kind):
    lines = [HEAD]
    for type in named.types(kind):
        asked = [f"    {key}: {annotation(types)} = None," for key, _, types in sorted(named.signature(kind, type))]
        asked += [f"    {name}: {EXTRA[name]} = {value!r}," for name, value in named._EXTRA.get(kind, ())]
        lines += [f"def {named.spelled(type)}(", *(["    *,"] if asked else []), *asked, f") -> {named._CLASSES[kind].__name__}: ...", ""]
    lines.append("__all__: list[str]")
    return "\n".join(lines) + "\n"


def main(arguments):
    wrong = []
    for kind, module in (("material", "materials"), ("texture", "textures"), ("light", "lights"), ("medium", "media"), ("camera", "cameras")):
        path = FOLDER / f"{module}.pyi"
        if arguments != ["--check"]:
            path.write_text(text(kind))
        elif not path.exists() or path.read_text() != text(kind):
            wrong.append(str(path))
    for path in wrong:
        print(f"{path} is not as tools/python_stubs.py writes it")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
