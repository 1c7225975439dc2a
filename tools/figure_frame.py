# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What figures of materials and of media share: a floor, a sky, two lamps, and a program that renders some or all of them."""
import argparse
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def framed(integrator, body):
    """The scene around `body`, which ends it."""
    return f"""Integrator {integrator}
LookAt 0.3 -6.5 2.6  0.15 0 0.85  0 0 1
Camera "perspective" "float fov" 26
Film "rgb" "integer xresolution" 480 "integer yresolution" 300
WorldBegin
LightSource "infinite" "rgb L" [0.35 0.4 0.45]
AttributeBegin
  AreaLightSource "diffuse" "blackbody L" 5000 "float scale" 14
  Translate 2.5 -3.5 5
  Shape "sphere" "float radius" 0.8
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [3 3 3]
  Translate -4 2.5 3
  Shape "sphere" "float radius" 0.7
AttributeEnd
Texture "floor" "spectrum" "checkerboard" "float uscale" 24 "float vscale" 24 "rgb tex1" [0.5 0.5 0.5] "rgb tex2" [0.3 0.3 0.3]
Material "diffuse" "texture reflectance" "floor"
Shape "bilinearmesh" "point3 P" [-12 -12 0 12 -12 0 -12 12 0 12 12 0] "integer indices" [0 1 2 3]
{body}"""


def run(folder_of_pictures, names, scene, files=lambda name, folder: None):
    """The command line: renders scene(name) of some of `names` or all to docs/images/FOLDER/NAME.png; `files` writes what it reads."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--caplet", default=str(ROOT / "build/release/bin/caplet"))
    parser.add_argument("--spp", default="256")
    parser.add_argument("names", nargs="*", metavar="NAME", help="of " + ", ".join(names))
    given = parser.parse_args()
    if unknown := set(given.names) - set(names):
        parser.error("unknown: " + ", ".join(sorted(unknown)))
    pictures = ROOT / "docs/images" / folder_of_pictures
    pictures.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for name in given.names or names:
            file = pathlib.Path(folder) / f"{name}.pbrt"
            file.write_text(scene(name))
            files(name, pathlib.Path(folder))
            subprocess.run([given.caplet, "render", file, "-o", file.with_suffix(".exr"), "--preview", pictures / f"{name}.png",
                            "--spp", given.spp], check=True)
