// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Changes and saves that pages ask for.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "lower/live_scene.h"
#include "view/detail/clients.h"
#include "view/detail/eye_films.h"
#include "view/detail/keeping.h"
#include "view/editor.h"

namespace caplet::view {

/// Makes what pages wish, and tells all pages what the scene then is. Only the renderer's thread
/// calls it, once there is one.
class EditDesk {
 public:
  /// All of these must outlive this. `device`: its name.
  EditDesk(const LiveScene& live, const Editor& editor, Keeping& keeping, Clients& clients,
           const EyeFilms& films, std::string device);

  /// Sets the message that greets pages.
  void prepare_greeting(bool read_only);
  /// Makes the waiting changes and saves; returns whether the scene has changed.
  bool make_all(Server& server);

 private:
  struct Made;
  bool make(const Wish& wish, Server& server, std::vector<Made>& made);
  void tell_saved(const nlohmann::ordered_json& told, ClientId asked, Server& server);
  struct Counts;
  Counts counts() const;
  void tell_edited(const Counts& before, Server& server);
  nlohmann::ordered_json told_scene() const;
  nlohmann::ordered_json told_parts() const;

  const LiveScene& live_;
  const Editor& editor_;
  Keeping& keeping_;
  Clients& clients_;
  const EyeFilms& films_;
  std::string device_;
};

}  // namespace caplet::view
