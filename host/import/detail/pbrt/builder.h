// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Builds a scene from pbrt's statements: keeps the graphics state, and resolves at the end what
// only then is known.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "import/detail/pbrt/draft.h"
#include "import/detail/pbrt/lights.h"
#include "import/detail/pbrt/state.h"
#include "import/detail/pbrt/target.h"
#include "import/import.h"

namespace caplet::pbrt {

/// The four parts of the builder share this.
struct Building {
  Draft draft;
  GraphicsState state = {};
  std::map<std::string, std::array<glm::dmat4, 2>> coordinate_systems = {};  // at both times
  std::array<double, 2> transform_times = {0, 1};
  bool renders_in_world = false;  // Option "rendercoordsys"
  LightFiles light_files{draft.images};
  std::optional<std::uint32_t> option_seed = {}, sampler_seed = {};
  bool in_world = false, has_camera = false;

  /// Joins a statement's own parameters with the attributes of its target (none: "").
  Parameters parameters(const Statement& at, const std::string& owner, ParameterList own,
                        std::string_view attribute_target = {});
  /// Returns the statement's own parameters with the state's colour space, and warns of duplicates.
  ParameterList taken(ParameterList own);
  /// As check_name of names.h.
  bool check_type(const Statement& at, const std::string& type);
  void check_place() { state.transform.check_place(draft.diagnostics); }
  /// Returns the keys of the current transform; none where it rests.
  TransformKeys keys() const;
  /// Warns where the current transform moves that `what` stays where it is at the start.
  void warn_that_stays(const Statement& at, const std::string& what);
};

class OptionBuilder : public OptionTarget {
 public:
  explicit OptionBuilder(Building& building) : to_(building) {}
  void accelerator(const Statement& at, const std::string& type, ParameterList own) override;
  void camera(const Statement& at, const std::string& type, ParameterList own) override;
  void film(const Statement& at, const std::string& type, ParameterList own) override;
  void integrator(const Statement& at, const std::string& type, ParameterList own) override;
  void option(const Statement& at, const std::string& name, const Token& value) override;
  void pixel_filter(const Statement& at, const std::string& type, ParameterList own) override;
  void sampler(const Statement& at, const std::string& type, ParameterList own) override;

 private:
  Building& to_;
};

class TransformBuilder : public TransformTarget {
 public:
  explicit TransformBuilder(Building& building) : to_(building) {}
  void active_transform(const Statement& at, const Word& which) override;
  void concat_transform(const Statement& at, const glm::dmat4& matrix) override;
  void coord_sys_transform(const Statement& at, const Word& name) override;
  void coordinate_system(const Statement& at, const Word& name) override;
  void identity(const Statement& at) override;
  void inverse_transform(const Statement& at, const glm::dmat4& matrix) override;
  void look_at(const Statement& at, const glm::dvec3& eye, const glm::dvec3& target,
               const glm::dvec3& up) override;
  void rotate(const Statement& at, double degrees, const glm::dvec3& axis) override;
  void scale(const Statement& at, const glm::dvec3& factors) override;
  void transform(const Statement& at, const glm::dmat4& matrix) override;
  void transform_times(const Statement& at, double start, double end) override;
  void translate(const Statement& at, const glm::dvec3& offset) override;

 private:
  template <class Change>
  void each_active(const Change& change) {
    to_.state.transform.each_active(change);
  }

  Building& to_;
};

/// The files that Include and Import name.
class Includes {
 public:
  Includes(const std::string& main_file, Diagnostics& diagnostics);
  /// Finds the file. Throws SyntaxError where files include themselves, or too many each other.
  void begin(const Statement& at, const Word& name);
  /// Parses the file that was opened, and closes it.
  void read(const Word& name, const ParseText& parse);

 private:
  struct OpenFile {
    std::string name, canonical;
  };

  const std::string& main_file_;
  Diagnostics& diagnostics_;
  std::vector<OpenFile> open_files_;
  std::unordered_set<std::string> files_read_;  // canonical paths
  std::size_t included_files_ = 0, included_again_ = 0;
};

class StateBuilder : public StateTarget {
 public:
  explicit StateBuilder(Building& building);
  void attribute(const Statement& at, const Word& target, ParameterList own) override;
  void attribute_begin(const Statement& at) override;
  void attribute_end(const Statement& at) override;
  void color_space(const Statement& at, const Word& name) override;
  void import(const Statement& at, const Word& file, const ParseText& parse) override;
  void include(const Statement& at, const Word& file, const ParseText& parse) override;
  void object_begin(const Statement& at, const std::string& name) override;
  void object_end(const Statement& at) override;
  void object_instance(const Statement& at, const std::string& name) override;
  void reverse_orientation(const Statement& at) override;
  void transform_begin(const Statement& at) override;
  void transform_end(const Statement& at) override;
  void world_begin(const Statement& at) override;
  /// Closes the open blocks of the file and reports them.
  void report_unclosed();

 private:
  Building& to_;
  Includes includes_;
  Blocks blocks_;
  bool warned_transform_begin_ = false;
};

class SceneBuilder : public SceneTarget {
 public:
  explicit SceneBuilder(Building& building) : to_(building), draft_(building.draft) {}
  void area_light_source(const Statement& at, const std::string& type, ParameterList own) override;
  void light_source(const Statement& at, const std::string& type, ParameterList own) override;
  void make_named_material(const Statement& at, const std::string& name,
                           ParameterList own) override;
  void make_named_medium(const Statement& at, const std::string& name, ParameterList own) override;
  void material(const Statement& at, const std::string& type, ParameterList own) override;
  void medium_interface(const Statement& at, const Word& inside,
                        const std::optional<Word>& outside) override;
  void named_material(const Statement& at, const Word& name) override;
  void shape(const Statement& at, const std::string& type, ParameterList own) override;
  void texture(const Statement& at, const std::string& name, const Word& kind,
               const Word& texture_class, ParameterList own) override;

 private:
  std::optional<std::uint32_t> side_of(const Word& medium);
  FinishedObject finished_object(const std::string& name, std::string& problem) const;

  Building& to_;
  Draft& draft_;
};

/// Adds the shapes of a file in another format: Shape "file" and "swc" (pbrt/file_shapes.cpp).
void add_shapes_of_file(const Statement& at, const std::string& type, Parameters& given,
                        Building& to);

class Builder {
 public:
  Builder(std::string main_file, const ImageReader& images);
  Diagnostics& diagnostics() { return building_.draft.diagnostics; }
  Target target() { return {options_, transforms_, states_, scenes_}; }
  /// Resolves what is left. `needs_light`: warns of a scene that has a camera and no light. Throws
  /// InputError with all errors.
  Imported finish(bool needs_light = true);

 private:
  Building building_;
  OptionBuilder options_{building_};
  TransformBuilder transforms_{building_};
  StateBuilder states_{building_};
  SceneBuilder scenes_{building_};
};

}  // namespace caplet::pbrt
