// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The text is cut at line ends into chunks that are parsed in parallel; the results are joined in
// the order of the file.
#include "import/detail/capsules.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/error.h"
#include "base/quotes.h"
#include "import/detail/importers.h"
#include "import/detail/text_file.h"
#include "present/present.h"

namespace caplet {

namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
constexpr std::size_t kMostErrors = 20;  // as in Diagnostics

struct Place {
  int line = 0, column = 0;  // the line counts from the start of the chunk
};

struct Name {
  std::string text;
  Place first_use;
};

struct Chunk {
  CapsulesShape capsules;  // radius1 complete (not emptied); materials are indices into `names`
  std::vector<Name> names;
  std::unordered_map<std::string, std::uint32_t> name_index;
  std::vector<std::pair<Place, std::string>> errors;
  std::size_t more_errors = 0;  // errors beyond those in `errors`
  int lines = 0;
  bool tapered = false;
};

/// Takes one line apart. Columns count bytes from 1.
class LineReader {
 public:
  LineReader(std::string_view line, Chunk& chunk) : line_(line), chunk_(chunk) {}

  bool at_end() {
    skip_blanks();
    return position_ >= line_.size() || line_[position_] == '#';
  }

  bool read_point(glm::vec3& point, const char* what) {
    if (!expect('<', what)) return false;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0 && !expect(',', what)) return false;
      if (!read_number(point[axis])) return false;
    }
    return expect('>', what);
  }

  bool read_number(float& value) {
    skip_blanks();
    const std::size_t begin = position_;
    const std::string_view token = take_token(",<>");
    const NumberError error = parse_float(token, value);
    if (error == NumberError::none) return true;
    if (token.empty() && at_end()) return fail(begin, "a number is missing");
    return fail(begin, describe(error, token.empty() ? line_.substr(begin, 1) : token));
  }

  bool read_radius(float& value) {
    skip_blanks();
    const std::size_t begin = position_;
    if (!read_number(value)) return false;
    return value > 0 || fail(begin, fmt::format("the radius must be positive, not {}", value));
  }

  bool at_number() {
    skip_blanks();
    if (position_ >= line_.size()) return false;
    const char c = line_[position_];
    return (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.' || spells_non_finite();
  }

  bool read_name(std::string& name, Place& place) {
    skip_blanks();
    place = {chunk_.lines, static_cast<int>(position_) + 1};
    if (at_number())
      return fail(position_, fmt::format("{}: material names do not start as numbers do",
                                         quoted(line_.substr(position_))));
    if (line_[position_] != '"') {
      const std::size_t begin = position_;
      name = std::string(take_token("<>,\""));
      return !name.empty() || fail(begin, fmt::format("{} is neither a radius nor a material name",
                                                      quoted(line_.substr(begin))));
    }
    const std::size_t close = line_.find('"', position_ + 1);
    if (close == std::string_view::npos)
      return fail(position_, "the quoted material name does not end");
    name = std::string(line_.substr(position_ + 1, close - position_ - 1));
    if (name.empty()) return fail(position_, "the material name is empty");
    position_ = close + 1;
    return true;
  }

  bool expect_end() {
    return at_end() || fail(position_, fmt::format("{} follows a complete capsule",
                                                   quoted(line_.substr(position_))));
  }

  bool fail(std::size_t position, std::string message) {
    if (chunk_.errors.size() < kMostErrors)
      chunk_.errors.emplace_back(Place{chunk_.lines, static_cast<int>(position) + 1},
                                 std::move(message));
    else
      ++chunk_.more_errors;
    return false;
  }

 private:
  void skip_blanks() {
    while (position_ < line_.size() && is_blank(line_[position_])) ++position_;
  }

  /// Takes text up to a blank, a comment, a zero byte or one of `stops`.
  std::string_view take_token(std::string_view stops) {
    const std::size_t begin = position_;
    for (; position_ < line_.size(); ++position_) {
      const char c = line_[position_];
      // Most characters are of numbers; std::strchr for each of them took a third of the time that
      // reading a file does.
      if ((c >= '0' && c <= '9') || c == '.' || c == '-') continue;
      if (is_blank(c) || c == '#' || c == '\0' || stops.find(c) != std::string_view::npos) break;
    }
    return line_.substr(begin, position_ - begin);
  }

  bool spells_non_finite() {
    const std::size_t begin = position_;
    const std::string_view token = take_token("<>,\"");
    position_ = begin;
    float ignored = 0;
    return parse_float(token, ignored) == NumberError::not_finite;
  }

  bool expect(char wanted, const char* what) {
    skip_blanks();
    if (position_ < line_.size() && line_[position_] == wanted) {
      ++position_;
      return true;
    }
    if (at_end()) return fail(position_, fmt::format("'{}' of {} is missing", wanted, what));
    return fail(position_, fmt::format("expected '{}' of {}, not {}", wanted, what,
                                       quoted(line_.substr(position_))));
  }

  std::string_view line_;
  Chunk& chunk_;
  std::size_t position_ = 0;
};

std::uint32_t index_of_name(Chunk& chunk, const std::string& name, const Place& place) {
  const auto [entry, fresh] =
      chunk.name_index.try_emplace(name, static_cast<std::uint32_t>(chunk.names.size()));
  if (fresh) chunk.names.push_back({name, place});
  return entry->second;
}

/// Returns whether the line contains a capsule.
bool parse_line(std::string_view text, Chunk& chunk) {
  LineReader line(text, chunk);
  if (line.at_end()) return false;
  glm::vec3 p0, p1;
  float radius0 = 0, radius1 = 0;
  if (!line.read_point(p0, "the first point") || !line.read_point(p1, "the second point") ||
      !line.read_radius(radius0))
    return false;
  radius1 = radius0;
  if (!line.at_end() && line.at_number() && !line.read_radius(radius1)) return false;
  std::string name;
  Place place{chunk.lines, 1};
  if (!line.at_end() && !line.read_name(name, place)) return false;
  if (!line.expect_end()) return false;
  CapsulesShape& out = chunk.capsules;
  out.p0.push_back(p0);
  out.p1.push_back(p1);
  out.radius0.push_back(radius0);
  out.radius1.push_back(radius1);
  out.materials.push_back(index_of_name(chunk, name, place));
  chunk.tapered |= radius0 != radius1;
  return true;
}

void parse_chunk(std::string_view text, Chunk& chunk) {
  constexpr std::size_t kUsualLine = 64;
  CapsulesShape& out = chunk.capsules;
  for (std::vector<glm::vec3>* points : {&out.p0, &out.p1})
    points->reserve(text.size() / kUsualLine);
  for (std::vector<float>* radii : {&out.radius0, &out.radius1})
    radii->reserve(text.size() / kUsualLine);
  out.materials.reserve(text.size() / kUsualLine);
  Unproven in_piece;  // one for each chunk, so that the number of threads makes no difference
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    ++chunk.lines;
    if (parse_line(line, chunk)) in_piece.prove();
  }
}

std::vector<std::string_view> cut_at_line_ends(std::string_view text) {
  std::vector<std::string_view> pieces;
  while (!text.empty()) {
    std::size_t size = std::min(kChunkBytes, text.size());
    const std::size_t end = text.find('\n', size - 1);
    size = end == std::string_view::npos ? text.size() : end + 1;
    pieces.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return pieces;
}

template <class T>
void place_at(std::vector<T>& to, std::size_t begin, const std::vector<T>& from) {
  std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(begin));
}

}  // namespace

CapsulesShape read_capsules(const std::filesystem::path& path,
                            const MaterialIndex& material_index) {
  const TextFile file(path);
  std::string_view text = file.text();
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const std::vector<std::string_view> pieces = cut_at_line_ends(text);
  std::vector<Chunk> chunks(pieces.size());
  tbb::parallel_for(std::size_t{0}, chunks.size(),
                    [&](std::size_t i) { parse_chunk(pieces[i], chunks[i]); });

  // Errors and names are kept in the order of the file.
  Diagnostics diagnostics(kMostErrors);
  std::vector<std::size_t> begin(chunks.size() + 1, 0);
  bool tapered = false, named = false;
  int first_line = 0;
  const auto where = [&](const Place& place) {
    return SourceLocation{path.string(), first_line + place.line, place.column};
  };
  std::vector<std::pair<std::string, SourceLocation>> names;
  std::unordered_map<std::string, std::uint32_t> name_index;
  std::vector<std::vector<std::uint32_t>> file_name(chunks.size());
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    for (const auto& [place, message] : chunks[i].errors) diagnostics.error(where(place), message);
    diagnostics.add_more(chunks[i].more_errors);
    for (const Name& name : chunks[i].names) {
      const auto [entry, fresh] =
          name_index.try_emplace(name.text, static_cast<std::uint32_t>(names.size()));
      if (fresh) names.emplace_back(name.text, where(name.first_use));
      file_name[i].push_back(entry->second);
      named |= !name.text.empty();
    }
    begin[i + 1] = begin[i] + chunks[i].capsules.p0.size();
    tapered |= chunks[i].tapered;
    first_line += chunks[i].lines;
  }
  diagnostics.finish();
  const std::size_t count = begin.back();
  if (count == 0) throw InputError({path.string(), 0, 0}, "holds no capsules");

  std::vector<std::uint32_t> material(names.size(), 0);
  if (named)
    for (std::size_t i = 0; i < names.size(); ++i)
      material[i] = material_index(names[i].first, names[i].second);

  CapsulesShape all;
  all.p0.resize(count);
  all.p1.resize(count);
  all.radius0.resize(count);
  if (tapered) all.radius1.resize(count);
  if (named) all.materials.resize(count);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
    const CapsulesShape part = std::move(chunks[i].capsules);
    place_at(all.p0, begin[i], part.p0);
    place_at(all.p1, begin[i], part.p1);
    place_at(all.radius0, begin[i], part.radius0);
    if (tapered) place_at(all.radius1, begin[i], part.radius1);
    if (named)
      for (std::size_t k = 0; k < part.materials.size(); ++k)
        all.materials[begin[i] + k] = material[file_name[i][part.materials[k]]];
  });
  return all;
}

Scene import_capsules_file(const std::filesystem::path& path, const ImageReader&,
                           const ImportOptions&) {
  Scene scene;
  scene.source = path.string();
  const auto add_material = [&scene](const std::string& name, const SourceLocation& where) {
    const std::size_t index = scene.materials.size();
    scene.materials.push_back({DiffuseMaterial{RgbSpectrum{palette_color(index)}},
                               name.empty() ? "default" : name, where});
    return narrow<std::uint32_t>(index);
  };
  Shape shape;
  shape.where = {path.string(), 1, 0};
  shape.name = path.stem().string();
  shape.geometry = read_capsules(path, add_material);
  if (scene.materials.empty()) add_material("", shape.where);
  scene.shapes.push_back(std::move(shape));
  return scene;
}

}  // namespace caplet
