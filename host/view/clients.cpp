// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/clients.h"

#include <algorithm>

#include "base/error.h"
#include "view/detail/scene_text.h"

namespace caplet::view {

namespace {

constexpr std::size_t most_questions = 16, most_wishes = 1000;  // limits of waiting messages

}  // namespace

void Clients::Client::ask(Question question) {
  // Only the last of several queries for the pixel under the cursor counts.
  const auto is_hover = [](const Question& one) {
    return std::holds_alternative<Ask>(one) && !std::get<Ask>(one).all;
  };
  if (is_hover(question)) std::erase_if(asked, is_hover);
  if (asked.size() < most_questions) asked.push_back(std::move(question));
}

Text Clients::join(ClientId id) {
  Text greeting;
  {
    const std::lock_guard lock(mutex_);
    clients_[id];
    greeting_["camera"] = camera_text(wanted_);
    greeting = text_of(greeting_);
  }
  changed_.notify_all();
  return greeting;
}

void Clients::leave(ClientId id) {
  const std::lock_guard lock(mutex_);
  clients_.erase(id);
}

std::vector<ClientId> Clients::take(ClientId id, const Message& message, const std::string& text) {
  std::vector<ClientId> others;
  {
    const std::lock_guard lock(mutex_);
    Client& client = clients_[id];
    if (const ShowView* look = std::get_if<ShowView>(&message)) {
      wanted_ = *look;
      ++wanted_number_;
      others = all_but(id);
    } else if (const Denoise* denoise = std::get_if<Denoise>(&message)) {
      if (!greeting_.contains("denoise")) throw InputError("there is no Open Image Denoise");
      denoise_ = denoise->on;
      greeting_["denoise"] = denoise->on;
      others = all_but(id);
    } else if (const Seen* seen = std::get_if<Seen>(&message)) {
      client.is_seen = seen->seen;
    } else if (const Ask* ask = std::get_if<Ask>(&message)) {
      client.ask(*ask);
    } else if (const Describe* describe = std::get_if<Describe>(&message)) {
      client.ask(*describe);
    } else if (const Form* form = std::get_if<Form>(&message)) {
      client.ask(*form);
    } else if (std::holds_alternative<Snapshot>(message)) {
      client.wants_snapshot = true;
    } else if (const MakeFigure* figure = std::get_if<MakeFigure>(&message)) {
      client.figure = *figure;
      client.wants_figure = false;
    } else if (std::holds_alternative<EndFigure>(message)) {
      client.figure.reset();
      client.wants_figure = false;
    } else {
      wish(id, message, text);
    }
  }
  changed_.notify_all();
  return others;
}

std::vector<ClientId> Clients::all_but(ClientId id) const {
  std::vector<ClientId> out;
  for (const auto& [other, of] : clients_)
    if (other != id) out.push_back(other);
  return out;
}

void Clients::wish(ClientId id, const Message& message, const std::string& text) {
  if (read_only_) throw InputError("this scene is shown read-only");
  if (wishes_.size() >= most_wishes) throw InputError("too many changes at once");
  wishes_.push_back({id, message, text});
}

std::optional<Clients::NextPicture> Clients::next_picture(ClientId id) {
  const std::lock_guard lock(mutex_);
  const auto client = clients_.find(id);
  if (client == clients_.end() || !client->second.is_seen) return {};
  for (std::size_t eye = 0; eye < pictures_.size(); ++eye) {
    auto& shown = client->second.shown[eye];
    if (!pictures_[eye] || (shown && shown->version == pictures_[eye]->version)) continue;
    std::shared_ptr<const Picture> before = std::exchange(shown, pictures_[eye]);
    return NextPicture{pictures_[eye], std::move(before)};
  }
  return {};
}

bool Clients::any(const std::function<bool(const Client&)>& is_so) const {
  return std::ranges::any_of(clients_, [&](const auto& client) { return is_so(client.second); });
}

bool Clients::wait_for_work(bool has_more) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] {
    return ended_ || is_called_ || denoise_ || wanted_number_ != taken_number_ ||
           !wishes_.empty() || any(&Client::waits) || any(&Client::has_figure) ||
           (has_more && any(&Client::is_seen));
  });
  is_called_ = false;
  return !ended_;
}

std::optional<ShowView> Clients::take_look() {
  const std::lock_guard lock(mutex_);
  if (wanted_number_ == taken_number_) return {};
  taken_number_ = wanted_number_;
  return wanted_;
}

std::optional<bool> Clients::take_denoise() {
  const std::lock_guard lock(mutex_);
  return std::exchange(denoise_, {});
}

std::deque<Wish> Clients::take_wishes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(wishes_, {});
}

std::optional<Clients::Asked> Clients::take_question(bool has_snapshot) {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::ranges::find_if(clients_, [](const auto& client) { return client.second.waits(); });
  if (found == clients_.end()) return {};
  auto& [id, client] = *found;
  if (!client.asked.empty()) {
    Asked out{id, std::move(client.asked.front())};
    client.asked.pop_front();
    return out;
  }
  if (!has_snapshot) return {};
  client.wants_snapshot = false;
  return Asked{id, {}};
}

std::optional<Clients::AskedFigure> Clients::take_figure() {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::ranges::find_if(clients_, [](const auto& client) { return client.second.has_figure(); });
  if (found == clients_.end()) return {};
  auto& [id, client] = *found;
  client.wants_figure = true;
  return AskedFigure{id, *std::exchange(client.figure, {})};
}

bool Clients::wants_figure(ClientId id) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(id);
  return !ended_ && found != clients_.end() && found->second.wants_figure;
}

bool Clients::is_seen() {
  const std::lock_guard lock(mutex_);
  return any(&Client::is_seen);
}

bool Clients::is_superseded() {
  const std::lock_guard lock(mutex_);
  return ended_ || wanted_number_ != taken_number_ || !wishes_.empty();
}

bool Clients::is_ended() {
  const std::lock_guard lock(mutex_);
  return ended_;
}

void Clients::show(std::size_t eye, std::shared_ptr<const Picture> picture) {
  const std::lock_guard lock(mutex_);
  pictures_[eye] = std::move(picture);
}

void Clients::show_one_eye() {
  const std::lock_guard lock(mutex_);
  pictures_[1].reset();
}

void Clients::greet_with(const nlohmann::ordered_json& members) {
  const std::lock_guard lock(mutex_);
  for (const auto& [name, value] : members.items()) greeting_[name] = value;
}

void Clients::wake() {
  {
    const std::lock_guard lock(mutex_);
    is_called_ = true;
  }
  changed_.notify_all();
}

void Clients::end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
}

}  // namespace caplet::view
