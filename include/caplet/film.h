// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A film: the exact sums of a picture's samples, and the picture with its layers that is computed
// from them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "caplet/error.h"
#include "caplet/export.h"
#include "caplet/scene.h"

CAPLET_BEGIN

/// The samples [first, first + count) of every pixel.
struct SampleRange {
  std::uint32_t first = 0, count = 0;
};

/// Layers that a film has on request, beside those that every film has. They take memory: 128 bytes
/// a pixel of the device for each of the three mattes, 256 for a deep picture.
struct ExtraLayers {
  bool cryptomatte = false;  // by object, material and file
  bool deep = false;
  bool none = false;  // the picture and its alpha alone, which is quicker; without the two above
};

/// What a matte tells apart.
enum class Matte { object, material, asset };

/// An overlay that can be drawn on a preview.
struct Overlay {
  std::string name, values, help;  // values: the allowed values, for people; empty for a switch
};
CAPLET_API std::vector<Overlay> overlays();

/// Values of overlays by name, as for `render --NAME` of the program; an empty value is the
/// default: {{"scale-bar", "50 um"},
/// {"outline", ""}}.
using OverlayOptions = std::map<std::string, std::string>;

/// The same samples give the same film bit for bit, in any order and split over any number of runs
/// and devices of one kind.
class CAPLET_API Film {
 public:
  Film(const Film&);
  Film(Film&&) noexcept;
  Film& operator=(const Film&);
  Film& operator=(Film&&) noexcept;
  ~Film();

  /// The size and place of the rendered part: of the crop, if there is one; x and y are its corner
  /// in the whole picture.
  int width() const;
  int height() const;
  int x() const;
  int y() const;
  /// Returns the number of finished samples.
  int samples_per_pixel() const;
  /// Returns the finished samples.
  std::vector<SampleRange> samples() const;

  /// Adds the samples of another film of the same scene, view and layers. Throws InputError, and
  /// changes nothing, when it differs in these or has samples that this film already has.
  void add(const Film& other);
  /// Saves the sums as an EXR file for `load` and `caplet merge`. The file is replaced atomically.
  /// Throws RunError.
  void save(const std::filesystem::path& file) const;
  /// Loads such a file, with the exposure and colours that its picture was made with. Throws
  /// InputError when the file is missing, broken or no film.
  static Film load(const std::filesystem::path& file);
  /// Does the same with the exposure and colours of `scene`, and with overlays, which need a scene.
  static Film load(const std::filesystem::path& file, const Scene& scene);

  /// Returns "R", "G", "B", "A", "Z", "albedo.R", "N.X", "P.X", "variance.R", ... and "object.id",
  /// "primitive.id".
  std::vector<std::string> channels() const;
  /// Returns the values of one channel, row by row from the top, scene-linear in the film's colour
  /// space. Throws InputError when the channel does not exist or contains ids.
  std::vector<float> values(const std::string& channel) const;
  /// Returns the values of a channel of ids; 2^32 - 1 where there is nothing.
  std::vector<std::uint32_t> ids(const std::string& channel) const;

  /// Returns the names that a matte tells apart, in order. Throws InputError when the film has no
  /// mattes.
  std::vector<std::string> matte_names(Matte matte) const;
  /// Returns the share of each pixel that what has this name covers, row by row from the top: exact
  /// but in pixels that show more than 16 things. Throws InputError when the film has no mattes or
  /// nothing has this name.
  std::vector<float> matte(Matte matte, const std::string& name) const;

  /// Writes a deep OpenEXR: alpha and distance of all that each pixel shows. Throws InputError when
  /// the film was rendered without `deep`; and RunError.
  void write_deep_exr(const std::filesystem::path& file) const;
  /// Writes all channels as OpenEXR. The file is replaced atomically. Throws RunError.
  void write_exr(const std::filesystem::path& file) const;
  /// Writes a tone-mapped picture, 8 bits per channel, in the format of the extension, with
  /// overlays. Throws InputError for an unknown extension or overlay, a wrong value, or a layer
  /// that the film lacks; and RunError.
  void write_preview(const std::filesystem::path& file, const OverlayOptions& drawn = {}) const;

 private:
  friend struct Inside;
  struct Data;
  explicit Film(std::shared_ptr<const Data> data);
  const Data& developed() const;
  std::shared_ptr<const Data> data_;
};

CAPLET_END
