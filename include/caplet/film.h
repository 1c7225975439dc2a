// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A film: the exact sums of the samples of a picture, and the picture with its layers that they make.
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

/// Samples [first, first + count) of every pixel.
struct SampleRange {
  std::uint32_t first = 0, count = 0;
};

/// What may be drawn on a preview.
struct Overlay {
  std::string name, values, help;  // values: what may be said of it, as people read it; empty of a switch
};
CAPLET_API std::vector<Overlay> overlays();

/// Values of overlays by name, as the program's `render` takes them as --NAME; an empty value is the usual one:
/// {{"scale-bar", "50 um"}, {"outline", ""}}.
using OverlayOptions = std::map<std::string, std::string>;

/// The same samples make the same film, to the bit, in whatever order and by however many devices of one kind and runs they came.
class CAPLET_API Film {
 public:
  Film(const Film&);
  Film(Film&&) noexcept;
  Film& operator=(const Film&);
  Film& operator=(Film&&) noexcept;
  ~Film();

  /// Of what was rendered: the crop, where the scene has one, whose place in the whole picture x and y are.
  int width() const;
  int height() const;
  int x() const;
  int y() const;
  /// That were finished.
  int samples_per_pixel() const;
  /// Which they are.
  std::vector<SampleRange> samples() const;

  /// Adds the samples of another film of the same scene, view and layers. Throws InputError, and changes nothing, when it is of
  /// another, or has samples that are here already.
  void add(const Film& other);
  /// The sums as an EXR file that `load` takes. The file is replaced as a whole, or is as it was. Throws RunError.
  void save(const std::filesystem::path& file) const;
  /// `scene`: of which the film is; it says the picture's exposure and colours. Throws InputError when the file is missing,
  /// broken or no film.
  static Film load(const std::filesystem::path& file, const Scene& scene);

  /// "R", "G", "B", "A", "Z", "albedo.R", "N.X", "P.X", "variance.R", ... and "object.id", "primitive.id".
  std::vector<std::string> channels() const;
  /// Values of one channel, row by row from the top: scene-linear in the film's colour space. Throws InputError when there is no
  /// such channel, or when it holds ids.
  std::vector<float> values(const std::string& channel) const;
  /// The same of a channel of ids; 2^32 - 1 where nothing is.
  std::vector<std::uint32_t> ids(const std::string& channel) const;

  /// All channels as OpenEXR. The file is replaced as a whole, or is as it was. Throws RunError.
  void write_exr(const std::filesystem::path& file) const;
  /// Tone-mapped, 8 bits a channel, in the format of the extension; with what is drawn on it. Throws InputError when that is
  /// unknown, or an overlay is, has a wrong value or needs a layer that the film does not have; and RunError.
  void write_preview(const std::filesystem::path& file, const OverlayOptions& drawn = {}) const;

 private:
  friend struct Inside;
  struct Data;
  explicit Film(std::shared_ptr<const Data> data);
  const Data& developed() const;
  std::shared_ptr<const Data> data_;
};

CAPLET_END
