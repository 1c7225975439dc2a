#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Random faults of one token each: which of them do the tests see?

usage: faults.py [--seed S] [--count N] [--since COMMIT] [--list] [--fast | --tests EXPRESSION] [--only N,...] [--jobs N] [PATH...]
       faults.py --self-test

Draws N places of the sources below the paths (default: host) by their syntax trees, the same ones for the same seed and sources: a
comparison, an operator, a number or a member is replaced, a condition turned round, a statement left out. All are built into one copy
of the sources (build/faults/tree) as switches that CAPLET_FAULT turns on one at a time. For each the test programs that link what it
is in run until one fails. The table grows in build/faults/result.md.

--since: only lines that differ from those of that commit. --list: draws, builds nothing. --fast: no programs that need a device or
the built program, no Python. --tests: only the test programs whose names this expression finds, no Python. --only: of the
draw only these, as when what was unseen has got its test.
Exit status: 0 when all was tried, whatever was seen; 2 where that was not possible.
"""
import argparse
import collections
import concurrent.futures
import dataclasses
import fcntl
import json
import multiprocessing
import os
import pathlib
import random
import re
import resource
import shlex
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/mutants"))
import fault_places  # noqa: E402
import mutants  # noqa: E402  the copy of the sources, its build and the environment of a test

WORK = ROOT / "build/faults"
TREE = WORK / "tree"
BUILD = TREE / "build/release"
# -O1: the tests are run a few dozen times, and built once for all of them.
OPTIONS = ["-DCAPLET_BENCH=OFF", "-DCAPLET_WERROR=OFF", "-DCMAKE_CXX_FLAGS_RELEASE=-O1"]
A_FILE = 2  # faults at most
MEMORY = 16 << 30  # bytes that a test may take: faults allocate without end


class Impossible(Exception):
    pass


# --- The draw ---


def commands():
    """What the compiler is told of each source: of those that are built together, what it is told of all."""
    out = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        words, arguments = shlex.split(entry["command"]), []
        for word, following in zip(words, words[1:] + [""]):
            if word == "-isystem":
                arguments += [word, following]
            elif re.match(r"-(I|D|std=)", word):
                arguments.append(word)
        path = pathlib.Path(entry["file"])
        sources = re.findall(r'#include "([^"]+)"', path.read_text()) if "/Unity/" in entry["file"] else [entry["file"]]
        for source in sources:
            out[source] = arguments
    return out


def changed_lines(commit):
    """By file: the lines that are not those of the commit."""
    out, file = collections.defaultdict(set), None
    for line in subprocess.run(["git", "-C", ROOT, "diff", "-U0", "--no-color", "--no-ext-diff", commit, "--", "*.cpp"], check=True, text=True,
                               errors="replace", stdout=subprocess.PIPE).stdout.splitlines():
        if line.startswith("+++ "):
            file = line[6:]
        elif hunk := re.match(r"@@ -\S+ \+(\d+)(?:,(\d+))? @@", line):
            out[file].update(range(int(hunk[1]), int(hunk[1]) + int(hunk[2] or 1)))
    return out


class Draw:
    def __init__(self, options):
        told = commands()
        paths = [str(TREE / p.strip("/")) for p in options.paths]
        known = [s for s in sorted(told) if any(s == p or s.startswith(p + "/") for p in paths) and s.startswith(str(TREE / "host"))]
        self.files = {os.path.relpath(s, TREE): (os.path.relpath(s, TREE), pathlib.Path(s), told[s]) for s in known}
        self.lines = changed_lines(options.since) if options.since else None
        if self.lines is not None:
            self.files = {f: w for f, w in self.files.items() if self.lines.get(f)}
        if not self.files:
            raise Impossible("there is no source below these paths that is built")
        self.random = random.Random(options.seed)
        sizes = [len(self.lines[f]) if self.lines is not None else w[1].read_bytes().count(b"\n") for f, w in self.files.items()]
        # Files by their sizes, each as often as it may be drawn.
        left = dict(zip(self.files, sizes))
        self.order = []
        while left:
            file = self.random.choices(list(left), list(left.values()))[0]
            self.order.append(file)
            if self.order.count(file) == A_FILE:
                del left[file]
        first = sorted(set(self.order[:options.count + options.count // 5]))
        with multiprocessing.Pool(options.jobs) as pool:
            self.places = dict(zip(first, pool.map(fault_places.kept, [(*self.files[f], WORK / "places") for f in first], chunksize=1)))
        self.used = collections.defaultdict(list)

    def next(self, file=None):
        """A place that is none yet; of this file, where it has one. None when all are drawn."""
        while file or self.order:
            file = file or self.order.pop(0)
            if file not in self.places:
                self.places[file] = fault_places.kept((*self.files[file], WORK / "places"))
            free = [p for p in self.places[file] if all(p.end <= u.begin or u.end <= p.begin for u in self.used[file])
                    and (self.lines is None or p.line in self.lines[file])]
            # Kinds weigh the same: most places are members and numbers.
            kinds = sorted({p.kind for p in free})
            if kinds:
                kind = self.random.choice(kinds)
                place = self.random.choice([p for p in free if p.kind == kind])
                self.used[file].append(place)
                return place
            file = None
        return None


# --- The build ---


class Build:
    def __init__(self):
        self.originals = {}

    def write(self, faults):
        """The sources with their switches; all lines keep their numbers."""
        header = WORK / "caplet_fault.h"
        header.write_text(fault_places.SWITCH)
        for place in faults.values():
            self.originals.setdefault(place.file, (TREE / place.file).read_bytes())
        for file, text in self.originals.items():
            here = {n: p for n, p in faults.items() if p.file == file}
            text = fault_places.switched(text, here, header) if here else text
            if (TREE / file).read_bytes() != text:
                (TREE / file).write_bytes(text)

    def build(self, draw, faults, targets, jobs):
        """Builds; what does not compile is replaced by another fault."""
        while True:
            self.write(faults)
            failed = mutants.build(["-k", "0", *targets], jobs, TREE)
            if not failed:
                return
            errors, led = set(), set()
            for file, line, kind in re.findall(r"^(/\S+?):(\d+):(?:\d+:)? +(\S+)", failed, re.MULTILINE):
                if kind != "warning:":
                    (errors if kind in ("error:", "fatal") else led).add((os.path.relpath(file, TREE), int(line)))
            bad = []
            # An error may stand in a header, and the line that led there in a note.
            for found in (errors, led if errors else set()):
                bad = bad or [n for n, p in faults.items() if any((p.file, line) in found for line in range(p.line, p.last + 1))]
            bad = bad or [n for n, p in faults.items() if any(p.file == f for f, _ in errors)]
            if not bad:
                raise Impossible(f"the sources with their faults do not build:\n{failed[-4000:]}")
            print(f"{len(bad)} faults do not compile, and are replaced", file=sys.stderr, flush=True)
            for number in bad:
                print("  " + faults[number].row(number), file=sys.stderr, flush=True)
                place = draw.next(faults[number].file) or draw.next()
                if place:
                    faults[number] = place
                else:
                    del faults[number]


# --- The tests ---


@dataclasses.dataclass
class Program:
    name: str
    folder: pathlib.Path  # it runs there, as ctest runs it
    labels: set
    rooms: set
    exclude: str = ""
    limit: float = 0
    reached: set = dataclasses.field(default_factory=set)  # numbers of the faults that it comes by

    @property
    def state(self):
        """What it is made of; it changes when the program is built again."""
        return [(f.stat().st_mtime_ns if f.exists() else 0) for f in (self.folder / self.name, BUILD / "bin/caplet")]


def programs():
    """All test programs, with the rooms that they link. The built program counts as a link of all rooms."""
    out = []
    for cmake in sorted((TREE / "tests").glob("*/CMakeLists.txt")):
        for name, labels in re.findall(r"caplet_test\((\w+) LABELS ([a-z ]+?) (?:LINK|SOURCES|SHARDS)", cmake.read_text()):
            target = f"tests/{cmake.parent.name}/{name}"
            query = subprocess.run(["ninja", "-C", BUILD, "-t", "query", target], text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
            rooms = set(re.findall(r"host/(?:\w+/)?lib(\w+)\.(?:a|so)", query)) | ({"*"} if "bin/caplet" in query else set())
            if rooms:
                out.append(Program(name, BUILD / "tests" / cmake.parent.name, set(labels.split()), rooms))
    return out


def run(command, folder, number, limit, reached=None):
    """Exit status, or None after the time limit, and the output. reached: a file for the faults that it comes by."""
    with tempfile.TemporaryDirectory(prefix="f-") as temporary:  # short: messages cut long paths
        env = mutants.environment(pathlib.Path(temporary), WORK / "pocl", BUILD / "bin/caplet")
        if number is not None:
            env["CAPLET_FAULT"] = str(number)
        if reached:
            env["CAPLET_REACHED"] = str(reached)
        if (data := ROOT.parent / "shared/data").is_dir():
            env.setdefault("CAPLET_DATA", str(data))
        with subprocess.Popen(command, cwd=folder, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", start_new_session=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))) as process:
            try:
                return process.communicate(timeout=limit)[0], process.returncode
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, 9)
                return process.communicate()[0], None


def numbers_in(path):
    return {int(line) for line in path.read_text().split()} if path.exists() else set()


def tried(program, number, limit, reached=None):
    """Empty when all passed, or the tests that failed."""
    command = [str(program.folder / program.name)]
    if program.exclude:
        command.append(f"--gtest_filter=-{program.exclude}")
    output, status = run(command + (["--gtest_fail_fast"] if number is not None else []), program.folder, number, limit, reached)
    failed = sorted(set(re.findall(r"^\[  FAILED  \] ([\w/]+\.[\w/]+)", output, re.MULTILINE)))
    begun = re.findall(r"^\[ RUN      \] (\S+)", output, re.MULTILINE)
    if not failed and status != 0:
        how = "too long" if status is None else f"signal {-status}" if status < 0 else f"exit status {status}"
        failed = [f"{begun[-1] if begun else '?'} ({how})"]
    return failed


class Tests:
    def __init__(self, all_programs, is_fast):
        self.programs, self.is_fast, self.lock, self.others, self.others_reach = all_programs, is_fast, threading.Lock(), None, set()
        self.seen = collections.Counter()

    def ready(self, jobs, signature):
        """Runs each program without faults, once: what fails then says nothing of a fault. Kept while the program is the same."""
        kept_path = WORK / "ready.json"
        kept = json.loads(kept_path.read_text()) if kept_path.exists() else {}
        kept = kept.get("programs", {}) if kept.get("faults") == signature else {}

        def one(program):
            known = kept.get(program.name)
            if known and known["state"] == program.state:
                program.exclude, program.limit, program.reached = known["exclude"], known["limit"], set(known["reached"])
                return
            reached = WORK / f"reached-{program.name}"
            reached.unlink(missing_ok=True)
            start = time.monotonic()
            failed = tried(program, None, 3600, reached)
            if any("(" in f for f in failed):
                raise Impossible(f"{program.name} without faults: {failed[0]}")
            if failed:
                print(f"{program.name}: not counted, for they fail without faults: {' '.join(failed)}", file=sys.stderr, flush=True)
            program.exclude, program.limit, program.reached = ":".join(failed), 30 + 8 * (time.monotonic() - start), numbers_in(reached)
            with self.lock:
                kept[program.name] = {"state": program.state, "exclude": program.exclude, "limit": program.limit,
                                      "reached": sorted(program.reached)}
                kept_path.write_text(json.dumps({"faults": signature, "programs": kept}))

        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            # Those without a device first: their kernels are built by then, and most faults are seen by them.
            list(pool.map(one, sorted(self.programs, key=lambda p: ("fast" not in p.labels, p.name))))

    def sees(self, number, place):
        folder = place.file.rsplit("/", 1)[0]
        # Those without a device, then those that have seen faults beside it, then those that are done sooner.
        for program in sorted((p for p in self.programs if number in p.reached),
                              key=lambda p: ("fast" not in p.labels, -self.seen[folder, p.name], p.limit)):
            if failed := tried(program, number, program.limit):
                self.seen[folder, program.name] += 1
                return f"{program.name}.{failed[0]}"
        return "" if self.is_fast else self.by_ctest(number)

    def by_ctest(self, number):
        """The tests that are no programs of our own: Python's, and that of bad files."""
        command = ["ctest", "-R", r"^(python|badfiles)\."]
        with self.lock:
            if self.others is None:
                reached = WORK / "reached-python"
                reached.unlink(missing_ok=True)
                self.others = set(re.findall(r"^\s+\d+ - (\S+) \(", run(command, BUILD, None, 3600, reached)[0], re.MULTILINE))
                self.others_reach = numbers_in(reached)
        if number not in self.others_reach:
            return ""
        output, _ = run(command + ["--stop-on-failure"] + (["-E", "|".join(map(re.escape, self.others))] if self.others else []), BUILD, number, 3600)
        failed = re.findall(r"^\s+\d+ - (\S+) \(", output, re.MULTILINE)
        return failed[0] if failed else ""


def try_all(options):
    WORK.mkdir(parents=True, exist_ok=True)
    lock = open(WORK / ".lock", "w")
    fcntl.flock(lock, fcntl.LOCK_EX)
    mutants.copy_sources(TREE)
    python = ROOT / "build/python-env/bin/python"
    options.fast = options.fast or bool(options.tests)
    if python.exists() and not options.fast:
        OPTIONS.extend(["-DCAPLET_WITH_PYTHON=ON", f"-DPython_EXECUTABLE={python}"])
    if failed := mutants.configure(TREE, OPTIONS):
        raise Impossible(failed[-4000:])
    draw = Draw(options)
    faults = {}
    while len(faults) < options.count and (place := draw.next()):
        faults[len(faults)] = place
    if options.list:
        print("\n".join(p.row(n) for n, p in faults.items()))
        return
    rooms = {p.file.split("/")[1] for p in faults.values()} | {"*"}
    chosen = [p for p in programs() if p.rooms & rooms and (
        re.search(options.tests, p.name) if options.tests else "fast" in p.labels and "*" not in p.rooms or not options.fast)]
    targets = [p.name for p in chosen] + ([] if options.fast else ["caplet"] + (["caplet_python"] if len(OPTIONS) > 3 else []))
    print(f"building {len(targets)} programs with {len(faults)} faults (minutes the first time)", file=sys.stderr, flush=True)
    Build().build(draw, faults, targets, options.jobs)
    tests, seen, write_lock = Tests(chosen, options.fast), {}, threading.Lock()
    print(f"running {len(chosen)} programs without faults", file=sys.stderr, flush=True)
    tests.ready(options.jobs, [p.row(n) for n, p in faults.items()])
    result = open(WORK / "result.md", "w")

    def say(line):
        print(line, flush=True)
        print(line, file=result, flush=True)

    say(f"Seed {options.seed}: {' '.join(options.paths)}\n\n| fault | place | before | after | seen by |\n|---|---|---|---|---|")

    def one(number):
        by = tests.sees(number, faults[number])
        with write_lock:
            seen[number] = by
            reached = number in tests.others_reach or any(number in p.reached for p in chosen)
            say(f"{faults[number].row(number)} {by or ('UNSEEN' if reached else 'UNSEEN, no test comes by')} |")

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        only = [n for n in faults if not options.only or str(n) in options.only.split(",")]
        try:
            for _ in pool.map(one, only):
                pass
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    say(f"\nseen: {sum(map(bool, seen.values()))} of {len(seen)}")


def main():
    parser = argparse.ArgumentParser(prog="faults", description="Random faults of one token each: which of them do the tests see?")
    parser.add_argument("paths", nargs="*", metavar="PATH", default=["host"], help="draw from these files and folders (default: host)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--since", metavar="COMMIT", help="draw from lines that differ from those of this commit")
    parser.add_argument("--list", action="store_true", help="draw, and build nothing")
    parser.add_argument("--fast", action="store_true", help="run no test that needs a device or the built program")
    parser.add_argument("--tests", metavar="EXPRESSION", help="run the test programs alone whose names this finds, and nothing of Python")
    parser.add_argument("--only", metavar="NUMBER,...", help="try these of the draw alone")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compilers, and tests, at the same time")
    parser.add_argument("--self-test", action="store_true", help="try the draw and the switches on a text of a few lines")
    options = parser.parse_args()
    if fault_places.cindex is None:
        print("skipped: clang.cindex is missing (python3-clang-14 and libclang-14-dev)")
        return 0 if options.self_test else 2
    if options.self_test:
        return fault_places.self_test()
    try_all(options)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (Impossible, subprocess.CalledProcessError) as error:
        print(f"faults: {error}", file=sys.stderr)
        sys.exit(2)
