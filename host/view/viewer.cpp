// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <future>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>

#include "base/clock.h"
#include "base/error.h"
#include "base/log.h"
#include "base/utf8.h"
#include "film/develop.h"
#include "lower/camera.h"
#include "lower/identity.h"
#include "render/query.h"
#include "render/session.h"
#include "report/pick_report.h"
#include "view/detail/keeping.h"
#include "view/detail/scene_text.h"
#include "view/detail/shown_view.h"
#include "view/detail/snapshot.h"
#include "view/editor.h"
#include "view/forms.h"
#include "view/messages.h"
#include "view/page.h"
#include "view/picture.h"

namespace caplet::view {

namespace {

constexpr int coarsest_scale = 16;
constexpr double first_guess_paths_a_second = 5e5;
constexpr std::size_t most_crossings = 4096;
constexpr std::size_t most_questions = 16, most_edits = 1000;  // limits of waiting messages

using Text = std::shared_ptr<const std::string>;

Text text_of(const nlohmann::ordered_json& message) { return std::make_shared<const std::string>(json_dump(message)); }

/// Thrown when a new view is requested, to abandon the picture in progress.
struct Superseded {};

/// `number`: of the request, if it has one.
std::string error_text(const std::string& what, double number = 0) {
  nlohmann::ordered_json out{{"type", "error"}, {"text", what}};
  if (number > 0) out["number"] = number;
  return json_dump(out);
}

}  // namespace

class Viewer::State {
 public:
  State(LiveScene scene, const Device& device, const ViewerOptions& options, std::unique_ptr<Keeper> keeper)
      : options_(options), live_(std::move(scene)), editor_(live_), device_(device), keeping_(live_, editor_, std::move(keeper)) {
    full_ = wanted_ = look_of_scene(live_.scene());
    session_.emplace(live_.flat(), live_.view(), std::vector<Device>{device}, session_options());
    (void)live_.take_changes();
    query_.emplace(*session_->scene_on(0));
    const RayRecord any{0, 0, 0, 0, 0, 0, 1, INFINITY};
    (void)query_->closest(std::span(&any, 1));  // compiles the query's kernel
    ServerEvents events;
    events.file = page_file;
    events.joined = [this](ClientId id) { joined(id); };
    events.left = [this](ClientId id) { left(id); };
    events.message = [this](ClientId id, const std::string& text) { said(id, text); };
    events.picture = [this](ClientId id, std::uint64_t& shown) { return picture_for(id, shown); };
    checked_ = view_of(live_.scene());
    checked_.camera.medium.reset();  // looks do not set the medium
    hello_ = told_scene();
    hello_["parts"] = told_parts();
    hello_["lists"] = lists_text();
    hello_["home"] = camera_text(full_);
    hello_["read_only"] = options.read_only;
    hello_["can_undo"] = editor_.can_undo();
    hello_["can_redo"] = editor_.can_redo();
    hello_["session"] = random_token();
    hello_["keep"] = keeping_.text();
    server_.emplace(options.server, std::move(events));
    thread_ = std::thread([this] { run(); });
  }

  ~State() { (void)end(); }

  std::optional<std::filesystem::path> end() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
    server_.reset();
    return keeping_.end();
  }

  std::string address() const { return server_->address(); }
  std::uint16_t port() const { return server_->port(); }

  void wait(double seconds) {
    std::unique_lock lock(mutex_);
    failed_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return failure_ != nullptr; });
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  using Question = std::variant<Ask, Describe, Form>;
  struct Wish {
    ClientId from = 0;
    Message message;
    std::string text;
  };
  struct Client {
    bool seen = true;
    std::array<std::shared_ptr<const Picture>, 2> shown;  // for both eyes
    std::deque<Question> asked;
    bool wants_snapshot = false;
  };

  SessionOptions session_options() const {
    SessionOptions out;
    out.layers = Layers::none().with(Layer::object).with(Layer::primitive).with(Layer::variance);
    out.batch_paths = options_.batch_paths;
    return out;
  }

  nlohmann::ordered_json told_scene() const { return scene_text(live_.scene(), device_.info().name, target()); }
  nlohmann::ordered_json told_parts() const {
    nlohmann::ordered_json out = parts_text(live_.scene());
    out["hidden"] = hidden_text(live_.scene(), editor_.hidden());
    return out;
  }

  std::uint32_t target() const {
    return static_cast<std::uint32_t>(options_.samples > 0 ? options_.samples : live_.scene().sampler.samples_per_pixel);
  }

  // --- On the server's thread ---

  void joined(ClientId id) {
    Text hello;
    {
      const std::lock_guard lock(mutex_);
      clients_[id];
      hello_["camera"] = camera_text(wanted_);
      hello = text_of(hello_);
    }
    changed_.notify_all();
    server_->send(id, hello);
  }

  void left(ClientId id) {
    const std::lock_guard lock(mutex_);
    clients_.erase(id);
  }

  /// Throws InputError for a look that this scene cannot have; such a look is not accepted.
  void check_look(const ShowView& look) const {
    for (const int eye : {0, 1}) check_edit(Scene(), shown_view(checked_, look, 1, eye));
  }

  void said(ClientId id, const std::string& text) try {
    const Message message = parse_message(text);
    if (const ShowView* look = std::get_if<ShowView>(&message)) check_look(*look);
    std::vector<ClientId> others;
    {
      const std::lock_guard lock(mutex_);
      Client& client = clients_[id];
      if (const ShowView* look = std::get_if<ShowView>(&message)) {
        wanted_ = *look;
        ++wanted_number_;
        for (const auto& [other, of] : clients_)
          if (other != id) others.push_back(other);
      } else if (const Seen* seen = std::get_if<Seen>(&message)) {
        client.seen = seen->seen;
      } else if (const Ask* ask = std::get_if<Ask>(&message)) {
        // Only the last of several queries for the pixel under the cursor counts.
        if (!ask->all)
          std::erase_if(client.asked,
                        [](const Question& other) { return std::holds_alternative<Ask>(other) && !std::get<Ask>(other).all; });
        if (client.asked.size() < most_questions) client.asked.emplace_back(*ask);
      } else if (const Describe* describe = std::get_if<Describe>(&message)) {
        if (client.asked.size() < most_questions) client.asked.emplace_back(*describe);
      } else if (const Form* form = std::get_if<Form>(&message)) {
        if (client.asked.size() < most_questions) client.asked.emplace_back(*form);
      } else if (std::holds_alternative<Snapshot>(message)) {
        client.wants_snapshot = true;
      } else {
        if (options_.read_only) throw InputError("this scene is shown read-only");
        if (edits_.size() >= most_edits) throw InputError("too many changes at once");
        edits_.push_back({id, message, text});
      }
    }
    changed_.notify_all();
    if (others.empty()) return;
    nlohmann::ordered_json looked = camera_text(std::get<ShowView>(message));
    looked["type"] = "looked";
    for (const ClientId other : others) server_->send(other, text_of(looked));
  } catch (const InputError& error) {
    server_->send(id, std::make_shared<const std::string>(error_text(error.what())));
  }

  Text picture_for(ClientId id, std::uint64_t& shown) {
    std::shared_ptr<const Picture> now, before;
    {
      const std::lock_guard lock(mutex_);
      const auto client = clients_.find(id);
      if (client == clients_.end() || !client->second.seen) return {};
      const auto is_new = [&](std::size_t eye) {
        const auto& had = client->second.shown[eye];
        return pictures_[eye] && (!had || had->version != pictures_[eye]->version);
      };
      if (!is_new(0) && !is_new(1)) return {};
      const std::size_t eye = is_new(0) ? 0 : 1;
      now = pictures_[eye];
      before = std::exchange(client->second.shown[eye], now);
    }
    shown = now->version;
    return std::make_shared<const std::string>(packed(*now, before.get()));
  }

  // --- On the renderer's thread ---

  void run() try {
    for (;;) {
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] {
          return ended_ || wanted_number_ != number_ || !edits_.empty() || asked() || (is_seen() && has_more());
        });
        if (ended_) return;
      }
      answer_all();
      try {
        const bool edited = edit_all();
        const std::optional<ShowView> look = take_wanted();
        if (edited || look) begin(look.value_or(full_));
        if (is_seen_now() && has_more()) step();
      } catch (const Superseded&) {
        scale_ = 0;
      } catch (const InputError& error) {  // the scene cannot have such a view
        server_->send_to_all(std::make_shared<const std::string>(error_text(error.what())));
      }
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    failed_.notify_all();
  }

  // These require the mutex:
  bool is_seen() const {
    return std::ranges::any_of(clients_, [](const auto& client) { return client.second.seen; });
  }
  bool asked() const {
    return std::ranges::any_of(clients_,
                               [](const auto& client) { return !client.second.asked.empty() || client.second.wants_snapshot; });
  }
  bool is_seen_now() {
    const std::lock_guard lock(mutex_);
    return is_seen();
  }
  bool has_more() const { return scale_ != 1 || samples_[eyes() - 1] < target(); }

  std::optional<ShowView> take_wanted() {
    const std::lock_guard lock(mutex_);
    if (wanted_number_ == number_) return {};
    number_ = wanted_number_;
    return wanted_;
  }

  /// Makes the waiting changes and saves; returns whether the scene has changed.
  bool edit_all() {
    std::deque<Wish> wishes;
    {
      const std::lock_guard lock(mutex_);
      wishes.swap(edits_);
    }
    if (wishes.empty()) return false;
    const std::uint64_t before = editor_.rearrangements(), numbers = editor_.renumberings();
    bool edited = false;
    std::vector<std::pair<ClientId, Text>> made;
    for (const Wish& wish : wishes) try {
        if (const Save* save = std::get_if<Save>(&wish.message)) {
          tell(keeping_.save(*save, full_, [this] { return is_ending(); }), wish.from);
          continue;
        }
        edited = keeping_.make(wish.message, wish.text) || edited;
        if (const Edit* edit = std::get_if<Edit>(&wish.message); edit && edit->number > 0)
          made.emplace_back(wish.from, text_of({{"type", "made"}, {"number", edit->number}, {"ids", editor_.made()}}));
      } catch (const std::exception& error) {  // an invalid scene, or a file that cannot be written
        const Edit* edit = std::get_if<Edit>(&wish.message);
        server_->send(wish.from, std::make_shared<const std::string>(error_text(error.what(), edit ? edit->number : 0)));
      }
    nlohmann::ordered_json told{{"type", "edited"},
                                {"can_undo", editor_.can_undo()},
                                {"can_redo", editor_.can_redo()},
                                {"renumbered", editor_.renumberings() != numbers},
                                {"keep", keeping_.text()}};
    if (editor_.rearrangements() != before) told["scene"] = told_scene();
    told["samples"] = target();
    told["parts"] = told_parts();
    {
      const std::lock_guard lock(mutex_);
      for (const char* name : {"can_undo", "can_redo", "keep", "samples", "parts"}) hello_[name] = told[name];
      if (told.contains("scene"))
        for (const auto& [name, value] : told["scene"].items()) hello_[name] = value;
    }
    server_->send_to_all(text_of(told));
    for (const auto& [id, text] : made) server_->send(id, text);
    return edited;
  }

  /// Sends the result of saving: questions to the client that asked, all else to everyone.
  void tell(const nlohmann::ordered_json& told, ClientId asked) {
    if (told["type"] != "saved") return server_->send(asked, text_of(told));
    {
      const std::lock_guard lock(mutex_);
      hello_["home"] = camera_text(keeping_.own_look());
    }
    server_->send_to_all(text_of(told));
  }

  bool is_ending() {
    const std::lock_guard lock(mutex_);
    return ended_;
  }

  bool is_superseded() {
    const std::lock_guard lock(mutex_);
    return ended_ || wanted_number_ != number_ || !edits_.empty();
  }

  std::size_t eyes() const { return full_.separation > 0 ? 2 : 1; }

  void look_with(const ShowView& look, int scale, std::size_t eye) {
    ViewEdit own = view_of(live_.scene());
    own.camera = editor_.view().camera;
    live_.edit(shown_view(own, look, scale, static_cast<int>(eye)));
    session_->update(live_.flat(), live_.take_changes(), live_.view());
    eye_ = eye;
  }

  /// Starts the film of `look` with a pixel for each square of `scale` pixels.
  void set_film(const ShowView& look, int scale) {
    look_with(look, scale, 0);
    scale_ = scale;
    samples_ = {0, 0};
    films_ = {};
  }

  /// Switches to the other eye of a pair and resumes its film.
  void change_eyes() {
    films_[eye_] = session_->film();
    look_with(full_, scale_, 1 - eye_);
    if (samples_[eye_] > 0) session_->resume(std::move(*films_[eye_]));
  }

  void begin(const ShowView& look) {
    scale_ = 0;
    const double pixels = static_cast<double>(look.width) * look.height;
    int scale = 1;
    while (scale < coarsest_scale && pixels > options_.coarse_seconds * paths_a_second_ * scale * scale) scale *= 2;
    set_film(look, scale);
    full_ = look;
    ++view_;
    const std::lock_guard lock(mutex_);
    if (eyes() == 1) pictures_[1].reset();
  }

  void step() {
    const bool both = samples_[0] > 0 && (eyes() == 1 || samples_[1] > 0);
    if (scale_ == 0 || (scale_ > 1 && both)) set_film(full_, 1);
    const std::size_t eye = eyes() == 2 && samples_[1] < samples_[0] ? 1 : 0;
    if (eye != eye_) change_eyes();
    const double pixels = static_cast<double>(live_.scene().film.width) * live_.scene().film.height;
    const double affordable = options_.step_seconds * paths_a_second_ / pixels;
    std::uint32_t count = 1;
    if (scale_ == 1)
      count = eye == 1 ? samples_[0] - samples_[1]
                       : std::clamp(static_cast<std::uint32_t>(affordable), 1u,
                                    std::max(1u, std::min(samples_[0], target() - samples_[0])));
    const bool is_coarse = scale_ > 1;
    const Clock::time_point start = Clock::now();
    session_->render(count, [&](const SessionProgress&) {
      answer_all();
      // A coarse picture is always shown, because nothing else appears while the camera moves.
      if (!is_coarse && is_superseded()) throw Superseded();
    });
    const double seconds = std::max(1e-4, seconds_since(start));
    paths_a_second_ = 0.5 * (paths_a_second_ + pixels * count / seconds);
    samples_[eye_] += count;
    publish();
    if (scale_ == 1) keeping_.pause();
  }

  void publish() {
    NotFinite not_finite;
    const LayeredImage image = develop(session_->film(), live_.scene(), session_options().layers, not_finite);
    auto picture = std::make_shared<Picture>(shown_of(image, scale_ == 1));
    picture->version = ++version_;
    picture->view = view_;
    picture->eye = static_cast<int>(eye_);
    picture->scale = scale_;
    picture->samples = samples_[eye_];
    {
      const std::lock_guard lock(mutex_);
      pictures_[eye_] = std::move(picture);
    }
    server_->picture_changed();
  }

  void answer_all() {
    for (;;) {
      ClientId id = 0;
      std::optional<Question> question;
      {
        const std::lock_guard lock(mutex_);
        const auto found = std::ranges::find_if(
            clients_, [](const auto& client) { return !client.second.asked.empty() || client.second.wants_snapshot; });
        if (found == clients_.end()) return;
        id = found->first;
        if (!found->second.asked.empty()) {
          question = found->second.asked.front();
          found->second.asked.pop_front();
        } else {
          if (scale_ != 1 || samples_[0] == 0) return;  // waits for the first picture
          found->second.wants_snapshot = false;
        }
      }
      if (question)
        server_->send(id, std::visit([this](const auto& it) { return answer(it); }, *question));
      else
        server_->send(id, snapshot(), true);
    }
  }

  Text answer(const Ask& ask) {
    nlohmann::ordered_json out{{"type", "answer"}, {"number", ask.number}};
    const Scene& scene = live_.scene();
    // The ray belongs to the pixel of the full picture, even if a coarse one is rendered.
    const RayRecord ray = ray_at(ask);
    report::PickReport told;
    told.pixel = {ask.x, ask.y};
    told.ray = ray;
    told.device = device_.info().name;
    told.all = true;  // reports a list, even for the nearest crossing only
    if (ask.all) {
      told.crossings = query_->all(std::span(&ray, 1), most_crossings).crossings;
    } else if (const PickRecord pick = query_->closest(std::span(&ray, 1))[0]; pick.object != CAPLET_NONE) {
      told.crossings = {pick};
    }
    if (ask.reference) told.reference = report::reference_crossings(scene, ray, ask.all);
    out["pick"] = nlohmann::ordered_json::parse(report::json_text(told, scene));
    return text_of(out);
  }

  Text answer(const Describe& describe) {
    nlohmann::ordered_json out{{"type", "answer"}, {"number", describe.number}};
    out["thing"] = thing_text(live_.scene(), describe.id, describe.primitive);
    return text_of(out);
  }

  Text answer(const Form& form) {
    nlohmann::ordered_json out{{"type", "answer"}, {"number", form.number}};
    out["form"] = form_text(live_.scene(), editor_.view(), form.part);
    return text_of(out);
  }

  RayRecord ray_at(const Ask& ask) const {
    ViewEdit own = view_of(live_.scene());
    own.camera = editor_.view().camera;
    const ViewEdit view = shown_view(own, full_, 1, ask.eye);
    Scene looked;
    looked.camera = view.camera;
    looked.film = view.film;
    return ray_of_pixel(looked, std::min(ask.x, full_.width - 1), std::min(ask.y, full_.height - 1));
  }

  Text snapshot() {
    return std::make_shared<const std::string>(
        exr_bytes(develop(eye_ == 0 ? session_->film() : *films_[0], live_.scene(), session_options().layers)));
  }

  ViewerOptions options_;
  ViewEdit checked_;
  LiveScene live_;
  Editor editor_;
  Device device_;
  Keeping keeping_;
  std::optional<Session> session_;
  std::optional<Query> query_;
  std::optional<Server> server_;

  // Only the renderer's thread uses these.
  ShowView full_;
  std::uint64_t number_ = 0, version_ = 0;
  std::uint32_t view_ = 1;
  std::array<std::uint32_t, 2> samples_{};  // for both eyes
  std::array<std::optional<Film>, 2> films_;
  std::size_t eye_ = 0;  // the eye whose film is in the session
  int scale_ = 0;        // of the film; 0: it is empty
  double paths_a_second_ = first_guess_paths_a_second;

  std::mutex mutex_;  // guards everything below
  std::condition_variable changed_, failed_;
  ShowView wanted_;
  std::uint64_t wanted_number_ = 1;
  std::deque<Wish> edits_;
  std::map<ClientId, Client> clients_;
  std::array<std::shared_ptr<const Picture>, 2> pictures_;
  nlohmann::ordered_json hello_;
  bool ended_ = false;
  std::exception_ptr failure_;

  std::thread thread_;
};

Viewer::Viewer(LiveScene scene, const Device& device, const ViewerOptions& options, std::unique_ptr<Keeper> keeper)
    : state_(std::make_unique<State>(std::move(scene), device, options, std::move(keeper))) {}
Viewer::~Viewer() = default;
std::string Viewer::address() const { return state_->address(); }
std::uint16_t Viewer::port() const { return state_->port(); }
void Viewer::wait(double seconds) { state_->wait(seconds); }
std::optional<std::filesystem::path> Viewer::end() { return state_->end(); }

}  // namespace caplet::view
