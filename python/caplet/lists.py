# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What the library's lists name: types and their parameters. Without NumPy, for what describes the package when it is built."""
import keyword

from . import _caplet


def spelled(name):
    """A parameter's name as a keyword: "conductor.eta" -> conductor_eta, "from" -> from_."""
    name = name.replace(".", "_")
    return name + "_" if keyword.iskeyword(name) else name


def types(kind):
    """The names of the library's list."""
    if kind == "material":
        return _caplet.material_types()
    if kind == "texture":
        return _caplet.texture_types()
    return _caplet.statement_types(kind)


def known_parameters(kind, type):
    """[(name, (types of values))] of the library's list."""
    if kind == "material":
        return [(name, ()) for name in _caplet.material_parameters(type)] + [("displacement", ("texture",)), ("normalmap", ("texture",))]
    if kind == "texture":
        return [(name, ()) for name in _caplet.texture_parameters(type)]
    return [(name, tuple(kinds)) for name, kinds in _caplet.statement_parameters(kind, type)]


# What constructors take besides, with what they are left at.
EXTRA = {
    "texture": (("is_float", False), ("transform", None)),
    "light": (("transform", None),),
    "medium": (("transform", None), ("name", None)),
    "material": (("name", None),),
    "camera": (("eye", None), ("target", None), ("up", (0, 1, 0)), ("transform", None)),
}


def signature(kind, type):
    """[(keyword, parameter, types)] of the constructor of a type, without what all of its kind have."""
    extra = {name for name, _ in EXTRA.get(kind, ())}  # of a name of the file's: that of an automatic camera
    out = [(spelled(name), name, kinds) for name, kinds in known_parameters(kind, type) if name not in extra]
    names = {name for name, _, _ in out}
    if {"alpha_u", "alpha_v"} <= names and "alpha" not in names:
        out.append(("alpha", "alpha", ()))
    return out
