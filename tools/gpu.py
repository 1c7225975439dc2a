#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Tries and measures Caplet on one GPU within a few minutes, the most important first.

`./run gpu --pack FOLDER` makes a folder of the program, its tests, the libraries they need, scenes, and pictures made by PoCL. The folder
goes to a machine with a GPU and Python 3, where nothing is installed, built or fetched:

    python3 FOLDER/tools/gpu.py --minutes 10 --out RESULTS

Every step has a limit, and the reason is kept where one fails or hangs. RESULTS/gpu.json and gpu.md are written after each. `--compiled
FILE` names a tar file of compiled kernels, which is read at the beginning if it exists and written at the end.
"""
import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import sys
import tarfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tools"))
from driver_kit import checks, exr, homes  # noqa: E402
from gpu_kit import pack, page, surroundings  # noqa: E402

# Whole images: scene, size, and two numbers of samples. The difference of their times leaves out start, compilation and writing.
IMAGES = [("walk", "512x512", 16, 528), ("capsules", "1280x720", 64, 1088), ("gallery", "960x540", 16, 528), ("cornell", "512x512", 16, 2064),
          ("many-lights", "512x512", 16, 2064), ("smoke", "960x540", 8, 72), ("motion", "960x540", 16, 528)]
BENCHES = [("capsules", 1000000), ("triangles", 1000000), ("shapes", 100000)]
# Whole images to a noise.
NOISES = [("gallery", "960x540", "3%"), ("capsules", "1280x720", "2%"), ("hair", "480x270", "5%"), ("reference/ignis-cbox-d6", "512x512", "2%")]
# Scenes whose stated noise is tried, when that is asked for.
TRIALS = ["gallery.pbrt", "capsules.pbrt", "hair.pbrt", "smoke.pbrt", "materials.pbrt", "neuron.swc", "walker.xml", "lattice.3mf",
          "reference/ignis-cbox-d6.pbrt", "reference/capsule-light-room.pbrt", "reference/sphere-light-irradiance.pbrt",
          "reference/furnace-box-50.pbrt"]
# Numbers of CAPLET_LAUNCH (docs/drivers.md).
SWEEP = ["", "paths=262144", "paths=1048576", "paths=4194304", "paths=16777216", "local=32", "local=128", "local=256", "chunk=65536", "chunk=1048576",
         "chunk=0", "rounds=2", "rounds=8", "rounds=16"]


class OutOfTime(Exception):
    """No time is left for a step."""


class Hour:
    """The run: what it found, and the time that is left."""

    def __init__(self, options):
        self.options, self.start = options, time.monotonic()
        self.out = options.out.resolve()
        (self.out / "references").mkdir(parents=True, exist_ok=True)
        self.facts, self.lock = {"steps": {}}, threading.Lock()
        self.home = homes.Home(surroundings.variables(ROOT, self.out, options.driver), [])

    def left(self):
        return self.options.minutes * 60 - (time.monotonic() - self.start)

    def tried(self, name, limit):
        """A driver_kit.checks.Tried with at most `limit` seconds."""
        seconds = min(limit, self.left())
        if seconds < 2:
            raise OutOfTime()
        return checks.Tried(self.home, self.options.encoding, self.out / "work" / name, seconds)

    def put(self, step, part, found):
        with self.lock:
            self.facts["steps"].setdefault(step, {})[part] = found
            self.facts["seconds"] = time.monotonic() - self.start
            (self.out / "gpu.json").write_text(json.dumps(self.facts, indent=1))
            (self.out / "gpu.md").write_text(page.of(self.facts))
            print(f"[{self.facts['seconds']:6.1f} s] {step}, {part}: {json.dumps(found)[:300]}", flush=True)

    def part(self, step, name, make):
        """Puts what `make` returns, or how it failed. Returns it."""
        begin = time.monotonic()
        try:
            found = make()
        except OutOfTime:
            found = {"left out": "no time was left"}
        except Exception as error:  # the other steps go on
            found = {"fails": f"{type(error).__name__}: {error}"[:300]}
        if isinstance(found, dict):
            found = {**found, "took": round(time.monotonic() - begin, 2)}
        self.put(step, name, found)
        return found

    # --- Steps ---

    def device(self):
        self.part("device", "opencl", lambda: checks.device(self.tried("device", 60)))
        self.part("device", "limits", lambda: {"devices": self.tried("limits", 60).json_of("devices", "--json")})
        self.part("device", "card", surroundings.card)

    def self_test(self):
        self.part("self-test", "doctor", lambda: checks.self_test(self.tried("doctor", 120)))

    def rendered(self, name, scene, size, samples, limit, *more, variables=None):
        """Seconds of a render as a whole, and what --stats says if it is among `more`."""
        tried = self.tried(name, limit)
        begin = time.monotonic()
        code, out, err = tried.run("caplet", "render", scene, "-o", tried.folder / "out.exr", "--size", size, "--spp", samples, "-q", *more,
                                   variables=variables)
        if code != 0:
            return {"fails": tried.how(code, err)}
        return {"wall": time.monotonic() - begin, **(json.loads(out) if "--stats" in more else {})}

    def compilation(self):
        scene = ROOT / "scenes/capsules.pbrt"
        for name in ("first", "again"):
            self.part("compilation", name, lambda: self.rendered("first", scene, "64x64", 4, 200, "--stats", "-"))

    def picture(self, scene):
        def made():
            ours = checks.picture(self.tried(f"picture-{scene.stem}", 240), scene, "full")
            if isinstance(ours, str):
                return {"fails": ours}
            theirs = pack.reference(ROOT, scene)
            return {"fails": f"there is no {theirs}"} if not theirs.exists() else {"difference": exr.difference(ours, exr.Picture(theirs))}
        self.part("pictures", scene.name, made)

    def verify(self, rays):
        self.part("verify", f"{rays} rays", lambda: checks.verify(self.tried("verify", 200), rays))

    def pool(self, tasks):
        """Runs tasks side by side: most of their time compiles kernels on the host."""
        with concurrent.futures.ThreadPoolExecutor(self.options.workers) as pool:
            for done in [pool.submit(*task) for task in tasks]:
                done.result()

    def hits(self, scene):
        def made():
            ours = checks.crossings(self.tried(f"hits-{scene.stem}", 120), scene, pack.HITS)
            theirs = pack.crossings_file(ROOT, scene)
            return {"fails": ours} if isinstance(ours, str) else checks.compare_crossings(ours, theirs.read_text().splitlines())
        self.part("hits", scene.name, made)

    def reference(self, scene):
        """A picture to be compared with another program's, beside this program: it stays in the results."""
        def made():
            tried = self.tried(f"reference-{scene.stem}", 240)
            code, _, err = tried.run("caplet", "render", scene, "-o", self.out / "references" / f"{scene.stem}.exr", "--spp", 256, "--layers", "none",
                                     "-q")
            return {"fails": tried.how(code, err)} if code != 0 else {}
        self.part("references", scene.name, made)

    def mattes(self, scene):
        """Coverage by names beside PoCL's, and a deep picture, which stays in the results."""
        def made():
            tried = self.tried(f"mattes-{scene.stem}", 240)
            ours = checks.picture(tried, scene, "full", *pack.MATTE_OPTIONS, "--deep", self.out / "references" / f"deep-{scene.stem}.exr")
            if isinstance(ours, str):
                return {"fails": ours}
            theirs = exr.Picture(pack.mattes_file(ROOT, scene))
            return {kind: exr.compare_mattes(ours, theirs, kind) for kind in ("CryptoObject", "CryptoMaterial", "CryptoAsset")}
        self.part("mattes", scene.name, made)

    def noise(self):
        """Seconds and samples to a noise by --noise, and of as many samples in every pixel as have the same noise."""
        for name, size, target in NOISES:
            def made(name=name, size=size, target=target):
                wanted = float(target.rstrip("%")) / 100
                first = self.rendered(f"noise-{pathlib.Path(name).stem}", pack.scene(ROOT, name), size, 16, 90, "--variance", "--stats", "-")
                adaptive = self.rendered(f"noise-{pathlib.Path(name).stem}", pack.scene(ROOT, name), size, 4096, 90, "--noise", target, "--stats", "-")
                if "fails" in first or "fails" in adaptive:
                    return first if "fails" in first else adaptive
                # The noise of equal samples falls as their root.
                samples = max(1, math.ceil(16 * (first["noise"] / wanted) ** 2))
                uniform = self.rendered(f"noise-{pathlib.Path(name).stem}", pack.scene(ROOT, name), size, samples, 90, "--variance", "--stats", "-")
                if "fails" in uniform:
                    return uniform
                return {way: {"wall": found["wall"], "render": found["seconds"]["render"], "noise": found["noise"], "samples": found["samples_per_pixel"]}
                        for way, found in (("adaptive", adaptive), ("uniform", uniform))}
            self.part("noise", f"{name} {target}", made)

    def trial(self, scene):
        """How true the noise is that films state (programs/noise_trial.cpp)."""
        def made():
            tried = self.tried(f"trial-{scene.stem}", 60 * self.options.trial_minutes + 120)
            code, out, err = tried.run("caplet_noise_trial", scene, "--device", "0", "--minutes", self.options.trial_minutes, "--seeds",
                                       self.options.trial_seeds, "--width", 64, "--height", 36, "--noise", *self.options.trial_noise)
            return {"lines": [json.loads(line) for line in out.splitlines()], **({} if code == 0 else {"fails": tried.how(code, err)})}
        self.part("trial", scene.name, made)

    def bench(self):
        for kind, count in BENCHES:
            def made(kind=kind, count=count):
                tried = self.tried(f"bench-{kind}", 60)
                words = [kind, "--device", "0", "--n", count, "--alone", "--seconds", 0.5, "--size", 2048] + (["--sorted"] if kind == "capsules" else [])
                code, out, err = tried.run("caplet_bench", *words)
                lines = [json.loads(line) for line in out.splitlines() if line.startswith("{")]
                return {"lines": lines, **({} if code == 0 else {"fails": tried.how(code, err)})}
            self.part("bench", kind, made)

    def image(self, name, size, few, many, variables=None):
        scene = pack.scene(ROOT, name)
        first = self.rendered(f"image-{name}", scene, size, few, 90, "--layers", "none", variables=variables)
        if "fails" in first:
            return first
        second = self.rendered(f"image-{name}", scene, size, many, 90, "--layers", "none", variables=variables)
        if "fails" in second:
            return second
        width, height = map(int, size.split("x"))
        seconds = second["wall"] - first["wall"]
        return {"seconds": seconds, "samples": many - few, "paths_per_second": width * height * (many - few) / max(seconds, 1e-3)}

    def there(self, images):
        """Those whose scenes are in the repository, or came along (--more)."""
        return [image for image in images if pack.scene(ROOT, image[0]).exists()]

    def images(self):
        for name, size, few, many in self.there(IMAGES):
            self.part("images", f"{name}, by stage",
                      lambda: self.rendered(f"stages-{name}", pack.scene(ROOT, name), size, few, 120, "--layers", "none", "--stats", "-"))
            self.part("images", name, lambda: self.image(name, size, few, many))

    def sweep(self):
        for name, size, few, many in self.there(IMAGES[:3:2]):
            for setting in self.options.launches or SWEEP:
                self.part("sweep", f"{name} {setting or 'as it is'}",
                          lambda: self.image(name, size, few, many, {"CAPLET_LAUNCH": setting} if setting else None))

    def test(self, program, shard, shards):
        def made():
            tried = self.tried(f"{program}-{shard}", 600)
            code, out, err = tried.run(program, variables={"GTEST_TOTAL_SHARDS": str(shards), "GTEST_SHARD_INDEX": str(shard),
                                                            "GTEST_FILTER": self.options.tests})
            found = checks.test_results(tried, code, out, err)
            if found["failed"] or "fails" in found:
                (self.out / f"{program}-{shard}.log").write_text(out[-20000:] + err[-5000:])
            return found
        self.part("tests", f"{program} {shard}", made)

    def all(self):
        wanted, chosen = self.options.steps, self.options.scenes
        steps = {
            "device": self.device,
            "self-test": self.self_test,
            "compilation": self.compilation,
            "pictures": lambda: self.pool([(self.verify, self.options.rays)] * ("verify" in wanted) +
                                          [(self.hits, scene) for scene in checks.scenes(pack.HIT_SCENES, "full") if "hits" in wanted] +
                                          [(self.picture, scene) for scene in checks.scenes(chosen, "full")]),
            "references": lambda: self.pool([(self.reference, scene) for scene in sorted((ROOT / "scenes/more").glob("*.pbrt"))
                                             if not chosen or any(part in scene.name for part in chosen)]),
            "mattes": lambda: self.pool([(self.mattes, scene) for scene in checks.scenes(pack.MATTES, "full")]),
            "noise": self.noise,
            "trial": lambda: self.pool([(self.trial, ROOT / "scenes" / name) for name in TRIALS]),
            "bench": self.bench,
            "images": self.images,
            "sweep": self.sweep,
            "tests": lambda: self.pool([(self.test, name, shard, self.options.workers) for name in pack.TESTS if name in homes.BINARIES
                                        for shard in range(self.options.workers)]),
        }
        for name, step in steps.items():
            if name in wanted:
                step()
            if "fails" in self.facts["steps"].get("device", {}).get("opencl", {}):
                return 1
        return 0


STEPS = ("device", "self-test", "compilation", "pictures", "verify", "hits", "references", "mattes", "noise", "trial", "bench", "images", "sweep", "tests")


def some_steps(text):
    names = text.split(",")
    if bad := [name for name in names if name not in STEPS]:
        raise argparse.ArgumentTypeError(f"{bad[0]} is none of {', '.join(STEPS)}")
    return names


def main(arguments):
    parser = argparse.ArgumentParser(prog="./run gpu", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pack", type=pathlib.Path, metavar="FOLDER", help="make the folder that goes to the machine with the GPU")
    parser.add_argument("--more", type=pathlib.Path, nargs="*", default=[], help="scenes, with what they read, that go along")
    parser.add_argument("--no-pictures", action="store_true", help="pack no pictures by PoCL, which take minutes")
    parser.add_argument("--minutes", type=float, default=40, help="most minutes of all (default %(default)s)")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("gpu-results"), help="folder of the results (default %(default)s)")
    usual = [step for step in STEPS if step != "trial"]
    parser.add_argument("--steps", type=some_steps, default=usual, help=f"default: {','.join(usual)}; trial: how true the stated noise is")
    parser.add_argument("--trial-minutes", type=float, default=3, help="of trial, for each scene (default %(default)s)")
    parser.add_argument("--trial-seeds", type=int, default=256, help="the most seeds of trial (default %(default)s)")
    parser.add_argument("--trial-noise", type=float, nargs="+", default=[0.05, 0.01], help="targets of trial (default 0.05 0.01)")
    parser.add_argument("--scenes", type=lambda text: text.split(","), default=[], help="parts of names of the pictures' scenes; default: all")
    parser.add_argument("--rays", type=int, default=1000000, help="of verify, beside the pictures (default %(default)s)")
    parser.add_argument("--launches", type=lambda text: text.split("/"), default=[], help="values of CAPLET_LAUNCH in place of the sweep's, with / between")
    parser.add_argument("--tests", default="*", help="as for --gtest_filter (default %(default)s)")
    parser.add_argument("--driver", default="", help="library of the OpenCL driver (default: NVIDIA's if it is found, else the system's)")
    parser.add_argument("--encoding", default="single", choices=("single", "wide"), help="default: single")
    parser.add_argument("--workers", type=int, default=max(1, len(os.sched_getaffinity(0)) - 1), help="programs that compile side by side")
    parser.add_argument("--compiled", type=pathlib.Path, metavar="FILE", help="tar file of compiled kernels")
    options = parser.parse_args(arguments)
    if options.pack:
        return pack.make(ROOT, options.pack.resolve(), options.more, options.workers, not options.no_pictures)
    homes.BINARIES.update(pack.binaries(ROOT))
    hour = Hour(options)
    caches = hour.out / "work" / "kernels"
    if options.compiled and options.compiled.exists():
        with tarfile.open(options.compiled) as file:
            file.extractall(caches)
    try:
        return hour.all()
    finally:
        if options.compiled:
            with tarfile.open(options.compiled, "w:xz", preset=1) as file:
                file.add(caches, ".")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
