#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The parts of tools/gpu.py over programs made up here."""
import argparse
import json
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.dont_write_bytecode = True
import gpu  # noqa: E402
from driver_kit import homes  # noqa: E402
from gpu_kit import pack, page, surroundings  # noqa: E402

DEVICES = """#!/bin/sh
[ "$1" = devices ] && echo '[{"name": "G", "driver": "1", "platform": "P", "version": "3", "type": "gpu", "native_float_width": 1}]' && exit 0
[ "$1" = render ] && sleep 60
[ "$1" = doctor ] && echo "it broke" >&2 && exit 7
"""
TESTS = """#!/bin/sh
echo "$GTEST_SHARD_INDEX of $GTEST_TOTAL_SHARDS with $GTEST_FILTER on $CAPLET_TEST_DEVICE" >>"$(dirname "$0")/asked"
echo "[       OK ] A.B (1 ms)"
[ "$GTEST_SHARD_INDEX" = 1 ] && echo "[  FAILED  ] C.D (2 ms)" && exit 1
exit 0
"""


class Runs(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name, text in (("caplet", DEVICES), ("trace_tests", TESTS)):
            (self.folder / name).write_text(text)
            (self.folder / name).chmod(0o755)
        self.enterContext(mock.patch.dict(homes.BINARIES, {name: self.folder / name for name in ("caplet", "trace_tests")}, clear=True))

    def hour(self, steps, minutes=1.0):
        return gpu.Hour(argparse.Namespace(out=self.folder / "out", minutes=minutes, driver="", encoding="single", workers=2, steps=steps, scenes=[],
                                           rays=10, launches=[], tests="*"))

    def found(self):
        return json.loads((self.folder / "out/gpu.json").read_text())["steps"]

    def test_each_step_is_kept_with_how_it_failed(self):
        hour = self.hour(["device", "self-test", "tests"])
        self.assertEqual(hour.all(), 0)
        found = self.found()
        self.assertEqual(found["device"]["opencl"]["name"], "G")
        self.assertEqual(found["self-test"]["doctor"]["fails"], "it broke")
        self.assertEqual(found["tests"]["trace_tests 0"]["passed"], 1)
        self.assertEqual(found["tests"]["trace_tests 1"]["failed"], ["C.D"])
        self.assertEqual(sorted((self.folder / "asked").read_text().splitlines()), ["0 of 2 with * on 0", "1 of 2 with * on 0"])
        self.assertIn("C.D", (self.folder / "out/trace_tests-1.log").read_text())
        self.assertIn("| trace_tests 1 | passed 1", (self.folder / "out/gpu.md").read_text())

    def test_a_program_that_hangs_ends_with_the_time(self):
        hour = self.hour(["compilation"], minutes=3 / 60)
        hour.all()
        first, again = (self.found()["compilation"][name] for name in ("first", "again"))
        self.assertRegex(first["fails"], r"^no end in [23]")
        self.assertEqual(again["left out"], "no time was left")

    def test_whole_images_are_differences_of_two_renders(self):
        hour = self.hour([])
        with mock.patch.object(hour, "rendered", side_effect=[{"wall": 1.0}, {"wall": 3.0}]) as rendered:
            found = hour.image("walk", "40x30", 2, 8)
        self.assertEqual(found, {"seconds": 2.0, "samples": 6, "paths_per_second": 40 * 30 * 6 / 2.0})
        self.assertEqual([call.args[3] for call in rendered.call_args_list], [2, 8])
        with mock.patch.object(hour, "rendered", side_effect=[{"wall": 1.0}, {"fails": "lost"}]):
            self.assertEqual(hour.image("walk", "40x30", 2, 8), {"fails": "lost"})

    def test_nothing_is_tried_without_a_device(self):
        (self.folder / "caplet").write_text("#!/bin/sh\necho none >&2\nexit 1\n")
        self.assertEqual(self.hour(["device", "tests"]).all(), 1)
        self.assertNotIn("tests", self.found())


class Packing(unittest.TestCase):
    def test_libraries_are_those_that_systems_lack(self):
        listed = ("\tlinux-vdso.so.1 (0x1)\n\tlibfmt.so.9 => /usr/lib/libfmt.so.9 (0x2)\n\tlibc.so.6 => /lib/libc.so.6 (0x3)\n"
                  "\tlibstdc++.so.6 => /lib/libstdc++.so.6 (0x4)\n\tlibz.so.1 => /lib/libz.so.1 (0x5)\n\t/lib64/ld-linux-x86-64.so.2 (0x6)\n")
        with mock.patch("subprocess.run", return_value=argparse.Namespace(stdout=listed)):
            self.assertEqual(pack.libraries("program"), {"libfmt.so.9": "/usr/lib/libfmt.so.9", "libz.so.1": "/lib/libz.so.1"})

    def test_a_packed_folder_has_its_own_programs_and_libraries(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for part in ("bin", "lib"):
                (folder / part).mkdir()
            (folder / "bin/caplet").touch()
            self.assertEqual(pack.binaries(folder), {"caplet": folder / "bin/caplet"})
            with mock.patch.dict(os.environ, {"LD_LIBRARY_PATH": "/before"}):
                env = surroundings.variables(folder, folder / "out", "/drivers/libgpu.so")
            self.assertEqual(env["LD_LIBRARY_PATH"], f"{folder}/lib:/drivers:/before")
            self.assertEqual(pathlib.Path(env["OCL_ICD_VENDORS"], "driver.icd").read_text(), "/drivers/libgpu.so\n")

    def test_all_test_programs_are_built_here(self):
        texts = "\n".join(file.read_text() for file in (ROOT / "tests").glob("*/CMakeLists.txt"))
        for name in pack.TESTS:
            self.assertIn(f"caplet_test({name} ", texts)


class Page(unittest.TestCase):
    def test_numbers_are_short_and_bars_break_no_table(self):
        text = page.of({"seconds": 12.3456, "steps": {"images": {"walk": {"seconds": 0.123456, "said": "a|b"}}}})
        self.assertIn("| walk | seconds 0.123, said a/b |", text)
        self.assertIn("12 s in all", text)


if __name__ == "__main__":
    unittest.main()
