#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""tools/release.py in repositories made up here, and tools/pages.py on pages made up here and on the project's own."""
import contextlib
import hashlib
import io
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import pages  # noqa: E402
import release  # noqa: E402

GOOD = {
    "CMakeLists.txt": "cmake_minimum_required(VERSION 3.25)\nproject(caplet VERSION 1.2.3 LANGUAGES C CXX)\n",
    "pyproject.toml": '[project]\nversion = "1.2.3"\n',
    "CHANGELOG.md": "# Changelog\n\n## 1.2.3 (2026-11-24)\n\n- New.\n\n## 1.2.2 (2026-01-01)\n",
}
# A machine: it answers as a bare system would that makes one file.
MACHINE = """#!/bin/bash
echo "$SUITE $*" >> {asked}
case "$*" in *"./run package"*) printf 'caplet_1.2.3-1~deb%s_amd64.deb\\nan archive' $([ $SUITE = trixie ] && echo 13 || echo 12) ;; esac
[ -z "${{FAILS:-}}" ]
"""


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def write(self, files):
        for name, text in files.items():
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)


class Versions(unittest.TestCase):
    def refused(self, change, draft=False):
        """What is said of the good texts with one of them changed."""
        said = io.StringIO()
        with contextlib.redirect_stderr(said), self.assertRaises(SystemExit) as end:
            release.version_of({**GOOD, **change}, draft)
        self.assertEqual(end.exception.code, 2)
        return said.getvalue()

    def test_the_three_agree(self):
        self.assertEqual(release.version_of(GOOD, False), "1.2.3")

    def test_another_in_one_of_them(self):
        self.assertIn("1.2.3, pyproject.toml of 1.2.4", self.refused({"pyproject.toml": 'version = "1.2.4"\n'}))
        self.assertIn("## 1.2.3 (", self.refused({"CHANGELOG.md": "# Changelog\n\n## 1.2.2 (2026-01-01)\n"}))
        self.assertIn("pyproject.toml of 1.2.3", self.refused({"CMakeLists.txt": "project(caplet VERSION 1.3.0)\n"}))

    def test_a_draft_alone_is_unreleased(self):
        changelog = {"CHANGELOG.md": GOOD["CHANGELOG.md"].replace("2026-11-24", "unreleased")}
        self.assertIn("as 'unreleased'", self.refused(changelog))
        self.assertEqual(release.version_of({**GOOD, **changelog}, True), "1.2.3")
        self.assertIn("as 'soon'", self.refused({"CHANGELOG.md": "## 1.2.3 (soon)\n"}, True))


@unittest.skipUnless(shutil.which("git"), "git makes the repository")
class Made(Folder):
    def setUp(self):
        super().setUp()
        self.write({**GOOD, ".gitignore": "/build/\n", "README.md": "```\n./run render a\n```\n", "run": "#!/bin/sh\n"})
        (self.folder / "tools").mkdir()
        for name in ("release.py", "pages.py"):
            shutil.copy2(ROOT / "tools" / name, self.folder / "tools")
        (self.folder / "run").chmod(0o755)
        (self.folder / "machine").write_text(MACHINE.format(asked=self.folder / "build/asked"))
        (self.folder / "machine").chmod(0o755)
        (self.folder / "build").mkdir()
        self.git("init", "-q")
        self.commit()

    def git(self, *arguments):
        subprocess.run(["git", "-c", "user.name=t", "-c", "user.email=t@t", *arguments], cwd=self.folder, check=True)

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-qm", "all")

    def end(self, *arguments, **environment):
        done = subprocess.run([sys.executable, "-B", self.folder / "tools/release.py", *arguments], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, env={**os.environ, "CAPLET_FRESH_MACHINE": str(self.folder / "machine"), **environment})
        return done.returncode, done.stdout

    def test_the_source_is_what_is_committed(self):
        self.assertEqual(self.end("source")[0], 0)
        archive = self.folder / "build/dist/caplet-1.2.3.tar.gz"
        first = archive.read_bytes()
        with tarfile.open(archive) as files:
            self.assertEqual(files.extractfile("caplet-1.2.3/CHANGELOG.md").read().decode(), GOOD["CHANGELOG.md"])
            self.assertEqual(files.getmember("caplet-1.2.3/run").mode, 0o755)
            self.assertEqual(files.getmember("caplet-1.2.3/README.md").mode, 0o644)
            self.assertFalse([name for name in files.getnames() if ".git/" in name or "build" in name])
        sums = (self.folder / "build/dist/SHA256SUMS").read_text()
        self.assertEqual(sums, f"{hashlib.sha256(first).hexdigest()}  caplet-1.2.3.tar.gz\n")
        os.utime(self.folder / "README.md", (0, 0))
        self.assertEqual(self.end("source")[0], 0)
        self.assertEqual(archive.read_bytes(), first)

    def test_what_is_not_committed_is_in_the_way(self):
        self.write({"README.md": "changed\n"})
        code, said = self.end("source")
        self.assertEqual(code, 2)
        self.assertIn("README.md", said)
        self.assertFalse((self.folder / "build/dist").exists())

    def test_parts_are_named(self):
        code, said = self.end("sources")
        self.assertEqual((code, "no part 'sources'" in said), (2, True), said)

    @unittest.skipUnless(os.geteuid() == 0, "bare systems need root")
    def test_packages_of_other_systems_come_from_bare_ones(self):
        code, said = self.end("trixie")
        self.assertEqual(code, 0, said)
        self.assertEqual((self.folder / "build/dist/caplet_1.2.3-1~deb13_amd64.deb").read_text(), "an archive")
        self.assertIn("trixie bash -euc ./run package", (self.folder / "build/asked").read_text())
        code, said = self.end("trixie", FAILS="1")
        self.assertEqual(code, 1, said)

    @unittest.skipUnless(os.geteuid() == 0, "bare systems need root")
    def test_a_trial_sees_what_is_damaged_missing_or_failing(self):
        self.assertEqual(self.end("--try", "source")[0], 2)
        self.assertEqual(self.end("source")[0], 0)
        code, said = self.end("--try", "source")
        self.assertEqual(code, 0, said)
        self.assertIn("all passed: source", said)
        self.assertIn("./run render a; ./run verify", (self.folder / "build/asked").read_text())
        code, said = self.end("--try", "source", FAILS="1")
        self.assertEqual((code, "failed: source" in said), (1, True), said)
        code, said = self.end("--try", "source", "wheel")
        self.assertEqual((code, "0 files of wheel" in said), (2, True), said)
        with open(self.folder / "build/dist/caplet-1.2.3.tar.gz", "ab") as file:
            file.write(b"more")
        self.assertNotIn(self.end("--try", "source")[0], (0, 2))


class Slugs(unittest.TestCase):
    def test_are_githubs(self):
        for heading, name in (("Man page and completions", "man-page-and-completions"), ("What <code>--no-outside</code> does", "what---no-outside-does"),
                              ("Rays &amp; hits: a_b", "rays--hits-a_b")):
            self.assertEqual(pages.slug(heading), name)


@unittest.skipUnless(shutil.which("cmark-gfm"), "cmark-gfm makes the pages")
class Pages(Folder):
    def made(self, readme, **docs):
        self.write({"README.md": readme, "CHANGELOG.md": "", "CONTRIBUTING.md": "", **{f"docs/{name}.md": text for name, text in docs.items()}})
        return pages.make(self.folder, self.folder / "out", "1.2.3")

    def test_links_lead_to_pages_headings_and_files(self):
        self.write({"a.txt": "a", "docs/b.png": "b"})
        errors = self.made("[p](docs/p.md#two-1) [a](a.txt) [w](https://x.y/z.md)", p="# One & All\n\n## Two\n\n## Two\n\n![b](b.png) [r](../README.md)\n")
        self.assertEqual(errors, [])
        index, page = ((self.folder / "out" / name).read_text() for name in ("index.html", "docs/p.html"))
        for text in ('href="docs/p.html#two-1"', 'href="a.txt"', 'href="https://x.y/z.md"'):
            self.assertIn(text, index)
        for text in ('<h2 id="two-1">', 'src="b.png"', 'href="../index.html"', "<title>One &amp; All</title>", 'href="../style.css"'):
            self.assertIn(text, page)
        self.assertEqual((self.folder / "out/docs/b.png").read_text(), "b")

    def test_links_to_nothing_are_told(self):
        self.assertEqual(self.made("[p](docs/p.md#three) [q](q.txt) [o](../outside.md)", p="# One\n"),
                         ["README.md: docs/p.md has no heading #three", "README.md: there is no q.txt", "README.md: there is no ../outside.md"])

    def test_the_projects_own(self):
        self.assertEqual(pages.make(ROOT, self.folder / "out", "0"), [])
        self.assertIn('href="docs/cli.html', (self.folder / "out/index.html").read_text())


if __name__ == "__main__":
    unittest.main()
