// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/resolve.h"

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

void resolve_instances(Draft& draft) {
  const ObjectDraft& objects = draft.objects;
  for (const ObjectDraft::Instance& use : objects.instances) {
    if (const auto found = objects.names.find(use.name); found != objects.names.end())
      draft.scene.instances.push_back({found->second, use.world_from_object, use.where});
    else
      draft.diagnostics.error(use.where, "the object " + in_quotes(use.name) + " is not defined" +
                                             draft.nearest(use.name, objects.names));
  }
}

}  // namespace

void resolve(Draft& draft) {
  resolve_media(draft);
  resolve_materials(draft);
  check_attributes(draft);
  resolve_instances(draft);
}

}  // namespace caplet::pbrt
