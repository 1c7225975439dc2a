// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds where the ICD loader looks for drivers, and what is registered there.
//
// Sources: for ocl-icd its manual page libOpenCL(7); for Khronos the README of
// github.com/KhronosGroup/OpenCL-ICD-Loader and loader/linux/icd_linux.c.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "doctor/finding.h"
#include "doctor/surroundings.h"

namespace caplet::doctor {

struct Loader {
  std::string name, vendor, version;  // empty: it does not say
  bool is_ocl_icd() const { return vendor.starts_with("OCL Icd"); }
};

struct Driver {
  std::string from;     // the .icd file, or the variable that names the library
  std::string library;  // as for dlopen
  std::string problem;  // of the .icd file; empty: none
};

struct Registry {
  std::string place;     // a folder, a file, or the value of a variable
  std::string variable;  // the variable that sets the place; empty: none
  std::string problem;   // why it contains no driver; empty: it does
  std::vector<Driver> drivers;
};

Registry read_registry(const Surroundings& machine, const Loader& loader);

/// Judges the place and the .icd files, not the libraries. A place without drivers is wrong, or
/// only a note if there is a bundled driver (`has_bundled`).
Findings check_registry(const Registry& registry, bool has_bundled = false);

/// Returns the variables that make the loader use only `library`.
std::vector<std::pair<std::string, std::string>> only(const std::string& library,
                                                      const Loader& loader);

/// Returns the text to type before a command to use only this library:
/// "OCL_ICD_VENDORS=libpocl.so.2".
std::string only_text(const std::string& library, const Loader& loader);

extern const char* const install_a_driver;

}  // namespace caplet::doctor
