#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Tries Caplet on every OpenCL driver that can be had here, in both encodings, and tells what agrees as one table.

`./run drivers` installs what the system's packages have, builds, and calls this. Wheels, chroots, pictures and results lie in a cache folder:
the second time nothing is fetched. The program is the release build, for all: in a chroot of a newer Debian it runs as it is.
"""
import argparse
import dataclasses
import functools
import json
import os
import pathlib
import signal
import sys
import tempfile
from typing import Callable

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from driver_kit import checks, exr, homes, page  # noqa: E402


@dataclasses.dataclass
class Driver:
    name: str
    title: str
    origin: str
    home: Callable  # of the cache folder and the name
    size: str = "full"  # of its pictures (checks.SIZES)


def intel(version):
    return Driver(f"intel-{version or 'newest'}", "Intel CPU runtime", "PyPI", functools.partial(homes.intel, version=version))


def debian(name, title, suite, version, library, variables=(), size="full"):
    home = functools.partial(homes.newer_debian, suite=suite, library=library, variables=dict(variables))
    return Driver(name, title, f"Debian {version}, in a chroot", home, size)


LLVMPIPE = (("RUSTICL_ENABLE", "llvmpipe"),)
# The first is what the others are compared with.
DRIVERS = [
    Driver("pocl", "PoCL", "Debian's package", functools.partial(homes.system, file="pocl.icd", variables={})),
    Driver("pocl-pypi", "PoCL", "PyPI", homes.pocl_of_pypi),
    debian("pocl-trixie", "PoCL", "trixie", "13", "pocl.icd"),
    debian("pocl-sid", "PoCL", "sid", "unstable", "pocl.icd"),
    intel("2023.2.4"),
    intel("2024.1.0"),
    intel("2025.3.3"),
    intel(""),
    Driver("rusticl", "Mesa rusticl on llvmpipe", "Debian's package",
           functools.partial(homes.system, file="rusticl.icd", variables=dict(LLVMPIPE)), "small"),
    debian("rusticl-trixie", "Mesa rusticl on llvmpipe", "trixie", "13", "rusticl.icd", LLVMPIPE, "small"),
    debian("rusticl-sid", "Mesa rusticl on llvmpipe", "sid", "unstable", "rusticl.icd", LLVMPIPE, "small"),
    Driver("oclgrind", "Oclgrind", "Debian's package", homes.oclgrind, "tiny"),
]
ENCODINGS = ("wide", "single")
CHECKS = ("self-test", "verify", "hits", "tests", "pictures")


class Trials:
    def __init__(self, options):
        self.options, self.cache, self.references = options, options.cache.resolve(), {}
        self.cache.mkdir(parents=True, exist_ok=True)
        self.own = tempfile.TemporaryDirectory(prefix="references-", dir=self.cache)

    def tried(self, driver, encoding, folder=None):
        home = driver.home(self.cache, driver.name)
        return checks.Tried(home, encoding, folder or self.cache / "results" / f"{driver.name}-{encoding}", self.options.limit)

    def reference(self, ask, scene, what):
        """What the first driver says of a scene in its own encoding, asked once."""
        key = (ask.__name__, scene, what)
        if key not in self.references:
            self.references[key] = ask(self.tried(DRIVERS[0], "wide", pathlib.Path(self.own.name)), scene, what)
        return self.references[key]

    def compared(self, tried, ask, scene, what, compare):
        theirs = self.reference(ask, scene, what)
        ours = ask(tried, scene, what)
        if isinstance(ours, str):
            return {"fails": ours}
        return {"fails": f"nothing to compare with: {theirs}"} if isinstance(theirs, str) else compare(ours, theirs)

    def one(self, driver, encoding, facts, keep):
        """Fills in the facts of a driver in an encoding, and keeps them after each check: they take long."""
        tried = self.tried(driver, encoding)
        facts["device"], facts["package"] = checks.device(tried), tried.home.package
        if "fails" in facts["device"]:
            raise homes.LeftOut(facts["device"]["fails"])
        wants = self.options.checks
        if "self-test" in wants:
            facts["self-test"] = checks.self_test(tried)
            keep()
        if "verify" in wants:
            rays = {"full": self.options.rays, "small": self.options.rays, "tiny": 500}[driver.size]
            facts["verify"] = checks.verify(tried, rays)
            keep()
        if "hits" in wants:
            count = 100 if driver.size == "tiny" else self.options.hits
            facts["hits"] = {scene.name: self.compared(tried, checks.crossings, scene, count, checks.compare_crossings)
                             for scene in checks.scenes(("gallery", "instances.pbrt"), driver.size)}
            keep()
        if "tests" in wants and driver.size != "tiny":
            for name in ("trace_tests", "render_tests"):
                facts.setdefault("tests", {})[name] = checks.tests(tried, name)
                keep()
        if "pictures" in wants:
            facts["size"] = driver.size
            facts["pictures"] = {scene.name: self.compared(tried, checks.picture, scene, driver.size, exr.difference)
                                 for scene in checks.scenes(self.options.scenes, driver.size)}

    def all(self, drivers):
        for driver in drivers:
            for encoding in self.options.encodings:
                file = self.cache / "results" / f"{driver.name}-{encoding}.json"
                facts = json.loads(file.read_text()) if file.exists() else {}
                facts.pop("left out", None)
                about = {"name": driver.name, "title": driver.title, "origin": driver.origin, "encoding": encoding}
                facts.update(about)
                print(f"drivers: {driver.name}, {encoding}", file=sys.stderr, flush=True)
                file.parent.mkdir(parents=True, exist_ok=True)
                try:
                    self.one(driver, encoding, facts, lambda: file.write_text(json.dumps(facts, indent=1)))
                except homes.LeftOut as reason:
                    facts = {**about, "left out": str(reason)}
                file.write_text(json.dumps(facts, indent=1))
                print(page.row(facts), flush=True)

    def results(self):
        """Returns the results of all drivers that were ever tried with this cache, in their order."""
        files = [self.cache / "results" / f"{driver.name}-{encoding}.json" for driver in DRIVERS for encoding in ENCODINGS]
        return [json.loads(file.read_text()) for file in files if file.exists()]


def words(allowed):
    def parse(text):
        out = text.split(",")
        if bad := [word for word in out if word not in allowed]:
            raise argparse.ArgumentTypeError(f"{bad[0]} is none of {', '.join(allowed)}")
        return out
    return parse


def main(arguments):
    names = [driver.name for driver in DRIVERS]
    parser = argparse.ArgumentParser(prog="./run drivers", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drivers", nargs="*", metavar="DRIVER", help=f"{', '.join(names)}; default: all")
    parser.add_argument("--encodings", type=words(ENCODINGS), default=list(ENCODINGS), help="default: wide,single")
    parser.add_argument("--checks", type=words(CHECKS), default=list(CHECKS), help=f"default: {','.join(CHECKS)}")
    parser.add_argument("--rays", type=int, default=1000000, help="of verify (default %(default)s)")
    parser.add_argument("--hits", type=int, default=20000, help="rays of each scene whose crossings are compared (default %(default)s)")
    parser.add_argument("--scenes", type=lambda text: text.split(","), default=[], help="parts of names of scenes; default: all of the repository")
    parser.add_argument("--limit", type=int, default=1200, help="most seconds of one program (default %(default)s)")
    parser.add_argument("--cache", type=pathlib.Path, default=homes.ROOT / "build" / "drivers", help="folder of all that is fetched (build/drivers)")
    parser.add_argument("--write", action="store_true", help="put the tables of all results in the cache into docs/drivers.md")
    parser.add_argument("--only-write", action="store_true", help="the same without trying anything")
    options = parser.parse_args(arguments)
    if unknown := [name for name in options.drivers if name not in names]:
        parser.error(f"no driver {unknown[0]}: {', '.join(names)}")
    trials = Trials(options)
    if not options.only_write:
        trials.all([driver for driver in DRIVERS if not options.drivers or driver.name in options.drivers])
    results = trials.results()
    if options.write or options.only_write:
        page.write(homes.ROOT / "docs/drivers.md", results)
    print(page.tables(results))
    return 1 if any(page.is_wrong(facts) for facts in results) else 0


def stop(*_):
    raise KeyboardInterrupt


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, stop)  # no program stays behind
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
