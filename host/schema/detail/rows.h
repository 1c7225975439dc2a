// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Parameters that only scene files have; models hold them in another form or not at all.
#pragma once

#include <span>

#include "scene/field.h"
#include "schema/parameter.h"

namespace caplet::schema {

/// A parameter as a row of a table. types: names separated by blanks; fallback: as in Parameter.
struct Row {
  Field field;
  const char* types;
  const char* fallback = "";
};

Parameter parameter_of(const Row& row);
void add_rows(std::span<const Row> rows, std::vector<Parameter>& out);
/// Adds parameters without effect.
void add_ignored(std::span<const Row> rows, std::vector<Parameter>& out);

void add_shape(const std::string& type, std::vector<Parameter>& out);
void add_option(std::string_view directive, const std::string& type, std::vector<Parameter>& out);

}  // namespace caplet::schema
