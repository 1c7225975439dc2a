// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/trees.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/utf8.h"
#include "export/export.h"
#include "film/image.h"
#include "import/import.h"
#include "report/outline.h"
#include "report/summary.h"

namespace caplet::cli {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

// The places of notes.
enum : std::size_t { view_note, outline_note, rest_note };

bool has_tree_name(const std::string& file) { return fs::path(file).extension() == ".tree"; }

/// Returns the shapes that go on in others, each with the first of them.
Json joined_pairs(const std::vector<std::uint32_t>& joined) {
  Json out = Json::array();
  for (std::size_t i = 0; i < joined.size(); ++i)
    if (joined[i] != i) out.push_back({i, joined[i]});
  return out;
}

glm::dvec3 vector_of(const Json& from) { return {from.at(0), from.at(1), from.at(2)}; }

/// Returns what text tells of a scene's view: all of it but the camera's medium.
Scene without_content(const Scene& scene) {
  Scene out;
  out.view = scene.view;
  out.view.camera.medium.reset();
  out.source = scene.source;
  out.has_no_up = scene.has_no_up;
  out.world_from_file = scene.world_from_file;
  out.unit = scene.unit;
  out.legend = scene.legend;
  return out;
}

}  // namespace

bool is_tree(const std::vector<std::string>& scenes) {
  const auto tree = std::ranges::find_if(scenes, has_tree_name);
  if (tree == scenes.end()) return false;
  if (scenes.size() > 1)
    throw InputError(SourceLocation{*tree}, "a tree file is a whole scene: no other joins it");
  return true;
}

TreeWriter::TreeWriter(const Scene& scene, const fs::path& folder) {
  const Scene seen = without_content(scene);
  write_pbrt(seen, folder, [this](std::string_view piece) { notes_[view_note] += piece; });
  notes_[outline_note] = report::outline_text(scene);
  Json rest;
  rest["summary"] = report::scene_summary(scene, FlatScene{});
  const post::Sight sight(scene);
  rest["joined"] = joined_pairs(sight.joined);
  rest["medium"] = scene.view.camera.medium ? Json(*scene.view.camera.medium) : Json(nullptr);
  notes_[rest_note] = json_dump(rest);
}

void TreeWriter::write(const fs::path& file, const FlatScene& flat,
                       const std::function<void(double)>& progress) {
  Json rest = Json::parse(notes_[rest_note]);
  report::tell_lowered(rest["summary"], flat);
  notes_[rest_note] = json_dump(rest);
  write_tree(file, flat, notes_, progress);
}

Tree read_tree(const std::string& file, const ImportOptions& options) {
  if (!options.values().empty())
    throw InputError(SourceLocation{"--" + options.values().begin()->first},
                     "is for `caplet build`, when a tree file is made of a scene");
  Tree out{{}, map_tree(file), {}, {}};
  out.scene = read_pbrt_text(file, out.file.notes[view_note], FileImageReader());
  report::add_outline(out.file.notes[outline_note], file, out.scene);
  try {
    Json rest = Json::parse(out.file.notes[rest_note]);
    if (!rest.at("medium").is_null()) out.scene.view.camera.medium = rest.at("medium");
    out.joined.resize(out.scene.shapes.size());
    std::iota(out.joined.begin(), out.joined.end(), 0U);
    for (const Json& pair : rest.at("joined"))
      out.joined.at(pair.at(0).get<std::size_t>()) = pair.at(1);
    out.summary = std::move(rest.at("summary"));
  } catch (const std::exception& error) {
    throw InputError({file}, std::string("the tree file is damaged: ") + error.what());
  }
  return out;
}

post::Sight Tree::sight(const Scene& seen) const {
  post::Sight out(seen);
  out.joined = joined;
  if (const Json& bounds = summary.at("bounds"); !bounds.is_null())
    out.bounds = {vector_of(bounds.at("min")), vector_of(bounds.at("max"))};
  return out;
}

}  // namespace caplet::cli
