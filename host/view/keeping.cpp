// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/keeping.h"

#include <fmt/format.h>

#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "base/utf8.h"
#include "view/detail/scene_text.h"
#include "view/detail/shown_view.h"

namespace caplet::view {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* undo_line = R"({"type":"undo","again":false})";
constexpr const char* redo_line = R"({"type":"undo","again":true})";

/// Returns the text as a single line.
std::string line_of(const std::string& text) { return json_dump(Json::parse(text)); }

/// Returns whether the line marks a save and not a change.
bool is_mark(const std::string& line) {
  const Json text = Json::parse(line, nullptr, false);
  return text.is_object() && text.value("type", "") == "saved";
}

}  // namespace

Keeping::Keeping(LiveScene& live, Editor& editor, std::unique_ptr<Keeper> keeper)
    : editor_(editor), keeper_(std::move(keeper)), own_(look_of_scene(live.scene())) {
  if (!keeper_ || keeper_->lines().empty()) return;
  const std::size_t made = make_lines(keeper_->lines()), all = keeper_->lines().size();
  keeper_->has_made(made);
  if (made < all)
    log::warn("{} of {} kept changes cannot be made again, and are put aside", all - made, all);
  restored_ = has_unsaved() ? made : 0;
  if (restored_ > 0)
    log::info("unsaved changes of an earlier session are made again: {} from {}", made,
              keeper_->journal().string());
}

bool Keeping::change(const Message& message) {
  if (const Edit* edit = std::get_if<Edit>(&message)) {
    editor_.make(edit->change, edit->goes_on);
    follow_camera();
    return true;
  }
  if (const Undo* undo = std::get_if<Undo>(&message)) return go(undo->again);
  return false;
}

/// Undoes or redoes a change.
bool Keeping::go(bool again) {
  const bool has_changed = again ? editor_.redo() : editor_.undo();
  follow_camera();
  return has_changed;
}

/// Takes the document's camera as the own one, if a change has set it.
void Keeping::follow_camera() {
  if (std::exchange(camera_changes_, editor_.camera_changes()) == editor_.camera_changes()) return;
  set_own(look_of(editor_.view()));
  own_is_new_ = false;
}

/// Sets the camera of the own look, which keeps its size.
void Keeping::set_own(ShowView look) {
  look.width = own_.width;
  look.height = own_.height;
  own_ = look;
}

/// Returns the document's settings with the camera and the clipping plane of `own`, in the shape of
/// the document's film.
View Keeping::view_of(ShowView own) const {
  own.separation = 0;
  own.width = editor_.view().film.width;
  own.height = editor_.view().film.height;
  View out = editor_.view();
  const View shown = shown_view(out, own, 1, 0);
  out.camera = shown.camera;
  out.clip = shown.clip;
  return out;
}

/// Returns whether the change could be made.
bool Keeping::make_line(const std::string& line) try {
  if (!is_mark(line)) return change(parse_message(line));
  const Json text = Json::parse(line);
  editor_.mark_saved();
  if (const auto camera = text.find("camera"); camera != text.end()) {
    Json look = *camera;
    look["type"] = "look";
    look["width"] = look["height"] = 1;
    set_own(std::get<ShowView>(parse_message(json_dump(look))));
    own_is_new_ = true;
    editor_.adopt_camera(view_of(own_));
  }
  return true;
} catch (const InputError&) {
  return false;
} catch (const Json::exception&) {
  return false;
}

std::size_t Keeping::make_lines(const std::vector<std::string>& lines) {
  std::size_t made = 0;
  while (made < lines.size() && make_line(lines[made])) ++made;
  return made;
}

bool Keeping::make(const Message& message, const std::string& text) {
  if (std::holds_alternative<Discard>(message)) {
    const std::uint64_t state = editor_.state();
    // A discard is recorded as the undos that it consists of.
    const auto go_and_keep = [&](bool again) {
      if (!go(again)) return false;
      if (keeper_) keeper_->keep(again ? redo_line : undo_line);
      return true;
    };
    const std::optional<bool> way = editor_.way_to_saved();
    if (!way)
      throw InputError("the saved scene is not among the states that undo leads to any more");
    while (editor_.has_unsaved() && go_and_keep(*way)) {
    }
    restored_ = 0;
    if (keeper_) keeper_->rest();
    return editor_.state() != state;
  }
  if (const Kept* kept = std::get_if<Kept>(&message)) {
    if (!keeper_ || !keeper_->old()) return false;
    std::size_t made = 0;
    if (kept->restore) {
      const std::vector<std::string> lines = keeper_->old()->lines;
      for (const std::string& line : lines)
        if (!is_mark(line) && make_line(line)) {
          keeper_->keep(line);
          ++made;
        }
      if (made < lines.size())
        log::warn("{} of {} changes of an earlier session do not fit the scene as it now is",
                  lines.size() - made, lines.size());
    }
    keeper_->forget_old();
    return made > 0;
  }
  if (!change(message)) return false;
  if (keeper_) keeper_->keep(line_of(text));
  if (keeper_ && !has_unsaved()) keeper_->rest();
  return true;
}

Json Keeping::save(const Save& save, const ShowView& look, const std::function<bool()>& cancelled) {
  if (!keeper_) throw InputError("this scene has no file to be saved beside");
  const std::filesystem::path target = keeper_->target(save.name);
  if (const std::string lost = keeper_->lost_with(target); !lost.empty() && !save.replace)
    return {{"type", "save_asks"},
            {"name", target.filename().string()},
            {"camera", save.camera},
            {"why", lost}};
  const bool camera_is_new = save.camera || own_is_new_;
  const ShowView own = save.camera ? look : own_;
  Scene scene = editor_.document();
  if (camera_is_new) scene.view = view_of(own);
  Json mark = Json::object();
  if (camera_is_new) mark["camera"] = camera_text(own);
  keeper_->save(scene, target, json_dump(mark), cancelled);
  own_ = own;
  own_is_new_ = camera_is_new;
  if (camera_is_new) editor_.adopt_camera(scene.view);
  editor_.mark_saved();
  restored_ = 0;
  log::info("wrote {}", target.string());
  return {{"type", "saved"}, {"name", target.filename().string()}, {"file", target.string()}};
}

Json Keeping::text() const {
  Json out{{"unsaved", has_unsaved()}, {"restored", restored_}};
  if (!keeper_) return out;
  out["name"] = keeper_->default_name();
  out["kept"] = keeper_->failure().empty();
  if (!keeper_->failure().empty()) out["why"] = keeper_->failure();
  if (keeper_->old()) out["old"] = keeper_->old()->lines.size();
  return out;
}

std::optional<std::filesystem::path> Keeping::end() {
  if (!keeper_) return {};
  const bool stays = has_unsaved();
  keeper_->end(stays);
  if (!stays || !keeper_->failure().empty()) return {};
  return keeper_->journal();
}

}  // namespace caplet::view
