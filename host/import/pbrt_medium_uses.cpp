// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Media by their names, and the surfaces that part them.
#include "import/detail/pbrt_media.h"
#include "import/detail/pbrt_parser.h"

namespace caplet::pbrt {

void Parser::make_named_medium() {
  const std::string name = string_argument("a name");
  Parameters given = parameters(owner(name), "medium");
  const bool has_type = given.has("type");
  const std::string type = given.text("type", "");
  const auto [at, fresh] = media_.emplace(name, MediumStatement{});
  if (!fresh) {
    diagnostics_.error(
        where_, "the medium " + in_quotes(name) + " is defined twice (first at " + at->second.medium.where.to_string() + ")");
    return;
  }
  at->second.medium.where = where_;
  if (!has_type) return given.error("\"string type\" is missing");
  const Refusal refusal = refusal_of("MakeNamedMedium", type);
  if (!refusal.text.empty()) {
    diagnostics_.error(given.where("type"), refusal.text, refusal.text);
    return;
  }
  at->second.medium = make_medium(type, name, given, state_.ctm);
  at->second.sound = true;
}

void Parser::medium_interface() {
  const auto side = [&]() -> std::optional<std::uint32_t> {
    const SourceLocation place = lexer_->place(lexer_->peek());
    std::string name = string_argument("a medium's name (or \"\")");
    if (name.empty()) return std::nullopt;
    medium_uses_.push_back({std::move(name), place});
    return static_cast<std::uint32_t>(medium_uses_.size() - 1);
  };
  state_.media.inside = side();
  state_.media.outside = lexer_->peek().kind == Token::Kind::string ? side() : state_.media.inside;
}

/// Names become indices of the scene's media, which are those that something has.
void Parser::resolve_media() {
  std::vector<bool> said(medium_uses_.size());
  const auto resolve = [&](std::optional<std::uint32_t>& side) {
    if (!side) return;
    const std::uint32_t number = *side;
    const MediumUse& use = medium_uses_[number];
    side.reset();
    const auto found = media_.find(use.name);
    if (found == media_.end()) {
      if (!said[number])
        diagnostics_.error(use.where, "the medium " + in_quotes(use.name) + " is not defined" + nearest(use.name, media_));
      said[number] = true;
      return;
    }
    MediumStatement& statement = found->second;
    if (!statement.sound) return;  // reported
    if (!statement.index) {
      statement.index = static_cast<std::uint32_t>(scene_.media.size());
      scene_.media.push_back(statement.medium);
    }
    side = statement.index;
  };
  const auto visit = [&](Shape& shape) {
    resolve(shape.media.inside);
    resolve(shape.media.outside);
  };
  resolve(scene_.camera.medium);
  for (Shape& shape : scene_.shapes) visit(shape);
  for (Object& object : scene_.objects)
    for (Shape& shape : object.shapes) visit(shape);
  // What no shape has is looked at as well.
  for (std::uint32_t i = 0; i < medium_uses_.size(); ++i)
    if (!said[i] && !media_.contains(medium_uses_[i].name)) {
      std::optional<std::uint32_t> side = i;
      resolve(side);
    }
}

}  // namespace caplet::pbrt
