// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Resolves the names of media, and assigns media to surfaces.
#include <memory>

#include "import/detail/pbrt/resolve.h"

namespace caplet::pbrt {

namespace {

/// A csg is one solid with one medium: that of its statement, or else that of its operands (all but
/// the subtracted ones), which must agree.
MediumSides media_of_csg(const Shape& shape, Diagnostics& diagnostics) {
  const auto& csg = std::get<CsgShape>(shape.geometry);
  if (csg.operands.empty()) return shape.media;
  const bool difference = csg.operation == CsgShape::Operation::set_difference;
  const MediumSides sides = shape.media.differ() ? shape.media : csg.operands[0]->media;
  for (std::size_t i = 0; i < (difference ? 1 : csg.operands.size()); ++i) {
    const Shape& operand = *csg.operands[i];
    const bool says_nothing = shape.media.differ() && !operand.media.differ();
    if (says_nothing || operand.media == sides || (!operand.media.differ() && !sides.differ()))
      continue;
    diagnostics.error(
        operand.where,
        "the operand of a csg has another MediumInterface than " +
            std::string(shape.media.differ() ? "the csg itself" : "the first operand") +
            ": a csg is of one medium (" + shape.where.to_string() + ")");
    return shape.media;
  }
  return sides.differ() ? sides : shape.media;
}

class MediumUses {
 public:
  explicit MediumUses(Draft& draft) : draft_(draft), said_(draft.media.uses.size()) {}

  /// Replaces the index of a use by that of the medium in the scene. An undefined medium is
  /// reported once.
  void resolve(std::optional<std::uint32_t>& side) {
    if (!side) return;
    const std::uint32_t number = *side;
    side.reset();
    const auto found = draft_.media.statements.find(draft_.media.uses[number].name);
    if (found == draft_.media.statements.end()) return report(number);
    MediumStatement& statement = found->second;
    if (!statement.sound) return;  // reported already
    if (!statement.index) {
      statement.index = static_cast<std::uint32_t>(draft_.scene.media.size());
      draft_.scene.media.push_back(statement.medium);
    }
    side = statement.index;
  }

  void resolve(Shape& shape) {
    resolve(shape.media.inside);
    resolve(shape.media.outside);
    auto* const csg = std::get_if<CsgShape>(&shape.geometry);
    if (!csg) return;
    const auto change = [&](const auto& how) {
      for (std::shared_ptr<const Shape>& operand : csg->operands) {
        auto own = std::make_shared<Shape>(*operand);
        how(*own);
        operand = std::move(own);
      }
    };
    change([&](Shape& operand) { resolve(operand); });
    shape.media = media_of_csg(shape, draft_.diagnostics);
    change([](Shape& operand) { operand.media = {}; });
  }

  /// Checks the names that no surface uses too.
  void check_unused() {
    for (std::uint32_t i = 0; i < said_.size(); ++i)
      if (!draft_.media.statements.contains(draft_.media.uses[i].name)) report(i);
  }

 private:
  void report(std::uint32_t number) {
    const MediumDraft::Use& use = draft_.media.uses[number];
    if (!said_[number])
      draft_.diagnostics.error(use.where, "the medium " + in_quotes(use.name) + " is not defined" +
                                              draft_.nearest(use.name, draft_.media.statements));
    said_[number] = true;
  }

  Draft& draft_;
  std::vector<bool> said_;
};

}  // namespace

void resolve_media(Draft& draft) {
  MediumUses uses(draft);
  uses.resolve(draft.scene.view.camera.medium);
  draft.each_shape([&](Shape& shape) { uses.resolve(shape); });
  uses.check_unused();
}

}  // namespace caplet::pbrt
