// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/poses.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/check.h"
#include "base/error.h"
#include "base/spelling.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uint32_t most_poses = 10'000'000;

/// Calls each(line, number) for lines that are not blank.
void for_lines(const fs::path& file, const std::function<void(std::string_view, int)>& each) {
  const TextFile text(file);
  std::string_view rest = text.text();
  for (int number = 1; !rest.empty(); ++number) {
    const std::string_view line = take_line(rest);
    if (line.find_first_not_of(" \t") != std::string_view::npos) each(line, number);
  }
}

/// Parses a line. Throws InputError.
json parsed(std::string_view line, SourceLocation where) {
  try {
    return json::parse(line);
  } catch (const json::parse_error& error) {
    where.column =
        static_cast<int>(std::min<std::size_t>(error.byte, std::numeric_limits<int>::max()));
    throw InputError(where, "this is no JSON object");
  } catch (const json::exception&) {
    throw InputError(where, "a number is too large");
  }
}

double time_of(const json& value, const SourceLocation& where) {
  if (!value.is_number()) throw InputError(where, "time: a number of seconds is needed");
  return value.get<double>();
}

/// PoseReader makes the pose of one line.
class PoseReader {
 public:
  PoseReader(const Scene& scene, SourceLocation where) : scene_(scene), where_(std::move(where)) {}

  ScenePose read(std::string_view line) {
    pose_.where = where_;
    for_keys(parsed(line, where_), "a pose",
             {{"time", [&](const json& value) { pose_.time = time_of(value, where_); }},
              {"shapes", [&](const json& value) { shapes(value); }},
              {"instances", [&](const json& value) { instances(value); }},
              {"capsules", [&](const json& value) { capsules(value); }},
              {"camera", [&](const json& value) { camera(value); }}});
    return std::move(pose_);
  }

 private:
  using Reader = std::function<void(const json&)>;

  [[noreturn]] void fail(const std::string& message) const { throw InputError(where_, message); }

  void for_keys(const json& object, const std::string& what,
                const std::vector<std::pair<std::string, Reader>>& readers) const {
    if (!object.is_object()) fail(what + " is a JSON object");
    for (const auto& [key, value] : object.items()) {
      const auto found = std::ranges::find(readers, key, &std::pair<std::string, Reader>::first);
      if (found != readers.end()) {
        found->second(value);
        continue;
      }
      std::vector<std::string> names;
      for (const auto& [name, reader] : readers) names.push_back(name);
      fail(fmt::format("{} has no '{}'; the nearest is '{}'", what, key, nearest_name(key, names)));
    }
  }

  /// Appends the numbers of arrays within arrays.
  void flatten(const json& value, const std::string& what, std::vector<double>& out,
               int levels = 3) const {
    if (value.is_array() && levels > 0) {
      for (const json& part : value) flatten(part, what, out, levels - 1);
    } else if (value.is_number()) {
      out.push_back(value.get<double>());
    } else {
      fail(what + ": numbers are needed");
    }
  }
  std::vector<double> numbers(const json& value, const std::string& what,
                              std::initializer_list<std::size_t> counts) const {
    std::vector<double> out;
    flatten(value, what, out);
    if (std::ranges::find(counts, out.size()) == counts.end())
      fail(fmt::format("{}: {} numbers are needed, not {}", what, fmt::join(counts, " or "),
                       out.size()));
    return out;
  }
  glm::dvec3 vector(const json& value, const std::string& what) const {
    const std::vector<double> v = numbers(value, what, {3});
    return {v[0], v[1], v[2]};
  }
  glm::dmat4 matrix(const json& value, const std::string& what) const {
    const std::vector<double> v = numbers(value, what, {12, 16});
    glm::dmat4 out(1);
    for (std::size_t i = 0; i < v.size(); ++i)
      out[static_cast<int>(i % 4)][static_cast<int>(i / 4)] = v[i];
    return out;
  }

  std::uint32_t shape(const std::string& name) const {
    std::optional<std::uint32_t> found;
    for (std::size_t i = 0; i < scene_.shapes.size(); ++i) {
      if (scene_.shapes[i].name != name) continue;
      if (found) fail(fmt::format("several shapes are named '{}'", name));
      found = narrow<std::uint32_t>(i);
    }
    if (found) return *found;
    std::vector<std::string> names;
    for (const Shape& one : scene_.shapes)
      if (!one.name.empty()) names.push_back(one.name);
    fail(names.empty()
             ? fmt::format("there is no shape '{}': no shape of the scene has a name", name)
             : fmt::format("there is no shape '{}'; the nearest is '{}'", name,
                           nearest_name(name, names)));
  }

  void add(const std::string& what, SceneEdit edit) {
    try {
      check_edit(scene_, edit);
    } catch (const InputError& error) {
      fail(fmt::format("{}: {}", what, error.what()));
    }
    pose_.edits.push_back(std::move(edit));
  }

  void shapes(const json& value) {
    if (!value.is_object()) fail("shapes is a JSON object");
    for (const auto& [name, to] : value.items()) {
      const std::string what = fmt::format("shape '{}'", name);
      add(what, TransformEdit{{std::nullopt, shape(name)}, matrix(to, what)});
    }
  }

  void instances(const json& value) {
    if (!value.is_object()) fail("instances is a JSON object");
    for (const auto& [name, to] : value.items()) {
      const std::string what = fmt::format("instance '{}'", name);
      std::uint32_t number = 0;
      const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
      if (error != std::errc() || end != name.data() + name.size() ||
          number >= scene_.instances.size())
        fail(fmt::format("there is no instance '{}'; there are {}, from 0", name,
                         scene_.instances.size()));
      add(what, InstanceEdit{number, matrix(to, what)});
    }
  }

  void capsules(const json& value) {
    if (!value.is_object()) fail("capsules is a JSON object");
    for (const auto& [name, to] : value.items()) capsules_of(name, to);
  }
  void capsules_of(const std::string& name, const json& value) {
    const std::string what = fmt::format("capsules of '{}'", name);
    const std::uint32_t number = shape(name);
    const auto* of = std::get_if<CapsulesShape>(&scene_.shapes[number].geometry);
    if (!of) fail(fmt::format("shape '{}' has no capsules", name));
    const std::size_t count = count_of(*of);
    const ShapeAt at{std::nullopt, number};
    std::vector<Capsule> now;
    for (std::size_t i = 0; i < count; ++i) now.push_back(capsule_at(scene_, at, i));
    const auto ends = [&](glm::vec3 Capsule::*end, const char* key) {
      return [&, end, key](const json& given) {
        const std::vector<double> v =
            numbers(given, fmt::format("{} of {}", key, what), {3 * count});
        for (std::size_t i = 0; i < count; ++i)
          now[i].*end = glm::vec3(glm::dvec3(v[3 * i], v[3 * i + 1], v[3 * i + 2]));
      };
    };
    for_keys(
        value, what,
        {{"p0", ends(&Capsule::p0, "p0")},
         {"p1", ends(&Capsule::p1, "p1")},
         {"radius", [&](const json& given) {
            const std::vector<double> v = numbers(given, "radius of " + what, {count, 2 * count});
            const std::size_t each = v.size() / count;
            for (std::size_t i = 0; i < count; ++i) {
              now[i].radius0 = static_cast<float>(v[each * i]);
              now[i].radius1 = static_cast<float>(v[each * i + each - 1]);
            }
          }}});
    for (std::size_t i = 0; i < count; ++i) add(what, CapsuleEdit{at, i, now[i]});
  }

  void camera(const json& value) {
    View view = scene_.view;
    std::optional<glm::dvec3> eye, target, up = scene_.framing.up;
    std::optional<glm::dmat4> place;
    for_keys(value, "camera",
             {{"eye", [&](const json& given) { eye = vector(given, "eye"); }},
              {"target", [&](const json& given) { target = vector(given, "target"); }},
              {"up", [&](const json& given) { up = vector(given, "up"); }},
              {"transform", [&](const json& given) { place = matrix(given, "transform"); }},
              {"fov", [&](const json& given) {
                 const double degrees = numbers(given, "fov", {1})[0];
                 view.camera.projection = PerspectiveProjection{degrees * std::numbers::pi / 180};
               }}});
    if (eye.has_value() != target.has_value()) fail("camera: eye and target go together");
    if (eye && place) fail("camera: transform does not go with eye and target");
    if (eye) {
      pose_.look = LookAt{*eye, *target, up.value_or(glm::dvec3(0, 1, 0))};
      place = camera_looking(*eye, *target, up.value_or(glm::dvec3(0, 1, 0)));
      if (!place)
        fail("the camera has no direction: eye and target coincide, or up lies along the view");
      // As pbrt's LookAt, camera_looking mirrors a right-handed world.
      const bool is_mirrored = !scene_.automatic_camera &&
                               glm::determinant(glm::dmat3(view.camera.world_from_camera)) > 0;
      if (!is_mirrored) (*place)[0] *= -1;
    }
    if (place) {
      view.camera.world_from_camera = *place;
      view.camera.motion.clear();
    }
    add("camera", std::move(view));
  }

  const Scene& scene_;
  SourceLocation where_;
  ScenePose pose_;
};

}  // namespace

PoseCount count_poses(const fs::path& file) {
  PoseCount out;
  for_lines(file, [&](std::string_view line, int number) {
    const SourceLocation where{file.string(), number, 0};
    if (++out.poses > most_poses)
      throw InputError(where, fmt::format("there are more than {} poses", most_poses));
    if (out.poses > 1 && !out.seconds) return;
    const json pose = parsed(line, where);
    const auto time = pose.find("time");
    if (time == pose.end()) {
      if (out.seconds) throw InputError(where, "time is missing, which the poses before have");
      return;
    }
    const double seconds = time_of(*time, where);
    if (out.seconds && !(seconds > out.seconds->second))
      throw InputError(where, fmt::format("time: {} is not after {}, the time of the pose before",
                                          seconds, out.seconds->second));
    out.seconds = {out.seconds ? out.seconds->first : seconds, seconds};
  });
  if (out.poses == 0) throw InputError({file.string(), 0, 0}, "it has no poses");
  return out;
}

std::vector<ScenePose> read_poses(const fs::path& file, const Scene& scene) {
  std::vector<ScenePose> out;
  for_lines(file, [&](std::string_view line, int number) {
    const SourceLocation where{file.string(), number, 0};
    out.push_back(PoseReader(scene, where).read(line));
    if (out.back().time.has_value() != out.front().time.has_value())
      throw InputError(where, "time is in all poses or in none");
  });
  return out;
}

}  // namespace caplet
