#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Makes or tries all files of a release (docs/releasing.md).

    ./run release [--draft] [PART...]     makes build/dist: source, pages, wheel, bookworm, trixie; all when none is named
    ./run release --try [PART...]         tries what is in build/dist on bare systems

A release is made of what is committed. Its version stands in CMakeLists.txt, in pyproject.toml and over the newest part of CHANGELOG.md,
with a date; --draft takes one that is "unreleased". Exit status: 0, 1 when something failed, 2 for what stands in the way.
"""
import argparse
import gzip
import hashlib
import io
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

import pages

ROOT = Path(__file__).resolve().parent.parent
DIST = ROOT / "build/dist"
PARTS = ["source", "pages", "wheel", "bookworm", "trixie"]
SUITES = {"bookworm": "12", "trixie": "13"}
FIRST = re.compile(r"^```\n(\./run .*)\n", re.M)


def say(text):
    print(f"release: {text}", file=sys.stderr, flush=True)


def stop(text):
    say(text)
    sys.exit(2)


def output_of(*command, **given):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, cwd=ROOT, **given).stdout


# --- What is released ---


def version_of(texts, draft):
    """The version, of the texts of CMakeLists.txt, pyproject.toml and CHANGELOG.md; or ends with what is wrong."""
    version = re.search(r"^project\(caplet VERSION (\S+)", texts["CMakeLists.txt"], re.M)[1]
    package = re.search(r'^version = "(.*)"', texts["pyproject.toml"], re.M)[1]
    if package != version:
        stop(f"CMakeLists.txt is of version {version}, pyproject.toml of {package}")
    newest = re.search(r"^## (\S+) \((.*)\)$", texts["CHANGELOG.md"], re.M)
    if not newest or newest[1] != version:
        stop(f"CHANGELOG.md does not begin with '## {version} (YYYY-MM-DD)'")
    if not re.fullmatch(r"\d{4}-\d\d-\d\d", newest[2]) and not (draft and newest[2] == "unreleased"):
        stop(f"CHANGELOG.md has {version} as '{newest[2]}', not with its date (YYYY-MM-DD)")
    return version


def committed(draft):
    """Version and time of the commit; or ends where it is not all that lies here."""
    changed = output_of("git", "status", "--porcelain", text=True)
    if changed:
        stop(f"these files are not committed:\n{changed.rstrip()}")
    texts = {name: output_of("git", "show", f"HEAD:{name}", text=True) for name in ("CMakeLists.txt", "pyproject.toml", "CHANGELOG.md")}
    return version_of(texts, draft), int(output_of("git", "log", "-1", "--format=%ct", text=True))


# --- Its files ---


def pack(folder, name, out, time):
    """A .tar.gz of the folder as NAME/: the same bytes whenever it is made of the same files."""
    with open(out, "wb") as file, gzip.GzipFile("", "wb", 9, file, 0) as packed, tarfile.open(fileobj=packed, mode="w") as archive:
        for path in sorted(folder.rglob("*")):
            entry = archive.gettarinfo(path, f"{name}/{path.relative_to(folder).as_posix()}")
            entry.uid = entry.gid = 0
            entry.uname = entry.gname = ""
            entry.mtime = time
            entry.mode = 0o755 if entry.isdir() or entry.mode & 0o100 else 0o644
            if entry.isreg():
                with open(path, "rb") as content:
                    archive.addfile(entry, content)
            else:
                archive.addfile(entry)


def machine(suite, command, **given):
    """Runs a command on a bare Debian, in a clone of what is committed."""
    tool = os.environ.get("CAPLET_FRESH_MACHINE", str(ROOT / "../shared/tools/fresh-machine"))
    if not os.access(tool, os.X_OK):
        stop(f"there is no {tool}, which makes bare systems (CAPLET_FRESH_MACHINE names another)")
    if os.geteuid() != 0:
        stop("bare systems need root")
    return subprocess.run([tool, "bash", "-euc", command], check=True, cwd=ROOT, env={**os.environ, "SUITE": suite}, **given)


def is_bookworm():
    system = Path("/etc/os-release")
    return system.exists() and "VERSION_CODENAME=bookworm" in system.read_text()


def fetch(suite, command, pattern, out):
    """Has a bare system make one file. Its name and its bytes are what the machine prints."""
    with tempfile.TemporaryFile() as file:
        machine(suite, f"{command} >&2; basename {pattern}; cat {pattern}", stdin=subprocess.DEVNULL, stdout=file)
        file.seek(0)
        name = file.readline().decode().strip()
        with open(out / name, "wb") as to:
            shutil.copyfileobj(file, to)


def make_source(version, time, out):
    with tempfile.TemporaryDirectory() as folder:
        with tarfile.open(fileobj=io.BytesIO(output_of("git", "archive", "HEAD"))) as archive:
            archive.extractall(folder, filter="data") if hasattr(tarfile, "data_filter") else archive.extractall(folder)
        pack(Path(folder), f"caplet-{version}", out / f"caplet-{version}.tar.gz", time)


def make_pages(version, time, out):
    with tempfile.TemporaryDirectory() as folder:
        site, man = Path(folder) / "pages", Path(folder) / "caplet.1"
        subprocess.run([ROOT / "run", "build"], check=True, stdout=sys.stderr)
        man.write_bytes(output_of(ROOT / "build/release/bin/caplet", "describe", "man"))
        errors = pages.make(ROOT, site, version, man)
        if errors:
            sys.exit("\n".join(f"release: {error}" for error in errors))
        pack(site, f"caplet-{version}-pages", out / f"caplet-{version}-pages.tar.gz", time)


def make_wheel(version, time, out):
    if not is_bookworm():
        return fetch("bookworm", "./run wheel --portable", "build/wheels/*manylinux*.whl", out)
    made = output_of(ROOT / "run", "wheel", "--portable", text=True).splitlines()[-1]
    shutil.copy(made, out)


def make_package(suite):
    def make(version, time, out):
        if suite == "bookworm" and is_bookworm():
            shutil.copy(output_of(ROOT / "run", "package", text=True).splitlines()[-1], out)
        else:
            fetch(suite, "./run package", "build/packages/*.deb", out)

    return make


def make(parts, draft):
    version, time = committed(draft)
    makers = {"source": make_source, "pages": make_pages, "wheel": make_wheel, **{suite: make_package(suite) for suite in SUITES}}
    DIST.mkdir(parents=True, exist_ok=True)
    for part in parts:
        say(f"making {part}")
        for old in files_of(part):
            old.unlink()
        makers[part](version, time, DIST)
        if not files_of(part):
            sys.exit(f"release: {part} made no file of its name in {DIST}")
    sums = ""
    for file in sorted(DIST.iterdir()):
        if file.name != "SHA256SUMS":
            sums += f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n"
    (DIST / "SHA256SUMS").write_text(sums)
    for file in sorted(DIST.iterdir()):
        print(f"{file.stat().st_size / 1e6:8.1f} MB  {file.relative_to(ROOT)}")


def files_of(part):
    patterns = {"source": r"caplet-[\d.]+\.tar\.gz", "pages": r"caplet-[\d.]+-pages\.tar\.gz", "wheel": r"caplet-.*manylinux.*\.whl",
                **{suite: rf"caplet_.*~deb{number}_.*\.deb" for suite, number in SUITES.items()}}
    return [file for file in sorted(DIST.glob("*")) if re.fullmatch(patterns[part], file.name)] if DIST.is_dir() else []


# --- Their trial ---


def try_source(file):
    """README's first command and `verify`, on the newest Debian."""
    first = FIRST.search((ROOT / "README.md").read_text())[1]
    with open(file, "rb") as archive:
        machine("trixie", f"mkdir /src/tried; tar xz -C /src/tried --strip-components 1; cd /src/tried; {first}; ./run verify --rays 100000",
                stdin=archive)


def try_pages(file):
    with tarfile.open(file) as archive:
        names = set(archive.getnames())
        top = os.path.commonpath(names)
        for name in ("index.html", "docs/cli.html", "caplet.1", "style.css"):
            if f"{top}/{name}" not in names:
                sys.exit(f"release: {file.name} is without {name}")


def try_wheel(file):
    (ROOT / "build/wheels").mkdir(parents=True, exist_ok=True)
    shutil.copy(file, ROOT / "build/wheels")  # the newest there is the one that is tried
    subprocess.run([ROOT / "run", "wheel", "--try"], check=True)


def try_package(suite):
    return lambda file: subprocess.run([ROOT / "run", "package-trial", suite, file], check=True)


def try_all(parts):
    checks = {"source": try_source, "pages": try_pages, "wheel": try_wheel, **{suite: try_package(suite) for suite in SUITES}}
    if not (DIST / "SHA256SUMS").exists():
        stop(f"there is no release in {DIST} (./run release)")
    subprocess.run(["sha256sum", "--quiet", "--strict", "-c", "SHA256SUMS"], check=True, cwd=DIST)
    for part in parts:
        if len(files_of(part)) != 1:
            stop(f"{DIST} has {len(files_of(part))} files of {part}, not one")
    failed = []
    for part in parts:
        say(f"trying {part}")
        try:
            checks[part](files_of(part)[0])
        except (subprocess.CalledProcessError, SystemExit) as error:
            say(f"{part} FAILED: {error}")
            failed.append(part)
    say(f"failed: {', '.join(failed)}" if failed else f"all passed: {', '.join(parts)}")
    return 1 if failed else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draft", action="store_true")
    parser.add_argument("--try", action="store_true", dest="tries")
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS))
    options = parser.parse_args()
    unknown = [part for part in options.parts if part not in PARTS]
    if unknown:
        stop(f"there is no part '{unknown[0]}' ({', '.join(PARTS)})")
    parts = options.parts or PARTS
    if options.tries:
        return try_all(parts)
    try:
        make(parts, options.draft)
    except subprocess.CalledProcessError as error:
        say(str(error))
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
