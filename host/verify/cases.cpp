// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "verify/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/utf8.h"

namespace caplet::verify {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* format_name = "caplet verify case 1";
constexpr std::uintmax_t largest_file = 1 << 24;

Json hexadecimal(float x) { return fmt::format("{:a}", x); }

Json to_json(const PickRecord& pick) {
  return {{"t", pick.t},
          {"object", pick.object},
          {"shape", pick.shape},
          {"primitive", pick.primitive},
          {"surface", pick.surface},
          {"material", pick.material},
          {"leaving", pick.leaving != 0}};
}

Json to_json(const reference::SceneHit& hit) {
  return {{"t", hit.t},
          {"instance", hit.instance == reference::no_instance ? Json(nullptr) : Json(hit.instance)},
          {"shape", hit.shape},
          {"primitive", hit.primitive},
          {"surface", hit.surface},
          {"material", hit.material},
          {"leaving", hit.leaving}};
}

Json to_json(const Failure& failure) {
  Json out;
  out["format"] = format_name;
  if (failure.scene.file.empty())
    out["torture"] = {{"seed", failure.scene.seed}, {"round", failure.scene.round}};
  else
    out["scene"] = fs::absolute(failure.scene.file).lexically_normal().string();
  if (failure.scene.time != 0) out["time"] = hexadecimal(failure.scene.time);
  const RayRecord& r = failure.ray;
  out["ray"] = {{"origin", {hexadecimal(r.ox), hexadecimal(r.oy), hexadecimal(r.oz)}},
                {"direction", {hexadecimal(r.dx), hexadecimal(r.dy), hexadecimal(r.dz)}}};
  out["family"] = failure.family;
  out["device"] = failure.device;
  out["driver"] = failure.driver;
  for (const Disagreement& d : failure.disagreements)
    out["disagreements"].push_back(
        {{"fault", fault_names[static_cast<std::size_t>(d.fault)]}, {"what", d.text}});
  out["nearest"] = failure.nearest.object == CAPLET_NONE ? Json(nullptr) : to_json(failure.nearest);
  out["crossings"] = Json::array();
  for (const PickRecord& pick : failure.list) out["crossings"].push_back(to_json(pick));
  out["reference"] = Json::array();
  for (const reference::SceneHit& hit : failure.expected) out["reference"].push_back(to_json(hit));
  return out;
}

float number(const Json& value, const fs::path& file) {
  if (value.is_string()) {
    const std::string text = value.get<std::string>();
    char* end = nullptr;
    const float x = std::strtof(text.c_str(), &end);
    if (!text.empty() && *end == 0 && std::isfinite(x)) return x;
  } else if (value.is_number()) {
    if (const auto x = value.get<float>(); std::isfinite(x)) return x;
  }
  throw InputError(SourceLocation{file.string()},
                   "a ray has finite numbers, not " + json_dump(value));
}

Case load(const fs::path& file) {
  const auto refuse = [&](const std::string& why) -> InputError {
    return InputError(SourceLocation{file.string()}, why);
  };
  std::error_code ignored;
  if (const auto size = fs::file_size(file, ignored); !ignored && size > largest_file)
    throw refuse("too large for a case");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw refuse("cannot be read");
  const Json json = Json::parse(in, nullptr, false);
  if (!json.is_object() || json.value("format", Json()) != format_name)
    throw refuse("not a case of caplet verify");
  Case out{file, {}, {}};
  try {
    if (const auto scene = json.find("scene"); scene != json.end()) {
      out.scene.file = scene->get<std::string>();
      if (const auto time = json.find("time"); time != json.end())
        out.scene.time = std::clamp(number(*time, file), 0.0f, 1.0f);
    } else {
      const auto whole = [&](const char* name) {
        const Json& value = json.at("torture").at(name);
        if (!value.is_number_unsigned())
          throw refuse(
              fmt::format("not a case of caplet verify: {} is a whole number from 0 up, not {}",
                          name, json_dump(value)));
        return value.get<std::uint64_t>();
      };
      out.scene.seed = whole("seed");
      out.scene.round = whole("round");
    }
    const Json &o = json.at("ray").at("origin"), &d = json.at("ray").at("direction");
    out.ray = {number(o.at(0), file), number(o.at(1), file), number(o.at(2), file), 0,
               number(d.at(0), file), number(d.at(1), file), number(d.at(2), file), HUGE_VALF};
  } catch (const Json::exception& error) {
    throw refuse(fmt::format("not a case of caplet verify: {}", error.what()));
  }
  return out;
}

}  // namespace

void save_cases(const fs::path& folder, const std::vector<Failure>& failures) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw RunError(fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
  for (std::size_t i = 0; i < failures.size(); ++i)
    write_atomically(folder / fmt::format("case-{:05}.json", i + 1),
                     [&](const fs::path& temporary) {
                       std::ofstream out(temporary, std::ios::binary);
                       out << json_dump(to_json(failures[i]), 2) << '\n';
                       if (!out.flush())
                         throw RunError(fmt::format("cannot write {}", temporary.string()));
                     });
}

std::vector<Case> load_cases(const fs::path& path) {
  std::vector<fs::path> files;
  std::error_code error;
  if (fs::is_directory(path, error)) {
    for (const auto& entry : fs::directory_iterator(path)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("case-") && name.ends_with(".json")) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    if (files.empty())
      throw InputError(SourceLocation{path.string()}, "the folder has no case-*.json");
  } else {
    files.push_back(path);
  }
  std::vector<Case> out;
  out.reserve(files.size());
  for (const fs::path& file : files) out.push_back(load(file));
  return out;
}

}  // namespace caplet::verify
