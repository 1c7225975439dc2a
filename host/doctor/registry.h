// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Where the ICD loader looks for drivers, and what is written there.
//
// ocl-icd: its manual page libOpenCL(7). Khronos: README of github.com/KhronosGroup/OpenCL-ICD-Loader and
// loader/linux/icd_linux.c.
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
  std::string library;  // as dlopen takes it
  std::string problem;  // of the .icd file; empty: none
};

struct Registry {
  std::string place;     // a folder, a file, or what a variable says
  std::string variable;  // that led there; empty: none
  std::string problem;   // why it holds no driver; empty: it does
  std::vector<Driver> drivers;
};

Registry read_registry(const Surroundings& machine, const Loader& loader);

/// Findings about the place and the .icd files, not about the libraries. That the place holds no driver is wrong, or a note where
/// there is another one, `has_bundled`.
Findings check_registry(const Registry& registry, bool has_bundled = false);

/// The variables that make the loader use `library` alone.
std::vector<std::pair<std::string, std::string>> only(const std::string& library, const Loader& loader);

/// What one types in front of a command to use it alone: "OCL_ICD_VENDORS=libpocl.so.2".
std::string only_text(const std::string& library, const Loader& loader);

extern const char* const install_a_driver;

}  // namespace caplet::doctor
