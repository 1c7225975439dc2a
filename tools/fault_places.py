# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Where a source can be changed by one token, by its syntax tree, and how: what tools/faults.py draws from."""
import bisect
import dataclasses
import hashlib
import pathlib
import pickle
import re
import subprocess
import tempfile

try:
    from clang import cindex
except ImportError:
    cindex = None

# With CAPLET_REACHED no fault is on: the switches that a program comes by are appended to that file, one number a line.
SWITCH = """#pragma once
#include <atomic>
#include <cstdlib>
#include <fcntl.h>
#include <unistd.h>
inline const int caplet_fault_number = std::getenv("CAPLET_FAULT") ? std::atoi(std::getenv("CAPLET_FAULT")) : -1;
inline const char* const caplet_reached_path = std::getenv("CAPLET_REACHED");
inline std::atomic<bool> caplet_reached[4096];
inline void caplet_note(int number) {
    if (caplet_reached[number].exchange(true)) return;
    char text[16];
    int length = 0;
    text[15] = 10;
    for (unsigned rest = static_cast<unsigned>(number); length == 0 || rest; rest /= 10) text[14 - length++] = static_cast<char>(48 + rest % 10);
    const int file = ::open(caplet_reached_path, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) return;
    if (::write(file, text + 15 - length, static_cast<unsigned>(length) + 1) < 0) std::abort();
    ::close(file);
}
inline bool caplet_fault(int number) {
    if (caplet_reached_path) caplet_note(number);
    return number == caplet_fault_number;
}
"""
REPLACED = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "+": "-", "-": "+", "*": "/", "/": "*", "&&": "||", "||": "&&"}
MEMBERS = {"x": "y", "y": "z", "z": "x"}
# Arguments of these functions are texts that people read, which no test compares.
MESSAGE = re.compile(r"(format|fail\w*|error\w*|warn\w*|notes?_?|print\w*|complain\w*|refuse\w*|message\w*|log_\w+|InputError|RunError)"
                     r"(\s*(\.|->|::)\s*\w+)?$")
# Calls that change nothing but time and memory, or what is printed.
SILENT = re.compile(r"\b(reserve|shrink_to_fit|notes?_?(\.|->)add|log_\w+|print\w*|warn\w*)$")


@dataclasses.dataclass(frozen=True)
class Place:
    file: str  # below the root
    line: int
    begin: int  # bytes
    end: int
    kind: str
    old: str
    new: str  # what people read
    switched: str  # what compilers read; @ is the fault's number

    @property
    def last(self):
        return self.line + self.old.count("\n")

    def row(self, number):
        def text(t):
            return "`" + " ".join(t.split()).replace("|", "\\|")[:70].replace("`", "'") + "`"

        return f"| {number} | {self.file}:{self.line} | {text(self.old)} | {text(self.new)} |"


class Reader:
    """Finds the places of one file."""

    def __init__(self, file, path, arguments):
        self.file, self.source, self.places = file, path.read_bytes(), {}
        self.lines = [0] + [i + 1 for i, c in enumerate(self.source) if c == 10]
        unit = cindex.Index.create().parse(str(path), args=arguments)
        for cursor in unit.cursor.get_children():
            if cursor.location.file and cursor.location.file.name == str(path):
                self.visit(cursor, None)

    def text(self, begin, end):
        return self.source[begin:end].decode(errors="replace")

    def span(self, cursor):
        return cursor.extent.start.offset, cursor.extent.end.offset

    def add(self, kind, begin, end, new, switched=None):
        line = bisect.bisect_right(self.lines, begin)
        whole = self.source[self.lines[line - 1]:].split(b"\n", 1)[0].strip()
        old = self.text(begin, end)
        if len(whole) < 8 or whole.startswith((b"#", b"//")) or b"constexpr" in whole or b"static_assert" in whole or not old:
            return
        self.places[begin, end, new] = Place(self.file, line, begin, end, kind, old, new, switched or f"(caplet_fault(@) ? ({new}) : ({old}))")

    def left_out(self, kind, begin, end):
        tail = re.match(rb"\s*;", self.source[end:end + 20])
        if tail:
            old = self.text(begin, end)
            self.add(kind, begin, end + tail.end(), "nothing", f"{{ if (!caplet_fault(@)) {old}; }}")

    def turned(self, kind, cursor):
        begin, end = self.span(cursor)
        old = self.text(begin, end)
        self.add(kind, begin, end, f"!({old})", f"(static_cast<bool>({old}) != caplet_fault(@))")

    def visit(self, cursor, parent):
        kind, (begin, end) = cursor.kind.name, self.span(cursor)
        children = list(cursor.get_children())
        if kind in ("STATIC_ASSERT", "CXX_THROW_EXPR", "ENUM_DECL"):
            return
        if kind in ("VAR_DECL", "FUNCTION_DECL", "CXX_METHOD", "CONSTRUCTOR", "FUNCTION_TEMPLATE", "FIELD_DECL") and re.search(
                r"\bconste?(xpr|val)\b", self.text(begin, cursor.location.offset)):
            return
        name = self.text(begin, end).split("(", 1)[0].strip()
        if parent in ("COMPOUND_STMT", "IF_STMT", "FOR_STMT", "CXX_FOR_RANGE_STMT", "WHILE_STMT"):
            self.statement(cursor, children, name, begin, end)
        if kind == "CALL_EXPR" and MESSAGE.search(name):
            return
        self.expression(cursor, kind, children, parent, begin, end)
        for child in children[1:] if kind == "CASE_STMT" else children:
            self.visit(child, kind)

    def statement(self, cursor, children, name, begin, end):
        inner, below = cursor, children
        while inner.kind.name == "UNEXPOSED_EXPR" and len(below) == 1:  # the end of temporaries
            inner = below[0]
            below = list(inner.get_children())
        kind = inner.kind.name
        if kind in ("BREAK_STMT", "CONTINUE_STMT"):
            self.left_out("jump", begin, end)
        elif kind == "CALL_EXPR" and inner.spelling.startswith("operator") or kind == "COMPOUND_ASSIGNMENT_OPERATOR":
            self.left_out("statement", begin, end)
        elif kind == "BINARY_OPERATOR" and len(below) == 2 and self.between(below) == "=":
            self.left_out("statement", begin, end)
        elif kind == "CALL_EXPR" and not SILENT.search(name):
            self.left_out("statement", begin, end)

    def between(self, children):
        return self.text(children[0].extent.end.offset, children[-1].extent.start.offset).strip()

    def expression(self, cursor, kind, children, parent, begin, end):
        is_overloaded = kind == "CALL_EXPR" and len(children) == 3 and cursor.spelling.startswith("operator")
        if kind == "BINARY_OPERATOR" and len(children) == 2 or is_overloaded:
            was = self.between(children)
            if was in REPLACED and children[0].extent.start.offset == begin and not re.search("string|path|iterator", cursor.type.get_canonical().spelling):
                middle, right = children[0].extent.end.offset, children[-1].extent.start.offset
                new = self.text(begin, middle) + self.text(middle, right).replace(was, REPLACED[was]) + self.text(right, end)
                kinds = {"+": "sum", "-": "sum", "*": "product", "/": "product", "&&": "logic", "||": "logic"}
                self.add(kinds.get(was, "comparison"), begin, end, new)
        elif kind in ("IF_STMT", "CONDITIONAL_OPERATOR") and children and children[0].kind.is_expression():
            self.turned("condition", children[0])
        elif kind == "RETURN_STMT" and children and children[0].type.get_canonical().spelling == "bool":
            self.turned("return", children[0])
        elif kind == "INTEGER_LITERAL":
            before, after = self.source[:begin].rstrip()[-1:], self.source[end:].lstrip()[:1]
            is_size = after == b">" or before == b"[" and parent in ("VAR_DECL", "FIELD_DECL")
            if not is_size and re.fullmatch(r"(0x)?[0-9a-fA-F']+[uUlL]*", self.text(begin, end)):
                self.add("integer", begin, end, self.text(begin, end) + " + 1")
        elif kind == "FLOATING_LITERAL":
            old = self.text(begin, end)
            if re.search(r"[1-9]", re.split("[eE]", old)[0]):
                self.add("number", begin, end, old + " * 2")
        elif kind == "MEMBER_REF_EXPR" and cursor.spelling in MEMBERS and re.search(r"[^.>](\.|->)[xyz]$", self.text(begin, end)):
            self.add("member", begin, end, self.text(begin, end)[:-1] + MEMBERS[cursor.spelling])


def kept(work):
    """The places of a file; kept in a folder, for reading a file takes seconds."""
    file, path, arguments, folder = work
    key = b"\0".join([path.read_bytes(), pathlib.Path(__file__).read_bytes(), file.encode(), *map(str.encode, arguments)])
    to = folder / hashlib.sha256(key).hexdigest()
    if not to.exists():
        folder.mkdir(parents=True, exist_ok=True)
        to.write_bytes(pickle.dumps(sorted(Reader(file, path, arguments).places.values(), key=lambda p: (p.begin, p.end, p.new))))
    return pickle.loads(to.read_bytes())


def switched(source, faults, header):
    """The source with the faults as switches. The include stands in the file itself: all others are compiled as they were, and caches know them."""
    for number, place in sorted(faults.items(), key=lambda f: -f[1].begin):
        source = source[:place.begin] + place.switched.replace("@", str(number)).encode() + source[place.end:]
    # The first line is a comment.
    return source.replace(b"\n", f'\n#include "{header}"\n#line 2\n'.encode(), 1)


# --- Its own test ---

TEXT = """// What faults are drawn from: one of each kind, and what is none.
#include <cstdio>
#include <string>
struct P { int x, y, z; };
static_assert(sizeof(P) > 3 * sizeof(char));
constexpr int four = 2 + 2;
std::string format(int n) { return std::to_string(n); }
bool is_more(int a, int b) { return a > b; }
int main() {
  P p{1, 2, 3};
  int sum = 0, list[3] = {};
  for (int k = 0; k < 3; ++k) {
    if (k == 1 && sum > 5) continue;
    sum += k * p.y;
    if (sum > 100) break;
  }
  double half = 0.5;
  const auto twice = [&](int n) { half = half * n; };
  twice(2);
  std::string message = format(sum - 1);
  std::printf("%d %d %g %d %s %d", sum, is_more(sum, 2), half, list[0] + four, message.c_str(), p.x ? 1 : 2);
}
"""
WANTED = [("comparison", "k < 3", "k <= 3"), ("comparison", "k == 1", "k != 1"), ("logic", "k == 1 && sum > 5", "k == 1 || sum > 5"),
          ("condition", "k == 1 && sum > 5", "!(k == 1 && sum > 5)"), ("jump", "continue;", "nothing"), ("jump", "break;", "nothing"),
          ("statement", "sum += k * p.y;", "nothing"), ("product", "k * p.y", "k / p.y"), ("member", "p.y", "p.z"), ("number", "0.5", "0.5 * 2"),
          ("statement", "half = half * n;", "nothing"), ("statement", "twice(2);", "nothing"), ("return", "a > b", "!(a > b)"),
          ("integer", "2", "2 + 1"), ("condition", "sum > 100", "!(sum > 100)"), ("comparison", "a > b", "a >= b")]
UNWANTED = ["sizeof", "2 + 2", "sum - 1", "[3]", "printf"]


def self_test():
    wrong = []
    with tempfile.TemporaryDirectory(prefix="caplet-faults-") as temporary:
        folder = pathlib.Path(temporary)
        path, header, program = folder / "text.cpp", folder / "switch.h", folder / "program"
        path.write_text(TEXT)
        header.write_text(SWITCH)
        found = Reader("text.cpp", path, ["-std=c++20"]).places.values()
        wrong += [f"not drawn: {w}" for w in WANTED if w not in [(p.kind, p.old, p.new) for p in found]]
        wrong += [f"drawn: {p}" for p in found if any(u in p.old for u in UNWANTED)]
        # One after the other, for some overlap; the last is no fault.
        chosen = []
        for place in sorted(found, key=lambda p: (p.end - p.begin, p.begin)):
            if all(place.end <= c.begin or c.end <= place.begin for c in chosen):
                chosen.append(place)
        path.write_bytes(switched(TEXT.encode(), dict(enumerate(chosen)), header))
        subprocess.run(["c++", "-std=c++20", "-w", "-o", program, path], check=True)
        said = [subprocess.run([program], env={"CAPLET_FAULT": str(n)}, stdout=subprocess.PIPE).stdout for n in range(len(chosen) + 1)]
        if said[-1] != b"6 1 1 4 5 1":
            wrong.append(f"without a fault the program says {said[-1]}")
        subprocess.run([program], env={"CAPLET_REACHED": str(header.with_name("reached"))}, stdout=subprocess.PIPE, check=True)
        reached = sorted(map(int, header.with_name("reached").read_text().split()))
        if len(set(reached)) != len(reached) or not set(reached) <= set(range(len(chosen))) or len(reached) < len(chosen) // 2:
            wrong.append(f"reached: {reached}")
        if sum(s != said[-1] for s in said) < len(chosen) // 2:
            wrong.append("most faults change nothing")
    print("\n".join(wrong) or f"{len(found)} places")
    return 1 if wrong else 0
