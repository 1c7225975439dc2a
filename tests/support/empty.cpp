// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// CMake precompiles headers for a target that has a source.
