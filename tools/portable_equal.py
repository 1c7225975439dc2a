#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Are the pictures of a portable wheel's program those of a build, bit for bit, on the same driver: the one in the wheel?

    tools/portable_equal.py WHEEL PROGRAM [SCENE...]     default: some of scenes/

Exit code 1 where one is not. Values are compared, not files: their headers name the platform and times.
"""
import os
import struct
import subprocess
import sys
import tempfile
import zipfile
import zlib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENES = ["capsules.pbrt", "gallery.pbrt", "materials.pbrt", "smoke.pbrt", "hair.pbrt", "neuron.swc"]
NONE, RLE, ZIP = 0, 1, 3  # https://openexr.com/en/latest/OpenEXRFileLayout.html
ROWS = {NONE: 1, RLE: 1, ZIP: 16}  # of a chunk


def expanded(data, compression):
    """The bytes of a chunk that was made smaller."""
    if compression == ZIP:
        data = zlib.decompress(data)
    else:
        out, at = bytearray(), 0
        while at < len(data):
            count = data[at] - 256 if data[at] > 127 else data[at]
            if count < 0:
                out += data[at + 1:at + 1 - count]
                at += 1 - count
            else:
                out += data[at + 1:at + 2] * (count + 1)
                at += 2
        data = bytes(out)
    values = bytearray(data)
    for i in range(1, len(values)):
        values[i] = (values[i - 1] + values[i] - 128) & 255
    half = (len(values) + 1) // 2
    out = bytearray(len(values))
    out[0::2], out[1::2] = values[:half], values[half:]
    return bytes(out)


def pixels(path):
    """The channels' names and types and all values, row by row, of a scan line EXR. What it is compressed by depends on how long it took."""
    data = path.read_bytes()
    at, attributes = 8, {}
    while data[at]:
        end = data.index(b"\0", at)
        name, at = data[at:end].decode(), data.index(b"\0", end + 1) + 1
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    left, first, right, last = struct.unpack("<4i", attributes["dataWindow"])
    compression, channels = attributes["compression"][0], attributes["channels"]
    width, place = 0, 0  # bytes of a row
    while channels[place]:
        place = channels.index(b"\0", place) + 1
        width += (2 if channels[place] == 1 else 4) * (right - left + 1)
        place += 16
    rows = ROWS[compression]
    at += 1 + 8 * ((last - first + rows) // rows)
    out = [channels]
    for y in range(first, last + 1, rows):
        of, size = struct.unpack_from("<2i", data, at)
        assert of == y, f"{path}: the chunk of row {of} stands where that of {y} should"
        chunk = data[at + 8:at + 8 + size]
        whole = width * min(rows, last + 1 - y)
        out.append(chunk if size == whole else expanded(chunk, compression))
        assert len(out[-1]) == whole, f"{path}: {len(out[-1])} bytes of row {y}, not {whole}"
        at += 8 + size
    return b"".join(out)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    wheel, program, scenes = Path(sys.argv[1]), Path(sys.argv[2]).resolve(), sys.argv[3:] or [ROOT / "scenes" / name for name in SCENES]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with zipfile.ZipFile(wheel) as file:
            file.extractall(folder)
        package = folder / "caplet"
        for path in (package / "bin/caplet", package / "pocl/bin/ld", package / "pocl/bin/lld"):
            path.chmod(0o755)
        environment = dict(os.environ, CAPLET_CACHE=str(folder / "cache"), CAPLET_BUNDLED_DRIVER=str(package / "pocl"))
        wrong = 0
        for scene in scenes:
            pictures = []
            for which, executable in (("wheel", package / "bin/caplet"), ("build", program)):
                out = folder / f"{which}.exr"
                subprocess.run([executable, "render", scene, "-o", out, "--size", "96x54", "--spp", "4", "--device", "bundled", "-q"],
                               check=True, env=environment)
                pictures.append(pixels(out))
            equal = pictures[0] == pictures[1] and len(pictures[0]) > 0
            wrong += not equal
            print(f"{Path(scene).name}: {len(pictures[0])} bytes, {'equal' if equal else 'NOT EQUAL'}", flush=True)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
