// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/viewer.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "view/detail/clients.h"
#include "view/detail/denoising.h"
#include "view/detail/edit_desk.h"
#include "view/detail/eye_films.h"
#include "view/detail/keeping.h"
#include "view/detail/picker.h"
#include "view/detail/render_loop.h"
#include "view/detail/scene_text.h"
#include "view/detail/shown_view.h"
#include "view/editor.h"
#include "view/messages.h"
#include "view/page.h"
#include "view/picture.h"

namespace caplet::view {

/// The parts of a viewer, and what the server's thread does with them. The owner's thread calls the
/// public functions.
class Viewer::State {
 public:
  State(LiveScene scene, const Device& device, const ViewerOptions& options,
        std::unique_ptr<Keeper> keeper)
      : live_(std::move(scene)),
        editor_(live_, options.files),
        keeping_(live_, editor_, std::move(keeper)),
        clients_(look_of_scene(live_.scene()), options.read_only),
        films_(live_, editor_, device, options, options.denoises),
        picker_(live_, editor_, films_, device.info().name),
        desk_(live_, editor_, keeping_, clients_, films_, device.info().name),
        checked_(live_.scene().view) {
    checked_.camera.medium.reset();  // looks do not set the medium
    desk_.prepare_greeting(options.read_only);
    if (options.denoises) {
      denoising_.emplace([this] { clients_.wake(); });
      clients_.greet_with({{"denoise", true}});
    }
    ServerEvents events;
    events.file = page_file;
    events.joined = [this](ClientId id) { server_->send(id, clients_.join(id)); };
    events.left = [this](ClientId id) { clients_.leave(id); };
    events.message = [this](ClientId id, const std::string& text) { said(id, text); };
    events.picture = [this](ClientId id) { return picture_for(id); };
    server_.emplace(options.server, std::move(events));
    loop_.emplace(RenderTools{clients_, *server_, films_, picker_, desk_, keeping_,
                              denoising_ ? &*denoising_ : nullptr});
  }

  ~State() { (void)end(); }

  std::optional<std::filesystem::path> end() {
    clients_.end();
    loop_.reset();
    denoising_.reset();
    server_.reset();
    return keeping_.end();
  }

  std::string address() const { return server_->address(); }
  std::uint16_t port() const { return server_->port(); }
  void wait(double seconds) { loop_->wait(seconds); }

 private:
  // The server's thread calls these.

  /// Throws InputError for a look that this scene cannot have; such a look is not accepted.
  void check_look(const ShowView& look) const {
    for (const int eye : {0, 1}) check_edit(Scene(), shown_view(checked_, look, 1, eye));
  }

  void said(ClientId id, const std::string& text) try {
    const Message message = parse_message(text);
    if (const ShowView* look = std::get_if<ShowView>(&message)) check_look(*look);
    const std::vector<ClientId> others = clients_.take(id, message, text);
    if (others.empty()) return;
    nlohmann::ordered_json told;
    if (const Denoise* denoise = std::get_if<Denoise>(&message)) {
      told = {{"type", "denoise"}, {"on", denoise->on}};
    } else {
      told = camera_text(std::get<ShowView>(message));
      told["type"] = "looked";
    }
    for (const ClientId other : others) server_->send(other, text_of(told));
  } catch (const InputError& error) {
    server_->send(id, error_text(error.what()));
  }

  Text picture_for(ClientId id) {
    const std::optional<Clients::NextPicture> next = clients_.next_picture(id);
    if (!next) return {};
    return std::make_shared<const std::string>(packed(*next->now, next->before.get()));
  }

  // The renderer's thread uses these while there is one.
  LiveScene live_;
  Editor editor_;
  Keeping keeping_;
  Clients clients_;  // any thread
  EyeFilms films_;
  Picker picker_;
  EditDesk desk_;
  View checked_;  // the server's thread
  std::optional<Denoising> denoising_;
  std::optional<Server> server_;
  std::optional<RenderLoop> loop_;
};

Viewer::Viewer(LiveScene scene, const Device& device, const ViewerOptions& options,
               std::unique_ptr<Keeper> keeper)
    : state_(std::make_unique<State>(std::move(scene), device, options, std::move(keeper))) {}
Viewer::~Viewer() = default;
std::string Viewer::address() const { return state_->address(); }
std::uint16_t Viewer::port() const { return state_->port(); }
void Viewer::wait(double seconds) { state_->wait(seconds); }
std::optional<std::filesystem::path> Viewer::end() { return state_->end(); }

}  // namespace caplet::view
