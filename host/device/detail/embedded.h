// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The kernel files as they were at build; the table itself is generated.
#pragma once

#include <span>

#include "base/embedded_file.h"

namespace caplet {

/// Their paths are from kernels/, as #include names them.
std::span<const EmbeddedFile> embedded_kernels();

}  // namespace caplet
