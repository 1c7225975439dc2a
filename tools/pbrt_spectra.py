#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Writes host/scene/spectrum_tables_pbrt.cpp, the metals and glasses behind pbrt-v4's names.

Usage: pbrt_spectra.py FOLDER
FOLDER holds NAME.csv for each name: a heading, then wavelength in nm and value, as in pbrt-v4's src/pbrt/util/spectrum.cpp
(commit 5f7a606, Apache-2.0; after SOPRA, Palik and glass makers). Digits are kept as they are.
"""
import pathlib
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent

if len(sys.argv) != 2:
    sys.exit(__doc__)
tables = {}
for path in sorted(pathlib.Path(sys.argv[1]).glob("*.csv")):
    lines = path.read_text().split()
    assert lines[0] == "nm,value", path
    tables[path.stem] = ", ".join(cell for line in lines[1:] for cell in line.split(","))
text = """// SPDX-License-Identifier: Apache-2.0
// Copyright pbrt authors
//
// Made by tools/pbrt_spectra.py: the metals and glasses behind pbrt-v4's names, from its src/pbrt/util/spectrum.cpp (5f7a606);
// wavelength in nm, value.
#include "scene/detail/spectrum_tables.h"

namespace caplet {

namespace {

// clang-format off
"""
for name, values in tables.items():
    text += f"constexpr double {name.replace('-', '_').lower()}[] = {{\n"
    text += textwrap.fill(values, width=126, initial_indent="    ", subsequent_indent="    ") + "};\n"
text += "// clang-format on\n\n}  // namespace\n\nconst std::vector<NamedTable>& pbrt_tables() {\n  static const std::vector<NamedTable> all = {\n      "
text += ",\n      ".join(f'{{"{name}", {name.replace("-", "_").lower()}}}' for name in tables)
text += "};\n  return all;\n}\n\n}  // namespace caplet\n"
(ROOT / "host/scene/spectrum_tables_pbrt.cpp").write_text(text)
