#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""tools/bare_debian.sh with scripts in place of fresh-machine: it is content only where no machine is to be had."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FIRST = re.search(r"^```\n(\./run .*)\n", (ROOT / "README.md").read_text(), re.M)[1]


@unittest.skipUnless(shutil.which("git"), "git makes the repository")
class BareDebian(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.asked = self.folder / "asked"
        clone = self.folder / "clone"  # a repository with a commit, wherever the sources lie
        (clone / "tools").mkdir(parents=True)
        shutil.copy2(ROOT / "tools/bare_debian.sh", clone / "tools")
        shutil.copy2(ROOT / "README.md", clone)
        for command in (["init", "-q"], ["add", "-A"], ["-c", "user.name=t", "-c", "user.email=t@t", "commit", "-qm", "all"]):
            subprocess.run(["git", *command], cwd=clone, check=True)
        self.script = clone / "tools/bare_debian.sh"

    def end(self, machine=None, root=True):
        """Exit status, and what it says; the machine is a script that has its arguments."""
        tool = self.folder / "machine"
        if machine is not None:
            tool.write_text(f'#!/bin/bash\nprintf "%s|%s\\n" "$SUITE" "$*" >> {self.asked}\n{machine}\n')
            tool.chmod(0o755)
        path = self.folder / "bin"
        path.mkdir()
        (path / "id").write_text(f"#!/bin/sh\necho {0 if root else 1000}\n")
        (path / "id").chmod(0o755)
        done = subprocess.run([str(self.script), "trixie"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              env={**os.environ, "CAPLET_FRESH_MACHINE": str(tool), "PATH": f"{path}:{os.environ['PATH']}"})
        return done.returncode, done.stdout

    def test_a_machine_on_which_all_passes(self):
        code, said = self.end("exit 0")
        self.assertEqual(code, 0, said)
        self.assertNotIn("SKIPPED", said)
        probe, real = self.asked.read_text().splitlines()
        self.assertTrue(probe.startswith("trixie|apt-get update"), probe)
        self.assertTrue(real.startswith("trixie|bash") and FIRST in real and "./run verify --rays 100000" in real, real)

    def test_a_command_that_fails_there(self):
        code, said = self.end('[ "$1" = apt-get ]')
        self.assertNotEqual(code, 0, said)
        self.assertNotIn("SKIPPED", said)

    def test_no_machine(self):
        for reason, of_end in {"root": dict(machine="exit 0", root=False), "no network": dict(machine="echo no network; exit 1"),
                               "there is no": dict()}.items():
            with self.subTest(reason):
                shutil.rmtree(self.folder / "bin", ignore_errors=True)
                (self.folder / "machine").unlink(missing_ok=True)
                code, said = self.end(**of_end)
                self.assertEqual(code, 0, said)
                self.assertRegex(said, rf"\*\*\*\* SKIPPED.*{reason}")


if __name__ == "__main__":
    unittest.main()
