#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Writes the spectral tables compiled into Caplet: host/lower/spectrum_observer.cpp and host/scene/spectrum_tables.cpp.

Usage: spectral_tables.py IOR_FOLDER
IOR_FOLDER holds METAL/TABLE.yml files of the refractiveindex.info database (CC0). Needs the Python package colour-science, whose
copies of the CIE tables are used: the 1931 2 degree observer at 1 nm (CIE 15:2018, table T.4 at full resolution, 360 to 830 nm), and
the illuminants D50, D65 and F1 to F12 at 5 nm (CIE 15:2018). D50 and D65 are continued from 780 to 830 nm by CIE's daylight components,
A is CIE's formula, D60 is the daylight of the ACES white. Metals are the rows of the files between 250 and 1000 nm, unchanged.
"""
import pathlib
import sys
import textwrap

import numpy
import yaml

import colour

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEAD = "// SPDX-License-Identifier: Apache-2.0\n// Copyright Caplet authors\n//\n"
METALS = [("Ag", "Johnson"), ("Al", "Rakic"), ("Au", "Johnson"), ("Cr", "Johnson"), ("Cu", "Johnson"), ("CuZn", "Querry-Cu70Zn30"),
          ("Fe", "Johnson"), ("Ni", "Johnson"), ("Pt", "Werner"), ("Ti", "Johnson"), ("W", "Werner")]


def number(value):
    return f"{value:.10g}"


def array(declaration, values):
    """A C++ array in lines of at most 126 columns."""
    body = textwrap.fill(", ".join(number(v) for v in values), width=126, initial_indent="    ", subsequent_indent="    ")
    return declaration + " = {\n" + body + "};\n"


def write(path, text):
    path.write_text(text)


def observer():
    table = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    assert list(table.wavelengths) == list(range(360, 831))
    text = HEAD + ("// Made by tools/spectral_tables.py: the CIE 1931 2 degree standard observer at 1 nm, 360 to 830 nm: x y z.\n"
                   '#include "lower/detail/spectrum_observer.h"\n\nnamespace caplet {\n\n// clang-format off\n')
    text += array("const double cie_1931_observer[471 * 3]", table.values.ravel())
    write(ROOT / "host/lower/spectrum_observer.cpp", text + "// clang-format on\n\n}  // namespace caplet\n")


def illuminants():
    wavelengths = numpy.arange(360, 831, 5)
    tables = {}
    scaled = numpy.exp(1.435e7 / (2848 * 560)) - 1
    tables["stdillum-A"] = 100 * (560 / wavelengths) ** 5 * scaled / (numpy.exp(1.435e7 / (2848 * wavelengths)) - 1)
    for name, key in [("stdillum-D50", "D50"), ("stdillum-D65", "D65")]:
        published = colour.SDS_ILLUMINANTS[key]
        xy = colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"][key]
        daylight = colour.sd_CIE_illuminant_D_series(xy)
        tables[name] = numpy.array([published[w] if w <= 780 else round(float(daylight[w]), 4) for w in wavelengths])
    tables["illum-acesD60"] = numpy.array([round(float(colour.SDS_ILLUMINANTS["D60"][w]), 6) for w in wavelengths])
    return wavelengths, tables


def scene_tables():
    text = HEAD + ("// Made by tools/spectral_tables.py: CIE standard illuminants (CIE 15:2018) at 5 nm, and optical constants of metals\n"
                   "// (refractiveindex.info database, CC0), wavelength in nm, n, k.\n"
                   '#include "scene/detail/spectrum_tables.h"\n\nnamespace caplet {\n\nnamespace {\n\n// clang-format off\n')
    rows = []
    wavelengths, tables = illuminants()
    for name, values in tables.items():
        identifier = name.replace("-", "_").lower()
        text += array(f"constexpr double {identifier}[]", values)
        rows.append(f'{{"{name}", 360, {identifier}}}')
    for index in range(1, 13):
        table = colour.SDS_ILLUMINANTS[f"FL{index}"]
        assert table.wavelengths[0] == 380 and table.wavelengths[-1] == 780 and table.shape.interval == 5
        text += array(f"constexpr double stdillum_f{index}[]", table.values)
        rows.append(f'{{"stdillum-F{index}", 380, stdillum_f{index}}}')
    metals = []
    for metal, table in METALS:
        data = yaml.safe_load((pathlib.Path(sys.argv[1]) / metal / (table + ".yml")).read_text())
        nk = next(part for part in data["DATA"] if part["type"] == "tabulated nk")
        values = [tuple(float(v) for v in line.split()) for line in nk["data"].splitlines() if line.strip()]
        kept = [(1000 * w, n, k) for w, n, k in values if 0.25 <= w <= 1.0]
        assert kept[0][0] <= 360 and kept[-1][0] >= 830 and all(a[0] < b[0] for a, b in zip(kept, kept[1:]))
        text += f"// {metal}/{table}\n" + array(f"constexpr double metal_{metal.lower()}[]", [v for row in kept for v in row])
        metals.append(f'{{"{metal}", metal_{metal.lower()}}}')
    text += "// clang-format on\n\n}  // namespace\n\nconst std::vector<IlluminantTable>& illuminant_tables() {\n  static const std::vector<IlluminantTable> all = {\n      "
    text += ",\n      ".join(rows) + "};\n  return all;\n}\n\nconst std::vector<MetalTable>& metal_tables() {\n  static const std::vector<MetalTable> all = {\n      "
    write(ROOT / "host/scene/spectrum_tables.cpp", text + ",\n      ".join(metals) + "};\n  return all;\n}\n\n}  // namespace caplet\n")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    observer()
    scene_tables()
