#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Things that the sources do in one place alone, so that what holds there holds everywhere. Exit code 1 where another does them.

    tools/doors.py              the sources
    tools/doors.py --self-test  each rule is broken once, in a copy in memory, and must be seen
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# What is done; its text; where it is looked for; where it may stand.
DOORS = [
    ("JSON is written by json_dump, which takes any bytes (host/base/utf8.h)", r"\.dump\(", ["host", "programs", "python/src"],
     ["host/base/utf8.h"]),
    ("files that scenes name are looked for by is_there and is_file (host/base/reading.h)",
     r"\b(fs|filesystem)::(exists|is_regular_file)\(", ["host/import", "host/film"],
     ["host/import/gzip_file.cpp", "host/import/import.cpp", "host/film/image_module.cpp"]),
    ("files that scenes name are opened after begin_reading (host/base/reading.h)",
     r"\bifstream\b|\bfopen\(|::open\(|\bgzopen\(|\bzip_open\(|\bMultiPartInputFile file\(|ReadFile\(", ["host/import", "host/film"],
     ["host/import/gzip_file.cpp", "host/import/import.cpp", "host/import/nanovdb.cpp", "host/import/text_file.cpp",
      "host/import/zip_file.cpp", "host/film/detail/checked_file.h", "host/film/image_exr.cpp", "host/film/image_oiio.cpp",
      "host/film/image_png.cpp"]),
    ("files that are read are noted by begin_reading (host/base/reading.h)", r"\bnote_input\(", ["host/import", "host/film"], []),
]
# Those that open files call one of these first.
ASKS = re.compile(r"\b(begin_reading|is_file|readable_file_bytes|check_may_read)\(")
# Those whose one caller asks before; and those that look for parts of the program alone, or only write.
ASKED_BY = {"host/film/image_oiio.cpp": "host/film/image_files.cpp", "host/film/image_png.cpp": "host/film/image_files.cpp"}
OWN_PARTS = ["host/film/image_module.cpp", "host/film/detail/checked_file.h"]


def sources():
    out = {}
    for folder in ("host", "programs", "python/src"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".cpp", ".h"):
                out[path.relative_to(ROOT).as_posix()] = path.read_text()
    return out


def broken(files):
    """What is wrong, a line each."""
    out = []
    for what, text, folders, doors in DOORS:
        for name, content in files.items():
            if not any(name.startswith(folder + "/") for folder in folders):
                continue
            found = [i + 1 for i, line in enumerate(content.split("\n")) if re.search(text, line) and not line.lstrip().startswith("//")]
            if found and name not in doors:
                out += [f"{name}:{line}: {what}" for line in found]
            asking = files.get(ASKED_BY.get(name, name), "")
            if found and name in doors and name not in OWN_PARTS and name.startswith(("host/import/", "host/film/")) and not ASKS.search(asking):
                out.append(f"{name}: opens files, and asks nobody whether it may")
        out += [f"{door}: there is no such file, or it does not do this any more: {what}" for door in doors
                if not re.search(text, files.get(door, ""))]
    return out


def self_test():
    files = sources()
    wrong = broken(files)
    planted = [("host/view/viewer.cpp", "auto x = json.dump();"), ("host/import/swc.cpp", "if (fs::exists(path)) return;"),
               ("host/import/meshes/obj.cpp", "std::ifstream in(path);"), ("host/film/image.cpp", "note_input(path);"),
               ("host/import/ies.cpp", "const int file = ::open(path.c_str(), 0);")]
    for name, line in planted:
        seen = broken({**files, name: files[name] + "\n" + line + "\n"})
        if len(seen) != len(wrong) + 1:
            wrong.append(f"'{line}' in {name} is not seen")
    for name in ("host/import/zip_file.cpp", "host/film/image_exr.cpp", "host/film/image_files.cpp"):
        if len(broken({**files, name: ASKS.sub("none(", files[name])})) <= len(wrong):
            wrong.append(f"{name} without its question is not seen")
    return wrong


if __name__ == "__main__":
    lines = self_test() if sys.argv[1:] == ["--self-test"] else broken(sources())
    print("\n".join(lines))
    sys.exit(1 if lines else 0)
