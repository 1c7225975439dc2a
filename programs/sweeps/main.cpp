// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Runs all sweeps at full size and writes a page of their results, with what gnuplot needs to draw
// its plots. caplet_sweeps RAYS OUT.md PLOT_FOLDER: fails when a cell is beyond the stated bound or
// differs from the reference.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>

#include "anchors.h"
#include "support/test_device.h"
#include "sweep.h"

namespace {

using namespace caplet;
using namespace caplet::test;

struct Row {
  ShapeKind kind;
  std::vector<Cell> cells;  // empty: no such measure
};

std::string name_of(const ShapeKind& kind) {
  std::string out = kind.name;
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

std::string table(const Axis& axis, const std::vector<Row>& rows,
                  const std::function<std::string(const Cell&)>& text) {
  std::string out = fmt::format("| {} |", axis.title), line = "|---|";
  for (const double value : axis.values) {
    out += fmt::format(" {:g} |", value);
    line += "---:|";
  }
  out += "\n" + line + "\n";
  for (const Row& row : rows) {
    if (row.cells.empty()) continue;
    out += fmt::format("| {} |", name_of(row.kind));
    for (const Cell& cell : row.cells) out += " " + text(cell) + " |";
    out += "\n";
  }
  return out + "\n";
}

// Columns: the value of the axis (0 beside the least other one), then worst distance over the bound
// and over the radius of each kind.
void write_plot(const std::filesystem::path& folder, const Axis& axis,
                const std::vector<Row>& rows) {
  const std::string base = (folder / axis.file).string();
  std::ofstream data(base + ".dat");
  double least = HUGE_VAL;
  for (const double value : axis.values)
    if (value > 0) least = std::min(least, value);
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    data << (axis.values[i] > 0 ? axis.values[i] : 0.1 * least);
    for (const Row& row : rows)
      if (!row.cells.empty())
        data << " " << std::max(row.cells[i].radius_worst, 1e-10) << " "
             << row.cells[i].bound_worst;
    data << "\n";
  }
  std::ofstream script(base + ".gp");
  script << "set terminal pngcairo size 1100,480 noenhanced font 'sans,10'\nset output '"
         << axis.file
         << ".png'\nset multiplot layout 1,2\nset logscale x\nset format x '%g'\nset xlabel \""
         << axis.title
         << "\"\nset grid\nset key outside below maxrows 4 font ',9'\nset logscale y\nset format y "
            "'%.0e'\n"
            "set title 'worst distance from the surface, over the radius'\nplot";
  const auto curves = [&](int offset) {
    int column = 2;
    for (const Row& row : rows) {
      if (row.cells.empty()) continue;
      script << (column == 2 ? " " : ", ") << "'" << axis.file
             << ".dat' using 1:" << column + offset << " with linespoints pointsize 0.4 title '"
             << name_of(row.kind) << "'";
      column += 2;
    }
  };
  curves(0);
  script << "\nunset logscale y\nset format y '%g'\nset yrange [0:1]\nset title 'worst distance "
            "over the stated bound'\nplot";
  curves(1);
  script << "\nunset multiplot\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return std::cerr << "usage: caplet_sweeps RAYS OUT.md PLOT_FOLDER\n", 2;
  const int rays = std::atoi(argv[1]);
  if (rays < 100) return std::cerr << "caplet_sweeps: RAYS must be 100 or more\n", 2;
  const std::filesystem::path document = argv[2], plots = argv[3];
  std::filesystem::create_directories(plots);
  const Device& device = test_device();
  std::string text = fmt::format(
      "# Precision sweeps\n\nBy `./run sweeps`, with {} rays a cell on {} ({}). The formulas and "
      "their "
      "bounds: "
      "docs/numerics.md. The command fails when a hit is beyond its bound, or a hit or miss "
      "differs from the reference "
      "where the "
      "referee does not say that the ray touches. The default tests do the same with fewer "
      "rays.\n\n"
      "Where nothing else is said the radius is 1, the length 10 radii and the shape about the "
      "origin of coordinates, and rays "
      "begin "
      "between one radius and four times the size away; half are aimed at the surface, often at "
      "rims, edges and ends, half "
      "within 0.3 "
      "radii of it. Distances are those of the computed o + t d from the exact surface. `instance` "
      "is an ellipsoid: a unit "
      "sphere "
      "stretched, turned and moved by an instance's map, measured in the sphere's space. Partial "
      "shapes are placed by turning "
      "and moving "
      "instances. `csg` is a long solid with a ball or cylinder added, taken away, or in common. "
      "Boxes, polyhedra, triangles and "
      "patches "
      "are two radii wide.\n\n",
      rays, device.info().name, device.info().driver);
  bool held = true;
  std::uint64_t total = 0, excused = 0, edge_on = 0, wrong = 0;
  for (const Axis& axis : axes()) {
    std::vector<Row> rows;
    for (const ShapeKind& kind : sweep_kinds()) {
      rows.push_back({kind, {}});
      if (has_axis(kind.shape, axis.name))
        rows.back().cells = sweep(device, kind.shape, axis.name, axis.values, rays, 7);
      for (std::size_t i = 0; i < rows.back().cells.size(); ++i) {
        const Cell& cell = rows.back().cells[i];
        total += cell.rays;
        excused += cell.excused;
        edge_on += cell.edge_on;
        wrong += cell.wrong;
        if (cell.wrong == 0 && cell.bound_worst <= 1) continue;
        held = false;
        std::cerr << kind.name << " at " << axis.title << " " << axis.values[i] << ": "
                  << cell.wrong << " wrong, worst " << cell.bound_worst << " of the bound\n";
        for (const std::string& example : cell.examples) std::cerr << example << "\n";
      }
      std::cerr << axis.file << " " << kind.name << "\n";
    }
    std::string title = axis.title;
    title[0] = static_cast<char>(std::toupper(title[0]));
    text += fmt::format(
        "## {}\n\n![{}]({}.png)\n\nDistance from the surface over the stated bound, worst (99 "
        "%):\n\n",
        title, title, axis.file);
    text += table(axis, rows, [](const Cell& c) {
      return fmt::format("{:.2f} ({:.2f})", c.bound_worst, c.bound_p99);
    });
    text += "Distance from the surface over the radius, worst (99 %):\n\n";
    text += table(axis, rows, [](const Cell& c) {
      return fmt::format("{:.1e} ({:.1e})", c.radius_worst, c.radius_p99);
    });
    text += "Error of t in units in its last place, median (99 %):\n\n";
    text += table(axis, rows, [](const Cell& c) {
      return fmt::format("{:.2g} ({:.2g})", c.ulps_p50, c.ulps_p99);
    });
    text +=
        "Differences from the reference: not excused / where the referee says that the ray "
        "touches:\n\n";
    text +=
        table(axis, rows, [](const Cell& c) { return fmt::format("{} / {}", c.wrong, c.excused); });
    if (axis.name == AxisName::graze) {
      text +=
          "Rays that pass the silhouette or an edge by so many radii, on either side (half of the "
          "above): in how many of 10,000 "
          "device and "
          "reference differ on whether there is a hit, and by how many radii such a ray missed "
          "touching at most. The stated bound "
          "is 2e-6 to "
          "2e-5 radii here:\n\n";
      text += table(axis, rows, [](const Cell& c) {
        const double part = 1e4 * static_cast<double>(c.differ) /
                            static_cast<double>(std::max<std::uint64_t>(c.passing, 1));
        return c.differ_radii == 0 ? fmt::format("{:.2g}", part)
                                   : fmt::format("{:.2g} ({:.1e})", part, c.differ_radii);
      });
    }
    write_plot(plots, axis, rows);
  }
  text += fmt::format(
      "## Sum\n\n{} rays: {} hits out of bound or differences not excused, {} differences that the "
      "referee excuses, {} hits of "
      "triangles "
      "and patches seen edge-on, beside them (docs/numerics.md).\n\n# Beside what is published\n\n",
      total, wrong, excused, edge_on);
  const Anchors beside = anchors(device, rays);
  text += beside.text;
  if (!beside.held) std::cerr << "an anchor is not held\n";
  std::ofstream out(document);
  out << text;
  if (!out) return std::cerr << "caplet_sweeps: " << document.string() << " cannot be written\n", 1;
  return held && beside.held ? 0 : 1;
}
