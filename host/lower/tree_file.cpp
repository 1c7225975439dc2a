// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The file is a header, the notes, and the arrays, each from a page on.
#include "lower/tree_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/content_hash.h"
#include "base/error.h"
#include "base/mapped_file.h"
#include "lower/contract_key.h"
#include "lower/fingerprint.h"
#include "shared/kinds.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view tree_magic = "caplet tree file";
constexpr std::uint32_t native_order = 0x01020304;
// Changes when a FlatScene says something else by the same contract.
constexpr std::string_view tree_format = "1 ";
// Drivers use memory where it lies if it begins at a page.
constexpr std::uint64_t section_alignment = 4096;
constexpr std::size_t written_bytes = std::size_t{8} << 20;  // at a time

struct Section {
  std::uint64_t offset = 0, bytes = 0;
};

#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)

/// Everything of a tree file but its notes and arrays.
struct Header {
  char magic[16];
  std::uint32_t order;
  std::uint32_t header_bytes;
  char key[32];  // of the contract
  char
      checksum[32];  // of what stands behind it in the header, of notes and of arrays that are read
  char fingerprint[32];
  std::uint64_t file_bytes;
  std::uint64_t shapes, primitive_count, bvh_nodes;
  double bvh_sah, build_seconds;
  std::int32_t leaf_kind_bits, bvh_depth;
  std::uint32_t sky_is_unseen, has_moving_operands, has_chains, reserved;
  Section notes[std::tuple_size_v<TreeNotes>];
#define BUFFER(name, type, access) Section name;
  struct Arrays {
    SCENE_GROUPS
  } arrays;
#undef BUFFER
};
static_assert(std::is_trivially_copyable_v<Header>);
static_assert(offsetof(Header, notes) == 192, "no bytes between members, which nobody would write");

/// Calls visit(of_scene, of_header) for each number of a scene that a header has.
template <class Scene, class Of, class Visit>
void visit_numbers(Scene& scene, Of& header, const Visit& visit) {
  visit(scene.shapes, header.shapes);
  visit(scene.primitive_count, header.primitive_count);
  visit(scene.bvh_nodes, header.bvh_nodes);
  visit(scene.bvh_sah, header.bvh_sah);
  visit(scene.build_seconds, header.build_seconds);
  visit(scene.leaf_kind_bits, header.leaf_kind_bits);
  visit(scene.bvh_depth, header.bvh_depth);
  visit(scene.sky_is_unseen, header.sky_is_unseen);
  visit(scene.has_moving_operands, header.has_moving_operands);
  visit(scene.has_chains, header.has_chains);
}
template <class To, class From>
void set(To& to, const From& from) {
  to = static_cast<To>(from);
}

std::string contract_key() { return content_hash(std::string(tree_format) + CAPLET_CONTRACT_KEY); }

template <std::size_t N>
void put(char (&to)[N], std::string_view text) {
  std::memcpy(to, text.data(), std::min(N, text.size()));
}
template <std::size_t N>
std::string text_of(const char (&from)[N]) {
  return {from, N};
}

template <class T>
std::string_view bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// Returns whether an array is read rather than mapped: the host asks these what kinds there are.
/// Records are read, too.
bool is_read(std::string_view array) {
  constexpr std::string_view names[] = {"materials",   "textures", "lights",
                                        "light_nodes", "mediums",  "instances"};
  return std::ranges::find(names, array) != std::end(names);
}
template <class T>
bool is_read(const std::vector<T>&, std::string_view name) {
  return is_read(name);
}
template <class T>
bool is_read(const T&, std::string_view) {
  return true;
}

/// Hashes what is read of a file: the header behind its checksum, notes and arrays.
class Checksum {
 public:
  explicit Checksum(const Header& header) {
    const char* const from = header.fingerprint;
    add({from,
         sizeof(Header) - static_cast<std::size_t>(from - reinterpret_cast<const char*>(&header))});
  }
  void add(std::string_view bytes) { all_ += content_hash(bytes); }
  std::string text() const { return content_hash(all_); }

 private:
  std::string all_;
};

/// Writes sections one after the other, and fills up what is between them.
class SectionWriter {
 public:
  /// `path`: the file to open; `name`: that of the file in messages.
  SectionWriter(const fs::path& path, std::string name, std::uint64_t all,
                const std::function<void(double)>& progress)
      : out_(path, std::ios::binary), name_(std::move(name)), all_(all), progress_(progress) {}
  void write(std::uint64_t offset, std::string_view bytes) {
    const std::string gap(static_cast<std::size_t>(offset - at_), '\0');
    append(gap);
    for (std::size_t i = 0; i < bytes.size(); i += written_bytes)
      append(bytes.substr(i, written_bytes));
  }
  void finish() {
    out_.flush();
    check();
  }

 private:
  void check() const {
    if (out_) return;
    throw RunError(
        fmt::format("{}: cannot be written ({})", name_, std::generic_category().message(errno)));
  }
  void append(std::string_view bytes) {
    out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    at_ += bytes.size();
    check();
    if (progress_) progress_(static_cast<double>(at_) / static_cast<double>(all_));
  }
  std::ofstream out_;
  std::string name_;
  std::uint64_t at_ = 0, all_;
  const std::function<void(double)>& progress_;
};

/// Gives each section the next place.
class Layout {
 public:
  Section next(std::uint64_t bytes) {
    at_ = (at_ + section_alignment - 1) / section_alignment * section_alignment;
    const Section out{at_, bytes};
    at_ += bytes;
    return out;
  }
  std::uint64_t end() const { return at_; }

 private:
  std::uint64_t at_ = sizeof(Header);
};

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw InputError({file.string()}, why);
}

/// Returns the bytes of a section of elements of this size.
std::string_view section_of(const fs::path& path, std::string_view file, const Section& section,
                            std::size_t element) {
  if (section.offset > file.size() || section.bytes > file.size() - section.offset ||
      section.offset % section_alignment != 0 || section.bytes % element != 0)
    refuse(path, "the tree file is damaged: a part of it lies outside");
  return file.substr(section.offset, section.bytes);
}

template <class T>
std::span<const T> elements_of(const fs::path& path, std::string_view file,
                               const Section& section) {
  const std::string_view bytes = section_of(path, file, section, sizeof(T));
  return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

template <class T>
void read_into(std::vector<T>& to, std::span<const T> from) {
  to.assign(from.begin(), from.end());
}
template <class T>
void read_into(T& to, std::span<const T> from) {
  if (from.size() == 1) to = from[0];
}

/// Throws when a record is of a kind that there is not: the host looks kinds up in tables.
template <class Record>
void check_kinds(const fs::path& path, const std::vector<Record>& records, std::size_t kinds) {
  for (const Record& record : records)
    if (record.kind >= kinds) refuse(path, "the tree file is damaged: it has an unknown kind");
}

Header header_of(const fs::path& path, std::string_view file) {
  Header out;
  if (!file.starts_with(tree_magic) || file.size() < sizeof(out))
    refuse(path, file.starts_with(tree_magic) ? "the tree file is cut short"
                                              : "is no tree file, as `caplet build` writes them");
  std::memcpy(&out, file.data(), sizeof(out));
  if (out.order != native_order) refuse(path, "the tree file is of a machine of other byte order");
  if (out.header_bytes != sizeof(out) || text_of(out.key) != contract_key())
    refuse(path, "the tree file is of another version of Caplet; make it again by `caplet build`");
  if (out.file_bytes != file.size())
    refuse(path, fmt::format("the tree file is damaged: it has {} bytes in place of {}",
                             file.size(), out.file_bytes));
  return out;
}

}  // namespace

void write_tree(const fs::path& file, const FlatScene& scene, const TreeNotes& notes,
                const std::function<void(double)>& progress) {
  const SceneArrays arrays = scene.arrays();
  Header header{};
  put(header.magic, tree_magic);
  header.order = native_order;
  header.header_bytes = sizeof(header);
  put(header.key, contract_key());
  put(header.fingerprint, fingerprint(scene));
  visit_numbers(scene, header, [](auto& from, auto& to) { set(to, from); });
  Layout layout;
  for (std::size_t i = 0; i < notes.size(); ++i) header.notes[i] = layout.next(notes[i].size());
#define BUFFER(name, type, access) header.arrays.name = layout.next(arrays.name.size_bytes());
  SCENE_GROUPS
#undef BUFFER
  header.file_bytes = layout.end();
  Checksum checksum(header);
  for (const std::string& note : notes) checksum.add(note);
#define BUFFER(name, type, access) \
  if (is_read(scene.name, #name)) checksum.add(bytes_of(arrays.name));
  SCENE_GROUPS
#undef BUFFER
  put(header.checksum, checksum.text());
  write_atomically(file, [&](const fs::path& path) {
    SectionWriter out(path, file.string(), header.file_bytes, progress);
    out.write(0, {reinterpret_cast<const char*>(&header), sizeof(header)});
    for (std::size_t i = 0; i < notes.size(); ++i) out.write(header.notes[i].offset, notes[i]);
#define BUFFER(name, type, access) out.write(header.arrays.name.offset, bytes_of(arrays.name));
    SCENE_GROUPS
#undef BUFFER
    out.finish();
  });
}

TreeFile map_tree(const fs::path& path) {
  struct Mapped {
    explicit Mapped(const fs::path& from) : file(from) {}
    MappedFile file;
    SceneArrays arrays;
  };
  const auto mapped = std::make_shared<Mapped>(path);
  const std::string_view file = mapped->file.bytes();
  const Header header = header_of(path, file);
  Checksum checksum(header);
  TreeFile out;
  out.fingerprint = text_of(header.fingerprint);
  FlatScene& scene = out.scene;
  visit_numbers(scene, header, [](auto& to, auto& from) { set(to, from); });
  for (std::size_t i = 0; i < out.notes.size(); ++i) {
    out.notes[i] = section_of(path, file, header.notes[i], 1);
    checksum.add(out.notes[i]);
  }
#define BUFFER(name, type, access)                                             \
  if (const auto elements = elements_of<type>(path, file, header.arrays.name); \
      is_read(scene.name, #name)) {                                            \
    read_into(scene.name, elements);                                           \
    checksum.add(bytes_of(elements));                                          \
  } else {                                                                     \
    mapped->arrays.name = elements;                                            \
  }
  SCENE_GROUPS
#undef BUFFER
  if (checksum.text() != text_of(header.checksum))
    refuse(path, "the tree file is damaged: its checksum is wrong");
  check_kinds(path, scene.materials, material_count);
  check_kinds(path, scene.textures, texture_count);
  check_kinds(path, scene.lights, light_count);
  check_kinds(path, scene.mediums, medium_count);
  scene.in_file = {mapped, &mapped->arrays};
  return out;
}

void check_tree(const fs::path& path, const TreeFile& tree) {
  if (fingerprint(tree.scene) != tree.fingerprint)
    refuse(path, "the tree file is damaged: it is not what was written");
}

#undef GROUP_BEGIN
#undef GROUP_END

}  // namespace caplet
