// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>

#include "import/detail/pbrt/resolve.h"
#include "scene/transform.h"

namespace caplet::pbrt {

namespace {

/// Reports parameters of Attribute statements that no statement after them knows.
void check_attributes(Draft& draft) {
  // An earlier Attribute counts as used if a later one of the same name that replaced it was used;
  // hence the reverse order.
  for (auto it = draft.attributes.rbegin(); it != draft.attributes.rend(); ++it)
    if ((*it)->replaced_by && (*it)->replaced_by->used) (*it)->used = true;
  for (const auto& parameter : draft.attributes)
    if (parameter->consulted && !parameter->used && !parameter->broken)
      draft.diagnostics.error(
          parameter->where,
          "no statement after this Attribute knows the parameter " + in_quotes(parameter->name));
}

/// Places an object, and the shapes that move within it.
void place(Draft& draft, const ObjectDraft::Instance& use, std::uint32_t object) {
  std::vector<Instance>& instances = draft.scene.instances;
  instances.push_back({object, use.world_from_object, use.where, use.motion,
                       use.motion.empty() ? glm::dvec3(0) : use.pivot});
  for (const ObjectDraft::MovingShape& shape : draft.objects.moving) {
    if (shape.of != object) continue;
    if (!use.motion.empty()) {
      draft.diagnostics.error(use.where, "a shape moves within the object " + in_quotes(use.name) +
                                             ", which moves itself: one of them must rest");
      return;
    }
    if (!is_similarity(use.world_from_object)) {
      draft.diagnostics.error(use.where, "a shape moves within the object " + in_quotes(use.name) +
                                             ", which is stretched here");
      return;
    }
    TransformKeys motion = shape.motion;
    move(motion, use.world_from_object);
    const glm::dmat4 first = motion.front().matrix;
    instances.push_back({shape.object, first, use.where, std::move(motion)});
  }
}

void resolve_instances(Draft& draft) {
  const ObjectDraft& objects = draft.objects;
  for (const ObjectDraft::Instance& use : objects.instances) {
    if (const auto found = objects.names.find(use.name); found != objects.names.end())
      place(draft, use, found->second);
    else
      draft.diagnostics.error(use.where, "the object " + in_quotes(use.name) + " is not defined" +
                                             draft.nearest(use.name, objects.names));
  }
}

/// Removes the objects of moving shapes that no instance places: operands of csg shapes are copies.
void drop_unplaced(Draft& draft) {
  Scene& scene = draft.scene;
  for (auto moving = draft.objects.moving.rbegin(); moving != draft.objects.moving.rend();
       ++moving) {
    const std::uint32_t unplaced = moving->object;
    if (std::ranges::any_of(scene.instances,
                            [&](const Instance& one) { return one.object == unplaced; }))
      continue;
    scene.objects.erase(scene.objects.begin() + static_cast<std::ptrdiff_t>(unplaced));
    for (Instance& instance : scene.instances)
      if (instance.object > unplaced) --instance.object;
  }
}

}  // namespace

void resolve(Draft& draft) {
  resolve_media(draft);
  resolve_materials(draft);
  check_attributes(draft);
  resolve_instances(draft);
  drop_unplaced(draft);
}

}  // namespace caplet::pbrt
