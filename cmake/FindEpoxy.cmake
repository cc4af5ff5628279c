# Finds libepoxy, which has no CMake package: target Epoxy::epoxy, variable Epoxy_FOUND.
find_path(Epoxy_INCLUDE_DIR epoxy/gl.h)
find_library(Epoxy_LIBRARY epoxy)
mark_as_advanced(Epoxy_INCLUDE_DIR Epoxy_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Epoxy REQUIRED_VARS Epoxy_LIBRARY Epoxy_INCLUDE_DIR)

if(Epoxy_FOUND AND NOT TARGET Epoxy::epoxy)
  add_library(Epoxy::epoxy UNKNOWN IMPORTED)
  set_target_properties(Epoxy::epoxy PROPERTIES
    IMPORTED_LOCATION "${Epoxy_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Epoxy_INCLUDE_DIR}")
endif()
