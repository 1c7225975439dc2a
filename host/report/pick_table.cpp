// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/pick_table.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "lower/identity.h"
#include "table/npy.h"

namespace caplet::report {

namespace {

namespace fs = std::filesystem;

/// Makes rows of text in parallel and keeps their order.
template <class MakeRow>
std::vector<std::string> made_in_slices(std::span<const PickRow> rows, const MakeRow& make_row) {
  constexpr std::size_t slice = 4096;
  std::vector<std::string> out((rows.size() + slice - 1) / slice);
  tbb::parallel_for(std::size_t{0}, out.size(), [&](std::size_t i) {
    for (const PickRow& row : rows.subspan(i * slice, std::min(slice, rows.size() - i * slice)))
      make_row(row, out[i]);
  });
  return out;
}

/// RFC 4180 requires quotes around text that contains commas, quotes or line breaks.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

class CsvTable : public PickTable {
 public:
  CsvTable(const fs::path& path, const Scene& scene, const fs::path& name)
      : path_(name), scene_(scene), file_(path, std::ios::binary) {
    file_ << "ray,t,object,primitive,surface,material,entering,x,y,z,nx,ny,nz,u,v\n";
    check();
  }

  void append(std::span<const PickRow> rows) override {
    for (const std::string& text :
         made_in_slices(rows, [&](const PickRow&row, std::string&out) { add(row, out); }))
      file_ << text;
    check();
  }

  void finish() override {
    file_.close();
    check();
  }

 private:
  void add(const PickRow& row, std::string& out) const {
    const PickRecord& p = row.pick;
    // {} is the shortest text that reads back as the same float.
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                   row.ray, p.t, csv_text(object_label(scene_, identity_of(scene_, p))),
                   p.primitive, p.surface, csv_text(material_label(scene_, p.material)),
                   p.leaving ? 0 : 1, p.point[0], p.point[1], p.point[2], p.normal[0], p.normal[1],
                   p.normal[2], p.u, p.v);
  }
  void check() const {
    if (!file_) throw RunError(fmt::format("{}: cannot be written", path_.string()));
  }

  fs::path path_;
  const Scene& scene_;
  std::ofstream file_;
};

/// Returns the length of the longest label in a table of this scene.
std::size_t longest_object_label(const Scene& scene) {
  std::size_t out = std::to_string(scene.shapes.size() + scene.instances.size()).size();
  for (const Shape& shape : scene.shapes) out = std::max(out, unicode_length(shape.name));
  for (const Object& object : scene.objects)
    for (const Shape& shape : object.shapes) out = std::max(out, unicode_length(shape.name));
  return out;
}

std::size_t longest_material_label(const Scene& scene) {
  std::size_t out = std::to_string(scene.materials.size()).size();
  for (const Material& material : scene.materials)
    out = std::max(out, unicode_length(material.name));
  return out;
}

class NpyTable : public PickTable {
 public:
  NpyTable(const fs::path& path, const Scene& scene, const fs::path& name)
      : scene_(scene),
        object_length_(longest_object_label(scene)),
        material_length_(longest_material_label(scene)),
        writer_(path,
                {{"ray", "<i8"},
                 {"t", "<f4"},
                 {"object", fmt::format("<U{}", object_length_)},
                 {"primitive", "<i4"},
                 {"surface", "<i4"},
                 {"material", fmt::format("<U{}", material_length_)},
                 {"entering", "|b1"},
                 {"x", "<f4"},
                 {"y", "<f4"},
                 {"z", "<f4"},
                 {"nx", "<f4"},
                 {"ny", "<f4"},
                 {"nz", "<f4"},
                 {"u", "<f4"},
                 {"v", "<f4"}},
                name) {}

  void append(std::span<const PickRow> rows) override {
    for (const std::string& bytes :
         made_in_slices(rows, [&](const PickRow&row, std::string&out) { add(row, out); }))
      writer_.append(bytes);
  }

  void finish() override { writer_.finish(); }

 private:
  void add(const PickRow& row, std::string& out) const {
    const PickRecord& p = row.pick;
    const auto put = [&](const auto& value) {
      out.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    put(static_cast<std::int64_t>(row.ray));
    put(p.t);
    append_unicode(out, object_label(scene_, identity_of(scene_, p)), object_length_);
    put(static_cast<std::int32_t>(p.primitive));
    put(static_cast<std::int32_t>(p.surface));
    append_unicode(out, material_label(scene_, p.material), material_length_);
    put(static_cast<char>(p.leaving ? 0 : 1));
    put(p.point);
    put(p.normal);
    put(p.u);
    put(p.v);
  }

  const Scene& scene_;
  std::size_t object_length_, material_length_;
  NpyWriter writer_;
};

}  // namespace

std::optional<TableFormat> table_format(const fs::path& path) {
  if (path.extension() == ".npy") return TableFormat::npy;
  return path.extension() == ".csv" || is_stream(path) ? std::optional(TableFormat::csv)
                                                       : std::nullopt;
}

void check_table_format(const fs::path& path, const std::string& flag) {
  if (!table_format(path))
    throw InputError(SourceLocation{flag},
                     fmt::format("'{}': tables are written as .csv or .npy", path.string()));
}

std::unique_ptr<PickTable> create_pick_table(const fs::path& path, TableFormat format,
                                             const Scene& scene, const fs::path& name) {
  if (format == TableFormat::npy) return std::make_unique<NpyTable>(path, scene, name);
  return std::make_unique<CsvTable>(path, scene, name);
}

}  // namespace caplet::report
