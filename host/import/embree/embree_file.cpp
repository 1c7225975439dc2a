// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lists of numbers in Embree's XML and its companion file.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "base/log.h"
#include "base/reading.h"
#include "import/detail/embree.h"
#include "import/detail/gzip_file.h"
#include "import/detail/text_file.h"

namespace caplet::embree {

namespace fs = std::filesystem;

namespace {

static_assert(std::endian::native == std::endian::little, "companions are little-endian");

bool is_binary(pugi::xml_node node) { return !node.attribute("ofs").empty(); }

/// Calls work with each word of the element.
template <class Work>
void each_word(pugi::xml_node node, const Work& work) {
  for (const pugi::xml_node piece : node.children())
    if (piece.type() == pugi::node_pcdata || piece.type() == pugi::node_cdata)
      caplet::each_word(std::string_view(piece.value()), work);
}

std::uint64_t count_of(const SceneFile& file, pugi::xml_node node, const char* name) {
  const std::string_view text = node.attribute(name).value();
  std::uint64_t value = 0;
  if (!parse_number(text, value))
    file.fail(node, fmt::format("{}=\"{}\" is no count", name, text.substr(0, 40)));
  return value;
}

}  // namespace

std::string SceneFile::text_of(pugi::xml_node node) {
  std::string out;
  for (const pugi::xml_node piece : node.children())
    if (piece.type() == pugi::node_pcdata || piece.type() == pugi::node_cdata) out += piece.value();
  return std::string(trimmed(out));
}

std::string_view SceneFile::binary(pugi::xml_node node, std::size_t row) {
  if (!companion_) {
    fs::path one = path(), other = path();
    one.replace_extension(".bin");
    other += ".bin";
    if (is_there(one, place(node)))
      companion_ = read_file(one, place(node));
    else if (is_there(other, place(node)))
      companion_ = read_file(other, place(node));
    else
      fail(node, fmt::format("its numbers are in '{}', which is not there (nor is '{}')",
                             one.string(), other.string()));
  }
  const std::uint64_t ofs = count_of(*this, node, "ofs");
  const std::uint64_t size = count_of(*this, node, node.attribute("size").empty() ? "num" : "size");
  if (ofs > companion_->size() || size > (companion_->size() - ofs) / row)
    fail(node, fmt::format("{} rows of {} bytes from byte {} on: the companion has {} bytes", size,
                           row, ofs, companion_->size()));
  return std::string_view(*companion_).substr(ofs, size * row);
}

std::vector<float> SceneFile::floats(pugi::xml_node node, std::size_t width, bool with_nan) {
  std::vector<float> out;
  const auto add = [&](float value) {
    if (!(std::abs(value) <= largest_number) && !(with_nan && std::isnan(value)))
      fail(node, fmt::format("<{}>: number {} is not finite or out of range", node.name(),
                             out.size() + 1));
    out.push_back(value);
  };
  if (is_binary(node)) {
    const std::string_view raw = binary(node, width * sizeof(float));
    for (std::size_t i = 0; i < raw.size(); i += sizeof(float)) {
      float value = 0;
      std::memcpy(&value, raw.data() + i, sizeof value);
      add(value);
    }
    return out;
  }
  each_word(node, [&](std::string_view word) {
    double value = 0;
    if (!parse_number(word, value)) {
      // A number that underflows a double is 0.
      float small = 0;
      if (parse_float(word, small) != NumberError::none)
        fail(node, fmt::format("<{}>: {} is not a number", node.name(), quoted(word)));
      value = static_cast<double>(small);
    }
    if (std::abs(value) > static_cast<double>(largest_number))
      fail(node, fmt::format("<{}>: {} is not finite or out of range", node.name(), quoted(word)));
    add(static_cast<float>(value));
  });
  if (out.size() % width != 0)
    fail(node, fmt::format("<{}>: {} numbers are no rows of {}", node.name(), out.size(), width));
  return out;
}

std::vector<std::uint32_t> SceneFile::indices(pugi::xml_node node, std::size_t width) {
  std::vector<std::uint32_t> out;
  if (is_binary(node)) {
    const std::string_view raw = binary(node, width * sizeof(std::uint32_t));
    out.resize(raw.size() / sizeof(std::uint32_t));
    if (!out.empty()) std::memcpy(out.data(), raw.data(), raw.size());
    return out;
  }
  each_word(node, [&](std::string_view word) {
    std::uint32_t value = 0;
    if (!parse_number(word, value))
      fail(node, fmt::format("<{}>: {} is no index", node.name(), quoted(word)));
    out.push_back(value);
  });
  if (out.size() % width != 0)
    fail(node, fmt::format("<{}>: {} indices are no rows of {}", node.name(), out.size(), width));
  return out;
}

std::vector<std::uint32_t> SceneFile::bytes(pugi::xml_node node) {
  if (!is_binary(node)) return indices(node, 1);
  std::vector<std::uint32_t> out;
  for (const char c : binary(node, 1)) out.push_back(static_cast<unsigned char>(c));
  return out;
}

void Notes::add(const std::string& what, const SourceLocation& where) {
  Note& note = notes_[what];
  if (note.count++ == 0) note.where = where;
}

void Notes::tell() const {
  for (const auto& [what, note] : notes_)
    Diagnostics().warning(note.where,
                          note.count == 1 ? what : fmt::format("{} ({} times)", what, note.count));
}

}  // namespace caplet::embree
