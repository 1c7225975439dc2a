# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Colours that tell numbers."""
import math

import numpy as np

from . import _caplet, arrays
from .errors import InputError
from .spelling import keywords

STEPS = 256
TABLE = np.array([_caplet.color_map(step / (STEPS - 1)) for step in range(STEPS)])  # linear sRGB
UNKNOWN = (0.5, 0.5, 0.5)  # of what has no value


def ends(values, low=None, high=None):
    """The values at both ends of the map: those asked for, else the least and greatest finite ones."""
    finite = values[np.isfinite(values)]
    low = float(low) if low is not None else float(finite.min()) if len(finite) else None
    high = float(high) if high is not None else float(finite.max()) if len(finite) else low
    low = (0.0 if high is None else high) if low is None else low
    high = low if high is None else high
    if not (math.isfinite(low) and math.isfinite(high) and low <= high):
        raise InputError(f"low, high: two numbers are needed, the first not above the second, not {low} and {high}")
    return low, high


def parts(values, low, high):
    """Where values are between both ends, 0 to 1, NaN where they are; a half where the ends are the same."""
    span = high / 2 - low / 2  # of halves, which do not overflow
    if not span > 0:
        return np.where(np.isnan(values), np.nan, 0.5)
    return np.clip((values / 2 - low / 2) / span, 0, 1)


@keywords
def color_map(values, low=None, high=None):
    """Colours that tell numbers, linear sRGB (n, 3): those of the program (viridis, dark blue to yellow), in 256 steps.

    values: (n,) or one. low, high: the values at both ends, which stand for all beyond; None: the least and greatest finite ones.
    What is NaN is grey. Scene.set_color_bar tells them.

    >>> color_map([0, 1, 5], high=1).round(2).tolist()
    [[0.06, 0.0, 0.09], [0.98, 0.8, 0.02], [0.98, 0.8, 0.02]]
    """
    values = arrays.scalars(values, "values").astype(np.float64)
    part = parts(values, *ends(values, low, high))
    out = np.tile(UNKNOWN, (len(values), 1))
    known = ~np.isnan(part)
    out[known] = TABLE[np.round((STEPS - 1) * part[known]).astype(np.int64)]
    return out
