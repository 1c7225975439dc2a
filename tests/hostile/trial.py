#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Runs Caplet over drivers that the hostile layer makes bad (README.md), and says what came of it.

Pictures of scenes must be those of the plain driver to the bit where a form only limits or delays. Where calls fail, a command either
gives what it gives without, or ends with an error, an exit status, and the files that were there before.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import view_latency  # noqa: E402
from driver_kit import exr  # noqa: E402

# Forms that change no result: limits of memory, launches and queries, and commands that finish late.
HARMLESS = {
    "blocks of 256 MB": "block=256M",
    "blocks of 2 MB": "block=2M",
    "256 MB in all": "memory=256M",
    "groups of 64": "group=64",
    "32 KB of local memory": "local=32K",
    "no vectors": "width=1",
    "no images": "no_images",
    "alignment of 512 bytes": "align=512",
    "late by up to 5 ms": "late=0.005",
    "builds take 0.05 s more": "compile=0.05",
    "memory is full of ones": "garbage",
}
# Forms that a command cannot end well with: each must be told of, in these words.
FATAL = {
    "launches end after 0.1 ms": ("watchdog=0.0001", "CL_OUT_OF_RESOURCES"),
    "1 MB in all": ("memory=1M", "[0-9]+ bytes in all|has [0-9]+ MB left"),
    "1 MB in all, missed late": ("memory=1M lazy", "CL_MEM_OBJECT_ALLOCATION_FAILURE"),
    "blocks of 4 KB": ("block=4K", "allows [0-9]+ MB in one buffer|CL_INVALID_BUFFER_SIZE"),
    "no program can be built": ("calls=clBuildProgram rate=1", "program '.*': clBuildProgram: CL_"),
    "no argument can be set": ("calls=clSetKernelArg rate=1", "argument.* of kernel '.*clSetKernelArg: CL_OUT_OF_RESOURCES"),
    "arguments cannot be set at the end": ("calls=clSetKernelArg from={clSetKernelArg}", "argument.* of kernel '.*clSetKernelArg: CL_OUT_OF_RESOURCES"),
    "waiting fails": ("calls=clFinish rate=1 fragile", "clFinish: CL_"),
    "the compiler crashes": ("crash=clBuildProgram", "the driver failed"),
    "the device is lost": ("lose=150", "CL_OUT_OF_RESOURCES"),
}
# What tells of a driver that failed, or gave wrong results.
ERROR = re.compile(r"^caplet: error: .*(cl[A-Z]\w+: CL_|driver|device|memory)|^\s*\d+ .*disagree", re.M)
LIMIT = 120  # seconds: a command that takes longer hangs


def read_report(path):
    """The layer's report: texts by name; empty where there is none."""
    return dict(line.split(" ", 1) for line in path.read_text().splitlines() if " " in line) if path.exists() else {}


class Result:
    """How a command ended, what it wrote, and its pictures (their headers tell times)."""

    def __init__(self, code, text, report, folder):
        self.code, self.text, self.report = code, text, report
        self.files, self.pictures = {p.name: p.read_bytes() for p in folder.iterdir()}, {}
        for path in folder.glob("*.exr") if code == 0 else []:
            self.pictures[path.name] = {name: values.tobytes() for name, values in exr.Picture(path).channels.items()}


class Trial:
    def __init__(self, options):
        self.options = options
        self.scenes = sorted(p for p in options.scenes.iterdir() if p.suffix in (".pbrt", ".swc", ".3mf", ".xml", ".capsules"))
        self.drawn_scenes = [p for p in self.scenes if not options.quick or p.stem == "capsules"]
        self.good, self.reports = {}, {}

    def run(self, command, form, folder):
        """Runs a command in a folder, where `report.txt` and pictures come to lie. `form` None: without the layer."""
        environment = {k: v for k, v in os.environ.items() if k not in ("HOSTILE", "OPENCL_LAYERS")}
        report = folder / "report.txt"
        report.unlink(missing_ok=True)
        if form is not None:
            environment.update(OPENCL_LAYERS=str(self.options.layer), HOSTILE=f"{form} report={report}")
        try:
            run = subprocess.run([self.options.program, *command], cwd=folder, env=environment, capture_output=True, timeout=LIMIT)
            code, text = run.returncode, (run.stdout + run.stderr).decode(errors="replace")
        except subprocess.TimeoutExpired:
            code, text = "hang", ""
        facts = read_report(report)
        report.unlink(missing_ok=True)
        return Result(code, text, facts, folder)

    def commands(self):
        """Commands by name; each with what of its text is compared."""
        scene = {p.stem: str(p) for p in self.scenes}
        small = ["--size", "48x27", "--spp", "2", "-o", "out.exr"]
        nothing, last = re.compile(r"(?!)"), re.compile(r"^(?!caplet: ).*$", re.M)
        all_of_them = {
            "render capsules": (["render", scene["capsules"], *small], nothing),
            "render gallery": (["render", scene["gallery"], *small], nothing),
            "render smoke": (["render", scene["smoke"], *small], nothing),
            "render neuron to 20 %": (["render", scene["neuron"], "--size", "48x27", "--noise", "20%", "-o", "out.exr"], nothing),
            "render with mattes": (["render", scene["instances"], *small, "--cryptomatte"], nothing),
            "pick": (["pick", scene["capsules"], "--pixel", "640,360", "--all"], last),
            "verify": (["verify", scene["gallery"], "--rays", "2000"], re.compile(r"^verdict.*$", re.M)),
        }
        return {"render capsules": all_of_them["render capsules"]} if self.options.quick else all_of_them

    def plain(self, name, command):
        if name not in self.good:
            with tempfile.TemporaryDirectory() as folder:
                self.good[name] = self.run(command, None, pathlib.Path(folder))
            if self.good[name].code != 0:
                sys.exit(f"{name} fails without the layer:\n{self.good[name].text}")
        return self.good[name]

    def calls_of(self, name, command):
        """The report of a command without faults."""
        if name not in self.reports:
            with tempfile.TemporaryDirectory() as folder:
                self.reports[name] = self.run(command, "", pathlib.Path(folder)).report
        return self.reports[name]

    def judged(self, name, command, compared, form):
        """One of: same, told, wrong, silent, lost, crash, hang; and the result."""
        good = self.plain(name, command)
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            old = {file: b"a picture of yesterday" for file in good.files}
            for file, contents in old.items():
                (folder / file).write_bytes(contents)
            result = self.run(command, form, folder)
        if result.code == "hang":
            return "hang", result
        if result.code < 0 or result.code >= 128:
            return "crash", result
        if result.code == 0:
            same = result.pictures == good.pictures and compared.findall(result.text) == compared.findall(good.text)
            return ("same" if same else "wrong"), result
        if result.files != old:
            return "lost", result
        return ("told" if ERROR.search(result.text) else "silent"), result

    def viewed(self, form, report):
        """Looks at a scene in the viewer from two places, and ends it. Returns what came of it, and the report."""
        environment = os.environ | {"OPENCL_LAYERS": str(self.options.layer), "HOSTILE": f"{form} report={report}"}
        command = [self.options.program, "view", self.options.scenes / "gallery.pbrt", "--no-browser", "-q", "--spp", "4", "--size", "96x54"]
        process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        seen = False
        try:
            client = view_latency.Client(process.stdout.readline().strip())
            client.socket.settimeout(60)
            hello = client.until(lambda got: isinstance(got, dict) and got["type"] == "scene")
            for by in (0, 0.1):
                view_latency.look(client, hello["camera"], (96, 54), by)
                client.until(lambda got: isinstance(got, tuple) and got[2:] == (1, 4))
            seen = True
        except TimeoutError:
            process.kill()
            return "hang", {}, ""
        except (OSError, ValueError, RuntimeError):  # the program has ended
            pass
        if seen:
            process.send_signal(signal.SIGINT)
        try:
            text = process.communicate(timeout=60)[1]
        except subprocess.TimeoutExpired:
            process.kill()
            return "hang", {}, ""
        facts = read_report(report)
        if process.returncode < 0 or process.returncode >= 128:
            return "crash", facts, text
        if process.returncode == 0:
            return ("same" if seen else "silent"), facts, text
        return ("told" if ERROR.search(text) else "silent"), facts, text

    def views(self):
        """The viewer where one call fails."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            what, facts, text = self.viewed("", folder / "plain")
            if what != "same":
                sys.exit(f"the viewer does not work without faults: {what}\n{text}")
            calls = [(call, int(count)) for call, count in facts.items() if call.startswith("cl")]
            draw = random.Random(self.options.seed)
            drawn = [(call, draw.randint(1, count)) for call, count in draw.choices(calls, k=(self.options.faults + 7) // 8)]
            found = self.pool([lambda i=i, call=call, at=at: self.viewed(f"calls={call} at={at} seed={at}", folder / str(i))
                               for i, (call, at) in enumerate(drawn)])
        rows = collections.defaultdict(collections.Counter)
        for (call, at), (what, facts, text) in zip(drawn, found):
            rows[call][what if facts.get("first") else "not reached" if what == "same" else what] += 1
            if what not in ("same", "told"):
                self.fail(f"{call} number {at} of the viewer fails ({facts.get('first')}): {what}\n{text}")
        for call, count in sorted(rows.items()):
            self.say(f"viewer, {call}: {self.counts(count)}")
        return rows

    def pool(self, jobs):
        with concurrent.futures.ThreadPoolExecutor(self.options.jobs) as pool:
            return list(pool.map(lambda job: job(), jobs))

    def pictures(self):
        """Every scene under each harmless form."""
        rows = {}
        for title, form in HARMLESS.items():
            def picture(scene, form=form):
                command = ["render", str(scene), "--size", "48x27", "--spp", "2", "-o", "out.exr"]
                return self.judged(scene.name, command, re.compile(r"(?!)"), form)[0]
            found = self.pool([lambda s=scene: picture(s) for scene in self.drawn_scenes])
            rows[title] = collections.Counter(found)
            self.say(f"{title}: {self.counts(rows[title])}")
            for scene, what in zip(self.drawn_scenes, found):
                if what != "same":
                    self.fail(f"{title}: the picture of {scene.name}: {what}")
        return rows

    def endings(self):
        """Every command under each form that it cannot end well with."""
        rows = {}
        for title, (form, words) in FATAL.items():
            def ending(name, command, compared, form=form):
                nine_tenths = {call: 9 * int(n) // 10 for call, n in self.calls_of(name, command).items() if call.startswith("cl")}
                return self.judged(name, command, compared, form.format(**nine_tenths))
            found = self.pool([lambda n=n, c=c, t=t, ending=ending: ending(n, c, t) for n, (c, t) in self.commands().items()])
            rows[title] = collections.Counter(what for what, _ in found)
            self.say(f"{title}: {self.counts(rows[title])}")
            for name, (what, result) in zip(self.commands(), found):
                if not (what == "told" and re.search(words, result.text) or what == "same" and not result.report.get("first")):
                    self.fail(f"{title}: {name}: {what}, not in the words \"{words}\"\n{result.text}")
        return rows

    def faults(self):
        """One call of a command fails: which one is drawn."""
        draw = random.Random(self.options.seed)
        possible = []
        for name, (command, compared) in self.commands().items():
            self.plain(name, command)
            report = self.calls_of(name, command)
            possible += [(name, command, compared, call, int(count)) for call, count in report.items() if call.startswith("cl")]
        drawn = [(*what, draw.randint(1, what[4])) for what in draw.choices(possible, k=self.options.faults)]
        found = self.pool([lambda d=d: self.judged(d[0], d[1], d[2], f"calls={d[3]} at={d[5]} seed={d[5]}") for d in drawn])
        rows = collections.defaultdict(collections.Counter)
        for (name, _, _, call, _, at), (what, result) in zip(drawn, found):
            rows[call][what if result.report.get("first") else "not reached"] += 1
            if what not in ("same", "told"):
                self.fail(f"{call} number {at} of {name} fails ({result.report.get('first')}): {what}\n{result.text}")
        for call, count in sorted(rows.items()):
            self.say(f"{call}: {self.counts(count)}")
        self.say(f"{len(possible)} kinds of calls of {len(self.commands())} commands; {len(drawn)} faults")
        return rows

    def suites(self):
        """Test programs under each harmless form; a number is that of the tests that fail."""
        rows = {}
        for title, form in HARMLESS.items():
            rows[title] = {}
            for suite in self.options.suites:
                environment = os.environ | {"OPENCL_LAYERS": str(self.options.layer), "HOSTILE": form}
                program, log = self.options.tests / suite, self.options.out / f"{suite.replace('/', '-')}-{form.split('=')[0]}.txt"
                with open(log, "wb") as output:
                    try:
                        code = subprocess.run([program, "--gtest_brief=1"], env=environment, stdout=output, stderr=subprocess.STDOUT,
                                              timeout=1800, cwd=self.options.out).returncode
                    except subprocess.TimeoutExpired:
                        code = "hang"
                failed = sorted(set(re.findall(r"^\[  FAILED  \] (\S+?)(?:,| \(|$)", log.read_text(errors="replace"), re.M)))
                rows[title][suite] = "passes" if code == 0 else f"{len(failed)} fail" if failed else str(code)
                self.say(f"{title}: {suite} {rows[title][suite]}")
                if code != 0:
                    self.fail(f"{title}: {suite}: {', '.join(failed) or code} ({log})")
        return rows

    @staticmethod
    def counts(counter):
        return ", ".join(f"{what} {count}" for what, count in sorted(counter.items()))

    def say(self, text):
        print(f"{time.monotonic() - START:6.0f} s  {text}", flush=True)

    def fail(self, text):
        FAILURES.append(text)
        print(f"FAILED  {text}", flush=True)


START, FAILURES = time.monotonic(), []


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", type=pathlib.Path, required=True, help="caplet")
    parser.add_argument("--layer", type=pathlib.Path, required=True, help="libhostile_layer.so")
    parser.add_argument("--scenes", type=pathlib.Path, required=True, help="the folder of scenes")
    parser.add_argument("--tests", type=pathlib.Path, help="the folder of test programs")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."), help="where hostile.json and the suites' output go")
    parser.add_argument("--parts", nargs="*", default=["pictures", "endings", "faults", "views"], choices=["pictures", "endings", "faults", "views", "suites"])
    parser.add_argument("--suites", nargs="*", default=["session/session_tests", "query/query_tests", "verify/verify_tests", "edits/edits_tests"])
    parser.add_argument("--only", nargs="*", help="forms, by their text")
    parser.add_argument("--faults", type=int, default=1000, help="how many (default 1000)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help="a few of each, within a minute")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    options.program, options.layer, options.scenes = (p.resolve() for p in (options.program, options.layer, options.scenes))
    options.out = options.out.resolve()
    if options.tests:
        options.tests = options.tests.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    if options.only:
        for forms in (HARMLESS, FATAL):
            for title in [t for t, form in forms.items() if (form if isinstance(form, str) else form[0]) not in options.only]:
                del forms[title]
    if options.quick:
        options.faults = 8
        for title in ("groups of 64", "no vectors", "the compiler crashes"):  # which compile anew
            HARMLESS.pop(title, None)
            FATAL.pop(title, None)
    trial = Trial(options)
    rows = {part: getattr(trial, part)() for part in options.parts}
    (options.out / "hostile.json").write_text(json.dumps(rows, indent=1) + "\n")
    print(f"{len(FAILURES)} of these went wrong" if FAILURES else "all as they must be")
    sys.exit(1 if FAILURES else 0)


if __name__ == "__main__":
    main()
