# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""A constructor for each texture of the library's list, with its parameters as keywords."""
from . import named as _named

_named.fill(globals(), "texture")
