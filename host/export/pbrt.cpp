// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Orders the statements. Importers number some things by their own rules (media by use, parts of
// mixes first, interfaces last); they are written in that order, so that a file that is read and
// written again is the same text.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "export/detail/families.h"
#include "export/export.h"
#include "scene/frozen.h"
#include "scene/part_materials.h"
#include "scene/transform.h"

namespace caplet {

namespace fs = std::filesystem;

namespace pbrt_text {

namespace {

class SceneWriter {
 public:
  SceneWriter(const Scene& scene, Stream& stream) : scene_(scene), stream_(stream) {}

  void write() {
    // This lists every field of the scene, so that a new one does not compile without its
    // statement. What only describes the file has none: its contents.
    const auto& [textures, materials, media, shapes, objects, instances, lights, view, source,
                 automatic_camera, has_no_up, framing, world_from_file, unit, legend, contents] =
        scene_;
    const auto& [camera, filter, film, sampler, integrator, clip] = view;
    order_materials();
    order_media();
    name_all();
    stream_.text << written_first_line;
    set_space(stream_, film.space);
    write_times();
    write_camera(camera, clip);
    write_film(film);
    write_filter(filter);
    write_sampler(sampler, integrator);
    stream_.text << "WorldBegin\n";
    if (camera.medium) stream_.text << "MediumInterface \"\" \"\"\n";
    for (const std::uint32_t medium : media_)
      medium_statement(media[medium], names_.media[medium], stream_).write(stream_);
    for (std::uint32_t i = 0; i < textures.size(); ++i)
      if (auto statement = texture_statement(scene_, i, names_, stream_)) statement->write(stream_);
    for (const std::uint32_t i : materials_)
      material_statement(scene_, i, names_, stream_).write(stream_);
    for (const Light& light : lights) light_statement(light, stream_).write(stream_);
    for (std::uint32_t i = 0; i < objects.size(); ++i) write_object(i);
    for (const Shape& shape : shapes) ensure_operands(shape);
    for (const Shape& shape : shapes) write_shape(shape);
    for (const Instance& instance : instances)
      if (is_moving_shape(instance)) write_moving_shape(instance);
    for (const auto& instance : instances) {
      const auto& [object, world_from_object, where, motion, pivot] = instance;
      if (is_moving_shape(instance)) continue;
      stream_.go_on();
      stream_.text << "AttributeBegin\n";
      if (motion.empty())
        stream_.text << transform_of(world_from_object, where);
      else
        stream_.text << motion_text(motion);
      stream_.text << "ObjectInstance " << quoted(names_.objects[object], where)
                   << "\nAttributeEnd\n";
    }
  }

 private:
  // --- Order and names ---

  bool is_interface(std::uint32_t material) const {
    return std::holds_alternative<InterfaceMaterial>(scene_.materials[material].model);
  }

  void order_materials() {
    std::vector<bool> done(scene_.materials.size(), false);
    // Parts come before their mixes; validate() has checked that no mix contains itself.
    std::vector<std::uint32_t> open;
    for (std::uint32_t i = 0; i < done.size(); ++i) {
      open.push_back(i);
      while (!open.empty()) {
        const std::uint32_t at = open.back();
        std::optional<std::uint32_t> before;
        if (const auto* mix = std::get_if<MixMaterial>(&scene_.materials[at].model))
          for (const std::uint32_t part : mix->materials) {
            if (is_interface(part)) refuse(scene_.materials[at].where, "a mix of an interface");
            if (!done[part] && !before) before = part;
          }
        if (before && !done[at]) {
          open.push_back(*before);
          continue;
        }
        open.pop_back();
        if (!done[at] && !is_interface(at)) materials_.push_back(at);
        done[at] = true;
      }
    }
    for (std::uint32_t i = 0; i < done.size() && !interface_; ++i)
      if (is_interface(i)) interface_ = i;
    if (interface_) materials_.push_back(*interface_);
  }

  void order_media() {
    std::vector<bool> seen(scene_.media.size(), false);
    const auto use = [&](const std::optional<std::uint32_t>& medium) {
      if (!medium || seen[*medium]) return;
      seen[*medium] = true;
      media_.push_back(*medium);
    };
    const auto visit = [&](const Shape& shape) {
      use(shape.media.inside);
      use(shape.media.outside);
    };
    use(scene_.view.camera.medium);
    std::ranges::for_each(scene_.shapes, visit);
    for (const Object& object : scene_.objects) std::ranges::for_each(object.shapes, visit);
  }

  bool is_written(std::uint32_t object) const {
    if (is_of_moving_shape_[object]) return false;
    return !scene_.objects[object].shapes.empty() || uses_[object] > 0;
  }

  void name_all() {
    names_.textures.resize(scene_.textures.size());
    NameList of_textures[2], of_materials, of_media;
    for (std::size_t i = 0; i < scene_.textures.size(); ++i)
      names_.textures[i] =
          of_textures[scene_.textures[i].is_float ? 1 : 0].take(scene_.textures[i].name, "texture");
    names_.materials.resize(scene_.materials.size());
    const std::string interface = of_materials.take("interface", "");
    for (const std::uint32_t i : materials_)
      if (!is_interface(i))
        names_.materials[i] = of_materials.take(scene_.materials[i].name, "material");
    for (std::uint32_t i = 0; i < scene_.materials.size(); ++i)
      if (is_interface(i)) names_.materials[i] = interface;
    names_.media.resize(scene_.media.size());
    for (const std::uint32_t i : media_)
      names_.media[i] = of_media.take(scene_.media[i].name, "medium");
    uses_.resize(scene_.objects.size());
    for (const Instance& instance : scene_.instances) ++uses_[instance.object];
    is_of_moving_shape_.resize(scene_.objects.size());
    for (const Instance& instance : scene_.instances)
      if (is_moving_shape(instance)) is_of_moving_shape_[instance.object] = true;
    names_.objects.resize(scene_.objects.size());
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i)
      if (is_written(i)) names_.objects[i] = object_names_.take(scene_.objects[i].name, "object");
  }

  // --- Options ---

  /// Returns when the shutter closes: a number that is read as the same exposure time.
  static double closing_of(const FilmSettings& film) {
    double close = film.shutter_open + film.exposure_time;
    for (const double near : {std::nextafter(close, -HUGE_VAL), std::nextafter(close, HUGE_VAL)})
      if (close - film.shutter_open != film.exposure_time &&
          near - film.shutter_open == film.exposure_time)
        close = near;
    return close;
  }

  std::string here() const { return scene_.source; }

  /// Returns whether an instance is a shape that moves, as importers make it of a Shape statement.
  bool is_moving_shape(const Instance& instance) const {
    const Object& object = scene_.objects[instance.object];
    return !instance.motion.empty() && instance.pivot == glm::dvec3(0) &&
           uses_[instance.object] == 1 && object.shapes.size() == 1 &&
           object.shapes[0].world_from_object == glm::dmat4(1);
  }
  void write_moving_shape(const Instance& instance) {
    stream_.go_on();
    ensure_operands(scene_.objects[instance.object].shapes[0]);
    stream_.text << "AttributeBegin\n";
    stream_.text << motion_text(instance.motion);
    const std::string outer = material_;
    write_shape(scene_.objects[instance.object].shapes[0]);
    material_ = outer;
    stream_.text << "AttributeEnd\n";
  }

  /// Writes where the pivots of all other instances that move are.
  void write_pivots() {
    std::optional<glm::dvec3> pivot;
    const glm::dvec3 of_camera = rendering_origin(scene_.view.camera);
    for (const Instance& instance : scene_.instances) {
      if (instance.motion.empty() || is_moving_shape(instance)) continue;
      if ((instance.pivot != of_camera && instance.pivot != glm::dvec3(0)) ||
          instance.pivot != pivot.value_or(instance.pivot))
        refuse(instance.where, "an instance that turns about a point of its own");
      pivot = instance.pivot;
    }
    if (pivot && *pivot != of_camera)
      stream_.text << "Option \"string rendercoordsys\" \"world\"\n";
  }

  /// Writes the two times of all that moves.
  void write_times() {
    const TransformKeys* first = nullptr;
    const auto add = [&](const TransformKeys& keys, const SourceLocation& where) {
      if (keys.empty()) return;
      if (!first) first = &keys;
      if (keys.size() != 2 || keys[0].time != (*first)[0].time || keys[1].time != (*first)[1].time)
        refuse(where, "a motion of other times than the first one's two");
    };
    add(scene_.view.camera.motion, {here()});
    for (const Instance& instance : scene_.instances) add(instance.motion, instance.where);
    const std::function<void(const Shape&)> add_operands = [&](const Shape& shape) {
      const auto* csg = std::get_if<CsgShape>(&shape.geometry);
      for (std::size_t i = 0; csg && i < csg->operands.size(); ++i) {
        add(csg->motion(i), csg->operands[i]->where);
        add_operands(*csg->operands[i]);
      }
    };
    std::ranges::for_each(scene_.shapes, add_operands);
    for (const Object& object : scene_.objects) std::ranges::for_each(object.shapes, add_operands);
    if (!first) return;
    write_pivots();
    stream_.text << "TransformTimes " << (*first)[0].time << " " << (*first)[1].time << "\n";
  }

  static std::string motion_text(const TransformKeys& motion) {
    return motion_text("Transform " + matrix_text(motion[0].matrix) + "\n",
                       "Transform " + matrix_text(motion[1].matrix) + "\n");
  }
  static std::string motion_text(const std::string& start, const std::string& end) {
    return "ActiveTransform StartTime\n" + start + "ActiveTransform EndTime\n" + end +
           "ActiveTransform All\n";
  }

  void write_camera(const Camera& camera, const std::optional<ClipPlane>& clip) {
    const auto& [world_from_camera, projection, frame_aspect_ratio, screen_window, lens_radius,
                 focal_distance, medium, motion, blades, blade_rotation] = camera;
    const SourceLocation where{here()};
    if (motion.empty())
      stream_.text << inverse_text(world_from_camera);
    else
      stream_.text << motion_text(inverse_text(motion[0].matrix), inverse_text(motion[1].matrix));
    if (medium)
      stream_.text << "MediumInterface \"\" " << quoted(names_.media[*medium], where) << "\n";
    Statement out(std::string("Camera \"") + projection_names.at(projection.index()) + "\"",
                  nullptr, where);
    std::visit([&](const auto& of) { of.fields(of, OptionWriter{out, stream_}); }, projection);
    if (frame_aspect_ratio) out.number(frame_aspect_ratio_field.name, *frame_aspect_ratio);
    if (screen_window) {
      const auto& w = *screen_window;
      out.numbers("float", "screenwindow", {w[0], w[1], w[2], w[3]});
    }
    Camera::fields(camera, OptionWriter{out, stream_});
    if (lens_radius != 0 && is_orthographic(camera))
      out.boolean(Camera::parallel_lens_field.name, true);
    const FilmSettings& film = scene_.view.film;
    if (film.shutter_open != 0) out.number("shutteropen", film.shutter_open);
    if (const double close = closing_of(film); close != 1) out.number("shutterclose", close);
    if (film.readout != 0) out.number(readout_field.name, film.readout);
    if (film.readout_order != 0)
      out.text(readout_order_field.name,
               readout_orders[static_cast<std::size_t>(film.readout_order)]);
    if (scene_.automatic_camera) out.boolean("automatic", true);
    if (scene_.has_no_up) out.boolean("noup", true);
    if (scene_.framing.toward_viewer) out.vector("view", *scene_.framing.toward_viewer);
    if (scene_.framing.up) out.vector("up", *scene_.framing.up);
    if (clip)
      out.numbers("float", "clipplane",
                  {clip->normal.x, clip->normal.y, clip->normal.z, clip->offset});
    if (!scene_.unit.empty()) out.text("unit", scene_.unit);
    if (const glm::dmat3& a = scene_.world_from_file; a != glm::dmat3(1))
      out.numbers("float", "fileaxes",
                  {a[0].x, a[0].y, a[0].z, a[1].x, a[1].y, a[1].z, a[2].x, a[2].y, a[2].z});
    if (scene_.legend) write_legend(*scene_.legend, out);
    out.write(stream_);
  }

  void write_legend(const Legend& legend, Statement& out) {
    const auto& [title, unit, low, high, colors, names, of_directions] = legend;
    out.text("legend", title);
    if (!unit.empty()) out.text("legendunit", unit);
    out.numbers("float", "legendrange", {low, high});
    if (!colors.empty())
      out.list("float", "legendcolors", 3 * colors.size(), [&legend](Text& text, std::size_t i) {
        text << legend.colors[i / 3][static_cast<int>(i % 3)];
      });
    if (!names.empty()) out.texts("legendnames", names);
    if (of_directions) out.boolean("legenddirections", true);
  }

  void write_film(const FilmSettings& film) {
    const auto& [width, height, crop, filename, iso, exposure_time, f_number, shutter_open, readout,
                 readout_order, diagonal, max_component_value, white_balance, space, backdrop,
                 exposure, denoise, matte_levels, least_width] = film;
    const SourceLocation where{here()};
    Statement out("Film \"rgb\"", nullptr, where);
    FilmSettings::fields(film, OptionWriter{out, stream_});
    if (crop) {
      const auto& c = *crop;
      out.list("integer", "pixelbounds", c.size(),
               [&c](Text& text, std::size_t i) { text << std::int64_t{c[i]}; });
    }
    out.text("filename", filename);
    if (backdrop) {
      static constexpr const char* kinds[] = {"transparent", "color", "image"};
      out.text("background", kinds[static_cast<std::size_t>(backdrop->kind)]);
      const glm::dvec3& c = backdrop->color;
      if (backdrop->kind == Backdrop::Kind::color)
        out.numbers("float", "backgroundcolor", {c.x, c.y, c.z});
      if (backdrop->kind == Backdrop::Kind::image)
        out.image("backgroundfile", *backdrop->image, "the backdrop", stream_);
    }
    out.write(stream_);
  }

  /// Writes the fields of options.
  struct OptionWriter {
    Statement& to;
    const Stream& stream;
    void number(const Field& field, double value) {
      if (std::isfinite(value)) to.number(field.name, value);
    }
    void integer(const Field& field, int value) { to.whole(field.name, value); }
    void flag(const Field& field, bool value) { to.boolean(field.name, value); }
    template <class Names>
    void choice(const Field& field, int value, const Names& names) {
      to.text(field.name, names[static_cast<std::size_t>(value)]);
    }
    void field_of_view(double radians) { to.number(fov_field.name, degrees_of(radians)); }
    void lens(const Field& field, const std::shared_ptr<const Lens>& of) {
      if (of) to.file(field.name, of->file, "the camera's lens", stream);
    }
    void aperture(const Field& field, const std::shared_ptr<const ApertureMask>& of) {
      if (!of) return;
      if (std::ranges::find(aperture_names, of->name) != aperture_names.end())
        to.text(field.name, of->name);
      else
        to.file(field.name, of->name, "the camera's aperture", stream);
    }
    void seed(const Field& field, std::uint32_t value) {
      if (value != 0) to.whole(field.name, static_cast<std::int32_t>(value));
    }
  };
  template <class Options>
  void write_option(const char* directive, const char* type, const Options& options) {
    const SourceLocation where{here()};
    Statement out(std::string(directive) + " \"" + type + "\"", nullptr, where);
    Options::fields(options, OptionWriter{out, stream_});
    out.write(stream_);
  }

  void write_filter(const PixelFilter& filter) {
    write_option("PixelFilter", filter_names[static_cast<std::size_t>(filter.kind)], filter);
  }

  void write_sampler(SamplerSettings sampler, const IntegratorSettings& integrator) {
    const std::array<int, 2> strata = strata_of(sampler);
    sampler.x_strata = strata[0];
    sampler.y_strata = strata[1];
    write_option("Sampler", sampler_names[static_cast<std::size_t>(sampler.kind)], sampler);
    write_option("Integrator", integrator_names[static_cast<std::size_t>(integrator.kind)],
                 integrator);
  }

  // --- Shapes ---

  static std::string transform_of(const glm::dmat4& matrix, const SourceLocation& where) {
    if (!has_inverse(matrix) || !is_affine(matrix))
      refuse(where, "the transform has no inverse as importers see it");
    return matrix == glm::dmat4(1) ? std::string() : "Transform " + matrix_text(matrix) + "\n";
  }

  /// Returns the material of the graphics state; none where no surface has it.
  std::optional<std::uint32_t> stated_material(const Shape& shape) const {
    if (!shape.materials.empty() || std::holds_alternative<CsgShape>(shape.geometry))
      return std::nullopt;
    const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
    if (capsules && count_of(*capsules) == 1 && !capsules->materials.empty())
      return capsules->materials[0];
    return shape.material;
  }

  bool is_all_interface(const Shape& shape) const {
    const auto interface = [&](std::uint32_t material) { return is_interface(material); };
    if (!shape.materials.empty()) return std::ranges::all_of(shape.materials, interface);
    if (const auto* csg = std::get_if<CsgShape>(&shape.geometry))
      return std::ranges::all_of(csg->operands,
                                 [&](const auto& operand) { return is_all_interface(*operand); });
    if (const auto* parts = part_materials(shape); parts && !parts->empty())
      return std::ranges::all_of(*parts, interface);
    return is_interface(shape.material);
  }

  ShapeReferences references() {
    return {scene_, names_, [this](const CsgShape& csg, std::size_t operand) {
              return operands_.at(operand_text(*csg.operands[operand], csg.motion(operand)));
            }};
  }

  void use_material(const Shape& shape, std::string& current) {
    const auto material = stated_material(shape);
    if (!material || names_.materials[*material] == current) return;
    current = names_.materials[*material];
    stream_.text << "NamedMaterial " << quoted(current, shape.where) << "\n";
  }

  void write_shape(const Shape& shape) {
    if (interface_ && is_all_interface(shape) && (shape.emission || !shape.media.differ()))
      refuse(shape.where, "a shape that is seen by nothing and parts no media, or emits");
    use_material(shape, material_);
    const std::string transform = transform_of(shape.world_from_object, shape.where);
    const bool is_block = !transform.empty() || shape.emission || shape.reverse_orientation ||
                          shape.media != MediumSides{};
    const ColorSpace space = stream_.space;
    if (is_block) stream_.text << "AttributeBegin\n" << transform;
    if (shape.media != MediumSides{}) {
      const auto name = [&](const std::optional<std::uint32_t>& medium) {
        return quoted(medium ? names_.media[*medium] : std::string(), shape.where);
      };
      stream_.text << "MediumInterface " << name(shape.media.inside) << " "
                   << name(shape.media.outside) << "\n";
    }
    if (shape.reverse_orientation) stream_.text << "ReverseOrientation\n";
    if (shape.emission) area_statement(*shape.emission, shape.where, stream_).write(stream_);
    shape_statement(shape, references()).write(stream_);
    if (!is_block) return;
    stream_.text << "AttributeEnd\n";
    stream_.space = space;
  }

  /// Returns a text that differs between different operands.
  std::string operand_text(const Shape& shape, const TransformKeys& motion) {
    return text_of([&](Text& text) {
      Stream aside{text, stream_.folder, {}};
      if (const auto material = stated_material(shape))
        text << "NamedMaterial " << quoted(names_.materials[*material], shape.where) << "\n";
      text << operand_transform(shape, motion);
      shape_statement(shape, references(), true).write(aside);
    });
  }

  std::string operand_transform(const Shape& shape, const TransformKeys& motion) {
    if (motion.empty()) return transform_of(shape.world_from_object, shape.where);
    return motion_text(motion);
  }

  /// Writes every operand of a csg shape as an object before the csg.
  void ensure_operands(const Shape& shape) {
    const auto* csg = std::get_if<CsgShape>(&shape.geometry);
    if (!csg) return;
    for (std::size_t i = 0; i < csg->operands.size(); ++i) {
      const std::shared_ptr<const Shape>& operand = csg->operands[i];
      ensure_operands(*operand);
      const std::string text = operand_text(*operand, csg->motion(i));
      const auto [found, fresh] = operands_.try_emplace(text);
      if (!fresh) continue;
      found->second = object_names_.take("", "operand");
      stream_.text << "ObjectBegin " << quoted(found->second, operand->where) << "\n";
      const std::string outer = material_;
      use_material(*operand, material_);
      const std::string transform = operand_transform(*operand, csg->motion(i));
      if (!transform.empty()) stream_.text << "AttributeBegin\n" << transform;
      Statement statement = shape_statement(*operand, references(), true);
      if (is_hair(scene_, *operand) && !operand->one_sided) statement.boolean("onesided", false);
      statement.write(stream_);
      stream_.text << (transform.empty() ? "" : "AttributeEnd\n") << "ObjectEnd\n";
      material_ = outer;
    }
  }

  bool may_be_operand(const Object& object) const {
    if (object.shapes.size() != 1) return false;
    const Shape& shape = object.shapes[0];
    const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
    return is_closed(shape) && !(capsules && count_of(*capsules) != 1) && !shape.emission &&
           !shape.reverse_orientation && !shape.alpha &&
           (!shape.one_sided || is_hair(scene_, shape));
  }

  void write_object(std::uint32_t index) {
    const auto& [name, shapes, where] = scene_.objects[index];
    if (!is_written(index)) return;
    for (const Shape& shape : shapes) ensure_operands(shape);
    stream_.text << "ObjectBegin " << quoted(names_.objects[index], where) << "\n";
    const std::string outer = material_;
    for (const Shape& shape : shapes) write_shape(shape);
    material_ = outer;
    stream_.text << "ObjectEnd\n";
    if (may_be_operand(scene_.objects[index]))
      operands_.try_emplace(operand_text(shapes[0], {}), names_.objects[index]);
  }

  const Scene& scene_;
  Stream& stream_;
  Names names_;
  NameList object_names_;
  std::vector<std::uint32_t> materials_, media_;  // in the order of writing
  std::optional<std::uint32_t> interface_;
  std::vector<std::size_t> uses_;                // instances of each object
  std::vector<bool> is_of_moving_shape_;         // objects that are no more than such a shape
  std::string material_;                         // in the graphics state
  std::map<std::string, std::string> operands_;  // names of objects by their text
};

}  // namespace

}  // namespace pbrt_text

namespace {

void write_text(const Scene& scene, const fs::path& folder,
                const std::function<void(std::string_view)>& sink,
                const std::function<bool()>& cancelled, pbrt_text::ImageFiles* images) {
  Diagnostics diagnostics;
  validate(scene, diagnostics);
  diagnostics.finish();
  pbrt_text::Text text(sink);
  pbrt_text::Stream stream{text, fs::weakly_canonical(fs::absolute(folder)), cancelled, images};
  pbrt_text::SceneWriter(scene, stream).write();
  text.flush();
}

/// Writes the scene's text as a file.
void write_file(const Scene& scene, const fs::path& file, const fs::path& folder,
                const std::function<bool()>& cancelled, pbrt_text::ImageFiles* images) {
  write_atomically(file, [&](const fs::path& path) {
    struct Close {
      void operator()(std::FILE* open) const { std::fclose(open); }
    };
    std::unique_ptr<std::FILE, Close> out(std::fopen(path.c_str(), "wb"));
    const auto failed = [&] {
      throw RunError(file.string() + ": cannot be written (" +
                     std::generic_category().message(errno) + ")");
    };
    if (!out) failed();
    write_text(
        scene, folder,
        [&](std::string_view piece) {
          if (std::fwrite(piece.data(), 1, piece.size(), out.get()) != piece.size()) failed();
        },
        cancelled, images);
    if (std::fclose(out.release()) != 0) failed();
  });
}

}  // namespace

void write_pbrt(const Scene& scene, const fs::path& folder,
                const std::function<void(std::string_view)>& sink,
                const std::function<bool()>& cancelled) {
  write_text(scene, folder, sink, cancelled, nullptr);
}

void write_scene(const Scene& scene, const fs::path& file, const std::function<bool()>& cancelled,
                 const ImageWriter* images) {
  if (file.extension() != ".pbrt" && !is_stream(file))
    throw InputError(SourceLocation{file.string()},
                     "scenes are written as pbrt text, to a file .pbrt");
  const fs::path folder = is_stream(file) ? fs::path(".") : fs::absolute(file).parent_path();
  std::optional<pbrt_text::ImageFiles> written;
  if (images != nullptr && !is_stream(file)) written.emplace(*images, fs::absolute(file));
  try {
    write_file(scene, file, folder, cancelled, written ? &*written : nullptr);
  } catch (...) {
    if (written) written->remove();
    throw;
  }
}

}  // namespace caplet
