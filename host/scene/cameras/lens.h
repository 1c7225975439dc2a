// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lenses of several surfaces, as realistic cameras have them (Kolb, Mitchell and Hanrahan 1995).
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera_ray.h"

namespace caplet {

/// A surface of a lens, as lines of lens files have them. Surfaces go from the scene to the film.
struct LensElement {
  double radius = 0;     // of curvature, mm; above 0: the centre is on the film's side; 0: the stop
  double thickness = 0;  // to the next surface, mm; of the last one: to the film, before focusing
  double eta = 0;        // index of refraction behind it; 0: of air
  double diameter = 0;   // mm
};

struct Lens {
  std::string file;  // that it was read from
  std::vector<LensElement> elements;
};

/// How much passes each part of the stop: rows from the top, as seen from behind, over the square
/// around it. A mean of pi / 4 is as bright as a round stop.
struct ApertureMask {
  std::string name;  // "square", "pentagon", "star", "gaussian", or a file
  int width = 0, height = 0;
  std::vector<float> values;
};

/// Lists the masks that need no file.
inline constexpr std::array aperture_names = {"gaussian", "pentagon", "square", "star"};
/// Returns a mask of `aperture_names`, as pbrt-v4 makes them; null for another name.
std::shared_ptr<const ApertureMask> aperture_mask(const std::string& name);
/// Scales a mask to the mean of a round stop; less than nothing passes nowhere. Returns false where
/// nothing passes, or more than a number says.
bool normalize(ApertureMask& mask);

/// A lens in focus. Lengths are camera units, which are metres. The film is at z = 0.
class FocusedLens {
 public:
  struct Surface {
    double radius = 0, z = 0;
    double eta = 1;   // index on the film's side over that on the scene's side
    double half = 0;  // of its diameter
  };
  struct Pupil {  // a rectangle of the plane z = rear_z()
    double x0 = 0, x1 = 0, y0 = 0, y1 = 0;
  };

  /// Focuses a lens at a distance from the film (pbrt-v4's thick lens, by paraxial rays). Stops get
  /// the diameter `aperture` (mm), where they are wider. Empty, with the reason in `problem`, where
  /// that cannot be.
  static std::optional<FocusedLens> of(const std::vector<LensElement>& elements, double aperture,
                                       double focus, std::string& problem);

  /// Surfaces from the film to the scene.
  const std::vector<Surface>& surfaces() const { return surfaces_; }
  double rear_z() const { return surfaces_.front().z; }
  /// The distance behind which a pinhole makes pictures of the same size, and where it is.
  double image_distance() const { return image_distance_; }
  double principal_z() const { return principal_z_; }

  /// Returns where a ray from the film leaves the lens; nothing where it does not. `is_clipped`: it
  /// has to pass within the diameters.
  std::optional<CameraRay> trace(CameraRay ray, bool is_clipped = true) const;
  /// Returns the ray from a place of the film, in the plane y = 0, through the middle of the stop.
  CameraRay chief_ray(double film_x) const;
  /// Returns rectangles that hold where rays from (x, 0) of the film pass the plane of the rear
  /// surface, for `count` equal intervals of x in [0, most]; an empty one where none does.
  std::vector<Pupil> pupils(double most, std::size_t count) const;

 private:
  /// Returns where the chief ray passes the plane of the rear surface, if a ray reaches the stop.
  std::optional<double> chief_x(double film_x) const;
  Pupil pupil_at(double film_x) const;
  /// Returns how far from the axis a ray passes the stop.
  std::optional<double> at_stop(double film_x, double rear_x) const;

  std::vector<Surface> surfaces_;
  std::size_t stop_ = 0;
  double image_distance_ = 0, principal_z_ = 0;
};

/// The lens of cameras without a lens file: two equal curves of one glass, 50 mm, behind a stop.
const std::vector<LensElement>& plain_lens();

}  // namespace caplet
