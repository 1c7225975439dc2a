// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// PLY meshes (G. Turk 1994): ascii, binary of either byte order, gzipped. Polygons are
// triangulated. assimp 5.2 is no substitute: it reads beyond the end of truncated files, refuses
// faces before vertices, drops a binary body's first byte if it is 0x0a, and its errors have no
// lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"

namespace caplet {

/// Reads a mesh. Vertices keep their order and are neither merged nor split; faces keep order and
/// winding. Normals or texture coordinates that are not finite at all vertices are dropped with a
/// warning. `where` is the statement that names the file. Throws InputError when the file is
/// missing, broken, or contradicts its header. `colors` receives linear colours of corners, three
/// per triangle, if the file has colours of vertices or else of faces.
TriangleMeshShape read_ply(const std::filesystem::path& path, const SourceLocation& where,
                           std::vector<glm::vec3>* colors = nullptr);
/// Does the same from bytes; `file` is the name for messages.
TriangleMeshShape parse_ply(const std::string& file, const std::string& bytes,
                            std::vector<glm::vec3>* colors = nullptr);

namespace ply {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class Encoding { ascii, little, big };

struct Property {
  std::string name;
  Type type = Type::float32;
  bool is_list = false;
  Type count_type = Type::uint8;
};
struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};
struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::size_t size = 0;  // bytes; the body starts here
  int lines = 0;
  std::size_t vertex = 0, face = 0,
              indices =
                  0;  // indices of the vertex and face elements, and of the faces' list of vertices
};

std::size_t size_of(Type type);
bool is_float(Type type);
/// Accepts "vertex_indices" and its variants.
bool is_index_list(const Property& property);

/// Reads and checks the header, and the counts against the file's size. Throws InputError.
Header parse_header(const std::string& file, std::string_view bytes);

/// What a file's vertices and faces hold. Normals, texture coordinates and colours are empty where
/// the file has none.
struct Body {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  std::vector<std::uint32_t> lengths,
      corners;  // numbers of corners of each face, and the vertices of all faces
  std::vector<glm::vec3> vertex_colors, face_colors;  // linear
};

/// Reads the body, with colours of vertices or else of faces if they are asked for. Throws
/// InputError unless every value of the body is present and readable, positions are finite and
/// indices are in range.
Body read_body(const std::string& file, std::string_view bytes, const Header& header,
               bool with_colors);

}  // namespace ply

}  // namespace caplet
