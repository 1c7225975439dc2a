#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Installs a build folder into an empty one, and builds and runs docs/library.md's programs with nothing but what is there.

usage: installed.py SOURCES BUILD CXX
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "films"))
from exr_chunks import chunks  # noqa: E402

SOURCES, BUILD, CXX = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]


def run(*command, **options):
    result = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    if result.returncode:
        sys.exit(f"{' '.join(map(str, command))}: exit status {result.returncode}\n{result.stdout}")
    return result.stdout


def check(holds, what):
    if not holds:
        sys.exit(what)


def blocks(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```", page, re.M | re.S)


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        prefix, project, build = folder / "prefix", folder / "project", folder / "build"
        run("cmake", "--install", BUILD, "--prefix", prefix)
        headers = {str(path.relative_to(prefix / "include")) for path in (prefix / "include").rglob("*") if path.is_file()}
        expected = {str(path.relative_to(SOURCES / "include")) for path in (SOURCES / "include/caplet").rglob("*.h")}
        check(headers == expected, f"installed headers: {sorted(headers)}, not {sorted(expected)}")
        for header in sorted(headers):
            text = (prefix / "include" / header).read_text()
            for word in ("CL/", "cl_", "--", "#include \"base", "fmt/", "glm/"):
                lines = [line for line in text.splitlines() if word in re.sub(r"//.*", "", line) or (word == "--" and "`--" in line)]
                check(not lines, f"{header} has '{word}': {lines}")
        check(run(prefix / "bin/caplet", "--version").startswith("caplet "), "the installed program does not tell its version")
        for text in ("man/man1/caplet.1", "bash-completion/completions/caplet", "zsh/site-functions/_caplet", "fish/vendor_completions.d/caplet.fish",
                     "caplet/scenes/gallery.pbrt"):
            check((prefix / "share" / text).stat().st_size > 500, f"{text} is not installed")
        page = (SOURCES / "docs/library.md").read_text()
        project.mkdir()
        example, edits = blocks(page, "cpp")
        check(len(edits.splitlines()) < 40, f"the program of edits has {len(edits.splitlines())} lines")
        (project / "CMakeLists.txt").write_text(blocks(page, "cmake")[0] + """
add_executable(edits edits.cpp)
target_link_libraries(edits PRIVATE caplet::caplet)
""")
        (project / "main.cpp").write_text(example)
        (project / "edits.cpp").write_text(edits)
        run("cmake", "-S", project, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_PREFIX_PATH={prefix}",
            f"-DCMAKE_CXX_COMPILER={CXX}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        run("cmake", "--build", build)
        library = [str(path) for path in prefix.glob("lib*/**/") if list(path.glob("libcaplet*"))]
        environment = os.environ | {"LD_LIBRARY_PATH": ":".join(library)}
        said = run(build / "example", SOURCES / "scenes/capsules.pbrt", folder / "out.exr", env=environment)
        check(re.search(r"t = [0-9.]+\n$", said), f"the example says: {said}")
        check((folder / "out.exr").read_bytes()[:4] == b"\x76\x2f\x31\x01", "the example wrote no OpenEXR file")
        film, fresh = folder / "film.exr", folder / "fresh.exr"
        told = [run(build / "edits", SOURCES / "scenes/capsules.pbrt", *words, env=environment)
                for words in ((film,), (film, "go-on"), (fresh, "at-once"))]
        check(len(set(told)) == 1 and re.search(r" at [0-9.]+\n$", told[0]), f"the program of edits says: {told}")
        check(chunks(film) == chunks(fresh), "a film of edits, saved, loaded and added to, is not that of one fresh render")
        print(said, *told[:1], end="")


main()
