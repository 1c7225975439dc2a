// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/edit_desk.h"

#include <deque>
#include <exception>
#include <utility>
#include <vector>

#include "post/overlay_options.h"
#include "view/detail/scene_text.h"
#include "view/forms.h"

namespace caplet::view {

/// The answer to a change, which follows the message to all pages.
struct EditDesk::Made {
  ClientId to = 0;
  Text text;
};

/// The editor counts these.
struct EditDesk::Counts {
  std::uint64_t rearrangements = 0, renumberings = 0, camera_changes = 0;
};

EditDesk::Counts EditDesk::counts() const {
  return {editor_.rearrangements(), editor_.renumberings(), editor_.camera_changes()};
}

EditDesk::EditDesk(const LiveScene& live, const Editor& editor, Keeping& keeping, Clients& clients,
                   const EyeFilms& films, std::string device)
    : live_(live),
      editor_(editor),
      keeping_(keeping),
      clients_(clients),
      films_(films),
      device_(std::move(device)) {}

nlohmann::ordered_json EditDesk::told_scene() const {
  nlohmann::ordered_json out =
      scene_text(live_.scene(), device_, films_.target(), films_.noise_target());
  const SceneFiles& files = editor_.files();
  out["options"] = nlohmann::ordered_json::array();
  for (const FileOption& each : files.options) {
    const auto now = files.now.find(each.name);
    out["options"].push_back({{"name", each.name},
                              {"values", each.values},
                              {"help", each.help},
                              {"now", now == files.now.end() ? "" : now->second}});
  }
  return out;
}

nlohmann::ordered_json EditDesk::told_parts() const {
  nlohmann::ordered_json out = parts_text(live_.scene());
  out["hidden"] = hidden_text(live_.scene(), editor_.hidden());
  return out;
}

void EditDesk::prepare_greeting(bool read_only) {
  nlohmann::ordered_json out = told_scene();
  out["parts"] = told_parts();
  out["lists"] = lists_text();
  for (const post::OverlayRow& row : post::overlay_rows())
    out["overlays"].push_back({{"name", row.name}, {"values", row.values}, {"help", row.help}});
  out["home"] = camera_text(films_.look());
  const Scene& scene = live_.scene();
  if (scene.automatic_camera)  // it fits films of these sides alone
    out["home"]["framed"] = {scene.view.film.width, scene.view.film.height};
  out["backdrop"] = backdrop_text(live_.scene().view.film.backdrop);
  out["exposure"] = exposure_text(live_.scene().view.film.exposure);
  out["read_only"] = read_only;
  out["can_undo"] = editor_.can_undo();
  out["can_redo"] = editor_.can_redo();
  out["session"] = random_token();
  out["keep"] = keeping_.text();
  clients_.greet_with(out);
}

/// Returns whether the scene has changed.
bool EditDesk::make(const Wish& wish, Server& server, std::vector<Made>& made) {
  const Edit* edit = std::get_if<Edit>(&wish.message);
  bool has_changed = false;
  try {
    if (const Save* save = std::get_if<Save>(&wish.message)) {
      tell_saved(keeping_.save(*save, films_.look(), [this] { return clients_.is_ended(); }),
                 wish.from, server);
      return false;
    }
    has_changed = keeping_.make(wish.message, wish.text);
    if (edit && edit->number > 0)
      made.push_back(
          {wish.from,
           text_of({{"type", "made"}, {"number", edit->number}, {"ids", editor_.made()}})});
  } catch (const std::exception& error) {  // an invalid scene, or a file that cannot be written
    server.send(wish.from, error_text(error.what(), edit ? edit->number : 0));
  }
  return has_changed;
}

bool EditDesk::make_all(Server& server) {
  const std::deque<Wish> wishes = clients_.take_wishes();
  if (wishes.empty()) return false;
  const Counts before = counts();
  bool has_changed = false;
  std::vector<Made> made;
  for (const Wish& wish : wishes) has_changed = make(wish, server, made) || has_changed;
  tell_edited(before, server);
  for (const auto& [to, text] : made) server.send(to, text);
  return has_changed;
}

void EditDesk::tell_edited(const Counts& before, Server& server) {
  const Counts now = counts();
  nlohmann::ordered_json told{{"type", "edited"},
                              {"can_undo", editor_.can_undo()},
                              {"can_redo", editor_.can_redo()},
                              {"renumbered", now.renumberings != before.renumberings},
                              {"keep", keeping_.text()}};
  if (now.rearrangements != before.rearrangements) told["scene"] = told_scene();
  told["samples"] = films_.target();
  told["time"] = live_.scene().view.film.shutter_open;
  told["backdrop"] = backdrop_text(live_.scene().view.film.backdrop);
  told["exposure"] = exposure_text(live_.scene().view.film.exposure);
  told["parts"] = told_parts();
  if (now.camera_changes != before.camera_changes) told["home"] = camera_text(keeping_.own_look());
  nlohmann::ordered_json greeting;
  for (const char* name :
       {"can_undo", "can_redo", "keep", "samples", "time", "backdrop", "exposure", "parts", "home"})
    if (told.contains(name)) greeting[name] = told[name];
  if (told.contains("scene")) greeting.update(told["scene"]);
  clients_.greet_with(greeting);
  server.send_to_all(text_of(told));
}

/// Sends the result of saving: questions to the client that asked, all else to everyone.
void EditDesk::tell_saved(const nlohmann::ordered_json& told, ClientId asked, Server& server) {
  if (told["type"] != "saved") return server.send(asked, text_of(told));
  nlohmann::ordered_json greeting;
  greeting["home"] = camera_text(keeping_.own_look());
  clients_.greet_with(greeting);
  server.send_to_all(text_of(told));
}

}  // namespace caplet::view
