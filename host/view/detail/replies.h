// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Messages to pages, ready to be sent.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/utf8.h"

namespace caplet::view {

using Text = std::shared_ptr<const std::string>;

inline Text text_of(const nlohmann::ordered_json& message) {
  return std::make_shared<const std::string>(json_dump(message));
}

/// Returns the message of an error. `number`: of the request, if it has one.
inline Text error_text(const std::string& what, double number = 0) {
  nlohmann::ordered_json out{{"type", "error"}, {"text", what}};
  if (number > 0) out["number"] = number;
  return text_of(out);
}

}  // namespace caplet::view
