// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Rays in arrays -> crossings in arrays.
#include <caplet/pick.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <tuple>

#include "session.h"

namespace caplet_python {

namespace {

using caplet::Crossing;
using caplet::Ray;

/// A picker, and whose turn it is.
struct HeldPicker {
  explicit HeldPicker(caplet::Picker of) : session(std::move(of)) {}
  caplet::Picker session;  // by the name that HeldSession has for what answers
  Lock lock;
};

constexpr std::size_t rays_in_a_chunk = std::size_t{1} << 18;

/// Rays [first, first + count) of arrays whose first dimension may be 1, which is repeated.
class Rays {
 public:
  Rays(std::size_t count, const Array& origins, const Array& directions, const Array& t_min,
       const Array& t_max, const Array& time)
      : count_(count),
        origins_(origins),
        directions_(directions),
        t_min_(t_min),
        t_max_(t_max),
        time_(time) {
    for (const Array* points : {&origins, &directions})
      if (points->ndim() != 2 || points->shape(1) != 3 ||
          (points->shape(0) != count && points->shape(0) != 1))
        throw nb::value_error("rays are arrays of shape (n, 3)");
    for (const Array* numbers : {&t_min, &t_max, &time})
      if (numbers->ndim() != 1 || (numbers->shape(0) != count && numbers->shape(0) != 1))
        throw nb::value_error("ends and times of rays: shape (n,)");
  }
  std::size_t count() const { return count_; }

  void read(std::size_t first, std::span<Ray> out) const {
    points(origins_, first, out, &Ray::origin);
    points(directions_, first, out, &Ray::direction);
    numbers(t_min_, first, out, &Ray::t_min);
    numbers(t_max_, first, out, &Ray::t_max);
    numbers(time_, first, out, &Ray::time);
  }

 private:
  static void points(const Array& from, std::size_t first, std::span<Ray> out,
                     std::array<float, 3> Ray::*to) {
    const std::size_t step = from.shape(0) == 1 ? 0 : 1;
    with_floats(from, [&](auto read) {
      for (std::size_t i = 0; i < out.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
          (out[i].*to)[k] = static_cast<float>(read((first + i) * step, k));
    });
  }
  template <class Number>
  static void numbers(const Array& from, std::size_t first, std::span<Ray> out, Number Ray::*to) {
    const std::size_t step = from.shape(0) == 1 ? 0 : 1;
    with_floats(from, [&](auto read) {
      for (std::size_t i = 0; i < out.size(); ++i)
        out[i].*to = static_cast<Number>(read((first + i) * step, 0));
    });
  }

  std::size_t count_;
  Array origins_, directions_, t_min_, t_max_, time_;
};

/// `out`: bytes of as many crossings, which a structured array lends.
template <class Owner>
void nearest(Owner& held, std::size_t count, const Array& origins, const Array& directions,
             const Array& t_min, const Array& t_max, const Array& time,
             nb::ndarray<std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>& out) {
  const Rays rays(count, origins, directions, t_min, t_max, time);
  if (out.shape(0) != count * sizeof(Crossing)) throw nb::value_error("room for other rays");
  std::uint8_t* const to = out.data();
  Released released;
  const auto turn = turn_of(held);
  std::vector<Ray> chunk;
  std::vector<Crossing> hits;
  for (std::size_t first = 0; first < count; first += rays_in_a_chunk) {
    if (first > 0) released.check_signals();
    chunk.resize(std::min(rays_in_a_chunk, count - first));
    rays.read(first, chunk);
    hits.resize(chunk.size());
    held.session.nearest(chunk, hits);
    for (std::size_t i = 0; i < hits.size(); ++i)
      hits[i].ray = static_cast<std::uint32_t>(first + i);
    std::memcpy(to + first * sizeof(Crossing), hits.data(), hits.size() * sizeof(Crossing));
  }
}

template <class Owner>
auto crossings(Owner& held, std::size_t count, const Array& origins, const Array& directions,
               const Array& t_min, const Array& t_max, const Array& time, std::size_t most) {
  const Rays rays(count, origins, directions, t_min, t_max, time);
  std::vector<std::uint8_t> bytes;
  {
    Released released;
    const auto turn = turn_of(held);
    std::vector<Ray> chunk;
    const std::size_t at_once = std::clamp<std::size_t>(
        (std::size_t{1} << 22) / std::max<std::size_t>(most, 1), 1, rays_in_a_chunk);
    for (std::size_t first = 0; first < count; first += at_once) {
      if (first > 0) released.check_signals();
      chunk.resize(std::min(at_once, count - first));
      rays.read(first, chunk);
      std::vector<Crossing> hits = held.session.crossings(chunk, most);
      for (Crossing& hit : hits) hit.ray += static_cast<std::uint32_t>(first);
      const std::size_t before = bytes.size();
      bytes.resize(before + hits.size() * sizeof(Crossing));
      if (!hits.empty())
        std::memcpy(bytes.data() + before, hits.data(), hits.size() * sizeof(Crossing));
    }
  }
  const std::size_t size = bytes.size();
  return array_of<std::uint8_t, 1>(std::move(bytes), {size});
}

/// `hits`: bytes of crossings; `points`: as many x y z, which are changed.
void carry(HeldPicker& held,
           const nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>& hits,
           double from, double to,
           nb::ndarray<double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>& points) {
  std::vector<Crossing> own(hits.shape(0) / sizeof(Crossing));
  std::memcpy(own.data(), hits.data(), own.size() * sizeof(Crossing));
  std::vector<std::array<double, 3>> at(points.shape(0));
  std::memcpy(at.data(), points.data(), at.size() * sizeof at[0]);
  {
    const Released released;
    const auto turn = turn_of(held);
    held.session.carry(own, from, to, at);
  }
  std::memcpy(points.data(), at.data(), at.size() * sizeof at[0]);
}

/// Names, NumPy's types and places of a crossing's numbers.
std::vector<std::tuple<std::string, std::string, std::size_t, std::size_t>> layout() {
  return {{"t", "f4", 1, offsetof(Crossing, t)},
          {"error", "f4", 1, offsetof(Crossing, error)},
          {"uv", "f4", 2, offsetof(Crossing, uv)},
          {"object_id", "u4", 1, offsetof(Crossing, object_id)},
          {"material_id", "u4", 1, offsetof(Crossing, material_id)},
          {"primitive", "u4", 1, offsetof(Crossing, primitive)},
          {"surface", "u4", 1, offsetof(Crossing, surface)},
          {"shape", "u4", 1, offsetof(Crossing, shape)},
          {"instance", "u4", 1, offsetof(Crossing, instance)},
          {"leaving", "u4", 1, offsetof(Crossing, leaving)},
          {"ray", "u4", 1, offsetof(Crossing, ray)},
          {"point", "f4", 3, offsetof(Crossing, point)},
          {"normal", "f4", 3, offsetof(Crossing, normal)}};
}

}  // namespace

void bind_trace(nb::module_& m) {
  m.attr("crossing_bytes") = sizeof(Crossing);
  m.def("crossing_layout", [] {
    nb::list out;
    for (const auto& [name, type, count, offset] : layout())
      out.append(nb::make_tuple(name, type, count, offset));
    return out;
  });
  nb::class_<HeldPicker>(m, "Picker")
      .def("__init__",
           [](HeldPicker* self, HeldScene& of, const caplet::Device& device) {
             const caplet::Scene scene = of.now();
             std::optional<caplet::Picker> picker;
             run_interruptibly([&] { picker.emplace(scene, device); }, [] {}, [] {});
             new (self) HeldPicker(*std::move(picker));
           })
      .def("nearest", &nearest<HeldPicker>)
      .def("crossings", &crossings<HeldPicker>)
      .def("carry", &carry)
      .def("pixel", [](HeldPicker& held, int x, int y) -> nb::object {
        std::optional<caplet::Hit> hit;
        {
          const Released released;
          const auto turn = turn_of(held);
          hit = held.session.pixel(x, y);
        }
        if (!hit) return nb::none();
        nb::dict out;
        out["t"] = hit->t;
        out["error"] = hit->error;
        out["point"] = nb::make_tuple(hit->point[0], hit->point[1], hit->point[2]);
        out["normal"] = nb::make_tuple(hit->normal[0], hit->normal[1], hit->normal[2]);
        out["uv"] = nb::make_tuple(hit->uv[0], hit->uv[1]);
        out["entering"] = hit->entering;
        out["object"] = hit->object;
        out["material"] = hit->material;
        out["object_id"] = hit->object_id;
        out["material_id"] = hit->material_id;
        out["primitive"] = hit->primitive;
        out["surface"] = hit->surface;
        if (hit->instance)
          out["instance"] = *hit->instance;
        else
          out["instance"] = nb::none();
        return out;
      });
}

}  // namespace caplet_python
