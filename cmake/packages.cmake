# SPDX-License-Identifier: Apache-2.0
# The package for Debian and Ubuntu that `./run package` makes: docs/package.md. Included where CAPLET_PACKAGE is set.
include(GNUInstallDirs)
file(STRINGS /etc/os-release os_release REGEX "^(ID|VERSION_ID|VERSION_CODENAME)=")
foreach(line ${os_release})
  string(REGEX MATCH "^([A-Z_]+)=\"?([^\"]*)" unused "${line}")
  set(os_${CMAKE_MATCH_1} ${CMAKE_MATCH_2})
endforeach()
string(REPLACE "debian" "deb" system "${os_ID}${os_VERSION_ID}")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME caplet)
set(CPACK_PACKAGE_CONTACT "Caplet authors <caplet@localhost.localdomain>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "OpenCL path tracer of exact analytic solids")
set(CPACK_PACKAGE_DESCRIPTION
"Caplet renders neurons, molecules, robots, fibres and lattices as what they
are: true tapered capsules, spheres and other solids, not triangles, with
millions of them at a time. It runs on any processor through PoCL, and on any
device with an OpenCL 1.2 driver.

This package has the program, its library with headers and CMake files,
completions for bash, zsh and fish, and example scenes.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)

# 12's version is lower than 13's: a system that is upgraded takes the newer package. DEB-DEFAULT: NAME_VERSION_ARCHITECTURE.deb.
set(CPACK_DEBIAN_PACKAGE_RELEASE "1~${system}")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
# Those of the program, the library and its module are found by dpkg-shlibdeps.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "bash-completion, ffmpeg")
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/triggers)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

# What Debian's policy wants of each package. The date is that of the sources (SOURCE_DATE_EPOCH, else the last commit's, else now).
set(debian ${PROJECT_BINARY_DIR}/debian)
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
  execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} log -1 --format=%ct OUTPUT_VARIABLE epoch OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(epoch)
    set(ENV{SOURCE_DATE_EPOCH} ${epoch})
  endif()
endif()
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
file(CONFIGURE OUTPUT ${debian}/changelog.Debian @ONLY CONTENT [[caplet (@version@) @os_VERSION_CODENAME@; urgency=medium

  * Version @PROJECT_VERSION@; changelog.gz tells what is new.

 -- @CPACK_PACKAGE_CONTACT@  @date@
]])
foreach(text ${debian}/changelog.Debian ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/NOTICE)
  get_filename_component(name ${text} NAME)
  string(REPLACE "CHANGELOG.md" "changelog" name ${name})
  execute_process(COMMAND gzip -9nc ${text} OUTPUT_FILE ${debian}/${name}.gz COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${debian}/${name}.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
endforeach()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/NOTICE)
install(FILES cmake/debian/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES cmake/debian/lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME caplet)
install(CODE [[file(GLOB pages "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share/man/man1/*.1")
execute_process(COMMAND gzip -9nf ${pages} COMMAND_ERROR_IS_FATAL ANY)]])

include(CPack)
