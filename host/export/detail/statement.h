// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Statements of pbrt text, their parameters, and the graphics state around them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/reading.h"
#include "export/detail/text.h"
#include "scene/image_writer.h"
#include "scene/scene.h"

namespace caplet::pbrt_text {

/// Files that are written for images that are in none, each once.
class ImageFiles {
 public:
  /// Files beside `scene`, whose names begin with its name.
  ImageFiles(const ImageWriter& writer, const std::filesystem::path& scene)
      : writer_(writer), stem_(scene.parent_path() / scene.stem()) {}
  template <class Image>
  std::string file_of(const Image& image) {
    std::string& file = files_[&image];
    if (file.empty()) {
      const ImageWriter::File made = writer_.write(stem_, image);
      if (made.is_new) new_.push_back(made.path);
      file = made.path.string();
    }
    return file;
  }
  /// Removes the files that were not there before.
  void remove() noexcept;

 private:
  const ImageWriter& writer_;
  std::filesystem::path stem_;
  std::map<const void*, std::string> files_;
  std::vector<std::filesystem::path> new_;
};

/// The output of statements, and the colour space there.
struct Stream {
  Text& text;
  std::filesystem::path folder;  // of the file, absolute
  std::function<bool()> cancelled;
  ImageFiles* images = nullptr;  // null: images that are in no file are refused
  ColorSpace space = ColorSpace::srgb;

  /// Throws RunError when it is cancelled.
  void go_on() const {
    if (cancelled && cancelled()) throw RunError("interrupted; nothing is written");
  }
};

/// One statement: `head` and its parameters, in order. A parameter in another colour space than the
/// stream's is written before the statement (Attribute `target`).
class Statement {
 public:
  Statement(std::string head, const char* target, const SourceLocation& where)
      : head_(std::move(head)), target_(target), where_(where) {}

  void number(const std::string& name, double value);
  void whole(const std::string& name, std::int64_t value) {
    add("integer", name, text_of([&](Text& to) { to << value; }));
  }
  void boolean(const std::string& name, bool value) { add("bool", name, value ? "true" : "false"); }
  void text(const std::string& name, std::string_view value) {
    add("string", name, quoted(value, where_));
  }
  void texts(const std::string& name, const std::vector<std::string>& values);
  void texture(const std::string& name, std::string_view value) {
    add("texture", name, quoted(value, where_));
  }
  void numbers(const char* type, const std::string& name, std::initializer_list<double> values);
  void point(const std::string& name, const glm::dvec3& p) {
    numbers("point3", name, {p.x, p.y, p.z});
  }
  void vector(const std::string& name, const glm::dvec3& v) {
    numbers("vector3", name, {v.x, v.y, v.z});
  }
  void spectrum(const std::string& name, const Spectrum& value);
  /// Writes a path of the scene so that it is valid from the written file's folder. Throws
  /// InputError when it is empty.
  void file(const std::string& name, const std::string& path, const char* what,
            const Stream& stream);
  /// Does the same for an image's file, which is written where it is in none, or in one that is
  /// gone.
  template <class Image>
  void image(const std::string& name, const Image& image, const char* what, const Stream& stream) {
    const bool is_written =
        stream.images != nullptr && (image.file.empty() || !is_there(image.file, where_));
    file(name, is_written ? stream.images->file_of(image) : image.file, what, stream);
  }
  /// Adds `count` values that `write` writes one by one, when the statement is written.
  void list(const char* type, const std::string& name, std::size_t count,
            std::function<void(Text&, std::size_t)> write, std::optional<ColorSpace> space = {});
  /// Puts the statement in a block, after this line.
  void within(const std::string& line) { before_ += line; }

  const SourceLocation& where() const { return where_; }
  void write(Stream& stream);

 private:
  struct Parameter {
    std::string declaration, value;
    std::optional<ColorSpace> space = {};
    std::size_t count = 0;  // of a list
    std::function<void(Text&, std::size_t)> list = {};
  };
  void add(const char* type, const std::string& name, std::string value,
           std::optional<ColorSpace> space = {});
  static void write(const Parameter& parameter, Stream& stream);
  void finite(double value, const std::string& name) const;

  std::string head_, before_;
  const char* target_;
  const SourceLocation& where_;
  std::vector<Parameter> parameters_;
};

/// Changes the `ColorSpace` from here on.
void set_space(Stream& stream, ColorSpace space);

}  // namespace caplet::pbrt_text
