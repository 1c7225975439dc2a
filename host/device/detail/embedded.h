// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This table holds the kernel files as they were at build; it is generated.
#pragma once

#include <span>
#include <string>

#include "base/embedded_file.h"

namespace caplet {

/// Returns the files. Their paths are from kernels/, as #include names them.
std::span<const EmbeddedFile> embedded_kernels();

/// Returns the text of kernels/math/builtins.cl, from $CAPLET_KERNELS where that folder has it.
std::string builtin_declarations();

}  // namespace caplet
