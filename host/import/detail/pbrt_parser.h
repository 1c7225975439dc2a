// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads pbrt-v4 statements in order, keeps the graphics state, and builds the scene. Each directive has one method.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/quotes.h"
#include "base/spelling.h"
#include "import/detail/pbrt_lexer.h"
#include "import/detail/pbrt_lights.h"
#include "import/detail/pbrt_materials.h"
#include "import/detail/pbrt_media.h"
#include "import/detail/pbrt_names.h"
#include "import/detail/pbrt_parameters.h"
#include "import/import.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// Calls `visit` with every material index of a shape.
void each_material(Shape& shape, const std::function<void(std::uint32_t&)>& visit);

class Parser {
 public:
  Parser(std::string main_file, const ImageReader& images)
      : main_file_(std::move(main_file)), images_(images), light_files_(images) {}

  /// Returns the scene of the main file's text. Throws InputError with all errors.
  Imported parse(std::string text);

 private:
  struct Flat {
    SourceLocation where;
    std::string what;
  };
  struct State {
    glm::dmat4 ctm{1};
    std::optional<Flat> flat;           // the first singular transform, which was not multiplied into ctm
    std::optional<Flat> skewed;         // the first transform that is not affine; ctm contains it, for directions only
    std::optional<glm::dmat4> inverse;  // of ctm, if the file states it, so that it need not be computed
    bool reverse_orientation = false;
    ColorSpace space = ColorSpace::srgb;
    std::uint32_t material = 0;  // index into uses_
    std::optional<AreaEmission> emission;
    MediumSides media;  // indices into medium_uses_
    std::map<std::string, SharedParameters> attributes;
  };
  struct Block {
    std::string opener;
    SourceLocation where;
    State saved;
  };
  struct MaterialStatement {
    std::string type, name;
    Parameters parameters;
    std::string refusal = {};  // why a type is not supported yet: an error only where a shape uses it
    SourceLocation where = {};
  };
  /// What shapes refer to until all materials are known: the default, a Material statement, or a name.
  struct MaterialUse {
    std::optional<std::size_t> statement;
    std::string name;
    SourceLocation where;
    std::optional<std::uint32_t> made = {};  // a material of another file, already in the scene
  };
  class MaterialMaking;
  /// For a mix with an interface: the probability of the other material, which becomes an alpha.
  struct PartlyThere {
    TextureOperand amount;
    bool inverted;    // 1 - amount
    bool subsurface;  // the other material contains a medium
  };
  struct MediumStatement {
    Medium medium;
    bool sound = false;
    std::optional<std::uint32_t> index = {};  // in the scene, once it is used
  };
  struct MediumUse {
    std::string name;
    SourceLocation where;
  };
  struct OpenFile {
    std::string name, canonical;
  };
  struct Warning {
    SourceLocation where;
    std::string message, kind;
    std::size_t others = 0;
  };
  struct InstanceUse {
    std::string name;
    glm::dmat4 world_from_object;
    SourceLocation where;
  };
  struct Handler {
    const char* name;
    void (Parser::*run)();
    enum class Allowed { anywhere, options, world } allowed;
  };
  static const std::vector<Handler>& handlers();

  // Reading
  void parse_file(const std::string& file, std::string text, Lexer* behind = nullptr);
  void parse_statement(Unproven& in_file);
  void skip_to_directive();
  std::string string_argument(const char* what);
  double number_argument();
  glm::dvec3 vector_argument();
  glm::dmat4 matrix_argument();
  std::vector<Parameter> own_parameters();
  Parameters parameters(const std::string& owner, const char* attribute_target = nullptr);
  std::string owner(const std::string& type) const { return directive_ + " " + in_quotes(type); }

  // Directives
  void accelerator();
  void active_transform();
  void area_light_source();
  void attribute();
  void attribute_begin();
  void attribute_end();
  void camera();
  void color_space();
  void concat_transform();
  void coord_sys_transform();
  void coordinate_system();
  void film();
  void identity();
  void import();
  void include();
  void integrator();
  void inverse_transform();
  void light_source();
  void look_at();
  void make_named_material();
  void make_named_medium();
  void material();
  void medium_interface();
  void named_material();
  void object_begin();
  void object_end();
  void object_instance();
  void option();
  void pixel_filter();
  void reverse_orientation();
  void rotate();
  void sampler();
  void scale();
  void shape();
  void texture();
  void transform();
  void transform_times();
  void translate();
  void world_begin();

  // Helpers of directives
  void shapes_of_file(const std::string& type, Parameters& given);
  void put_as_stated(Shape& shape, const SourceLocation& where, bool is_instanced) const;
  TextureContext texture_context();
  std::shared_ptr<const TextureImage> texture_image(Parameters& parameters, const char* name, const ImageEncoding& encoding,
                                                    std::string& problem);
  void multiply(const glm::dmat4& matrix);
  /// Reports a singular or non-affine transform before something is placed with it.
  void check_place();
  glm::dmat4 place_of_light(const std::string& type);
  void set_transform(const glm::dmat4& ctm);
  glm::dmat4 inverse_of_transform() const;
  void open_block();
  void close_block(const std::string& opener);
  void report_unclosed(std::size_t first_block);
  std::string included_file();
  void read_included(const std::string& file, Lexer* behind);
  std::uint32_t use_of_name(const std::string& name, const SourceLocation& where);
  const Object* finished_object(const std::string& name, std::string& problem) const;

  /// Warnings are logged at the end: the first of each kind, with the number of the others.
  void warn_of_kind(const SourceLocation& where, const std::string& message, const std::string& kind);

  // End of the scene
  /// Returns "; the nearest known name is ..." for errors that are shown; the search is skipped for the rest, as it is slow.
  template <class Map>
  std::string nearest(const std::string& name, const Map& map) const {
    if (map.empty() || diagnostics_.is_full()) return {};
    std::vector<std::string> known;
    known.reserve(map.size());
    for (const auto& [one, value] : map) known.push_back(one);
    return "; the nearest known name is \"" + nearest_name(name, known) + "\"";
  }
  void log_warnings();
  void finish_attributes();
  std::vector<bool> used_materials();
  std::vector<std::uint32_t> make_materials(const std::vector<bool>& used);
  void resolve_materials();
  void drop_interfaces(const std::vector<std::uint32_t>& index_of_use);
  void make_hair_one_sided();
  void resolve_media();
  void fill_subsurfaces();
  void take_out_interfaces(const std::function<const PartlyThere*(std::uint32_t use)>& partly_there);
  std::uint32_t float_texture(Texture texture);
  MediumSides media_of_csg(const Shape& shape);
  void resolve_instances();

  std::string main_file_;
  const ImageReader& images_;
  LightFiles light_files_;
  Diagnostics diagnostics_;
  std::vector<Warning> warnings_;
  Scene scene_;

  Lexer* lexer_ = nullptr;
  std::string directive_;
  SourceLocation where_;
  std::vector<OpenFile> open_files_;
  std::unordered_set<std::string> files_read_;  // canonical paths
  std::size_t included_files_ = 0, included_again_ = 0;
  State state_;
  std::vector<Block> blocks_;
  std::size_t block_floor_ = 0;  // blocks below this were opened outside the imported file
  bool in_world_ = false, has_camera_ = false, warned_transform_begin_ = false;
  std::optional<std::uint32_t> option_seed_, sampler_seed_;
  std::map<std::string, glm::dmat4> coordinate_systems_;
  std::optional<std::size_t> object_;  // the object that is being defined
  SourceLocation object_where_;
  std::map<std::string, std::uint32_t> object_names_;
  std::vector<InstanceUse> instances_;
  std::vector<MaterialStatement> materials_;
  std::map<std::string, std::size_t> named_materials_;
  std::vector<MaterialUse> uses_{1};
  std::map<std::string, std::uint32_t> uses_by_name_;
  std::map<std::string, MediumStatement> media_;
  std::vector<MediumUse> medium_uses_;
  std::map<std::uint32_t, Medium> media_within_;     // by material of the scene
  std::map<std::size_t, PartlyThere> partly_there_;  // by statement
  TextureTable textures_;
  std::map<std::pair<std::string, ImageEncoding>, std::shared_ptr<const TextureImage>> texture_images_;
  SharedParameters all_attributes_;
  std::set<std::string> said_two_sided_;  // places of shapes whose statements state that they are not one-sided
};

}  // namespace caplet::pbrt
