// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The connected pages: what they wish, and what they have been shown.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "view/detail/replies.h"
#include "view/messages.h"
#include "view/picture.h"
#include "view/server.h"

namespace caplet::view {

/// A question that one page waits for.
using Question = std::variant<Ask, Describe, Form>;

/// A change or a save that a page asks for; `text` is the message as received.
struct Wish {
  ClientId from = 0;
  Message message;
  std::string text;
};

/// The state that the server's thread and the renderer's thread share, behind one mutex. It sends
/// nothing.
class Clients {
 public:
  Clients(const ShowView& look, bool read_only) : read_only_(read_only), wanted_(look) {}

  // The server's thread calls these.

  /// Adds a page, and returns the message that greets it.
  Text join(ClientId id);
  void leave(ClientId id);
  /// Stores what the page says. Returns the pages that have to be told of a new look, or of whether
  /// pictures are denoised. Throws InputError.
  std::vector<ClientId> take(ClientId id, const Message& message, const std::string& text);
  /// A picture that a page has not been shown, and the one of the same eye that it has.
  struct NextPicture {
    std::shared_ptr<const Picture> now, before;
  };
  /// Returns the next picture for a page, and notes it as shown; no value where there is none.
  std::optional<NextPicture> next_picture(ClientId id);

  // The renderer's thread calls these.

  /// Waits for something to do. `has_more`: the picture can be improved. Returns false when the
  /// session ends.
  bool wait_for_work(bool has_more);
  /// Returns the look that the pages want, if it is new.
  std::optional<ShowView> take_look();
  /// Returns whether the pages want pictures to be denoised, if that is new.
  std::optional<bool> take_denoise();
  std::deque<Wish> take_wishes();
  /// A page's next question; without a question it waits for a snapshot.
  struct Asked {
    ClientId from = 0;
    std::optional<Question> question;
  };
  /// Returns the next question, of the pages in order. A snapshot waits until `has_snapshot`.
  std::optional<Asked> take_question(bool has_snapshot);
  struct AskedFigure {
    ClientId from = 0;
    MakeFigure figure;
  };
  /// Returns the next figure that a page waits for.
  std::optional<AskedFigure> take_figure();
  /// Returns whether the page still waits for the figure that was taken.
  bool wants_figure(ClientId id);
  /// Returns whether a page is visible.
  bool is_seen();
  /// Returns whether the picture in progress is out of date.
  bool is_superseded();
  bool is_ended();
  void show(std::size_t eye, std::shared_ptr<const Picture> picture);
  /// Removes the picture of the right eye.
  void show_one_eye();
  /// Changes members of the message that greets new pages.
  void greet_with(const nlohmann::ordered_json& members);

  /// Ends wait_for_work. Any thread may call this.
  void wake();
  /// Ends the session. Any thread may call this.
  void end();

 private:
  struct Client {
    bool is_seen = true;
    std::array<std::shared_ptr<const Picture>, 2> shown;  // for both eyes
    std::deque<Question> asked;
    bool wants_snapshot = false;
    std::optional<MakeFigure> figure;  // not begun
    bool wants_figure = false;         // begun, and not ended

    bool waits() const { return !asked.empty() || wants_snapshot; }
    bool has_figure() const { return figure.has_value(); }
    void ask(Question question);
  };

  // These require the mutex:
  bool any(const std::function<bool(const Client&)>& is_so) const;
  std::vector<ClientId> all_but(ClientId id) const;
  void wish(ClientId id, const Message& message, const std::string& text);

  bool read_only_;
  std::mutex mutex_;  // guards everything below
  std::condition_variable changed_;
  ShowView wanted_;
  std::uint64_t wanted_number_ = 1, taken_number_ = 0;
  std::deque<Wish> wishes_;
  std::map<ClientId, Client> clients_;
  std::array<std::shared_ptr<const Picture>, 2> pictures_;
  nlohmann::ordered_json greeting_;
  std::optional<bool> denoise_;
  bool is_called_ = false, ended_ = false;
};

}  // namespace caplet::view
