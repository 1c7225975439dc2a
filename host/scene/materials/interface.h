// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

namespace caplet {

/// Light goes on as if there were no surface: it bounds media alone.
struct InterfaceMaterial {
  template <class Self, class Visit>
  static void fields(Self&, Visit&&) {}
};

}  // namespace caplet
