#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Seeded faults: each is put into a copy of the sources, where the test that it names must fail.

usage: mutants.py [--jobs N] [NAME...]   run all mutants, or those named
       mutants.py --check                is every mutant's place still there, once, and its test?
       mutants.py --page                 print a table of all. The last two run no test.
       mutants.py --self-test            are functions found in a text of a few lines?

A mutant is an entry of a *.toml file of this folder: `old` is the text of `file` that becomes `new`, `test` a test program and a
filter of its tests. `function` may name the function whose body holds `old`, which need not be unique elsewhere.
Kernels are mutated for the device alone (CAPLET_KERNELS), so one of kernels/shared makes host and device differ.
Exit status: 0 when all were caught, 1 when not, 2 for a fault of the list.

No test yet catches these faults: no Newton step on bilinear patches; no second step to a sphere's centre; a cone's nappe behind
its apex; a csg shape crossed again where a ray begins on it; no room between a capsule's tube and caps, or in instance boxes; no
step back from a triangle's edge for a displacement's normals; the receiving side left out of the density of a tree light that
scattering found.
"""
import argparse
import collections
import concurrent.futures
import dataclasses
import fcntl
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = pathlib.Path(__file__).resolve().parent
WORK = ROOT / "build/mutants"
TREE = WORK / "tree"  # the copy of the sources
BUILD = TREE / "build/release"
TIMEOUT = 300  # seconds a test may take
NOT_COMPILED = "the build log says:"  # of host/device/program.cpp
CAUGHT, SURVIVED, PASSED = "caught", "SURVIVED", "passed"


class ListError(Exception):
    pass


@dataclasses.dataclass(frozen=True)
class Mutant:
    name: str
    fault: str
    file: str
    old: str
    new: str
    test: str
    source: str  # the file it is listed in
    function: str = ""  # the one whose body holds `old`; empty: anywhere in the file

    @property
    def program(self):
        return self.test.split(" ", 1)[0]

    @property
    def filter(self):
        return self.test.split(" ", 1)[1]

    @property
    def is_kernel(self):
        return self.file.startswith("kernels/")

    def row(self):
        tests = ", ".join(f"`{self.program}.{t}`" for t in self.filter.split(":"))
        return f"| {self.name} | `{self.file}` | {self.fault} | {tests} |"


def listed():
    mutants = []
    for path in sorted(FOLDER.glob("*.toml")):
        with open(path, "rb") as file:
            entries = tomllib.load(file)["mutant"]
        for entry in entries:
            try:
                mutants.append(Mutant(source=path.name, **entry))
            except TypeError as error:
                raise ListError(f"{path.name}: {entry.get('name', '?')}: {error}") from None
    return mutants


# --- Places in the sources ---

# Braces in these are no braces of the code.
NO_CODE = re.compile(r"//[^\n]*|/\*(?s:.*?)\*/" r'|R"(\w*)\((?s:.*?)\)\1"' r'|"(?:\\.|[^"\\\n])*"' r"|(?<!\w)'(?:\\.|[^'\\\n])+'")
# What may stand between a function's parameters and its body, initializers of members included.
BEFORE_BODY = re.compile(r"(?:\s|const\b|noexcept\b|override\b|final\b|try\b|->[\w:<>&*\s]++|:(?!:)[^;{}]*+)*+\{")


def closed(code, at):
    """Returns the place behind the bracket that closes the one at `at`; the code's end if none does."""
    depth = 0
    for i in range(at, len(code)):
        depth += (code[i] in "({") - (code[i] in ")}")
        if depth == 0:
            return i + 1
    return len(code)


def bodies(text, function):
    """Returns beginning and end of the body of each function of this name (overloads have the same one), with its braces."""
    code = NO_CODE.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)
    out = []
    for named in re.finditer(rf"(?<![\w~]){re.escape(function)}\s*(?=\()", code):
        if before := BEFORE_BODY.match(code, closed(code, named.end())):
            out.append((before.end() - 1, closed(code, before.end() - 1)))
    return out


def pattern(old):
    """Returns a regular expression for the text, however its words and signs are divided by blanks and lines."""
    out = previous = ""
    for token in re.findall(r"\w+|[^\w\s]", old):
        if previous:
            out += r"(?:\s|\\\n)" + ("+" if re.match(r"\w", previous) and re.match(r"\w", token) else "*")
        out += re.escape(token)
        previous = token
    return re.compile(out)


def places(text, m):
    """Returns beginning and end of each place of the mutant's old text."""
    within = bodies(text, m.function) if m.function else [(0, len(text))]
    return sorted({(begin + at.start(), begin + at.end()) for begin, end in within for at in pattern(m.old).finditer(text[begin:end])})


def place(path, m):
    """Returns the only place of the mutant's old text. Raises ListError where there is none, or another."""
    found = places(path.read_text(), m) if path.is_file() else []
    if len(found) != 1:
        where = f"{m.function} of {m.file}" if m.function else m.file
        raise ListError(f"{m.name}: its old text occurs {len(found)} times in {where}, not once")
    return found[0]


SAMPLE = """int once(int a);
int once(int a) { return '}' + a; }  // once() {
struct Twice {
  explicit Twice(int a) : a_(a), b_(once(a)) { a_ += 1; }
  int twice(int a) const { if (a) { return a += 1; } return once(a); }
  int twice(char a) try { return a += 2; } catch (...) {}
  ~Twice() { a_ += 1; }
  const char* text = "twice(int a) { a += 3";
  int a_ = 1'000, b_;
};
auto Twice::other() -> std::vector<int> { if (twice(1)) { a_ += 1; } }
"""


def self_test():
    def counted(function, old):
        return len(places(SAMPLE, Mutant("", "", "", old, "", "", "", function)))

    expected = {("once", "return"): 1, ("once", "'}' + a"): 1, ("Twice", "a_ += 1"): 1, ("twice", "a += 1"): 1, ("twice", "a +="): 2,
                ("other", "a_ += 1"): 1, ("Twice::other", "a_ += 1"): 1, ("~Twice", "a_ += 1"): 1, ("", "a_ += 1"): 3, ("none", "a"): 0}
    wrong = [f"{old!r} of {function}: {counted(function, old)} times, not {count}"
             for (function, old), count in expected.items() if counted(function, old) != count]
    print("\n".join(wrong) or "functions are found")
    return 1 if wrong else 0


# --- The list itself ---


def complaints(mutants):
    out = []
    for name, count in collections.Counter(m.name for m in mutants).items():
        if count > 1:
            out.append(f"{name}: {count} mutants have this name")
    cmake = "\n".join(p.read_text() for p in sorted(ROOT.glob("tests/*/CMakeLists.txt")))
    programs = set(re.findall(r"(?:caplet_test|add_executable)\((\w+_tests)", cmake))
    sources = "\n".join(p.read_text() for p in sorted(ROOT.glob("tests/**/*.cpp")))
    tests = set(re.findall(r"\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", sources))
    for m in mutants:
        where = f"{m.source}: {m.name}"
        try:
            place(ROOT / m.file, m)
        except ListError as error:
            out.append(f"{m.source}: {error}")
        if m.old == m.new:
            out.append(f"{where}: changes nothing")
        if " " not in m.test or m.program not in programs:
            out.append(f"{where}: '{m.program}' is no test program")
            continue
        for test in m.filter.split(":"):
            suite, _, name = test.partition(".")
            if (suite.split("/")[-1], name.split("/")[0]) not in tests:
                out.append(f"{where}: there is no test {test}")
    return out


def page(mutants):
    return "\n".join(["# Seeded faults", "", "| mutant | file | fault | test |", "|---|---|---|---|", *(m.row() for m in mutants), ""])


def check():
    mutants = listed()
    bad = complaints(mutants)
    for line in bad:
        print(line)
    print(f"{len(mutants)} mutants, {len(bad)} complaints")
    return 2 if bad else 0


# --- The copy of the sources, and its build ---


def copy_sources(tree=TREE):
    """Makes the tree what ROOT is; files that are equal stay untouched, so that little is built again."""
    wanted = set()
    for folder, names, files in os.walk(ROOT):
        here = pathlib.Path(folder).relative_to(ROOT)
        names[:] = [n for n in names if n != ".git" and not (here == pathlib.Path() and n.startswith("build"))]
        wanted.update(here / f for f in files if not (ROOT / here / f).is_symlink())
    for file in wanted:
        to, contents = tree / file, (ROOT / file).read_bytes()
        if not to.is_file() or to.read_bytes() != contents:
            to.parent.mkdir(parents=True, exist_ok=True)
            to.write_bytes(contents)
            shutil.copymode(ROOT / file, to)
    for folder, names, files in os.walk(tree):
        here = pathlib.Path(folder).relative_to(tree)
        if here == pathlib.Path():
            names[:] = [n for n in names if n != "build"]
        for file in files:
            if here / file not in wanted:
                (tree / here / file).unlink()


def ran(command, tree):
    """Empty when it went well, or the output."""
    # Compilers' caches are to find what was built elsewhere.
    env = dict(os.environ, CCACHE_BASEDIR=str(tree), CCACHE_NOHASHDIR="1")
    done = subprocess.run(command, env=env, cwd=tree, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                          text=True, errors="replace")
    return "" if done.returncode == 0 else done.stdout or "no output"


def configure(tree=TREE, options=("-DCAPLET_BENCH=OFF",)):
    return ran(["cmake", "-S", str(tree), "--preset", "release", *options], tree)


def build(targets, jobs, tree=TREE):
    """Empty when it went well, or the output."""
    folder = tree / "build/release"
    failed = "" if (folder / "build.ninja").exists() else configure(tree)
    return failed or ran(["ninja", "-C", str(folder), "-j", str(jobs), *targets], tree)


def program_path(name):
    return next(BUILD.glob(f"tests/*/{name}"))


def take(name, folder):
    """Copies a test program and the program that it may run."""
    shutil.copy2(program_path(name), folder / name)
    if (BUILD / "bin/caplet").exists():
        shutil.copy2(BUILD / "bin/caplet", folder / "caplet")


# --- Running a test ---


def environment(folder, kernel_cache, program):
    """Of a test that has the folder for itself and may run the built program."""
    env = {k: v for k, v in os.environ.items() if not k.startswith(("GTEST_", "CAPLET_TEST_", "CAPLET_KERNELS", "CAPLET_FAULT"))}
    for name in ("CAPLET_CACHE", "TMPDIR"):
        env[name] = str(folder / name.lower())
        pathlib.Path(env[name]).mkdir(parents=True, exist_ok=True)
    # PoCL finds compiled kernels by their text: those that a mutant leaves alone are compiled once for all.
    env["POCL_CACHE_DIR"] = str(kernel_cache)
    env["CAPLET_TEST_PROGRAM"] = str(program)
    return env


def outcome(program, test_filter, kernels, folder):
    """Runs the tests in an own folder. One of PASSED, CAUGHT, or why neither can be said; and the output."""
    # The built program that tests run is the one beside them: another mutant may be built meanwhile.
    env = environment(folder, folder.parent / "pocl", program.with_name("caplet"))
    if kernels:
        env["CAPLET_KERNELS"] = str(kernels)
    try:
        done = subprocess.run([str(program), f"--gtest_filter={test_filter}"], env=env, cwd=folder, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True, errors="replace", timeout=TIMEOUT)
    except subprocess.TimeoutExpired:
        return f"over {TIMEOUT} s", ""
    text = done.stdout
    ran = re.search(r"^\[=+\] (\d+) tests? from \d+ test suites? ran", text, re.MULTILINE)
    if NOT_COMPILED in text:
        return "does not compile", text
    if ran and int(ran[1]) == 0:
        return "no such test", text
    if "[  SKIPPED ]" in text:
        return "skips", text
    if done.returncode == 0 and ran:
        return PASSED, text
    if done.returncode < 0:
        return f"{CAUGHT} (signal {-done.returncode})", text
    return (CAUGHT if "[  FAILED  ]" in text else f"exit status {done.returncode}"), text


def mutate(path, m):
    text, (begin, end) = path.read_text(), place(path, m)
    path.write_text(text[:begin] + m.new + text[end:])


class Run:
    def __init__(self, mutants, jobs):
        self.mutants, self.jobs = mutants, jobs
        self.results, self.seconds = {}, {}
        self.lock = threading.Lock()
        self.logs = WORK / "logs"

    def report(self, m, result, seconds, text):
        result = SURVIVED if result == PASSED else result
        with self.lock:
            self.results[m.name], self.seconds[m.name] = result, seconds
            (self.logs / f"{m.name}.log").write_text(text)
            print(f"[{len(self.results)}/{len(self.mutants)}] {m.name}: {result} ({seconds:.0f} s)", file=sys.stderr, flush=True)

    def prepare(self):
        """Builds the unmutated programs and keeps them apart."""
        copy_sources()
        programs = sorted({m.program for m in self.mutants})
        print(f"building {', '.join(programs)} (minutes the first time)", file=sys.stderr, flush=True)
        if failed := build(programs, self.jobs):
            raise ListError(f"the unmutated sources do not build:\n{failed[-4000:]}")
        shutil.rmtree(self.logs, ignore_errors=True)
        self.logs.mkdir(parents=True)
        self.plain = self.temporary / "plain"
        self.plain.mkdir()
        for name in programs:
            take(name, self.plain)

    def unmutated(self, pool):
        """Every named test must pass as it is, and every program that runs kernels must see what CAPLET_KERNELS names."""
        broken = self.temporary / "kernels-broken"
        shutil.copytree(TREE / "kernels", broken)
        with open(broken / "shared/kinds.h", "a") as file:
            file.write('#error "these kernels do not compile"\n')
        trials = []
        for test in sorted({m.test for m in self.mutants}):
            users = [m for m in self.mutants if m.test == test]
            of_kernel = any(m.is_kernel for m in users)
            trials.append((users, PASSED, TREE / "kernels" if of_kernel else None))
        for program in sorted({m.program for m in self.mutants if m.is_kernel}):
            trials.append(([m for m in self.mutants if m.is_kernel and m.program == program], "does not compile", broken))
        waiting = []
        for users, wanted, kernels in trials:
            folder = self.temporary / f"test-{len(waiting)}"
            folder.mkdir()
            waiting.append((users, wanted, pool.submit(outcome, self.plain / users[0].program, users[0].filter, kernels, folder)))
        bad = {}
        for users, wanted, future in waiting:
            got, text = future.result()
            if got == wanted:
                continue
            why = f"unmutated: {got}" if wanted == PASSED else f"does not read CAPLET_KERNELS: {got}"
            for m in users:
                bad[m.name] = why
                (self.logs / f"{m.name}.log").write_text(text)
        for m in self.mutants:
            if m.name in bad:
                self.report(m, bad[m.name], 0, (self.logs / f"{m.name}.log").read_text())
        return [m for m in self.mutants if m.name not in bad]

    def of_kernel(self, m):
        start = time.monotonic()
        folder = self.temporary / m.name
        folder.mkdir()
        shutil.copytree(TREE / "kernels", folder / "kernels")
        mutate(folder / pathlib.Path(m.file), m)
        result, text = outcome(self.plain / m.program, m.filter, folder / "kernels", folder)
        shutil.rmtree(folder)
        self.report(m, result, time.monotonic() - start, text)

    def of_host(self, m, pool):
        """Builds; its test runs in the pool."""
        start = time.monotonic()
        path, folder = TREE / m.file, self.temporary / m.name
        folder.mkdir()
        original = path.read_bytes()
        try:
            mutate(path, m)
            failed = build([m.program], self.jobs)
            if not failed:
                take(m.program, folder)
        finally:
            path.write_bytes(original)
        if failed:
            self.report(m, "does not build", time.monotonic() - start, failed[-4000:])
            return None

        def test():
            result, text = outcome(folder / m.program, m.filter, None, folder)
            shutil.rmtree(folder)
            self.report(m, result, time.monotonic() - start, text)

        return pool.submit(test)

    def run(self):
        with tempfile.TemporaryDirectory(prefix="caplet-mutants-") as temporary:
            self.temporary = pathlib.Path(temporary)
            self.prepare()
            with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
                sound = self.unmutated(pool)
                waiting = [pool.submit(self.of_kernel, m) for m in sound if m.is_kernel]
                waiting += [self.of_host(m, pool) for m in sound if not m.is_kernel]
                for future in waiting:
                    if future:
                        future.result()
        return self.results


def main():
    parser = argparse.ArgumentParser(prog="mutants", description="Seeded faults: each must be caught by the test that it names.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="these mutants only")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="tests at the same time")
    parser.add_argument("--check", action="store_true", help="look at the list alone")
    parser.add_argument("--page", action="store_true", help="print a table of all mutants")
    parser.add_argument("--self-test", action="store_true", help="try how functions are found")
    options = parser.parse_args()
    if options.self_test:
        return self_test()
    if options.check:
        return check()
    mutants = listed()
    if options.page:
        print(page(mutants), end="")
        return 0
    if bad := complaints(mutants):
        raise ListError("\n".join(bad))
    if unknown := set(options.names) - {m.name for m in mutants}:
        raise ListError(f"unknown mutants: {', '.join(sorted(unknown))}")
    chosen = [m for m in mutants if not options.names or m.name in options.names]
    start = time.monotonic()
    WORK.mkdir(parents=True, exist_ok=True)
    lock = open(WORK / ".lock", "w")
    fcntl.flock(lock, fcntl.LOCK_EX)
    results = Run(chosen, max(1, options.jobs)).run()
    for m in chosen:
        print(f"{results[m.name]:10} {m.name}: {m.fault} ({m.file})")
    caught = sum(r.startswith(CAUGHT) for r in results.values())
    print(f"\n{caught} of {len(chosen)} mutants caught, {time.monotonic() - start:.0f} s "
          f"(output of their tests: {(WORK / 'logs').relative_to(ROOT)})")
    return 0 if caught == len(chosen) else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except ListError as error:
        print(f"mutants: {error}", file=sys.stderr)
        sys.exit(2)
