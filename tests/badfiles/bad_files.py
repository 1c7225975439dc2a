#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Bad files of every format of the registry: the program refuses each with its name (exit status 2), or reads it (0).

usage: bad_files.py PROGRAM [EACH]    EACH: files of each format (default 6; the target `badfiles` takes 400)

The samples are the seeds of the fuzz targets. They are cut off, have bytes changed, zeroed or repeated, counts and numbers replaced by huge
and senseless ones, and the endings of others; there are empty files, folders and files of zeros too. A run that takes more than a minute, more
than 4 GiB of data, another exit status, or whose message does not name the file, is a failure, and its file is kept.
"""
import concurrent.futures
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SEEDS = ROOT / "tests/fuzz/seeds"
SECONDS, DATA = 60, 4 << 30
HUGE = (b"\xff\xff\xff\x7f", b"\xff\xff\xff\xff", b"\x00\x00\x00\x80", b"\x00\xca\x9a\x3b", b"\x3b\x9a\xca\x00", b"\x00\x00\xc0\x7f")
WORDS = (b"1000000000", b"-1", b"1e400", b"nan", b"18446744073709551616", b"", b"x")


def formats():
    """(name, first ending) of each row."""
    rows = re.findall(r'^(?:FULL_)?IMPORTER\(\w+, "([^"]+)", OPTIONS\([^)]*\), "([^"]+)"', (ROOT / "host/import/importers.def").read_text(), re.M)
    assert len(rows) >= 20, rows
    return rows


def samples(name, ending):
    """Whole files; of formats whose seeds are parts of files those with the ending."""
    for folder in (ending[1:], name, {"pbrt-v4": "pbrt", "tressfx": "tfx"}.get(name, name)):
        found = sorted(path for path in (SEEDS / folder).glob("*") if path.is_file())
        if found:
            break
    if ending in (".3mf", ".trx"):
        found = [path for path in found if path.suffix == ending]
    if not found:
        sys.exit(f"{name}: tests/fuzz/seeds has no sample")
    return [path.read_bytes() for path in found]


def spoilt(data, draw):
    way = draw.randrange(7)
    data = bytearray(data)
    at = draw.randrange(len(data) + 1)
    if way == 0:
        return data[:at]
    if way == 1:
        for _ in range(draw.choice((1, 1, 2, 8))):
            if data:
                data[draw.randrange(len(data))] = draw.randrange(256)
    elif way == 2:
        data[at:at + 4] = draw.choice(HUGE)
    elif way == 3:
        count = draw.choice((1, 4, 64))
        data[at:at + count] = bytes(count)
    elif way == 4:
        data[at:at] = data[max(0, at - draw.choice((1, 16, 256))):at] * draw.choice((1, 3))
    else:
        numbers = list(re.finditer(rb"[-+]?\d[\d.]*", bytes(data)))
        if numbers:
            one = draw.choice(numbers)
            data[one.start():one.end()] = draw.choice(WORDS)
    return data


def limits():
    resource.setrlimit(resource.RLIMIT_DATA, (DATA, DATA))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def complaint(program, path):
    """What is wrong with how the program takes the file; None: nothing."""
    try:
        done = subprocess.run([program, "info", path], capture_output=True, timeout=SECONDS, preexec_fn=limits, stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return f"takes more than {SECONDS} s"
    if done.returncode not in (0, 2):
        return f"exit status {done.returncode}: {done.stderr.decode(errors='replace')[-300:]}"
    if done.returncode == 2 and path.name.encode() not in done.stderr:
        return f"the message does not name the file: {done.stderr.decode(errors='replace')[-300:]}"
    return None


def write_all(folder, each):
    rows = formats()
    for k, (name, ending) in enumerate(rows):
        draw, whole = random.Random(name), samples(name, ending)
        bad = [b"", bytes(1000), *samples(*rows[(k + 1) % len(rows)])[:1]]
        bad += [spoilt(draw.choice(whole), draw) for _ in range(each)]
        for i, data in enumerate(bad):
            path = folder / f"{name}_{i}{ending}"
            path.write_bytes(data)
            yield path
        (folder / f"{name}_folder{ending}").mkdir()
        yield folder / f"{name}_folder{ending}"


def main(program, each=6):
    folder = pathlib.Path(tempfile.mkdtemp(prefix="bad_files"))
    paths = list(write_all(folder, int(each)))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        wrong = [(path, text) for path, text in zip(paths, pool.map(lambda path: complaint(program, path), paths)) if text]
    for path, text in wrong:
        print(f"{path}: {text}")
    print(f"{len(paths)} files, {len(wrong)} failures")
    if not wrong:
        shutil.rmtree(folder)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
