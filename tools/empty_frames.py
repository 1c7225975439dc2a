#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Whether exceptions find their way through programs and libraries: no unwind record may be of no bytes.

usage: empty_frames.py FILE...    exit status 1 where one is, 77 where there is no objdump (binutils)

At -O3 GCC 12 splits unlikely parts from functions, and leaves empty ones with records of their own. Such a record begins where the next
function does, the unwinder takes it for that function's, finds nothing, and the program ends where an error was to be told.
"""
import re
import shutil
import subprocess
import sys


def empty_ones(file):
    frames = subprocess.run(["objdump", "--dwarf=frames", file], capture_output=True, text=True, errors="replace", check=True).stdout
    spans = re.findall(r"FDE .*pc=([0-9a-f]+)\.\.([0-9a-f]+)", frames)
    assert len(spans) > 100, f"{file}: objdump tells of {len(spans)} functions"
    return [begin for begin, end in spans if begin == end]


def main(files):
    if not shutil.which("objdump"):
        print("SKIPPED: no objdump (binutils)")
        return 77
    bad = 0
    for file in files:
        symbols = subprocess.run(["nm", "-C", file], capture_output=True, text=True, errors="replace", check=True).stdout.splitlines()
        for begin in empty_ones(file):
            bad += 1
            print(f"{file}: an empty record before", "; ".join(line.split(" ", 2)[2] for line in symbols if line.startswith(begin)) or begin)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
