// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Resolves the names of media, and assigns media to surfaces.
#include <functional>
#include <memory>

#include "import/detail/pbrt_media.h"
#include "import/detail/pbrt_parser.h"

namespace caplet::pbrt {

void Parser::make_named_medium() {
  const std::string name = string_argument("a name");
  Parameters given = parameters(owner(name), "medium");
  if (state_.skewed) check_place();
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

/// A csg is one solid with one medium: that of its statement, or else that of its operands (all but the subtracted ones), which
/// must agree.
MediumSides Parser::media_of_csg(const Shape& shape) {
  const auto& csg = std::get<CsgShape>(shape.geometry);
  if (csg.operands.empty()) return shape.media;
  const bool difference = csg.operation == CsgShape::Operation::set_difference;
  const MediumSides sides = shape.media.differ() ? shape.media : csg.operands[0]->media;
  for (std::size_t i = 0; i < (difference ? 1 : csg.operands.size()); ++i) {
    const Shape& operand = *csg.operands[i];
    const bool says_nothing = shape.media.differ() && !operand.media.differ();
    if (says_nothing || operand.media == sides || (!operand.media.differ() && !sides.differ())) continue;
    diagnostics_.error(operand.where, "the operand of a csg has another MediumInterface than " +
                                          std::string(shape.media.differ() ? "the csg itself" : "the first operand") +
                                          ": a csg is of one medium (" + shape.where.to_string() + ")");
    return shape.media;
  }
  return sides.differ() ? sides : shape.media;
}

/// Replaces names by indices of the scene's media. Only media that are used are added.
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
    if (!statement.sound) return;  // reported already
    if (!statement.index) {
      statement.index = static_cast<std::uint32_t>(scene_.media.size());
      scene_.media.push_back(statement.medium);
    }
    side = statement.index;
  };
  const std::function<void(Shape&)> visit = [&](Shape& shape) {
    resolve(shape.media.inside);
    resolve(shape.media.outside);
    if (auto* csg = std::get_if<CsgShape>(&shape.geometry)) {
      for (std::shared_ptr<const Shape>& operand : csg->operands) {
        auto own = std::make_shared<Shape>(*operand);
        visit(*own);
        operand = std::move(own);
      }
      shape.media = media_of_csg(shape);
      for (std::shared_ptr<const Shape>& operand : csg->operands) {
        auto own = std::make_shared<Shape>(*operand);
        own->media = {};
        operand = std::move(own);
      }
    }
  };
  resolve(scene_.camera.medium);
  for (Shape& shape : scene_.shapes) visit(shape);
  for (Object& object : scene_.objects)
    for (Shape& shape : object.shapes) visit(shape);
  // Unused names are checked too.
  for (std::uint32_t i = 0; i < medium_uses_.size(); ++i)
    if (!said[i] && !media_.contains(medium_uses_[i].name)) {
      std::optional<std::uint32_t> side = i;
      resolve(side);
    }
}

}  // namespace caplet::pbrt
