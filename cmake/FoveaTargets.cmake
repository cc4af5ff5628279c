# What every target of the project has in common.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# A folder finds its own libraries, but who links the folder's static library needs them too.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()
find_program(FOVEA_CCACHE ccache)
if(FOVEA_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${FOVEA_CCACHE})
endif()

add_library(fovea_warnings INTERFACE)
target_compile_options(fovea_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12
   AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # It sees overlaps inside std::string that cannot be (its bug 105651).
  target_compile_options(fovea_warnings INTERFACE -Wno-restrict)
endif()

if(CMAKE_UNITY_BUILD)
  # Names local to a file meet those of the files before it; builds of single files warn where it matters.
  target_compile_options(fovea_warnings INTERFACE -Wno-shadow)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(fovea_warnings INTERFACE -Wno-subobject-linkage)
  endif()
endif()

# Same bits on any machine: no contraction into fused multiply-adds that depends on the target. Nobody reads
# errno or traps after arithmetic; without that, roots and choices become vector instructions.
add_library(fovea_floating_point INTERFACE)
target_compile_options(fovea_floating_point INTERFACE -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Where it packs statements that follow each other, GCC 12 drops the rounding of double -> float -> double.
  target_compile_options(fovea_floating_point INTERFACE -fno-tree-slp-vectorize)
endif()

# fovea_module(name DEPENDS modules... LIBRARIES private libraries... HEADER_LIBRARIES libraries...
#              HEADERS public headers...)
# One folder of src/fovea: all its .cpp files, one static library. DEPENDS are the folders that its
# headers include; order in src/fovea/CMakeLists.txt forbids cycles. HEADER_LIBRARIES are private and
# nothing but headers, so that who links Fovea does not need them. HEADERS are installed; without the
# list all are.
function(fovea_module name)
  cmake_parse_arguments(arg "" "" "DEPENDS;LIBRARIES;HEADER_LIBRARIES;HEADERS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_library(fovea_${name} STATIC ${sources})
  add_library(fovea::${name} ALIAS fovea_${name})
  set_target_properties(fovea_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(fovea_${name} PUBLIC cxx_std_20)
  target_include_directories(fovea_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include>)
  foreach(dependency IN LISTS arg_DEPENDS)
    target_link_libraries(fovea_${name} PUBLIC fovea_${dependency})
  endforeach()
  target_link_libraries(fovea_${name} PRIVATE ${arg_LIBRARIES} $<BUILD_INTERFACE:fovea_warnings>
    $<BUILD_INTERFACE:fovea_floating_point>)
  foreach(library IN LISTS arg_HEADER_LIBRARIES)
    target_link_libraries(fovea_${name} PRIVATE $<BUILD_INTERFACE:${library}>)
  endforeach()
  fovea_public_headers(${name} "${arg_HEADERS}")
  set_property(GLOBAL APPEND PROPERTY FOVEA_MODULES fovea_${name})
endfunction()

# Remembers the headers of a folder that are for users.
function(fovea_public_headers name headers)
  if(NOT headers)
    file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/*.h)
  endif()
  list(TRANSFORM headers PREPEND fovea/${name}/)
  set_property(GLOBAL APPEND PROPERTY FOVEA_PUBLIC_HEADERS ${headers})
endfunction()
