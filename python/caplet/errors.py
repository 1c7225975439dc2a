# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What the package raises."""
import re

_PLACE = re.compile(r"^(?P<file>[^\n]*?):(?P<line>\d+)(?::(?P<column>\d+))?: ")


class Error(Exception):
    """The base of both."""

    def __init__(self, messages):
        self.messages = [messages] if isinstance(messages, str) else list(messages)
        super().__init__("\n".join(self.messages))

    def __reduce__(self):
        return type(self), (self.messages,)


class InputError(Error, ValueError):
    """Wrong input.

    messages: one line each, with its place. file, line, column: those of the first that has one, else None; both count from 1.
    """

    def __init__(self, messages):
        super().__init__(messages)
        places = filter(None, map(_PLACE.match, self.messages))
        place = next(places, None)
        self.file = place["file"] if place else None
        self.line = int(place["line"]) if place else None
        self.column = int(place["column"]) if place and place["column"] else None


class RunError(Error, RuntimeError):
    """Failed while working: a device, a disk."""
