# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The folder that goes to a machine with a GPU: bin, lib, tools, scenes, pictures."""
import concurrent.futures
import pathlib
import re
import shutil
import subprocess

from driver_kit import checks, homes

# Programs of tests by their folders, those first that say most.
TESTS = {"known_answers_tests": "render", "trace_tests": "bvh", "render_tests": "render", "launch_policy_tests": "launch", "query_tests": "query",
         "shapes_tests": "shapes", "motion_tests": "motion", "csg_tests": "shapes", "device_tests": "device", "layout_tests": "layout", "agreement_tests": "shapes",
         "list_tests": "bvh", "edits_tests": "edits", "layers_tests": "layers", "bsdf_tests": "bsdf", "lights_tests": "lights",
         "media_tests": "media", "texture_tests": "textures", "sampling_tests": "sampling", "closed_form_tests": "closed_forms"}
PROGRAMS = {"caplet": "bin/caplet", "caplet_bench": "bin/caplet_bench", "caplet_noise_trial": "bin/caplet_noise_trial", **{name: f"tests/{folder}/{name}" for name, folder in TESTS.items()}}
# These libraries are the machine's own: programs built on Debian 12 run with newer ones.
SYSTEMS = re.compile(r"^(ld-linux|linux-vdso|lib(c|m|dl|rt|pthread|resolv|gcc_s|stdc\+\+)\.so)")


def binaries(root):
    """Programs of a packed folder or else of the release build, by name."""
    if (root / "lib").is_dir():
        return {path.name: path for path in (root / "bin").iterdir()}
    return {name: root / "build/release" / path for name, path in PROGRAMS.items() if (root / "build/release" / path).exists()}


def scene(root, name):
    """A scene to measure: of the repository, else one that was put into the packed folder's scenes/more."""
    found = [path for path in (root / "scenes" / f"{name}.pbrt", root / "scenes/more" / f"{name}.pbrt") if path.exists()]
    return found[0] if found else root / "scenes" / f"{name}.pbrt"


# Scenes whose crossings with so many rays are compared with PoCL's.
HIT_SCENES, HITS = ("gallery", "instances.pbrt"), 20000


# Scenes whose mattes and deep pictures are compared with PoCL's.
MATTES, MATTE_OPTIONS = ("gallery", "neuron.swc", "instances.pbrt"), ("--layers", "all,crypto_object,crypto_material,crypto_asset")


def mattes_file(root, scene_file):
    return root / "pictures" / f"mattes-{scene_file.stem}.exr"


def crossings_file(root, scene_file):
    return root / "pictures" / f"{scene_file.stem}.csv"


def reference(root, scene_file):
    return root / "pictures" / f"{scene_file.stem}.exr"


def libraries(program):
    """The libraries that a program loads at its start, but for the system's."""
    done = subprocess.run(["ldd", str(program)], stdout=subprocess.PIPE, text=True, check=True)
    found = re.findall(r"^\s*(\S+) => (/\S+)", done.stdout, re.MULTILINE)
    return {name: path for name, path in found if not SYSTEMS.match(name)}


def make(root, folder, more, workers, pictures):
    """Fills the folder from the release build, with pictures by PoCL if they are asked for. Returns an exit code."""
    shutil.rmtree(folder, ignore_errors=True)
    for name in ("bin", "lib", "pictures"):
        (folder / name).mkdir(parents=True)
    needed = {}
    for name, path in PROGRAMS.items():
        built = root / "build/release" / path
        if not built.exists():
            print(f"{built} is not built and left out")
            continue
        subprocess.run(["strip", "-o", str(folder / "bin" / name), str(built)], check=True)
        needed.update(libraries(built))
    for name, path in needed.items():
        subprocess.run(["strip", "--strip-unneeded", "-o", str(folder / "lib" / name), path], check=True)
    for part in ("gpu.py", "gpu_kit", "driver_kit"):
        copy = shutil.copytree if (root / "tools" / part).is_dir() else shutil.copy
        (folder / "tools").mkdir(exist_ok=True)
        copy(root / "tools" / part, folder / "tools" / part)
    for part in ("scenes", "kernels"):
        shutil.copytree(root / part, folder / part)
    (folder / "scenes/more").mkdir()
    for file in more:
        shutil.copy(file, folder / "scenes/more")
    # Tests read these files.
    for name in subprocess.run(["git", "-C", str(root), "ls-files", "tests"], stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines():
        if not name.endswith((".cpp", ".h", ".txt", ".py", ".toml")):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(root / name, folder / name)
    if not pictures:
        return 0
    home = homes.Home({}, [])

    def picture(scene_file):
        tried = checks.Tried(home, "single", folder / "work" / scene_file.stem, 1200)
        found = checks.picture(tried, scene_file, "full")
        if isinstance(found, str):
            return f"{scene_file.name}: {found}"
        shutil.copy(found.path, reference(folder, scene_file))
        if any(part in scene_file.name for part in HIT_SCENES):
            lines = checks.crossings(tried, scene_file, HITS)
            if isinstance(lines, str):
                return f"{scene_file.name}: {lines}"
            crossings_file(folder, scene_file).write_text("\n".join(lines) + "\n")
        if any(part in scene_file.name for part in MATTES):
            found = checks.picture(tried, scene_file, "full", *MATTE_OPTIONS)
            if isinstance(found, str):
                return f"{scene_file.name}: {found}"
            shutil.copy(found.path, mattes_file(folder, scene_file))
        return ""

    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        failures = [said for said in pool.map(picture, checks.scenes((), "full")) if said]
    shutil.rmtree(folder / "work")
    print(*failures, sep="\n")
    return 1 if failures else 0
