// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/detail/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "base/check.h"
#include "shared/records.h"

namespace caplet {

namespace {

constexpr std::size_t largest_record_bytes = std::max({
#define RECORD_BEGIN(name) sizeof(name),
#define FIELD(type, name)
#define ARRAY(type, name, count)
#define RECORD_END(name, bytes)
#include "shared/records.def"
#undef RECORD_BEGIN
#undef FIELD
#undef ARRAY
#undef RECORD_END
});

/// Expectation holds the values that the kernel should write (without the count at the front), and
/// the meaning of each.
struct Expectation {
  std::vector<cl_uint> values;
  std::vector<std::string> meanings;

  void add(cl_uint value, const std::string& meaning) {
    values.push_back(value);
    meanings.push_back(meaning);
  }
};

Expectation expectation(const std::vector<RecordLayout>& layouts) {
  Expectation out;
  for (const RecordLayout& record : layouts) {
    out.add(record.bytes, record.name + ": size");
    for (const FieldLayout& field : record.fields) {
      const std::string name = record.name + "." + field.name;
      out.add(field.offset, name + ": offset");
      out.add(field.offset, name + ": offset it is loaded from");
      out.add(field.bytes, name + ": size");
    }
  }
  return out;
}

/// Returns the name in a line of records.def that has one: of a record, or of a field of it.
std::string_view name_in(std::string_view line) {
  constexpr std::string_view record = "RECORD_BEGIN(";
  for (const std::string_view begin :
       {record, std::string_view("FIELD("), std::string_view("ARRAY(")}) {
    if (!line.starts_with(begin)) continue;
    line.remove_prefix(begin.size());
    if (begin != record) line.remove_prefix(std::min(line.find(',') + 1, line.size()));
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    return line.substr(0, line.find_first_of(",) "));
  }
  return {};
}

/// Returns the first other name of a record or field in the text that devices compile, which
/// CAPLET_KERNELS may have changed: fields of one size that changed places have the same offsets.
/// It is empty where host and text agree.
std::string other_name(const std::vector<RecordLayout>& layouts) {
  std::vector<std::string> wanted;
  for (const RecordLayout& record : layouts) {
    wanted.push_back(record.name);
    for (const FieldLayout& field : record.fields) wanted.push_back(record.name + "." + field.name);
  }
  const std::string text = kernel_source("shared/records.def");
  std::string record;
  std::size_t i = 0;
  for (std::size_t begin = 0; begin < text.size() && i < wanted.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    std::string name(name_in(line));
    if (name.empty()) continue;
    if (line.starts_with("RECORD_BEGIN"))
      record = name;
    else
      name = record + "." + name;
    if (name != wanted[i])
      return fmt::format("the device has {} where the host has {}", name, wanted[i]);
    ++i;
  }
  return {};
}

}  // namespace

std::vector<RecordLayout> host_layout() {
  std::vector<RecordLayout> out;
#define RECORD_BEGIN(name) \
  {                        \
    using Record = name;   \
    RecordLayout layout{#name, narrow<std::uint32_t>(sizeof(Record)), {}};
#define FIELD(type, name)                                                        \
  layout.fields.push_back({#name, narrow<std::uint32_t>(offsetof(Record, name)), \
                           narrow<std::uint32_t>(sizeof(Record::name))});
#define ARRAY(type, name, count) FIELD(type, name)
#define RECORD_END(name, bytes) \
  out.push_back(layout);        \
  }
#include "shared/records.def"
#undef RECORD_BEGIN
#undef FIELD
#undef ARRAY
#undef RECORD_END
  return out;
}

std::vector<std::string> compare_layout(const Device& device,
                                        const std::vector<RecordLayout>& expected) {
  const Expectation wanted = expectation(expected);
  // There is room for a device list that is longer than the host's, as it can be with
  // CAPLET_KERNELS.
  const std::size_t capacity = 2 * wanted.values.size() + 1;
  // There is as much beyond the largest record again, in case the device's records are larger than
  // the host's.
  std::vector<cl_uint> words(2 * largest_record_bytes / sizeof(cl_uint));
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = 0x40000000u + narrow<cl_uint>(4 * i);

  const Program program =
      Program::from_source(device, "layout", kernel_source("probe/layout.cl"), "");
  Buffer<cl_uint> out(device, capacity);
  const Buffer<cl_uint> in(device, std::span<const cl_uint>(words));
  cl::Kernel kernel = program.kernel("layout");
  set_arguments(device, kernel, out, narrow<cl_uint>(capacity), in);
  launch(device, kernel, 1, 1);
  const std::vector<cl_uint> seen = out.read();

  std::vector<std::string> mismatches;
  if (const std::string other = other_name(expected); !other.empty()) mismatches.push_back(other);
  if (seen[0] != wanted.values.size() + 1)
    mismatches.push_back(fmt::format("the device lists {} sizes and offsets, the host {}",
                                     seen[0] - 1, wanted.values.size()));
  const std::size_t comparable = std::min<std::size_t>(seen[0] - 1, wanted.values.size());
  for (std::size_t i = 0; i < comparable; ++i)
    if (seen[i + 1] != wanted.values[i])
      mismatches.push_back(fmt::format("{} is {} on the device, {} on the host", wanted.meanings[i],
                                       seen[i + 1], wanted.values[i]));
  return mismatches;
}

std::vector<std::string> compare_layout(const Device& device) {
  return compare_layout(device, host_layout());
}

}  // namespace caplet
