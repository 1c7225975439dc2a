#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Do the includes of the sources obey the table of rooms in docs/architecture.md?

usage: includes.py [--root FOLDER]          one line for each that does not; exit status 1 when there are any
       includes.py --draw [--root FOLDER]   the graph of the rooms, as mermaid text
       includes.py --self-test              plants one fault of each kind in a small tree: each must be found

The table names each room's folder and, in its last column, the rooms and libraries that its files include: all of them and no others. A room
may include rooms of earlier rows only, so no arrow runs up and none in a circle. Headers in a folder `detail` are their room's own; a folder of
tests may include those of the rooms that its CMakeLists.txt links as ROOM_detail. Within a room no
units (x.h with x.cpp) may depend on each other in a circle, directly or through others.
"""
import argparse
import pathlib
import re
import sys
import tempfile

PAGE = "docs/architecture.md"
LIBRARIES = {  # how their headers begin
    "Boost": ("boost/",), "CLI11": ("CLI/",), "Embree": ("embree3/", "embree4/"), "fmt": ("fmt/",), "gemmi": ("gemmi/",), "glm": ("glm/",), "pugixml": ("pugixml.hpp",), "stb": ("stb/",),
    "json": ("nlohmann/",), "libzip": ("zip.h",), "OpenCL": ("CL/",), "OpenEXR": ("Imf", "Iex", "Imath"), "OpenImageIO": ("OpenImageIO/",), "png": ("png.h",), "spdlog": ("spdlog/",),
    "TBB": ("tbb/", "oneapi/"), "zlib": ("zlib.h",)}
POSIX = ("sys/", "arpa/", "net/", "netinet/", "dlfcn.h", "fcntl.h", "grp.h", "poll.h", "pwd.h", "signal.h", "unistd.h")
SOURCES = {".h", ".cpp", ".c", ".cl", ".def"}
NAMESPACE = re.compile(r"^(?:namespace\b|}  // namespace\b)", re.M)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.M)


class Room:
    def __init__(self, folder, allowed, order):
        self.folder, self.allowed, self.order = folder, allowed, order
        self.name = folder.rsplit("/", 1)[-1]  # as includes begin
        self.used = set()


def read_table(root):
    """Rooms by folder, in the table's order."""
    rooms = {}
    for line in (root / PAGE).read_text().splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) != 3 or not cells[0].startswith("`"):
            continue
        for folder in re.findall(r"`([^`]+)`", cells[0]):
            if not (root / folder).is_dir():
                continue
            names = {re.sub(r"[`\s]", "", name) for name in cells[2].split(",")} - {"", "nothing"}
            rooms[folder] = Room(folder, names, len(rooms))
    return rooms


def files_of(root, tops):
    for top in tops:
        for path in sorted((root / top).rglob("*")):
            if path.suffix in SOURCES and path.is_file():
                yield path


def room_of(path, root, rooms):
    folder = path.parent.relative_to(root)
    while str(folder) != ".":
        if str(folder) in rooms:
            return rooms[str(folder)]
        folder = folder.parent
    return None


def library_of(header):
    return next((name for name, starts in LIBRARIES.items() if header.startswith(starts)), None)


def circles(edges):
    """Sets of nodes that reach each other (Tarjan 1972)."""
    index, low, stack, out = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in sorted(edges.get(node, ())):
            if other not in index:
                visit(other)
            if other in stack:
                low[node] = min(low[node], low[other])
        if low[node] == index[node]:
            members = stack[stack.index(node):]
            del stack[stack.index(node):]
            if len(members) > 1 or node in edges.get(node, ()):
                out.append(sorted(members))

    for node in sorted(edges):
        if node not in index:
            visit(node)
    return out


class Check:
    def __init__(self, root):
        self.root = root
        self.rooms = read_table(root)
        self.by_name = {room.name: room for room in self.rooms.values()}
        self.complaints = []
        self.headers = {}  # header -> headers it includes
        self.units = {}  # unit -> units of its own room
        tops = [top for top in ("include", "host", "kernels", "programs", "tests") if (root / top).is_dir()]
        if not self.rooms:
            self.complaints.append(f"{PAGE}: no table of rooms")
        for path in files_of(root, tops):
            self.file(path)
        for folder in sorted(p for top in ("host", "kernels") if (root / top).is_dir() for p in (root / top).iterdir() if p.is_dir()):
            if str(folder.relative_to(root)) not in self.rooms:
                self.complaints.append(f"{folder.relative_to(root)}: no row in {PAGE}")
        self.table()
        self.graph()

    def file(self, path):
        name = path.relative_to(self.root)
        room = room_of(path, self.root, self.rooms)
        # Kernels within C++ are no includes of the file.
        text = re.sub(r'R"\((.*?)\)"', lambda raw: "\n" * raw[0].count("\n"), path.read_text(errors="replace"), flags=re.S)
        for match in INCLUDE.finditer(text):
            place = f"{name}:{text.count(chr(10), 0, match.start()) + 1}"
            before = [end[0] for end in NAMESPACE.finditer(text, 0, match.start())]
            if not (match[1] or match[2]).endswith((".def", ".cl")) and path.suffix in (".cpp", ".h") and before[-1:] == ["namespace"]:
                self.complaints.append(f"{place}: {match[1] or match[2]} is included within a namespace")
            if match[2]:
                self.library(place, match[2], room)
            else:
                self.header(place, match[1], path, room)

    def library(self, place, header, room):
        if room is None:
            return
        library = library_of(header)
        if library is None:
            if "/" in header and not header.startswith(POSIX):
                self.complaints.append(f"{place}: <{header}> is of no library that {pathlib.Path(__file__).name} knows")
            return
        room.used.add(library)
        if library not in room.allowed:
            self.complaints.append(f"{place}: {room.folder} may not include {library} (<{header}>)")

    def header(self, place, header, path, room):
        beside = (path.parent / header).resolve()
        target = self.by_name.get(header.split("/")[0]) if "/" in header else None
        if target is None:
            if beside.is_file():
                self.edge(path, beside, room)
            return
        found = self.root / target.folder / header.split("/", 1)[1]
        self.edge(path, found, room)
        is_detail = "/detail/" in header
        if room is target:
            if is_detail and path.suffix != ".cpp" and "detail" not in path.relative_to(self.root).parts:
                self.complaints.append(f'{place}: "{header}" is not seen by those who include this header')
            return
        if is_detail and not self.may_see_detail(path, target):
            self.complaints.append(f'{place}: "{header}" is {target.folder}\'s own')
        if room is None:
            return
        room.used.add(target.name)
        if target.name not in room.allowed:
            self.complaints.append(f'{place}: {room.folder} may not include {target.name} ("{header}")')
        elif target.order > room.order:
            self.complaints.append(f'{place}: {room.folder} includes {target.folder}, which stands above it ("{header}")')

    def may_see_detail(self, path, target):
        """Tests whose own CMakeLists.txt, or that of a folder around, links ROOM_detail."""
        folder = path.parent
        while "tests" in folder.relative_to(self.root).parts:
            lists = folder / "CMakeLists.txt"
            if lists.is_file() and re.search(rf"\b{target.name}_detail\b", lists.read_text()):
                return True
            folder = folder.parent
        return False

    def edge(self, path, target, room):
        if not target.is_file():
            return
        if path.suffix != ".cpp":
            self.headers.setdefault(str(path.relative_to(self.root)), set()).add(str(target.resolve().relative_to(self.root.resolve())))
        if room is not None and room.folder.startswith("host/") and room is room_of(target.resolve(), self.root.resolve(), self.rooms):
            a, b = f"{room.name}/{path.stem}", f"{room.name}/{target.stem}"
            if a != b:
                self.units.setdefault(a, set()).add(b)

    def table(self):
        for room in self.rooms.values():
            for name in sorted(room.allowed - room.used):
                what = "includes nothing of it" if name in LIBRARIES or name in self.by_name else "there is no such room or library"
                self.complaints.append(f"{PAGE}: {room.folder} may include {name}: {what}")

    def graph(self):
        for members in circles(self.headers):
            self.complaints.append("a circle of headers: " + ", ".join(members))
        for members in circles({room.name: room.used & set(self.by_name) for room in self.rooms.values()}):
            self.complaints.append("a circle of rooms: " + ", ".join(members))
        for members in circles(self.units):
            self.complaints.append("a circle within a room: " + ", ".join(members))

    def drawn(self):
        """Without the arrows that follow from others."""
        used = {room.name: {name for name in room.used if name in self.by_name} for room in self.rooms.values()}

        def reaches(a, b, first):
            return any(c == b or reaches(c, b, False) for c in used[a] if not (first and c == b))

        lines = [f"  {a} --> {b}" for a in used for b in sorted(used[a]) if not reaches(a, b, True)]
        return "\n".join(["flowchart BT", *lines])


def self_test():
    def make(folder, files):
        table = ("| room | what | may include |\n|---|---|---|\n| `host/base` | errors | fmt |\n| `host/scene` | model | base, glm |\n"
                 "| `host/bvh` | trees | base |\n| `host/lower` | records | scene, bvh |\n")
        good = {PAGE: table,
                "host/base/error.h": "#include <string>\n#include <fmt/format.h>\n",
                "host/scene/scene.h": '#include "base/error.h"\n#include <glm/vec3.hpp>\n',
                "host/bvh/bvh.h": "", "host/bvh/bvh.cpp": '#include "bvh/bvh.h"\n#include "bvh/detail/binary.h"\n#include "base/error.h"\n',
                "host/bvh/detail/binary.h": "",
                "host/lower/lower.h": '#include "scene/scene.h"\n', "host/lower/lower.cpp": '#include "lower/lower.h"\n#include "bvh/bvh.h"\n',
                "tests/bvh/CMakeLists.txt": "caplet_test(bvh_tests LINK bvh_detail)\n",
                "tests/bvh/a_test.cpp": '#include "bvh/detail/binary.h"\n'}
        for name, text in (good | files).items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return Check(folder).complaints

    one = '#include "lower/{}.h"\n'.format
    cases = [
        ({}, None),
        ({"host/scene/a.cpp": '#include "bvh/bvh.h"\n'}, "host/scene/a.cpp:1: host/scene may not include bvh"),
        ({"host/bvh/a.cpp": '\n#include <glm/vec3.hpp>\n'}, "host/bvh/a.cpp:2: host/bvh may not include glm"),
        ({"host/lower/a.cpp": '#include "bvh/detail/binary.h"\n'}, "is host/bvh's own"),
        ({"host/bvh/bvh.h": '#include "bvh/detail/binary.h"\n'}, "host/bvh/bvh.h:1: \"bvh/detail/binary.h\" is not seen"),
        ({"tests/lower/a_test.cpp": '#include "bvh/detail/binary.h"\n'}, "is host/bvh's own"),
        ({"host/bvh/a.cpp": 'namespace caplet {\n#include "base/error.h"\n}\n'}, "host/bvh/a.cpp:2: base/error.h is included within a namespace"),
        ({"host/bvh/a.cpp": 'namespace caplet {\n#include "rows.def"\n}\n'}, None),
        ({"host/lower/lower.cpp": ""}, "host/lower may include bvh: includes nothing of it"),
        ({"host/attic/a.h": ""}, "host/attic: no row"),
        ({"host/base/a.h": '#include "base/b.h"\n', "host/base/b.h": '#include "base/a.h"\n'}, "a circle of headers: host/base/a.h, host/base/b.h"),
        ({f"host/lower/{a}.cpp": one(b) for a, b in ("ab", "ba", "cd", "dc", "ef", "fe", "gh", "hg")}
         | {f"host/lower/{a}.h": "" for a in "abcdefgh"}, "a circle within a room"),
        ({PAGE: "| `host/base` | errors | fmt, scene |\n| `host/scene` | model | glm |\n| `host/bvh` | trees | base |\n| `host/lower` | r | scene, bvh |\n",
          "host/base/error.h": '#include <fmt/format.h>\n#include "scene/scene.h"\n', "host/scene/scene.h": "#include <glm/vec3.hpp>\n"},
         "includes host/scene, which stands above it"),
        ({PAGE: "no table\n"}, "no table of rooms"),
    ]
    bad = 0
    for files, expected in cases:
        with tempfile.TemporaryDirectory() as folder:
            said = make(pathlib.Path(folder), files)
        if (not any(expected in line for line in said)) if expected else said:
            bad += 1
            print(f"expected {expected!r}, not {said}")
    print(f"{len(cases) - bad} of {len(cases)} as expected")
    return 1 if bad else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[1])
    parser.add_argument("--draw", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    if options.self_test:
        return self_test()
    check = Check(options.root)
    if options.draw:
        print(check.drawn())
        return 0
    for line in check.complaints:
        print(line)
    if check.complaints:
        return 1
    print(f"{len(check.rooms)} rooms, as {PAGE} has them")
    return 0


if __name__ == "__main__":
    sys.exit(main())
