# What a portable wheel has beside the package (docs/portable.md): the program, the script that calls it, and the linker of the bundled
# driver. tools/portable_wheel.py adds the driver itself.
install(TARGETS caplet RUNTIME DESTINATION caplet/bin COMPONENT python EXCLUDE_FROM_ALL)
install(PROGRAMS ${CMAKE_CURRENT_SOURCE_DIR}/portable/caplet DESTINATION ${SKBUILD_SCRIPTS_DIR} COMPONENT python EXCLUDE_FROM_ALL)
install(TARGETS caplet_driver_linker RUNTIME DESTINATION caplet/pocl/bin COMPONENT python EXCLUDE_FROM_ALL)
