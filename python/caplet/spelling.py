# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Errors for misspelt keywords that name the nearest, which Python itself does since 3.13."""
from __future__ import annotations

import difflib
import functools
import inspect
from typing import Any, TypeVar

Of = TypeVar("Of")


def nearest(name, known):
    """What a message about an unknown name ends with: the nearest of those that are known, or all where none is near."""
    near = difflib.get_close_matches(name, known, 1)
    return f"the nearest is {near[0]!r}" if near else f"it has {', '.join(known)}"


def _checked(function):
    parameters = inspect.signature(function).parameters.values()
    if any(one.kind is one.VAR_KEYWORD for one in parameters):
        return function
    names = [one.name for one in parameters if one.kind is not one.POSITIONAL_ONLY and one.name != "self"]

    @functools.wraps(function)
    def called(*args: Any, **given: Any) -> Any:
        for name in given:
            if name not in names:
                raise TypeError(f"{function.__qualname__}() got an unexpected keyword argument {name!r}; {nearest(name, names)}")
        return function(*args, **given)

    return called


def keywords(of: Of) -> Of:
    """Decorates a function, or a class with its public functions, whose keywords are then checked by name."""
    if not inspect.isclass(of):
        return _checked(of)
    for name, function in list(vars(of).items()):
        if inspect.isfunction(function) and (not name.startswith("_") or name == "__init__"):
            setattr(of, name, _checked(function))
    return of
