# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The results of ./run gpu as a page of tables."""
import json


def short(value):
    if isinstance(value, float):
        return f"{value:.3g}"
    if isinstance(value, dict):
        return ", ".join(f"{key} {short(each)}" for key, each in value.items())
    if isinstance(value, list):
        return "; ".join(map(short, value))
    return str(value)


def of(facts):
    """All steps, one table each."""
    lines = [f"# Caplet on a GPU", "", f"{facts.get('seconds', 0):.0f} s in all."]
    for step, parts in facts["steps"].items():
        lines += ["", f"## {step}", "", "| what | found |", "|---|---|"]
        lines += [f"| {name} | {short(found).replace('|', '/')} |" for name, found in parts.items()]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    import sys
    print(of(json.load(open(sys.argv[1]))), end="")
