#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Are the pictures of a portable wheel's program those of a build, bit for bit, on the same driver: the one in the wheel?

    tools/portable_equal.py WHEEL PROGRAM [SCENE...]     default: some of scenes/

Exit code 1 where one is not. Headers of files name the platform and times, and are not compared.
"""
import os
import struct
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENES = ["capsules.pbrt", "gallery.pbrt", "materials.pbrt", "smoke.pbrt", "hair.pbrt", "neuron.swc"]
ROWS = {0: 1, 1: 1, 2: 1, 3: 16, 4: 32, 5: 16, 6: 32, 7: 32, 8: 32, 9: 256}  # of a chunk, by the compression: openexr.com, "file layout"


def chunks(path):
    """What stands in a scan line EXR behind its header and the places of its chunks."""
    data = path.read_bytes()
    at, attributes = 8, {}
    while data[at]:
        end = data.index(b"\0", at)
        name, at = data[at:end].decode(), data.index(b"\0", end + 1) + 1
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    _, first, _, last = struct.unpack("<4i", attributes["dataWindow"])
    rows = ROWS[attributes["compression"][0]]
    return data[at + 1 + 8 * ((last - first + rows) // rows):]


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
                pictures.append(chunks(out))
            equal = pictures[0] == pictures[1] and len(pictures[0]) > 0
            wrong += not equal
            print(f"{Path(scene).name}: {len(pictures[0])} bytes, {'equal' if equal else 'NOT EQUAL'}", flush=True)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
