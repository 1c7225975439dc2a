#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The parts of tools/drivers.py over files and answers made up here."""
import pathlib
import re
import struct
import sys
import tempfile
import unittest
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.dont_write_bytecode = True
from driver_kit import checks, exr, homes, page  # noqa: E402

FLOAT, UINT = 2, 0
COLOURS = ("B", "G", "R", "variance.B", "variance.G", "variance.R")


def packed(data, compression):
    """As openexr.com, "Technical Introduction": bytes parted, differences, then zlib or runs (a count below 0: bytes as they are)."""
    parted = data[0::2] + data[1::2]
    differences = bytes([parted[0]]) + bytes((b - a + 128) & 255 for a, b in zip(parted, parted[1:]))
    if compression == 3:
        return zlib.compress(differences)
    out = bytearray()
    for run in re.finditer(rb"(?s)(.)\1{2,126}|.", differences):
        text = run[0]
        out += bytes([len(text) - 1, text[0]]) if len(text) > 1 else bytes([255, text[0]])
    return bytes(out) if len(out) < len(data) else data


def exr_bytes(width, height, channels, compression):
    """A file of `channels`: (name, kind, numbers row by row), in the order of their names."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    list_of = b"".join(name.encode() + b"\0" + struct.pack("<iiii", kind, 0, 1, 1) for name, kind, _ in channels) + b"\0"
    head = b"v/1\x01" + struct.pack("<i", 2) + attribute("channels", "chlist", list_of)
    head += attribute("compression", "compression", bytes([compression]))
    head += attribute("dataWindow", "box2i", struct.pack("<4i", 3, 5, 3 + width - 1, 5 + height - 1)) + b"\0"
    rows = {0: 1, 1: 1, 3: 16}[compression]
    blocks = []
    for y in range(0, height, rows):
        data = b""
        for row in range(y, min(y + rows, height)):
            for _, kind, values in channels:
                data += struct.pack(f"<{width}{'f' if kind == FLOAT else 'I'}", *values[row * width:(row + 1) * width])
        block = data if compression == 0 else packed(data, compression)
        blocks.append(struct.pack("<ii", 5 + y, len(block)) + block)
    at, offsets = len(head) + 8 * len(blocks), b""
    for block in blocks:
        offsets += struct.pack("<Q", at)
        at += len(block)
    return head + offsets + b"".join(blocks)


class Pictures(unittest.TestCase):
    def read(self, data):
        with tempfile.NamedTemporaryFile(suffix=".exr") as file:
            file.write(data)
            file.flush()
            return exr.Picture(file.name)

    def picture(self, values, variance, ids=(1, 2)):
        channels = [(name, FLOAT, [variance] * 2 if "variance" in name else list(values)) for name in COLOURS[:3]]
        channels += [("object.id", UINT, list(ids)), ("primitive.id", UINT, [7, 7])]
        channels += [(name, FLOAT, [variance] * 2) for name in COLOURS[3:]]
        return self.read(exr_bytes(2, 1, channels, 0))

    def test_all_compressions_give_what_was_written(self):
        width, height = 5, 19
        numbers = [(x * 37 % 11) / 4 - 1 if x > 40 else 0.5 for x in range(width * height)]
        ids = [x // 9 + (1 << 31) for x in range(width * height)]
        for compression in (0, 1, 3):
            read = self.read(exr_bytes(width, height, [("R", FLOAT, numbers), ("object.id", UINT, ids)], compression))
            self.assertEqual((read.width, read.height), (width, height))
            self.assertEqual(read.channels["R"].tolist(), numbers)
            self.assertEqual(read.channels["object.id"].tolist(), ids)

    def test_other_files_are_refused(self):
        for data in (b"P6 2 1 255 abcdef", exr_bytes(2, 1, [("R", 1, [0, 0])], 0)):
            with self.assertRaises(ValueError):
                self.read(data)

    def test_differences_are_told_in_units_of_the_noise(self):
        self.assertIsNone(exr.difference(self.picture((1, 3), 0.5), self.picture((1, 3), 0.5)))
        # R, G and B each differ by 1 and -2: mean square 2.5; both variances are 0.5 a pixel: 1. The means' difference is 0.5 of three
        # channels' 6 numbers, -3 in all, of a standard error of sqrt(6).
        found = exr.difference(self.picture((2, 1), 0.5, (1, 3)), self.picture((1, 3), 0.5))
        self.assertAlmostEqual(found["rms"], 2.5 ** 0.5 / 2)
        self.assertAlmostEqual(found["noise"], 2.5 ** 0.5)
        self.assertAlmostEqual(found["shift"], 3 / 6 ** 0.5)
        self.assertEqual((found["pixels"], found["of"]), (1, 2))
        self.assertFalse(exr.within_noise(found))
        self.assertTrue(exr.within_noise(exr.difference(self.picture((1.5, 2.5), 0.5), self.picture((1, 3), 0.5))))
        # Every number 0.9 higher: less than the noise of each, and still no chance.
        shifted = {**found, "noise": 0.9, "shift": 3.1}
        self.assertFalse(exr.within_noise(shifted))
        self.assertFalse(exr.within_noise(exr.difference(self.picture((1, 3.1), 0.0), self.picture((1, 3), 0.0))))

    def test_an_id_alone_is_a_difference(self):
        found = exr.difference(self.picture((1, 3), 0.5, (1, 9)), self.picture((1, 3), 0.5))
        self.assertEqual((found["rms"], found["pixels"]), (0, 1))


class Crossings(unittest.TestCase):
    def test_are_equal_near_or_elsewhere(self):
        theirs = ["0,1.5,a,0,0,m,1,0", "1,2,a,1,0,m,1,0", "3,4,b,2,0,m,1,0", "4,8,b,2,0,m,1,0"]
        ours = ["0,1.5,a,0,0,m,1,9", "1,2.5,a,1,0,m,1,0", "2,1,a,0,0,m,1,0", "3,4,b,3,0,m,1,0", "4,8,b,2,0,m,0,0"]
        self.assertEqual(checks.compare_crossings(theirs, theirs), {"rays": 4, "t": 4, "worst": 0.0, "other": 0})
        # One of the five rays is equal, one has t a quarter larger, one is new, one hits another primitive, one another side.
        self.assertEqual(checks.compare_crossings(ours, theirs), {"rays": 5, "t": 1, "worst": 0.25, "other": 3})


FINE = {
    "name": "one", "title": "Some driver", "origin": "somewhere", "encoding": "wide", "package": "",
    "device": {"name": "A | B", "driver": "3.1+x", "platform": "P LLVM 15.0.6", "version": "OpenCL 3.0", "type": "cpu", "own": "wide"},
    "self-test": {"notes": []}, "verify": {"rays": 1000000, "wrong": 0, "worst": 0.9, "faults": {}},
    "hits": {"s": {"rays": 10, "t": 10, "worst": 0.0, "other": 0}},
    "tests": {"render_tests": {"passed": 5, "skipped": 1, "failed": []}, "trace_tests": {"passed": 3, "skipped": 0, "failed": []}},
    "pictures": {"s": None, "r": {"rms": 1e-4, "noise": 0.02, "shift": 0.1, "pixels": 3, "of": 100}},
}


class Tables(unittest.TestCase):
    def test_a_row_says_what_was_seen(self):
        self.assertEqual(page.row(FINE), "| Some driver 3.1+x (LLVM 15.0.6); somewhere | wide, its own | passes | 0 of 1,000,000 | "
                         "all | 5 pass, 1 skipped | 3 pass | 1 equal, 1 within noise |")
        self.assertFalse(page.is_wrong(FINE))

    def test_a_package_has_its_own_version_and_the_drivers(self):
        self.assertIn("| Some driver 2026.2.0 (driver 3.1+x); somewhere | single |",
                      page.row({**FINE, "package": "2026.2.0", "encoding": "single"}))

    def test_each_thing_that_is_wrong_counts_and_is_told(self):
        far = {"rms": 1, "noise": 1.2, "shift": 0, "pixels": 3, "of": 100}
        cases = [("self-test", {"fails": "computes wrongly"}, "fails: computes wrongly"),
                 ("verify", {**FINE["verify"], "wrong": 1250}, "| 1,250 of 1,000,000 |"), ("verify", {"fails": "signal 6"}, "fails: signal 6"),
                 ("hits", {"s": {"fails": "no end in 9 s"}}, "fails: no end in 9 s"), ("pictures", {"s": far}, "1 beyond it"),
                 ("pictures", {"s": {"fails": "signal 11"}}, "1 fail: signal 11"),
                 ("tests", {"trace_tests": {"passed": 2, "skipped": 0, "failed": ["A.B"]}}, "2 pass, 1 fail"),
                 ("tests", {"trace_tests": {"passed": 2, "skipped": 0, "failed": [], "fails": "signal 6: x in A.B"}}, "signal 6: x in A.B")]
        for part, facts, text in cases:
            bad = {**FINE, part: facts}
            self.assertTrue(page.is_wrong(bad), part)
            self.assertIn(text, page.row(bad))

    def test_a_driver_that_is_left_out_says_why(self):
        row = page.row({"name": "one", "title": "T", "origin": "o", "encoding": "wide", "left out": "needs root"})
        self.assertIn("left out: needs root", row)
        self.assertEqual(row.count("|"), page.row(FINE).count("|"))

    def test_a_driver_is_named_once(self):
        rows = page.table([FINE, {**FINE, "encoding": "single"}, {**FINE, "package": "2026.2.0"}]).splitlines()[2:]
        self.assertEqual([row.split(" | ")[0].startswith("| the same") for row in rows], [False, True, False], rows)
        self.assertEqual(rows[1].count("|"), rows[0].count("|"))

    def test_the_page_keeps_what_stands_around_the_tables(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "page.md"
            file.write_text(f"before\n{page.BEGIN}\nold\n{page.END}\nafter\n")
            page.write(file, [FINE])
            text = file.read_text()
            self.assertTrue(text.startswith("before\n") and text.endswith("\nafter\n") and page.row(FINE) in text and "old" not in text)
            page.write(file, [FINE])
            self.assertEqual(file.read_text(), text)

    def test_the_repositorys_page_has_room_for_them(self):
        text = (ROOT / "docs/drivers.md").read_text()
        self.assertEqual((text.count(page.BEGIN), text.count(page.END)), (1, 1))


class Programs(unittest.TestCase):
    """What becomes of programs that end in every way; /bin/sh stands for them."""

    def tried(self, script, seconds=20):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="drivers-test-"))
        self.addCleanup(lambda: [each.unlink() for each in folder.iterdir()] + [folder.rmdir()])
        # The program's own words come after the script, where sh takes them for arguments.
        return checks.Tried(homes.Home({"WORD": "x"}, ["/bin/sh", "-c", script]), "single", folder, seconds)

    def test_see_the_driver_and_the_encoding(self):
        code, out, _ = self.tried('echo "$WORD $CAPLET_ENCODING $CAPLET_TEST_DEVICE"').run("caplet")
        self.assertEqual((code, out), (0, "x single 0\n"))

    def test_that_crash_hang_or_fail_say_how(self):
        self.assertIn("signal 6", checks.verify(self.tried("echo last words >&2; kill -ABRT $$"), 5)["fails"])
        self.assertIn("last words", checks.verify(self.tried("echo last words >&2; kill -ABRT $$"), 5)["fails"])
        self.assertEqual(checks.verify(self.tried("exec sleep 30", 0.2), 5)["fails"], "no end in 0.2 s")
        self.assertEqual(checks.verify(self.tried("exit 1"), 5)["fails"], "exit code 1")
        self.assertIn("JSON", checks.verify(self.tried("echo no"), 5)["fails"])

    def test_of_gtest_are_counted_to_the_crash(self):
        said = r"[ RUN      ] A.B\n[       OK ] A.B (1 ms)\n[ RUN      ] A.C\n[  SKIPPED ] A.C (0 ms)\n[ RUN      ] A.D\n[  FAILED  ] A.D (3 ms)\n[ RUN      ] A.E\n"
        found = checks.tests(self.tried(f"printf '{said}'; kill -SEGV $$"), "trace_tests")
        self.assertEqual((found["passed"], found["skipped"], found["failed"]), (1, 1, ["A.D"]))
        self.assertRegex(found["fails"], "signal 11.* in A.E")
        found = checks.tests(self.tried(f"printf '{said}'; exit 1"), "trace_tests")
        self.assertNotIn("fails", found)
        self.assertIn("fails", checks.tests(self.tried("exit 1"), "trace_tests"))

    def test_of_the_doctor_pass_by_the_word_about_the_device_alone(self):
        def findings(state, what, about="device 0 X"):
            return ('[{"state": "note", "about": "PoCL", "what": "its cache holds what the self-test said"}, '
                    f'{{"state": "{state}", "about": "{about}", "what": "{what}"}}]')
        def tested(*words):
            return checks.self_test(self.tried(f"echo '{{\"findings\": {findings(*words)}}}'"))
        self.assertNotIn("fails", tested("ok", "passes the self-test"))
        self.assertEqual(tested("wrong", "fails the self-test: so")["fails"], "fails the self-test: so")
        self.assertEqual(tested("ok", "passes the self-test", "PoCL")["fails"], "was not made")


if __name__ == "__main__":
    unittest.main()
