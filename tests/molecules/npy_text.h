// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <string>
#include <vector>

namespace caplet::test {

/// A file of NumPy's format, version 1.0, of doubles.
inline std::string npy(const std::string& shape, const std::vector<double>& values) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + shape + "), }";
  header.resize(117, ' ');
  return std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n" +
         std::string(reinterpret_cast<const char*>(values.data()), 8 * values.size());
}

}  // namespace caplet::test
