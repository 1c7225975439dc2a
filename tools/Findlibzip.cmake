# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
#
# libzip as caplet_libzip: Debian 12's own package file of CMake wants programs that are in another package.
find_path(libzip_INCLUDE_DIR zip.h)
find_library(libzip_LIBRARY zip)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(libzip REQUIRED_VARS libzip_LIBRARY libzip_INCLUDE_DIR)
if(libzip_FOUND AND NOT TARGET caplet_libzip)
  add_library(caplet_libzip UNKNOWN IMPORTED)
  set_target_properties(caplet_libzip PROPERTIES IMPORTED_LOCATION "${libzip_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${libzip_INCLUDE_DIR}")
endif()
mark_as_advanced(libzip_INCLUDE_DIR libzip_LIBRARY)
