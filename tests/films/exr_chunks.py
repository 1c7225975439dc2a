# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Compares EXR files without what their headers say."""
import struct


def chunks(file):
    """The packed pixels of an EXR file, without its header, whose attributes tell of names and times."""
    data = file.read_bytes()
    place = 8
    while data[place]:
        for _ in range(2):  # name and type
            place = data.index(0, place) + 1
        place += 4 + struct.unpack_from("<I", data, place)[0]
    return data[struct.unpack_from("<Q", data, place + 1)[0]:]
