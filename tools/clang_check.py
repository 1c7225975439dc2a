#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Does clang accept the sources? It reads them without making code, in a third of a build's time.

usage: clang_check.py BUILD [PART...]     BUILD: a folder that CMake has configured for clang; PART: of the names of objects, such as host/film

Exit status 1 when it refuses one.
"""
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys


def ninja(folder, *arguments):
    done = subprocess.run(["ninja", "-C", folder, *arguments], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    return done.stdout


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folder, parts = os.path.abspath(sys.argv[1]), sys.argv[2:]
    made = re.findall(r"^(\S*embedded_\w+\.cpp): CUSTOM_COMMAND", ninja(folder, "-t", "targets", "all"), re.M)
    ninja(folder, *made)
    rows = [row for row in json.loads(re.sub(r"^ninja: .*\n", "", ninja(folder, "-t", "compdb"), flags=re.M))
            if " -c " in row["command"] and "clang" in row["command"].split(" ", 1)[0]]
    headers = [row["output"] for row in rows if row["output"].endswith(".pch")]
    ninja(folder, *headers)
    rows = [row for row in rows if row["output"] not in headers and (not parts or any(part in row["output"] for part in parts))]
    if not rows:
        sys.exit(f"clang_check: no object's name has {' or '.join(parts)}")

    def check(row):
        command, skip = [], 0
        for word in shlex.split(row["command"]):
            if skip:
                skip -= 1
            elif word in ("-o", "-MT", "-MF"):
                skip = 1
            elif word != "-MD":
                command.append("-fsyntax-only" if word == "-c" else word)
        return subprocess.run(command, cwd=row["directory"], capture_output=True, text=True)

    refused = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for done in pool.map(check, rows):
            refused += done.returncode != 0
            sys.stderr.write(done.stderr)
    print(f"clang_check: {len(rows)} objects, {refused} refused")
    return 1 if refused else 0


if __name__ == "__main__":
    sys.exit(main())
