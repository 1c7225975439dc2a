#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Are the pictures of a portable wheel's program those of a build, bit for bit, on the same driver: the one in the wheel?

    tools/portable_equal.py WHEEL PROGRAM [SCENE...]     default: some of scenes/

Exit code 1 where one is not. Values are compared, not files: their headers name the platform and times.
"""
import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

from driver_kit.exr import Picture

ROOT = Path(__file__).resolve().parent.parent
SCENES = ["capsules.pbrt", "gallery.pbrt", "materials.pbrt", "smoke.pbrt", "hair.pbrt", "neuron.swc"]


def pixels(path):
    """All values, bit for bit. The files differ: what they are compressed by depends on how long the render took."""
    return {name: values.tobytes() for name, values in Picture(path).channels.items()}


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
            print(f"{Path(scene).name}: {len(pictures[0])} channels, {'equal' if equal else 'NOT EQUAL'}", flush=True)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
