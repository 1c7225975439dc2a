// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/ext/vector_float1.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "import/detail/base64.h"
#include "import/detail/gltf.h"
#include "import/detail/gzip_file.h"
#include "import/detail/text_file.h"

namespace caplet::gltf {

namespace {

constexpr std::uint32_t kGlb = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

constexpr double kLeastScale = 1e-6;  // of an axis: a scale of 0 has no inverse

std::uint32_t word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

const nlohmann::json& nothing() {
  static const nlohmann::json empty = nlohmann::json::object();
  return empty;
}
const nlohmann::json& no_list() {
  static const nlohmann::json empty = nlohmann::json::array();
  return empty;
}

}  // namespace

File::File(std::filesystem::path file, std::string bytes)
    : path(std::move(file)), bytes_(std::move(bytes)), held_(bytes_.size()) {
  std::string_view text = bytes_;
  constexpr std::size_t header = 12, chunk_header = 8;
  if (text.size() >= header && word(text, 0) == kGlb) {
    if (word(text, 4) != 2) fail(fmt::format("GLB of version {}", word(text, 4)));
    if (word(text, 8) > text.size())
      fail(fmt::format("{} bytes are announced; the file has {}", word(text, 8), text.size()));
    std::string_view chunks =
        text.substr(header, word(text, 8) - std::min<std::size_t>(header, word(text, 8)));
    text = {};
    while (chunks.size() >= chunk_header) {
      const std::size_t size = word(chunks, 0);
      const std::uint32_t kind = word(chunks, 4);
      if (size > chunks.size() - chunk_header) fail("a chunk is longer than the file");
      if (kind == kJsonChunk && text.empty()) text = chunks.substr(chunk_header, size);
      if (kind == kBinaryChunk && binary_.empty()) binary_ = chunks.substr(chunk_header, size);
      chunks.remove_prefix(chunk_header + size);
    }
  }
  // Deep nesting would overflow the stack when it is freed; glTF needs less than a dozen levels.
  const auto callback = [](int depth, Json::parse_event_t, Json&) { return depth < 64; };
  const auto place = [&](std::size_t byte) {
    SourceLocation where{path.string(), 1, 1};
    for (std::size_t i = 0; i < std::min(byte, text.size()); ++i) {
      where.column = text[i] == '\n' ? 1 : where.column + 1;
      where.line += text[i] == '\n';
    }
    return where;
  };
  try {
    json = Json::parse(text.begin(), text.end(), callback);
  } catch (const Json::parse_error& error) {
    throw InputError(place(std::max<std::size_t>(error.byte, 1) - 1), "is no JSON here");
  } catch (const Json::out_of_range& error) {
    // The number is out of range of doubles; the message quotes it.
    const std::string_view said = error.what();
    const std::size_t begin = std::min(said.find('\''), said.size() - 1);
    const std::string_view number = said.substr(begin + 1, said.rfind('\'') - begin - 1);
    throw InputError(place(text.find(number)),
                     "the number " + std::string(number) + " is out of range");
  }
  if (!json.is_object()) fail("is no glTF file: its JSON is no object");
}

void File::fail(const std::string& message) const {
  throw InputError({path.string(), 0, 0}, message);
}

void File::check_version() const {
  const std::string version = text(object(json, "asset"), "version", "");
  if (!version.starts_with("2")) fail("is no glTF 2.0 file (asset.version is '" + version + "')");
  for (const Json& name : list("extensionsRequired")) {
    const std::string text = name.is_string() ? name.get<std::string>() : "?";
    if (text != "KHR_texture_transform" && text != "KHR_lights_punctual" &&
        text != "KHR_mesh_quantization" && text != "EXT_mesh_gpu_instancing" &&
        !text.starts_with("KHR_materials_"))
      fail("requires the extension " + text + ", which is not read");
  }
}

const File::Json& File::list_of(const Json& of, const char* name) const {
  if (!of.is_object()) fail(std::string(name) + " is asked of what is no object");
  const auto found = of.find(name);
  if (found == of.end()) return no_list();
  if (!found->is_array()) fail(std::string(name) + " is no list");
  return *found;
}

const File::Json& File::object(const Json& of, const char* name) const {
  if (!of.is_object()) fail(std::string(name) + " is asked of what is no object");
  const auto found = of.find(name);
  if (found == of.end()) return nothing();
  if (!found->is_object()) fail(std::string(name) + " is no object");
  return *found;
}

std::string File::text(const Json& of, const char* name, const std::string& otherwise) const {
  if (!of.is_object()) fail(std::string(name) + " is asked of what is no object");
  const auto found = of.find(name);
  if (found == of.end()) return otherwise;
  if (!found->is_string()) fail(std::string(name) + " is no text");
  return found->get<std::string>();
}

double File::number_value(const Json& value, const char* what) const {
  if (!value.is_number()) fail(std::string(what) + " is no number");
  const auto number = value.get<double>();
  if (!(std::abs(number) <= static_cast<double>(largest_number)))
    fail(std::string(what) + " is not finite or out of range");
  return number;
}

double File::number(const Json& of, const char* name, double otherwise) const {
  if (!of.is_object()) fail(std::string(name) + " is asked of what is no object");
  const auto found = of.find(name);
  return found == of.end() ? otherwise : number_value(*found, name);
}

bool File::flag(const Json& of, const char* name, bool otherwise) const {
  if (!of.is_object()) fail(std::string(name) + " is asked of what is no object");
  const auto found = of.find(name);
  if (found == of.end()) return otherwise;
  if (!found->is_boolean()) fail(std::string(name) + " is neither true nor false");
  return found->get<bool>();
}

std::size_t File::index_value(const Json& value, std::size_t count, const char* what) const {
  if (!value.is_number_unsigned())
    fail(std::string("an index of a ") + what + " is no whole number");
  const auto index = value.get<std::uint64_t>();
  if (index >= count) fail(fmt::format("{} {}: there are {}", what, index, count));
  return index;
}

std::optional<std::size_t> File::index(const Json& of, const char* name, std::size_t count,
                                       const char* what) const {
  if (!of.is_object()) fail(std::string(name) + " is asked of what is no object");
  const auto found = of.find(name);
  return found == of.end() ? std::nullopt : std::optional(index_value(*found, count, what));
}

glm::dmat4 File::transform_of(const Json& node) const {
  const Json& matrix = list_of(node, "matrix");
  if (!matrix.empty()) {
    if (matrix.size() != 16) fail("a matrix has another number of components than 16");
    glm::dmat4 out;
    for (int i = 0; i < 16; ++i)
      out[i / 4][i % 4] = number_value(matrix[static_cast<std::size_t>(i)], "matrix");
    return out;
  }
  return parts_of(node).matrix();
}

Parts File::parts_of(const Json& node) const {
  Parts out;
  out.translation = vector(node, "translation", glm::dvec3(0));
  out.scale = vector(node, "scale", glm::dvec3(1));
  const auto r = vector(node, "rotation", glm::dvec4(0, 0, 0, 1));
  if (!(glm::length(r) > 0)) fail("a rotation is no quaternion");
  const glm::dvec4 q = glm::normalize(r);
  out.rotation = glm::dquat(q.w, q.x, q.y, q.z);
  return out;
}

glm::dmat4 Parts::matrix() const {
  glm::dvec3 factors = scale;
  for (int k = 0; k < 3; ++k)
    if (std::abs(factors[k]) < kLeastScale) factors[k] = std::copysign(kLeastScale, factors[k]);
  return glm::scale(glm::translate(glm::dmat4(1), translation) * glm::mat4_cast(rotation), factors);
}

std::optional<std::string> File::data_uri(const std::string& uri) const {
  if (!uri.starts_with("data:")) return std::nullopt;
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos || uri.substr(0, comma).find(";base64") == std::string::npos)
    fail("a data address is not of base64");
  std::optional<std::string> out = bytes_of_base64(std::string_view(uri).substr(comma + 1));
  if (!out) fail("a data address has a letter that is none of base64");
  return out;
}

std::filesystem::path File::beside(const std::string& uri) const {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto hex = [](char c) {
      return c >= '0' && c <= '9'   ? c - '0'
             : c >= 'a' && c <= 'f' ? c - 'a' + 10
             : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                    : -1;
    };
    if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0) {
      name += static_cast<char>(hex(uri[i + 1]) * 16 + hex(uri[i + 2]));
      i += 2;
    } else {
      name += uri[i];
    }
  }
  if (name.find('\0') != std::string::npos) fail("an address holds a zero");
  return path.parent_path() / name;
}

std::string_view File::buffer(std::size_t index) {
  const Json& of = list("buffers")[index];
  const std::string uri = text(of, "uri", "");
  if (uri.empty()) return index == 0 ? binary_ : std::string_view();
  const auto known = buffers_.find(index);
  if (known != buffers_.end()) return known->second;
  std::optional<std::string> data = data_uri(uri);
  if (!data) data = read_file(beside(uri), {path.string(), 0, 0});
  held_ += data->size();
  return buffers_[index] = std::move(*data);
}

std::string_view File::view(std::size_t index) {
  const Json& of = list("bufferViews")[index];
  const auto which = this->index(of, "buffer", list("buffers").size(), "buffer");
  if (!which) fail(fmt::format("buffer view {} names no buffer", index));
  const std::string_view bytes = buffer(*which);
  const double offset = number(of, "byteOffset", 0), length = number(of, "byteLength", 0);
  if (offset < 0 || length < 0 || offset + length > static_cast<double>(bytes.size()))
    fail(fmt::format("buffer view {} goes from byte {} to {}; its buffer has {}", index, offset,
                     offset + length, bytes.size()));
  return bytes.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

/// The raw elements of an accessor.
struct File::Elements {
  std::string_view bytes;  // empty: all are 0
  std::size_t count = 0, stride = 0, components = 0;
  int type = 0;
  bool normalized = false;
  std::vector<std::uint32_t> replaced;   // elements that a sparse accessor gives anew, in order
  std::shared_ptr<const Elements> anew;  // their values

  double at(std::size_t i, std::size_t k) const {
    if (anew)
      if (const auto found = std::ranges::lower_bound(replaced, i);
          found != replaced.end() && *found == i)
        return anew->at(static_cast<std::size_t>(found - replaced.begin()), k);
    if (bytes.empty()) return 0;
    const char* from = bytes.data() + i * stride;
    const auto read = [&]<class Number>(Number) {
      Number value;
      std::memcpy(&value, from + k * sizeof(Number), sizeof value);
      return value;
    };
    switch (type) {
      case 5120:
        return normalized ? std::max(read(std::int8_t{}) / 127.0, -1.0) : read(std::int8_t{});
      case 5121:
        return normalized ? read(std::uint8_t{}) / 255.0 : read(std::uint8_t{});
      case 5122:
        return normalized ? std::max(read(std::int16_t{}) / 32767.0, -1.0) : read(std::int16_t{});
      case 5123:
        return normalized ? read(std::uint16_t{}) / 65535.0 : read(std::uint16_t{});
      case 5125:
        return read(std::uint32_t{});
      default:
        return static_cast<double>(read(float{}));
    }
  }
};

File::Elements File::stored(std::size_t accessor, const Json& of, int type, std::size_t components,
                            std::size_t count, bool has_stride) {
  Elements out;
  out.type = type;
  out.components = components;
  out.count = count;
  const std::map<int, std::size_t> sizes = {{5120, 1}, {5121, 1}, {5122, 2},
                                            {5123, 2}, {5125, 4}, {5126, 4}};
  const auto size = sizes.find(type);
  if (size == sizes.end())
    fail(fmt::format("accessor {} has a componentType that there is not", accessor));
  const double offset = number(of, "byteOffset", 0);
  if (offset < 0) fail(fmt::format("accessor {} has a count or offset out of range", accessor));
  const auto which = index(of, "bufferView", list("bufferViews").size(), "buffer view");
  if (!which) fail(fmt::format("accessor {} names no buffer view", accessor));
  const std::string_view bytes = view(*which);
  const std::size_t element = size->second * components;
  if (has_stride)
    out.stride = static_cast<std::size_t>(
        std::clamp(number(list("bufferViews")[*which], "byteStride", 0), 0.0, 65536.0));
  if (out.stride == 0) out.stride = element;
  if (count > 0 && (out.stride < element ||
                    offset + static_cast<double>(element) > static_cast<double>(bytes.size()) ||
                    (static_cast<double>(bytes.size()) - offset - static_cast<double>(element)) /
                                static_cast<double>(out.stride) +
                            1 <
                        static_cast<double>(count)))
    fail(fmt::format("accessor {} announces {} elements beyond its {} bytes", accessor, count,
                     bytes.size()));
  out.bytes = bytes.substr(std::min(bytes.size(), static_cast<std::size_t>(offset)));
  return out;
}

File::Elements File::elements(std::size_t accessor) {
  const Json& of = list("accessors")[accessor];
  const auto type_of = [&](const Json& object) {
    return static_cast<int>(std::clamp(number(object, "componentType", 0), 0.0, 65536.0));
  };
  const auto count_of = [&](const Json& object) {
    const double count = number(object, "count", 0);
    if (!(count >= 0 && count < 4294967296.0))
      fail(fmt::format("accessor {} has a count or offset out of range", accessor));
    return static_cast<std::size_t>(count);
  };
  const std::map<std::string, std::size_t> kinds = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  const auto kind = kinds.find(text(of, "type", ""));
  if (kind == kinds.end()) fail(fmt::format("accessor {} has a type that is not read", accessor));
  const bool is_sparse = of.contains("sparse");
  Elements out;
  if (is_sparse && !of.contains("bufferView")) {
    out.type = type_of(of);
    out.components = kind->second;
    out.count = count_of(of);
  } else {
    out = stored(accessor, of, type_of(of), kind->second, count_of(of), true);
  }
  out.normalized = flag(of, "normalized", false);
  if (is_sparse) {
    const Json& sparse = object(of, "sparse");
    const Json &indices = object(sparse, "indices"), &values = object(sparse, "values");
    const std::size_t count = count_of(sparse);
    const Elements at = stored(accessor, indices, type_of(indices), 1, count, false);
    auto anew = std::make_shared<Elements>(
        stored(accessor, values, out.type, out.components, count, false));
    anew->normalized = out.normalized;
    for (std::size_t i = 0; i < count; ++i) {
      const double place = at.at(i, 0);
      if (!(place >= 0 && place < static_cast<double>(out.count)) ||
          (i > 0 && !(place > out.replaced.back())))
        fail(fmt::format("the sparse indices of accessor {} do not rise, or are out of range",
                         accessor));
      out.replaced.push_back(static_cast<std::uint32_t>(place));
    }
    out.anew = std::move(anew);
  }
  // Every primitive has its own vertices, and any number of primitives can share an accessor.
  taken_ += sizeof(float) * out.components * out.count;
  if (taken_ > std::max<std::uintmax_t>(std::uintmax_t{1} << 30, 100 * held_))
    fail(fmt::format("accessor {}: what the meshes share comes to {} bytes, of {} in the file",
                     accessor, taken_, held_));
  return out;
}

template <class Vector>
std::vector<Vector> File::vectors(std::size_t accessor) {
  const Elements from = elements(accessor);
  if (from.components != static_cast<std::size_t>(Vector::length()))
    fail(fmt::format("accessor {} has another type than is needed", accessor));
  std::vector<Vector> out(from.count);
  for (std::size_t i = 0; i < from.count; ++i)
    for (glm::length_t k = 0; k < Vector::length(); ++k) {
      const double value = from.at(i, static_cast<std::size_t>(k));
      if (!(std::abs(value) <= static_cast<double>(largest_number)))
        fail(fmt::format("element {} of accessor {} is not finite or out of range", i, accessor));
      out[i][k] = static_cast<float>(value);
    }
  return out;
}
template std::vector<glm::vec1> File::vectors<glm::vec1>(std::size_t accessor);
template std::vector<glm::vec4> File::vectors<glm::vec4>(std::size_t accessor);
template std::vector<glm::vec2> File::vectors<glm::vec2>(std::size_t accessor);
template std::vector<glm::vec3> File::vectors<glm::vec3>(std::size_t accessor);

std::vector<glm::vec3> File::colors(std::size_t accessor) {
  const Elements from = elements(accessor);
  if (from.components != 3 && from.components != 4)
    fail(fmt::format("accessor {} has another type than colours have", accessor));
  std::vector<glm::vec3> out(from.count);
  for (std::size_t i = 0; i < from.count; ++i)
    for (glm::length_t k = 0; k < 3; ++k) {
      const double value = from.at(i, static_cast<std::size_t>(k));
      if (!(std::abs(value) <= static_cast<double>(largest_number)))
        fail(fmt::format("element {} of accessor {} is not finite or out of range", i, accessor));
      out[i][k] = static_cast<float>(value);
    }
  return out;
}

std::vector<glm::dmat4> File::matrices(std::size_t accessor) {
  const Elements from = elements(accessor);
  if (from.components != 16)
    fail(fmt::format("accessor {} has another type than is needed", accessor));
  std::vector<glm::dmat4> out(from.count);
  for (std::size_t i = 0; i < from.count; ++i)
    for (std::size_t k = 0; k < 16; ++k) {
      const double value = from.at(i, k);
      if (!(std::abs(value) <= static_cast<double>(largest_number)))
        fail(fmt::format("element {} of accessor {} is not finite or out of range", i, accessor));
      out[i][static_cast<glm::length_t>(k / 4)][static_cast<glm::length_t>(k % 4)] = value;
    }
  return out;
}

std::vector<std::uint32_t> File::indices(std::size_t accessor) {
  const Elements from = elements(accessor);
  if (from.components != 1 || from.type == 5126)
    fail(fmt::format("accessor {} has another type than indices have", accessor));
  std::vector<std::uint32_t> out(from.count);
  for (std::size_t i = 0; i < from.count; ++i) {
    const double value = from.at(i, 0);
    if (value < 0) fail(fmt::format("element {} of accessor {} is negative", i, accessor));
    out[i] = static_cast<std::uint32_t>(value);
  }
  return out;
}

}  // namespace caplet::gltf
