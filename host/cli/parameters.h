// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet info --parameters`: lists the parameters of statements in scene files.
#pragma once

#include <string>
#include <vector>

namespace caplet::cli {

/// `names`: nothing, a family ("material"), or a family and a type ("material", "conductor"). Lists
/// families with their types, or the parameters of the types. Throws InputError for unknown names.
std::string parameters_text(const std::vector<std::string>& names);
/// Returns them as a JSON array of types, each with its parameters.
std::string parameters_json(const std::vector<std::string>& names);

}  // namespace caplet::cli
