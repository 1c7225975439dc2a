# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The tables of docs/drivers.md, made of the facts of checks.py."""
import re

from driver_kit import exr

BEGIN, END = "<!-- tables of ./run drivers: begin -->", "<!-- tables of ./run drivers: end -->"
COLUMNS = ("driver", "encoding", "self-test", "wrong in `verify`", "crossings equal", "`render_tests`", "`trace_tests`", "pictures")


def count(number):
    return f"{number:,}"


def compiler(device):
    """The parts of a platform's or a device's name that tell of the compiler."""
    found = re.search(r"LLVM \d[\d.]*", f"{device['platform']} {device['name']}")
    return found[0] if found else ""


def driver_name(facts):
    device = facts.get("device", {})
    title = facts["title"]
    if device:
        package = facts.get("package")
        words = device["driver"].split()
        title = f"{title} {package or next((word for word in words if word[0].isdigit()), words[0])}"
        if more := f"driver {device['driver'].split('_')[0]}" if package else compiler(device):
            title += f" ({more})"
    else:
        title += f" ({facts['name']})"
    return f"{title}; {facts['origin']}"


def self_test_cell(facts):
    return f"fails: {facts['fails'][:60]}" if "fails" in facts else "passes"


def verify_cell(facts):
    if "fails" in facts:
        return f"fails: {facts['fails'][:60]}"
    return f"{count(facts['wrong'])} of {count(facts['rays'])}"


def hits_cell(facts):
    if bad := [each["fails"] for each in facts.values() if "fails" in each]:
        return f"fails: {bad[0][:60]}"
    rays, same, other = (sum(each[key] for each in facts.values()) for key in ("rays", "t", "other"))
    if same == rays:
        return "all"
    worst = max(each["worst"] for each in facts.values())
    parts = [f"{count(same)} of {count(rays)}", f"t by at most {worst:.0e} of it"]
    return ", ".join(parts + ([f"{other} of another primitive"] if other else []))


def tests_cell(facts):
    parts = [f"{facts['passed']} pass"]
    if facts["failed"]:
        parts.append(f"{len(facts['failed'])} fail")
    if facts["skipped"]:
        parts.append(f"{facts['skipped']} skipped")
    if "fails" in facts:
        parts.append(facts["fails"][:60])
    return ", ".join(parts)


def pictures_cell(facts):
    pictures = list(facts.values())
    if not pictures:
        return ""
    bad = [each["fails"] for each in pictures if each and "fails" in each]
    other = [each for each in pictures if each and "fails" not in each]
    parts = []
    if equal := sum(each is None for each in pictures):
        parts.append(f"{equal} equal" if equal < len(pictures) else f"all {equal} equal")
    if other:
        within = sum(exr.within_noise(each) for each in other)
        parts.append(f"{within} within noise")
        if within < len(other):
            parts.append(f"{len(other) - within} beyond it")
    if bad:
        parts.append(f"{len(bad)} fail: {bad[0][:60]}")
    return ", ".join(parts)


def cells(facts):
    encoding = facts["encoding"] + (", its own" if facts.get("device", {}).get("own") == facts["encoding"] else "")
    out = [driver_name(facts), encoding]
    if "left out" in facts:
        return [*out, f"left out: {facts['left out']}", *[""] * (len(COLUMNS) - 3)]
    tests = facts.get("tests", {})
    for make, part in ((self_test_cell, facts.get("self-test")), (verify_cell, facts.get("verify")), (hits_cell, facts.get("hits")),
                       (tests_cell, tests.get("render_tests")), (tests_cell, tests.get("trace_tests")),
                       (pictures_cell, facts.get("pictures"))):
        out.append("not tried" if part is None else make(part))
    return out


def row(facts, before=None):
    """`before`: the facts of the row above, whose driver is not named again."""
    first, *rest = cells(facts)
    if before and driver_name(before) == first:
        first = "the same"
    return "| " + " | ".join(cell.replace("|", "/").replace("\n", " ") for cell in (first, *rest)) + " |"


def is_wrong(facts):
    """Something that was tried does not do as it should."""
    tests = facts.get("tests", {}).values()
    return bool("fails" in facts.get("self-test", {}) or "fails" in facts.get("verify", {}) or facts.get("verify", {}).get("wrong") or
                any("fails" in each or each["failed"] for each in tests) or any("fails" in each for each in facts.get("hits", {}).values()) or
                any(each and ("fails" in each or not exr.within_noise(each)) for each in facts.get("pictures", {}).values()))


def of_pictures(results):
    """The pictures that differ, worst first for each driver."""
    lines = []
    for facts in results:
        other = {name: each for name, each in facts.get("pictures", {}).items() if each and "fails" not in each}
        for name, each in sorted(other.items(), key=lambda pair: -pair[1]["noise"])[:2]:
            lines.append(f"| {driver_name(facts)} | {facts['encoding']} | {name} | {each['rms']:.1e} | {each['noise']:.1e} | {each['shift']:.1e} | "
                         f"{each['pixels']} of {count(each['of'])} |")
    if not lines:
        return ""
    return "\n".join(["", "The two pictures of each that differ most:", "",
                      "| driver | encoding | picture | rms, of the mean | rms, of the noise | shift, in standard errors | pixels of other ids |",
                      "|---|---|---|---|---|---|---|", *lines])


def table(results):
    """One row a driver and encoding."""
    head = ["| " + " | ".join(COLUMNS) + " |", "|---" * len(COLUMNS) + "|"]
    return "\n".join([*head, *map(row, results, [None, *results])])


def tables(results):
    """The table, and the pictures that differ most: for the terminal."""
    return table(results) + "\n" + of_pictures(results)


def write(path, results):
    text = path.read_text()
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    path.write_text(f"{before}{BEGIN}\n{table(results)}\n{END}{after}")
