#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Has every row of the lists of textures, materials, lights and media what belongs to it?

usage: rows.py [--root FOLDER]              one line for each thing that is missing; exit status 1 when there are any
       rows.py --self-test [--root FOLDER]  takes one thing of each kind away from a copy: each must be missed

To a row NAME of kernels/shared/*.def belong its model's or kernel's mutant (tests/mutants), a test on a device, a statement in a seed of the fuzzer of
scene files, and a place in the list's page with a figure.
"""
import argparse
import pathlib
import re
import shutil
import sys
import tempfile


class List:
    def __init__(self, name, row, kernels, models, tests, page, statement, figure=None, says=None, seeds=None):
        self.name, self.row, self.kernels, self.models, self.tests, self.page = name, row, kernels, models, tests, page
        self.statement = statement          # of scene files, where `seeds` has none: NAME stands for the row's
        self.figures = figure or {}         # rows whose figure has another name
        self.says = says or {}              # rows that the page calls otherwise
        self.seeds = seeds or {}            # rows that scene files call otherwise


LISTS = [
    List("textures", "TEXTURE", "textures", "textures", [("tests/textures/texture_trials.cpp", r"\bTextureTrial NAME_texture_trial\(")], "textures.md",
         r'Texture "[^"]*" "(?:float|spectrum)" "NAME"',
         says={"extinction": "reflectance", "alpha": "alpha", "normalmap": "normalmap", "displacement": "displacement"},
         seeds={"normalmap": r'"string normalmap"', "displacement": r'"texture displacement"', "alpha": r'"texture alpha"',
                "extinction": r'"conductor" "texture reflectance"'}),
    List("materials", "(?:MATERIAL|CHOICE)", "bsdf", "materials",
         [("tests/bsdf/NAME_trial.cpp", r"\bNAME_trial\("), ("tests/bsdf/choice_test.cpp", r'"NAME"|\bNAME_|Mix')], "materials.md",
         r'(?:Material|"string type") "NAME"'),
    List("lights", "LIGHT", "lights", "lights", [("tests/lights/light_trials.cpp", r"\bNAME_trial\(")], "lights.md", r'LightSource "NAME"',
         figure={"textured_area": "area"}, says={"textured_area": "textured area"},
         seeds={"area": r'AreaLightSource "diffuse" "(?:blackbody|rgb|spectrum|float) L"', "textured_area": r'AreaLightSource "diffuse" "string filename"',
                "constant": r'LightSource "infinite"\s', "image": r'LightSource "infinite" "string filename"[^\n]*\n(?!.*portal)',
                "portal": r'"point3 portal"'}),
    List("media", "MEDIUM", "media", "media", [("tests/media/*.cpp", r'\\"NAME\\"|(?i:\bNAMEMedium\b)')], "media.md", r'MakeNamedMedium "[^"]*" "string type" "NAME"'),
]


def text_of(root, pattern):
    return "\n".join(path.read_text() for path in sorted(root.glob(pattern)))


def missing(root):
    """Complaints, one a thing."""
    out = []
    mutated = set(re.findall(r'^file = "([^"]+)"', text_of(root, "tests/mutants/*.toml"), re.M))
    seeds = text_of(root, "tests/fuzz/seeds/pbrt/*.pbrt")
    for one in LISTS:
        rows = re.findall(rf"^{one.row}\((\w+)", (root / f"kernels/shared/{one.name}.def").read_text(), re.M)
        if not rows:
            out.append(f"{one.name}: the list has no rows")
        page = (root / "docs" / one.page).read_text()
        for row in rows:
            def lacks(what):
                out.append(f"{one.name}: {row}: {what}")
            own = {f"kernels/{one.kernels}/{row}.cl", f"host/scene/{one.models}/{row}.h"}
            if not own & mutated:
                lacks(f"no mutant in {' or '.join(sorted(own))}")
            if not any(re.search(pattern.replace("NAME", row), text_of(root, files.replace("NAME", row))) for files, pattern in one.tests):
                lacks(f"no test in {' or '.join(files.replace('NAME', row) for files, _ in one.tests)}")
            if not re.search(one.seeds.get(row, one.statement).replace("NAME", row), seeds):
                lacks("no seed in tests/fuzz/seeds/pbrt has it")
            if not re.search(rf"^\|.*(?:`{row}`|\b{one.says.get(row, row)}\b)|`{one.says.get(row, row)}`", page, re.M):
                lacks(f"docs/{one.page} does not name it")
            figure = f"images/{one.name}/{one.figures.get(row, row)}.png"
            if figure not in page or not (root / "docs" / figure).is_file():
                lacks(f"docs/{one.page} has no {figure}")
    return out


def self_test(root):
    """Takes things away from a copy, each by itself."""
    faults = [
        ("tests/textures/texture_trials.cpp", "TextureTrial dots_texture_trial(", "TextureTrial dot_texture_trial(", "textures: dots: no test"),
        ("tests/mutants/textures.toml", 'file = "kernels/textures/marble.cl"', 'file = "kernels/textures/noise.cl"', "textures: marble: no mutant"),
        ("tests/fuzz/seeds/pbrt/media.pbrt", '"string type" "cloud"', '"string type" "fog"', "media: cloud: no seed"),
        ("docs/lights.md", "images/lights/spot.png", "images/lights/spots.png", "lights: spot: docs/lights.md has no"),
        ("kernels/shared/materials.def", "MATERIAL(diffuse,", "MATERIAL(velvet,", "materials: velvet: no mutant"),
    ]
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for part in ("kernels/shared", "tests/mutants", "tests/textures", "tests/bsdf", "tests/lights", "tests/media", "tests/fuzz/seeds/pbrt", "docs"):
            shutil.copytree(root / part, copy / part)
        for file, old, new, complaint in faults:
            before = (copy / file).read_text()
            if old not in before:
                print(f"{file} has no {old!r}")
                failures += 1
                continue
            (copy / file).write_text(before.replace(old, new))
            if not any(line.startswith(complaint) for line in missing(copy)):
                print(f"not seen: {complaint}")
                failures += 1
            (copy / file).write_text(before)
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    if options.self_test:
        return 1 if self_test(options.root) else 0
    complaints = missing(options.root)
    for line in complaints:
        print(line)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
