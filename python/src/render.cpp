// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Devices, films and sessions.
#include <caplet/device.h>
#include <caplet/film.h>
#include <caplet/session.h>
#include <caplet/verify.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <memory>
#include <optional>
#include <tuple>

#include "session.h"

namespace caplet_python {

namespace {

nb::dict told(const caplet::DeviceInfo& info) {
  nb::dict out;
  out["index"] = info.index;
  out["name"] = info.name;
  out["vendor"] = info.vendor;
  out["driver"] = info.driver;
  out["version"] = info.version;
  out["platform"] = info.platform;
  out["type"] = info.type;
  out["compute_units"] = info.compute_units;
  out["global_bytes"] = info.global_bytes;
  out["bundled"] = info.bundled;
  return out;
}

caplet::VerifyReport verified(const std::optional<caplet::Scene>& scene, const std::string& choice,
                              std::uint64_t rays, std::uint64_t seed) {
  caplet::VerifyReport report;
  std::atomic<bool> stopped = false;
  struct Stopped {};
  run_interruptibly(
      [&] {
        const std::vector<caplet::Device> devices =
            choice.empty() ? std::vector{caplet::choose_device()} : caplet::choose_devices(choice);
        const caplet::VerifyOptions options{rays, seed, [&](std::uint64_t) {
                                              if (stopped) throw Stopped{};
                                            }};
        try {
          report =
              scene ? caplet::verify(*scene, devices, options) : caplet::verify(devices, options);
        } catch (const Stopped&) {
        }
      },
      [&] { stopped = true; }, [] {});
  return report;
}

using caplet::Film;

/// Binds devices, and verify on them.
void bind_devices(nb::module_& m) {
  m.def("devices", [] {
    std::vector<caplet::DeviceInfo> found;
    {
      const Released released;
      found = caplet::devices();
    }
    nb::list out;
    for (const caplet::DeviceInfo& info : found) out.append(told(info));
    return out;
  });
  m.def(
      "verify",
      [](HeldScene* scene, const std::string& devices, std::uint64_t rays, std::uint64_t seed) {
        const caplet::VerifyReport report =
            verified(scene ? std::optional(scene->now()) : std::nullopt, devices, rays, seed);
        nb::list of_devices;
        for (const auto& one : report.devices) {
          nb::dict row = told(one.device);
          row["rays"] = one.rays;
          row["hits"] = one.hits;
          row["disagreements"] = one.disagreements;
          row["worst"] = one.worst;
          row["seconds"] = one.seconds;
          of_devices.append(row);
        }
        return nb::make_tuple(report.agrees(), of_devices, report.text, report.json);
      },
      nb::arg("scene").none(), nb::arg("devices"), nb::arg("rays"), nb::arg("seed"));

  nb::class_<caplet::Device>(m, "Device").def_prop_ro("info", [](const caplet::Device& device) {
    return told(device.info());
  });
  m.def("choose_devices", [](const std::string& choice) {
    const Released released;
    return choice.empty() ? std::vector{caplet::choose_device()} : caplet::choose_devices(choice);
  });
}

/// Throws InputError for another word.
caplet::Matte matte_named(const std::string& word) {
  if (word == "object") return caplet::Matte::object;
  if (word == "material") return caplet::Matte::material;
  if (word == "asset") return caplet::Matte::asset;
  throw caplet::InputError("by: 'object', 'material' or 'asset' is needed, not '" + word + "'");
}

void bind_film(nb::module_& m) {
  nb::class_<Film>(m, "Film")
      .def_prop_ro("width", &Film::width)
      .def_prop_ro("height", &Film::height)
      .def_prop_ro("x", &Film::x)
      .def_prop_ro("y", &Film::y)
      .def_prop_ro("spp", &Film::samples_per_pixel)
      .def("samples",
           [](const Film& film) {
             std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
             for (const caplet::SampleRange& range : film.samples())
               out.emplace_back(range.first, range.count);
             return out;
           })
      .def("copy", [](const Film& film) { return Film(film); })
      .def("add", &Film::add, nb::call_guard<Released>())
      .def("save",
           [](const Film& film, const std::string& file) {
             const Released released;
             film.save(file);
           })
      .def_static("load",
                  [](const std::string& file) {
                    const Released released;
                    return Film::load(file);
                  })
      .def_static("load",
                  [](const std::string& file, HeldScene& of) {
                    const caplet::Scene scene = of.now();
                    const Released released;
                    return Film::load(file, scene);
                  })
      .def("channels", &Film::channels, nb::call_guard<Released>())
      .def("values",
           [](const Film& film, const std::string& channel) {
             const auto shape = std::array{static_cast<std::size_t>(film.height()),
                                           static_cast<std::size_t>(film.width())};
             std::vector<float> values;
             {
               const Released released;
               values = film.values(channel);
             }
             return array_of<float, 2>(std::move(values), shape);
           })
      .def("ids",
           [](const Film& film, const std::string& channel) {
             const auto shape = std::array{static_cast<std::size_t>(film.height()),
                                           static_cast<std::size_t>(film.width())};
             std::vector<std::uint32_t> ids;
             {
               const Released released;
               ids = film.ids(channel);
             }
             return array_of<std::uint32_t, 2>(std::move(ids), shape);
           })
      .def("matte_names",
           [](const Film& film, const std::string& matte) {
             return film.matte_names(matte_named(matte));
           })
      .def("matte",
           [](const Film& film, const std::string& matte, const std::string& name) {
             const auto shape = std::array{static_cast<std::size_t>(film.height()),
                                           static_cast<std::size_t>(film.width())};
             std::vector<float> values;
             {
               const Released released;
               values = film.matte(matte_named(matte), name);
             }
             return array_of<float, 2>(std::move(values), shape);
           })
      .def("write_deep_exr",
           [](const Film& film, const std::string& file) {
             const Released released;
             film.write_deep_exr(file);
           })
      .def("write_exr",
           [](const Film& film, const std::string& file) {
             const Released released;
             film.write_exr(file);
           })
      .def("write_preview",
           [](const Film& film, const std::string& file, const caplet::OverlayOptions& drawn) {
             const Released released;
             film.write_preview(file, drawn);
           });
  m.def("overlays", [] {
    std::vector<std::tuple<std::string, std::string, std::string>> out;
    for (const caplet::Overlay& one : caplet::overlays())
      out.emplace_back(one.name, one.values, one.help);
    return out;
  });
}

/// Calls `work` with options of a session's render, on its turn, and lets signals cancel it.
template <class Work>
void run_session(HeldSession& held, std::optional<double> time_limit, const nb::object& progress,
                 const Work& work) {
  std::atomic<double> fraction = 0, speed = 0;
  std::mutex mutex;  // of these two
  bool is_stopped = false, is_under_way = false;
  const auto now_under_way = [&](bool is) {
    const std::lock_guard lock(mutex);
    is_under_way = is;
    return !is_stopped;
  };
  run_interruptibly(
      [&] {
        const auto turn = turn_of(held);
        if (!now_under_way(true)) return;
        caplet::RenderOptions options;
        options.time_limit = time_limit;
        options.progress = [&](const caplet::RenderProgress& now) {
          fraction = now.fraction;
          speed = now.samples_per_second;
        };
        work(options);
        now_under_way(false);
      },
      [&] {  // the render of another thread, which this one waits for, goes on
        const std::lock_guard lock(mutex);
        is_stopped = true;
        if (is_under_way) held.session.cancel();
      },
      [&] {
        if (!progress.is_none()) progress(fraction.load(), speed.load());
      });
}

void bind_session(nb::module_& m) {
  nb::class_<HeldSession>(m, "Session")
      .def(
          "__init__",
          [](HeldSession* self, HeldScene& of, const std::vector<caplet::Device>& devices,
             bool cryptomatte, bool deep, bool none) {
            const caplet::Scene scene = of.now();
            std::optional<caplet::Session> session;
            run_interruptibly(
                [&] {
                  session.emplace(scene, devices, caplet::ExtraLayers{cryptomatte, deep, none});
                },
                [] {}, [] {});
            new (self) HeldSession(*std::move(session));
          },
          nb::arg("scene"), nb::arg("devices"), nb::arg("cryptomatte") = false,
          nb::arg("deep") = false, nb::arg("none") = false)
      .def("update",
           [](HeldSession& held, HeldScene& of) {
             const caplet::Scene scene = of.now();
             run_interruptibly(
                 [&] {
                   const auto turn = turn_of(held);
                   held.session.update(scene);
                 },
                 [] {}, [] {});
           })
      .def(
          "render",
          [](HeldSession& held, int samples, std::optional<double> time_limit,
             const nb::object& progress) {
            int done = 0;
            run_session(held, time_limit, progress, [&](const caplet::RenderOptions& options) {
              done = held.session.render(samples, options);
            });
            return done;
          },
          nb::arg("samples"), nb::arg("time_limit").none(), nb::arg("progress").none())
      .def(
          "render_to",
          [](HeldSession& held, double noise, int least, int most, bool in_display,
             std::optional<double> time_limit, const nb::object& progress) {
            double reached = 0;
            run_session(held, time_limit, progress, [&](const caplet::RenderOptions& options) {
              reached = held.session.render_to({noise, least, most, in_display}, options);
            });
            return reached;
          },
          nb::arg("noise"), nb::arg("least"), nb::arg("most"), nb::arg("in_display"),
          nb::arg("time_limit").none(), nb::arg("progress").none())
      .def("cancel", [](HeldSession& held) { held.session.cancel(); })
      .def("film",
           [](HeldSession& held) {
             const Released released;
             const auto turn = turn_of(held);
             return held.session.film();
           })
      .def("begin_at",
           [](HeldSession& held, std::uint32_t sample) {
             const Released released;
             const auto turn = turn_of(held);
             held.session.begin_at(sample);
           })
      .def("resume", [](HeldSession& held, const Film& film) {
        const Released released;
        const auto turn = turn_of(held);
        held.session.resume(film);
      });
}

}  // namespace

void bind_render(nb::module_& m) {
  bind_devices(m);
  bind_film(m);
  bind_session(m);
}

}  // namespace caplet_python
