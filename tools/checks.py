#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The checks of `./run test`, which builds the release folder first, and their totals.

usage: checks.py           test preset `default`, clang-format
       checks.py --fast    test preset `fast`
       checks.py --all     all tests at their full size (tests/support/thorough.h) with kernels for each scene's own rows, also clang-tidy, and the builds and test presets `asan` and `minimal`

Each preset stands in CMakePresets.json. A check that fails does not keep those after it from being done.
Exit status: 0 when all passed, 1 when not, 2 for wrong usage.
"""
import collections
import os
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = ROOT / "build"
RUN = str(ROOT / "run")
# These lines tell of tests that begin or pass. The line by which a test begins is held back until
# the test says more.
QUIET = re.compile(r"^ *(\d+/\d+ Test +#.*Passed|Start +\d+|\[ RUN  |\[ +OK \]|\[-{10}\])")
BEGINS = re.compile(r"^\[ RUN  ")


def count_tests(said, log):
    """Passed, failed and skipped tests, by what ctest said and its LastTest.log. A program of GoogleTest counts by its own tests."""
    passed = failed = skipped = 0
    blocks = dict(re.findall(r"^\d+/\d+ Testing: (\S+)\n(.*?)(?=^\d+/\d+ Testing: |\Z)", log, re.M | re.S))
    for name, state in re.findall(r"^ *\d+/\d+ +Test +#\d+: (\S+) \.*[ *]*(Passed|Skipped|\w+)", said, re.M):
        ok, bad, out = (len(re.findall(rf"^\[ +{word} +\] .* \(\d+ ms\)$", blocks.get(name, ""), re.M)) for word in ("OK", "FAILED", "SKIPPED"))
        if state == "Skipped":
            out = max(1, out)
        elif state != "Passed":
            bad = max(1, bad)  # one that crashes says nothing of it
        elif ok + out == 0:
            ok = 1
        passed, failed, skipped = passed + ok, failed + bad, skipped + out
    return passed, failed, skipped


class Totals:
    def __init__(self):
        self.passed = self.failed = self.skipped = 0
        self.failures, self.left_out = [], []
        self.skip_reasons = collections.Counter()

    def check(self, name, command):
        """One command that either passes or fails, as it does then. True when it passed."""
        start = time.monotonic()
        log = BUILD / f"check-{name}.log"
        with open(log, "wb") as out:
            code = subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL).returncode
        if code == 0:
            self.passed += 1
        else:
            self.failed += 1
            self.failures.append(name)
            print("\n".join(log.read_text(errors="replace").splitlines()[-100:]))
        print(f"check {name}: {'passed' if code == 0 else 'FAILED'} ({time.monotonic() - start:.0f} s)", flush=True)
        return code == 0

    def ctest(self, preset, folder):
        """The tests of a preset, which run in build/FOLDER."""
        lines, begun = [], ""
        command = ["ctest", "--preset", preset, "-j", str(len(os.sched_getaffinity(0)))]
        with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True,
                              errors="replace") as process, open(BUILD / folder / "ctest.log", "w") as log:
            for line in process.stdout:
                lines.append(line)
                log.write(line)
                quiet = QUIET.match(line)
                if not quiet:
                    print(begun, line, sep="", end="", flush=True)
                begun = line if quiet and BEGINS.match(line) else ""
        log = BUILD / folder / "Testing/Temporary/LastTest.log"
        details = log.read_text(errors="replace") if log.exists() else ""
        passed, failed, skipped = count_tests("".join(lines), details)
        if failed == 0 and (process.returncode != 0 or passed == 0):
            failed = 1
        self.passed += passed
        self.failed += failed
        self.skipped += skipped
        if failed:
            self.failures.append(f"build/{folder}: {failed} of {passed + failed + skipped} tests (build/{folder}/ctest.log)")
        self.skip_reasons.update(re.findall(r": Skipped\n(.*)", details))
        # Those that pytest skips within one test of ctest.
        for count, reason in re.findall(r"^SKIPPED \[(\d+)\] \S+: (.*)$", details, re.M):
            self.skipped += int(count)
            self.skip_reasons[f"Python: {reason}"] += int(count)

    def summary(self):
        if self.failures:
            print("\nFailed:", *self.failures, sep="\n  ")
        total = self.passed + self.failed
        print(f"\n{100 * self.passed // max(1, total)}% tests passed, {self.failed} tests failed out of {total}")
        if self.skipped:
            reasons = "; ".join(f"{reason} ({count})" for reason, count in sorted(self.skip_reasons.items()))
            print(f"SKIPPED: {self.skipped} of these tests did not run: {reasons}")
        for what in self.left_out:
            print(f"LEFT OUT: {what}")
        return total > 0 and self.failed == 0


def has_format_14():
    """Versions of clang-format differ in taste: the tree is in that of 14 (Debian 12)."""
    version = subprocess.run(["clang-format", "--version"], stdout=subprocess.PIPE, text=True).stdout
    return "version 14." in version


def main(arguments):
    if arguments not in ([], ["--fast"], ["--all"]):
        print(__doc__, file=sys.stderr)
        return 2
    totals = Totals()
    if arguments == ["--all"]:
        os.environ["CAPLET_THOROUGH"] = "1"
    else:
        os.environ.setdefault("CAPLET_ROWS", "all")  # tests share kernels
    if arguments == ["--fast"]:
        totals.ctest("fast", "release")
        return 0 if totals.summary() else 1
    totals.ctest("default", "release")
    if has_format_14():
        totals.check("format", [RUN, "format", "--check"])
    else:
        totals.left_out.append("check format: needs clang-format 14")
    if arguments == ["--all"]:
        totals.check("clang-tidy", [RUN, "tidy"])
        for preset in ("asan", "minimal"):
            if totals.check(f"{preset}-build", [RUN, "build", preset]):
                totals.ctest(preset, preset)
    return 0 if totals.summary() else 1


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
