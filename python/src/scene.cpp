// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes: reading, writing, building, editing.
#include <caplet/import.h>
#include <caplet/write.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>

#include "binding.h"

namespace caplet_python {

namespace {

/// (height, width, channels).
std::shared_ptr<const caplet::Pixels> pixels_of(const Array& array) {
  if (array.ndim() != 3 || array.dtype() != nb::dtype<float>())
    throw nb::type_error("an image of 32-bit floats");
  auto out = std::make_shared<caplet::Pixels>();
  const std::size_t tall = array.shape(0), wide = array.shape(1), channels = array.shape(2);
  if (tall > std::size_t{1} << 20 || wide > std::size_t{1} << 20 || channels > 4)
    throw nb::value_error("an image of another shape");
  out->height = static_cast<int>(tall);
  out->width = static_cast<int>(wide);
  out->channels = static_cast<int>(channels);
  out->values.resize(tall * wide * channels);
  const auto* data = static_cast<const float*>(array.data());
  const auto at = [&](std::size_t y, std::size_t x, std::size_t c) {
    return data[static_cast<std::int64_t>(y) * array.stride(0) +
                static_cast<std::int64_t>(x) * array.stride(1) +
                static_cast<std::int64_t>(c) * array.stride(2)];
  };
  std::size_t i = 0;
  for (std::size_t y = 0; y < tall; ++y)
    for (std::size_t x = 0; x < wide; ++x)
      for (std::size_t c = 0; c < channels; ++c) out->values[i++] = at(y, x, c);
  return out;
}

caplet::Parameter parameter_of(nb::handle value) {
  if (nb::isinstance<nb::bool_>(value)) return nb::cast<bool>(value);
  if (nb::isinstance<nb::str>(value)) return nb::cast<std::string>(value);
  if (nb::isinstance<nb::float_>(value) || nb::isinstance<nb::int_>(value))
    return nb::cast<double>(value);
  if (nb::isinstance<nb::list>(value)) return nb::cast<std::vector<std::string>>(value);
  if (nb::isinstance<nb::tuple>(value)) {
    const auto tuple = nb::cast<nb::tuple>(value);
    const auto word = nb::cast<std::string>(tuple[0]);
    if (word == "texture") return caplet::TextureNumber{nb::cast<std::uint32_t>(tuple[1])};
    if (word == "blackbody") return caplet::Blackbody{nb::cast<double>(tuple[1])};
    if (word == "materials")
      return std::array<std::uint32_t, 2>{nb::cast<std::uint32_t>(tuple[1]),
                                          nb::cast<std::uint32_t>(tuple[2])};
    if (word == "pixels") return pixels_of(nb::cast<Array>(tuple[1]));
    if (word == "rgb")
      return caplet::Rgb{nb::cast<double>(tuple[1]), nb::cast<double>(tuple[2]),
                         nb::cast<double>(tuple[3])};
  }
  if (nb::ndarray_check(value)) {
    const auto array = nb::cast<Array>(value);
    std::vector<double> numbers(array.ndim() == 1 ? array.shape(0) : 0);
    with_floats(array, [&](auto read) {
      for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = read(i, 0);
    });
    if (numbers.size() == 3) return std::array<double, 3>{numbers[0], numbers[1], numbers[2]};
    return numbers;
  }
  throw nb::type_error(
      "a parameter is a number, a text, a switch, an array, a list of texts or a tuple of a word "
      "and what it is of");
}

/// The same of values for many shapes, which stay in their array.
caplet::Parameters each_of(const nb::dict& given) {
  caplet::Parameters out;
  for (const auto& [name, value] : given) {
    const auto array = nb::cast<Array>(value);
    std::vector<double> numbers(array.shape(0));
    with_floats(array, [&](auto read) {
      for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = read(i, 0);
    });
    out[nb::cast<std::string>(name)] = std::move(numbers);
  }
  return out;
}

caplet::ShapeOptions options_of(const nb::dict& given) {
  caplet::ShapeOptions out;
  const auto has = [&](const char* name) { return given.contains(name) && !given[name].is_none(); };
  if (has("name")) out.name = nb::cast<std::string>(given["name"]);
  if (has("object")) out.object = nb::cast<std::string>(given["object"]);
  if (has("transform")) out.transform = transform_of(nb::cast<Array>(given["transform"]));
  if (has("materials")) out.materials = nb::cast<std::vector<std::uint32_t>>(given["materials"]);
  if (has("emission")) out.emission = parameters_of(nb::cast<nb::dict>(given["emission"]));
  if (has("inside")) out.inside = nb::cast<std::uint32_t>(given["inside"]);
  if (has("outside")) out.outside = nb::cast<std::uint32_t>(given["outside"]);
  if (has("reverse_orientation"))
    out.reverse_orientation = nb::cast<bool>(given["reverse_orientation"]);
  return out;
}

/// (n, 3, 4) of 64-bit floats, one behind the other.
std::vector<caplet::Transform> transforms_of(const Array& array) {
  if (array.ndim() != 2 || array.shape(1) != 12) throw nb::value_error("an array of another shape");
  std::vector<caplet::Transform> out(array.shape(0));
  with_floats(array, [&](auto read) {
    for (std::size_t i = 0; i < out.size(); ++i)
      for (std::size_t k = 0; k < 12; ++k) out[i][k] = read(i, k);
  });
  return out;
}

caplet::CapsuleArrays capsules_of(const Array& p0, const Array& p1, const Array& radius0,
                                  const std::optional<Array>& radius1,
                                  const std::optional<Array>& materials,
                                  const std::optional<Array>& u, std::size_t count,
                                  const std::vector<double>& times = {}) {
  caplet::CapsuleArrays out;
  out.times = times;
  out.p0 = rows_of<3>(p0, count);
  out.p1 = rows_of<3>(p1, count);
  out.radius0 = floats_of(radius0, count);
  if (radius1) out.radius1 = floats_of(*radius1, count);
  if (materials) out.materials = numbers_of(*materials);
  if (u) out.u = rows_of<2>(*u, count / std::max<std::size_t>(1, times.size()));
  return out;
}

template <std::size_t K>
nb::ndarray<nb::numpy, float, nb::ndim<2>> rows_array(
    const std::vector<std::array<float, K>>& rows) {
  std::vector<float> flat(K * rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy(rows[i].begin(), rows[i].end(), flat.begin() + static_cast<std::ptrdiff_t>(K * i));
  return array_of<float, 2>(std::move(flat), {rows.size(), K});
}

nb::ndarray<nb::numpy, double, nb::ndim<2>> transform_array(const caplet::Transform& transform) {
  std::vector<double> flat(transform.begin(), transform.end());
  for (const double last : {0, 0, 0, 1}) flat.push_back(last);
  return array_of<double, 2>(std::move(flat), {4, 4});
}

caplet::Statement statement_named(const std::string& name) {
  using caplet::Statement;
  static const std::vector<std::pair<const char*, Statement>> names = {
      {"shape", Statement::shape},           {"light", Statement::light},
      {"emission", Statement::emission},     {"medium", Statement::medium},
      {"camera", Statement::camera},         {"film", Statement::film},
      {"filter", Statement::filter},         {"sampler", Statement::sampler},
      {"integrator", Statement::integrator}, {"material", Statement::material},
      {"texture", Statement::texture}};
  for (const auto& [known, statement] : names)
    if (name == known) return statement;
  throw nb::value_error("no such kind of statement");
}

/// The same for a HeldScene, when it is this thread's turn.
template <class Use, class Return, class Self, class... Arguments>
auto in_turn(const Use& use, Return (Use::*)(Self&, Arguments...) const) {
  static_assert(!std::is_reference_v<Return>, "it would point into what other threads change");
  return [use](HeldScene& held, Arguments... arguments) -> Return {
    const Turn turn(held.lock);
    return use(held.scene, std::forward<Arguments>(arguments)...);
  };
}
template <class Use>
auto in_turn(const Use& use) {
  return in_turn(use, &Use::operator());
}
template <class Return, class... Arguments>
auto in_turn(Return (caplet::Scene::*use)(Arguments...)) {
  return in_turn([use](caplet::Scene& scene, Arguments... arguments) -> Return {
    return (scene.*use)(std::forward<Arguments>(arguments)...);
  });
}
template <class Return, class... Arguments>
auto in_turn(Return (caplet::Scene::*use)(Arguments...) const) {
  return in_turn([use](caplet::Scene& scene, Arguments... arguments) -> Return {
    return (scene.*use)(std::forward<Arguments>(arguments)...);
  });
}

nb::object triple(const std::array<double, 3>& v) { return nb::make_tuple(v[0], v[1], v[2]); }

}  // namespace

caplet::Parameters parameters_of(const nb::dict& given) {
  caplet::Parameters out;
  for (const auto& [name, value] : given) out[nb::cast<std::string>(name)] = parameter_of(value);
  return out;
}

caplet::Transform transform_of(const Array& rows) {
  if (rows.ndim() != 1 || rows.shape(0) != 12) throw nb::value_error("an array of another shape");
  caplet::Transform out{};
  with_floats(rows, [&](auto read) {
    for (std::size_t k = 0; k < 12; ++k) out[k] = read(k, 0);
  });
  return out;
}

std::vector<float> floats_of(const Array& array, std::size_t count) {
  if (array.ndim() != 1 || (array.shape(0) != count && array.shape(0) != 1))
    throw nb::value_error("an array of another shape");
  std::vector<float> out(count);
  const std::size_t step = array.shape(0) == 1 ? 0 : 1;
  with_floats(array, [&](auto read) {
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<float>(read(i * step, 0));
  });
  return out;
}

std::vector<std::uint32_t> numbers_of(const Array& array) {
  if (array.ndim() != 1 || array.dtype() != nb::dtype<std::uint32_t>())
    throw nb::type_error("an array of 32-bit unsigned integers");
  std::vector<std::uint32_t> out(array.shape(0));
  with_rows<std::uint32_t>(array, [&](auto read) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = read(i, 0);
  });
  return out;
}

namespace {

using caplet::Scene;

/// Binds what is known without a scene: types and parameters of statements, formats, files.
void bind_lists(nb::module_& m) {
  m.def("statement_types",
        [](const std::string& kind) { return caplet::statement_types(statement_named(kind)); });
  m.def("statement_parameters", [](const std::string& kind, const std::string& type) {
    nb::list out;
    for (const caplet::KnownParameter& one :
         caplet::statement_parameters(statement_named(kind), type)) {
      nb::dict row;
      row["name"] = one.name;
      row["types"] = one.types;
      row["doc"] = one.doc;
      row["default"] = one.fallback;
      row["low"] = one.low;
      row["high"] = one.high;
      row["above_low"] = one.above_low;
      row["unit"] = one.unit;
      row["choices"] = one.choices;
      row["excludes"] = one.excludes;
      row["has_effect"] = one.has_effect;
      out.append(row);
    }
    return out;
  });
  m.def("color_map", [](double part) {
    const caplet::Rgb color = caplet::color_map(part);
    return nb::make_tuple(color.r, color.g, color.b);
  });
  m.def("formats", [] {
    std::vector<std::pair<std::string, std::vector<std::string>>> out;
    for (const caplet::SceneFormat& format : caplet::scene_formats())
      out.emplace_back(format.name, format.extensions);
    return out;
  });
  m.def(
      "load",
      [](const std::string& file, const std::map<std::string, std::string>& options) {
        std::optional<Scene> scene;
        run_interruptibly([&] { scene = caplet::import_scene(file, options); }, [] {}, [] {});
        return HeldScene(*std::move(scene));
      },
      nb::arg("file"), nb::arg("options") = std::map<std::string, std::string>(),
      "Reads a scene of any known format.");
}

/// Binds copies, counts, options, size and camera of a scene.
void bind_settings(nb::class_<HeldScene>& held) {
  held.def(nb::init<>())
      .def("copy", [](HeldScene& held) { return HeldScene(held.now()); })
      .def("save",
           [](HeldScene& held, const std::string& file) {
             const Scene scene = held.now();
             const Released released;
             caplet::write_scene(scene, file);
           })
      .def("bounds", in_turn([](const Scene& scene) {
             const caplet::Bounds bounds = scene.bounds();
             return nb::make_tuple(triple(bounds.min), triple(bounds.max));
           }))
      .def("primitives", in_turn(&Scene::primitives))
      .def("materials", in_turn(&Scene::materials))
      .def("media", in_turn(&Scene::media))
      .def("objects", in_turn(&Scene::objects))
      .def("shapes", in_turn(&Scene::shapes))
      .def("shape", in_turn(&Scene::shape))
      .def("shape_in", in_turn(&Scene::shape_in))
      .def("place", in_turn(&Scene::place))
      .def_prop_ro("width", in_turn(&Scene::width))
      .def_prop_ro("height", in_turn(&Scene::height))
      .def("set_size", in_turn(&Scene::set_size))
      .def("set_crop", in_turn(&Scene::set_crop))
      .def("widen_to_least", in_turn(&Scene::widen_to_least))
      .def_prop_rw("spp", in_turn(&Scene::samples_per_pixel),
                   in_turn(&Scene::set_samples_per_pixel))
      .def_prop_ro("noise", in_turn(&Scene::noise))
      .def_prop_ro("noise_target", in_turn([](const Scene& scene) {
                     const std::optional<caplet::NoiseTarget> target = scene.noise_target();
                     using Parts = std::tuple<double, int, int, bool>;
                     return target ? std::optional(Parts(target->noise, target->least_samples,
                                                         target->most_samples, target->in_display))
                                   : std::nullopt;
                   }))
      .def_prop_rw("max_depth", in_turn(&Scene::max_depth), in_turn(&Scene::set_max_depth))
      .def_prop_rw("seed", in_turn(&Scene::seed), in_turn(&Scene::set_seed))
      .def_prop_ro("lights", in_turn(&Scene::lights))
      .def_prop_ro("instances", in_turn(&Scene::instances))
      .def("capsules", in_turn(&Scene::capsules))
      .def("present", in_turn([](Scene& scene) {
             const Released released;
             scene.present();
           }))
      .def("look_at", in_turn(&Scene::look_at))
      .def_prop_ro("fov", in_turn(&Scene::fov))
      .def("set_fov", in_turn(&Scene::set_fov))
      .def("camera", in_turn([](const Scene& scene) { return transform_array(scene.camera()); }))
      .def("set_camera", in_turn([](Scene& scene, const std::string& type, const nb::dict& given,
                                    const Array& transform) {
             scene.set_camera(type, parameters_of(given), transform_of(transform));
           }))
      .def_prop_rw("unit", in_turn(&Scene::unit), in_turn(&Scene::set_unit))
      .def("set_color_bar", in_turn(&Scene::set_color_bar))
      .def("set_camera_medium", in_turn(&Scene::set_camera_medium), nb::arg("medium").none())
      .def("set_option", in_turn([](Scene& scene, const std::string& kind, const std::string& type,
                                    const nb::dict& given) {
             scene.set_option(statement_named(kind), type, parameters_of(given));
           }));
}

/// Binds places, materials, textures, media and lights.
void bind_statements(nb::class_<HeldScene>& held) {
  held.def("transform", in_turn([](const Scene& scene, std::uint32_t shape) {
             return transform_array(scene.transform(shape));
           }))
      .def("set_transform", in_turn([](Scene& scene, std::uint32_t shape, const Array& to) {
             scene.set_transform(shape, transform_of(to));
           }))
      .def("instance", in_turn([](const Scene& scene, std::uint32_t number) {
             return transform_array(scene.instance(number));
           }))
      .def("set_instance", in_turn([](Scene& scene, std::uint32_t number, const Array& to) {
             scene.set_instance(number, transform_of(to));
           }))
      .def("set_instance_motion",
           in_turn([](Scene& scene, std::uint32_t number, const std::vector<double>& times,
                      const Array& transforms, const std::array<double, 3>& pivot) {
             scene.set_instance_motion(number, times, transforms_of(transforms), pivot);
           }))
      .def("set_operand_motion",
           in_turn([](Scene& scene, std::uint32_t shape, std::size_t operand,
                      const std::vector<double>& times, const Array& transforms) {
             scene.set_operand_motion(shape, operand, times, transforms_of(transforms));
           }))
      .def("set_shutter", in_turn(&Scene::set_shutter))
      .def("set_camera_motion",
           in_turn([](Scene& scene, const std::vector<double>& times, const Array& transforms) {
             scene.set_camera_motion(times, transforms_of(transforms));
           }))
      .def("add_instances",
           in_turn([](Scene& scene, const std::string& object, const Array& transforms) {
             return scene.add_instances(object, transforms_of(transforms));
           }))
      .def("add_material", in_turn([](Scene& scene, const std::string& name,
                                      const std::string& type, const nb::dict& given) {
             return scene.add_material(name, caplet::NamedMaterial{type, parameters_of(given)});
           }))
      .def("set_material", in_turn([](Scene& scene, std::uint32_t number, const std::string& type,
                                      const nb::dict& given) {
             scene.set_material(number, caplet::NamedMaterial{type, parameters_of(given)});
           }))
      .def("add_texture", in_turn([](Scene& scene, const std::string& type, bool is_float,
                                     const nb::dict& given, const Array& transform) {
             return scene
                 .add_texture({type, is_float, parameters_of(given), transform_of(transform)})
                 .number;
           }))
      .def("add_medium", in_turn([](Scene& scene, const std::string& name, const std::string& type,
                                    const nb::dict& given, const Array& transform) {
             return scene.add_medium(name, type, parameters_of(given), transform_of(transform));
           }))
      .def("add_light", in_turn([](Scene& scene, const std::string& type, const nb::dict& given,
                                   const Array& transform) {
             return scene.add_light(type, parameters_of(given), transform_of(transform));
           }))
      .def("remove_lights", in_turn(&Scene::remove_lights))
      .def("light_scale", in_turn(&Scene::light_scale))
      .def("set_light", in_turn([](Scene& scene, std::uint32_t light,
                                   const std::array<double, 3>& rgb, double scale) {
             scene.set_light(light, caplet::Rgb{rgb[0], rgb[1], rgb[2]}, scale);
           }))
      .def("set_emission", in_turn([](Scene& scene, std::uint32_t shape,
                                      const std::array<double, 3>& rgb, double scale) {
             scene.set_emission(shape, caplet::Rgb{rgb[0], rgb[1], rgb[2]}, scale);
           }))
      .def("set_shape_materials", in_turn(&Scene::set_shape_materials));
}

/// Binds shapes by parameters, and capsules by arrays.
void bind_shapes(nb::class_<HeldScene>& held) {
  held.def("add_shape", in_turn([](Scene& scene, const std::string& type, const nb::dict& given,
                                   const nb::dict& options) {
             return scene.add_shape(type, parameters_of(given), options_of(options));
           }))
      .def("add_shapes",
           in_turn([](Scene& scene, const std::string& type, std::size_t count,
                      const nb::dict& shared, const nb::dict& each,
                      const std::optional<Array>& transforms, const std::optional<Array>& materials,
                      const nb::dict& options) {
             const caplet::Parameters of_all = parameters_of(shared), of_each = each_of(each);
             const caplet::ShapeOptions given = options_of(options);
             std::vector<caplet::Transform> places;
             if (transforms) places = transforms_of(*transforms);
             std::vector<std::uint32_t> numbers;
             if (materials) numbers = numbers_of(*materials);
             const Released released;
             return scene.add_shapes(type, count, of_all, of_each, places, numbers, given);
           }),
           nb::arg("type"), nb::arg("count"), nb::arg("shared"), nb::arg("each"),
           nb::arg("transforms").none(), nb::arg("materials").none(), nb::arg("options"))
      .def("add_capsules",
           in_turn([](Scene& scene, std::size_t count, const Array& p0, const Array& p1,
                      const Array& radius0, const std::optional<Array>& radius1,
                      const std::optional<Array>& materials, const std::optional<Array>& u,
                      const nb::dict& options) {
             const caplet::ShapeOptions given = options_of(options);
             const Released released;
             return scene.add_capsules(capsules_of(p0, p1, radius0, radius1, materials, u, count),
                                       given);
           }),
           nb::arg("count"), nb::arg("p0"), nb::arg("p1"), nb::arg("radius0"),
           nb::arg("radius1").none(), nb::arg("materials").none(), nb::arg("u").none(),
           nb::arg("options"))
      .def(
          "add_molecular_surface",
          in_turn([](Scene& scene, std::size_t count, const Array& center, const Array& radius,
                     double probe, const std::optional<Array>& materials, const nb::dict& options) {
            const caplet::ShapeOptions given = options_of(options);
            const Released released;
            caplet::BallArrays balls{rows_of<3>(center, count), floats_of(radius, count), {}};
            if (materials) balls.materials = numbers_of(*materials);
            return scene.add_molecular_surface(balls, probe, given);
          }),
          nb::arg("count"), nb::arg("center"), nb::arg("radius"), nb::arg("probe"),
          nb::arg("materials").none(), nb::arg("options"))
      .def("set_capsules",
           in_turn([](Scene& scene, std::uint32_t shape, std::size_t count, const Array& p0,
                      const Array& p1, const Array& radius0, const std::optional<Array>& radius1,
                      const std::optional<Array>& materials, const std::optional<Array>& u,
                      const std::vector<double>& times) {
             const Released released;
             scene.set_capsules(shape,
                                capsules_of(p0, p1, radius0, radius1, materials, u, count, times));
           }),
           nb::arg("shape"), nb::arg("count"), nb::arg("p0"), nb::arg("p1"), nb::arg("radius0"),
           nb::arg("radius1").none(), nb::arg("materials").none(), nb::arg("u").none(),
           nb::arg("times"))
      .def("capsule_arrays", in_turn([](const Scene& scene, std::uint32_t shape) {
             caplet::CapsuleArrays arrays = scene.capsule_arrays(shape);
             if (arrays.radius1.empty()) arrays.radius1 = arrays.radius0;
             const std::size_t count = arrays.p0.size(), named = arrays.materials.size();
             return nb::make_tuple(rows_array(arrays.p0), rows_array(arrays.p1),
                                   array_of<float, 1>(std::move(arrays.radius0), {count}),
                                   array_of<float, 1>(std::move(arrays.radius1), {count}),
                                   array_of<std::uint32_t, 1>(std::move(arrays.materials), {named}),
                                   rows_array(arrays.u), arrays.times);
           }));
}

caplet::MeshArrays mesh_of(const Array& positions, const Array& triangles,
                           const std::optional<Array>& normals, const std::optional<Array>& uvs,
                           const std::vector<double>& times = {}) {
  caplet::MeshArrays mesh;
  mesh.positions = rows_of<3>(positions, positions.shape(0));
  if (normals) mesh.normals = rows_of<3>(*normals, normals->shape(0));
  if (uvs) mesh.uvs = rows_of<2>(*uvs, uvs->shape(0));
  const std::vector<std::uint32_t> corners = numbers_of(triangles);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  mesh.times = times;
  return mesh;
}

/// Binds meshes by arrays.
void bind_meshes(nb::class_<HeldScene>& held) {
  held.def("add_mesh",
           in_turn([](Scene& scene, const Array& positions, const Array& triangles,
                      const std::optional<Array>& normals, const std::optional<Array>& uvs,
                      const nb::dict& options) {
             const caplet::ShapeOptions given = options_of(options);
             const caplet::MeshArrays mesh = mesh_of(positions, triangles, normals, uvs);
             const Released released;
             return scene.add_mesh(mesh, given);
           }),
           nb::arg("positions"), nb::arg("triangles"), nb::arg("normals").none(),
           nb::arg("uvs").none(), nb::arg("options"))
      .def("set_mesh",
           in_turn([](Scene& scene, std::uint32_t shape, const Array& positions,
                      const Array& triangles, const std::optional<Array>& normals,
                      const std::optional<Array>& uvs, const std::vector<double>& times) {
             const caplet::MeshArrays mesh = mesh_of(positions, triangles, normals, uvs, times);
             const Released released;
             scene.set_mesh(shape, mesh);
           }),
           nb::arg("shape"), nb::arg("positions"), nb::arg("triangles"), nb::arg("normals").none(),
           nb::arg("uvs").none(), nb::arg("times"))
      .def("mesh_arrays", in_turn([](const Scene& scene, std::uint32_t shape) {
             const caplet::MeshArrays mesh = scene.mesh_arrays(shape);
             std::vector<std::uint32_t> corners;
             for (const auto& triangle : mesh.triangles)
               corners.insert(corners.end(), triangle.begin(), triangle.end());
             return nb::make_tuple(
                 rows_array(mesh.positions),
                 array_of<std::uint32_t, 2>(std::move(corners), {mesh.triangles.size(), 3}),
                 rows_array(mesh.normals), rows_array(mesh.uvs), mesh.times);
           }));
}

}  // namespace

void bind_scene(nb::module_& m) {
  bind_lists(m);
  nb::class_<HeldScene> held(m, "Scene");
  bind_settings(held);
  bind_statements(held);
  bind_shapes(held);
  bind_meshes(held);
}

}  // namespace caplet_python
