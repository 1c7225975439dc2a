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
    return _caplet.statement_types(kind)


def described_parameters(kind, type):
    """What the library says of each parameter: dicts with name, types, doc, default, low, high, above_low, unit, choices, excludes."""
    return [one for one in _caplet.statement_parameters(kind, type) if one["has_effect"]]


def known_parameters(kind, type):
    """[(name, (types of values))] of the library's list."""
    return [(one["name"], tuple(one["types"])) for one in described_parameters(kind, type)]


def meaning(parameter):
    """A line of help: what a parameter is, its default and its range."""
    said = [parameter["doc"] or "of scene files"]
    if parameter["choices"]:
        said.append("one of " + ", ".join(repr(one) for one in parameter["choices"]))
    low, high, unit = parameter["low"], parameter["high"], parameter["unit"]
    least = f"above {low:g}" if parameter["above_low"] else f"from {low:g}"
    if low > float("-inf"):
        said.append(f"{least} to {high:g}" if high < float("inf") else f"{least} up")
    elif high < float("inf"):
        said.append(f"at most {high:g}")
    if unit:
        said.append(unit)
    if parameter["default"]:
        said.append("default " + parameter["default"])
    return "; ".join(said)


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
