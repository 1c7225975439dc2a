// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

namespace caplet {

/// Light passes unchanged: the surface only separates media.
struct InterfaceMaterial {
  template <class Self, class Visit>
  static void fields(Self&, Visit&&) {}
};

}  // namespace caplet
