# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What is tried on a driver: each check gives a dictionary of facts, without dates and times, that the tables are made of.

A check whose program crashes, hangs or fails has `fails` in it: how, in words.
"""
import json
import os
import pathlib
import random
import re
import signal
import subprocess

from driver_kit import exr
from driver_kit.homes import BINARIES, ROOT

# Size and samples of pictures: for compilers, and for drivers that interpret or run on few lanes.
SIZES = {"full": ("96x54", 16), "small": ("48x27", 4), "tiny": ("8x8", 2)}
GALLERY = ("320x180", 16)  # of `full`


class Tried:
    """A driver in one encoding."""

    def __init__(self, home, encoding, folder, seconds):
        self.home, self.encoding, self.folder, self.seconds = home, encoding, folder, seconds
        folder.mkdir(parents=True, exist_ok=True)

    def run(self, program, *words, variables=None):
        """(exit code, None for out of time; stdout; stderr)"""
        env = {key: value for key, value in os.environ.items() if not key.startswith(("OCL_ICD", "OPENCL_VENDOR", "CAPLET_RUN"))}
        env.update(self.home.env, CAPLET_ENCODING=self.encoding, CAPLET_TEST_DEVICE="0", **(variables or {}))
        command = [*self.home.prefix, str(BINARIES[program]), *map(str, words)]
        with open(self.folder / "stdout", "w+b") as out, open(self.folder / "stderr", "w+b") as err:
            process = subprocess.Popen(command, env=env, stdin=subprocess.DEVNULL, stdout=out, stderr=err, start_new_session=True)
            try:
                code = process.wait(self.seconds)
            except BaseException as error:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
                if not isinstance(error, subprocess.TimeoutExpired):
                    raise
                code = None
        return code, *((self.folder / name).read_text(errors="replace") for name in ("stdout", "stderr"))

    def how(self, code, err):
        """Why it did not end well."""
        if code is None:
            return f"no end in {self.seconds} s"
        lines = [line for line in err.splitlines() if line.strip() and ": info:" not in line]
        said = lines[-1].strip()[:300] if lines else ""
        return f"signal {-code}: {said}" if code < 0 else said or f"exit code {code}"

    def json_of(self, *words, good=(0,)):
        code, out, err = self.run("caplet", *words)
        if code not in good:
            return {"fails": self.how(code, err)}
        try:
            return json.loads(out)
        except ValueError:
            return {"fails": "prints no JSON"}


def device(tried):
    found = tried.json_of("devices", "--json")
    if isinstance(found, dict):
        return found
    if not found:
        return {"fails": "offers no device"}
    # CAPLET_ENCODING is what it was told; that of its own choice goes by type and width.
    own = "wide" if found[0]["type"] == "cpu" and found[0]["native_float_width"] > 1 else "single"
    return {**{key: found[0][key] for key in ("name", "driver", "platform", "version", "type")}, "own": own}


def self_test(tried):
    found = tried.json_of("doctor", "--json", "--device", "0", "--timeout", max(30, tried.seconds // 4), good=(0, 1))
    if "fails" in found:
        return found
    tests = [each for each in found["findings"] if each["about"].startswith("device ") and "the self-test" in each["what"]]
    wrong = [each["what"] for each in tests if each["state"] != "ok"]
    if wrong or not tests:
        return {"fails": re.sub(r"\s+", " ", wrong[0] if wrong else "was not made")[:600]}
    return {"notes": [each["what"] for each in found["findings"] if each["state"] == "note"]}


def verify(tried, rays):
    found = tried.json_of("verify", "--rays", rays, "--json", "-q", good=(0, 3))
    if "fails" in found:
        return found
    return {"rays": found["rays"], "wrong": found["disagreements"], "worst": found["worst"], "faults": found["faults"]}


def tests(tried, program):
    return test_results(tried, *tried.run(program))


def test_results(tried, code, out, err):
    """What a program of GoogleTest printed, as numbers of tests and names of those that failed."""
    passed = len(re.findall(r"^\[       OK \]", out, re.MULTILINE))
    skipped = len(re.findall(r"^\[  SKIPPED \] .*\(\d+ ms\)$", out, re.MULTILINE))
    failed = sorted(set(re.findall(r"^\[  FAILED  \] ([\w/]+\.[\w/]+)", out, re.MULTILINE)))
    facts = {"passed": passed, "skipped": skipped, "failed": failed}
    if code not in (0, 1):
        begun = re.findall(r"^\[ RUN      \] (\S+)", out, re.MULTILINE)
        facts["fails"] = f"{tried.how(code, err)} in {begun[-1] if begun else 'its beginning'}"
    elif code == 1 and not failed:
        facts["fails"] = tried.how(code, err)
    return facts


def rays_file(path, bounds, count):
    """Rays from around a scene to its middle."""
    chance = random.Random(1)
    low, high = ([max(-10.0, min(10.0, x)) for x in bounds[end]] for end in ("min", "max"))
    with open(path, "w") as file:
        for _ in range(count):
            o = [a + (b - a) * (2 * chance.random() - 0.5) for a, b in zip(low, high)]
            to = [a + (b - a) * chance.random() for a, b in zip(low, high)]
            print(*o, *(b - a for a, b in zip(o, to)), file=file)


def crossings(tried, scene, count):
    """The nearest crossings of the same rays on every driver, as lines of a table. A text says why there are none."""
    rays, table = tried.folder / "rays.txt", tried.folder / f"{scene.stem}.csv"
    info = tried.json_of("info", scene, "--json")
    if "fails" in info:
        return info["fails"]
    rays_file(rays, info["bounds"], count)
    code, _, err = tried.run("caplet", "pick", scene, "--rays", rays, "--out", table, "-q")
    return tried.how(code, err) if code != 0 else table.read_text().splitlines()[1:]


def compare_crossings(ours, theirs):
    """rays: that cross something; t: of those, how many have the same t and the same primitive to the bit; worst: the greatest
    difference of t among the others of the same primitive, of its size; other: rays that cross another primitive, or none."""
    rows = [{line.split(",", 1)[0]: line.split(",") for line in lines} for lines in (ours, theirs)]
    same, other, worst = 0, 0, 0.0
    for ray in rows[0].keys() | rows[1].keys():
        a, b = rows[0].get(ray), rows[1].get(ray)
        if a is None or b is None or a[2:7] != b[2:7]:
            other += 1
        elif a[1] == b[1]:
            same += 1
        else:
            worst = max(worst, abs(float(a[1]) - float(b[1])) / abs(float(b[1])))
    return {"rays": len(rows[0].keys() | rows[1].keys()), "t": same, "worst": worst, "other": other}


def picture(tried, scene, size, *more):
    """An exr.Picture, or a text that says why there is none. `more`: further options of the program."""
    file = tried.folder / f"{scene.stem}-{size}.exr"
    pixels, samples = GALLERY if size == "full" and scene.stem == "gallery" else SIZES[size]
    file.unlink(missing_ok=True)
    code, _, err = tried.run("caplet", "render", scene, "-o", file, "--size", pixels, "--spp", samples, "--variance", "-q", *more)
    return tried.how(code, err) if code != 0 else exr.Picture(file)


def scenes(chosen, size):
    """The repository's scenes; of a tiny size the gallery alone. `chosen`: parts of names, empty for all."""
    files = [*sorted((ROOT / "scenes").glob("*.*")), *sorted((ROOT / "scenes/reference").glob("*.pbrt"))]
    files = [file for file in files if file.suffix in (".pbrt", ".swc", ".capsules")]
    if size == "tiny":
        return [file for file in files if file.stem == "gallery"]
    return [file for file in files if not chosen or any(part in file.name for part in chosen)]
