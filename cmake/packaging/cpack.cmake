# SPDX-License-Identifier: MIT
#
# `cpack` in a build folder makes libabut-dev_<version>_all.deb: what is installed, below /usr, with what Debian wants beside it.

set(ABUT_PACKAGE_CONTACT "the abut authors <abut@example.org>" CACHE STRING "Maintainer that the Debian package names")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME libabut-dev)
set(CPACK_PACKAGE_VENDOR "the abut authors")
set(CPACK_PACKAGE_CONTACT "${ABUT_PACKAGE_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "collision geometry for C++20 (headers)")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "abut finds which shapes touch, where, how deep, and when: triangle meshes,
spheres, boxes, capsules, cylinders, cones, convex hulls and rays, at rest and
in motion. Whether shapes touch is decided exactly.
.
The library is header-only. One source runs on one thread, on OpenMP threads
and on CUDA, and gives the same answers on each.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "g++ (>= 4:12) | clang (>= 1:14)")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake (>= 3.25), pkg-config, libopenmpi-dev")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
# Without compiled code, and with no folder of an architecture, it suits each machine; else CPack asks dpkg which this one is.
get_property(abut_targets DIRECTORY ${PROJECT_SOURCE_DIR} PROPERTY BUILDSYSTEM_TARGETS)
set(abut_compiled OFF)
foreach(target IN LISTS abut_targets)
    get_target_property(type ${target} TYPE)
    if(target MATCHES "^abut_cuda_" AND type MATCHES "^(STATIC|SHARED|OBJECT)_LIBRARY$")
        set(abut_compiled ON)
    endif()
endforeach()
if(NOT abut_compiled AND CMAKE_INSTALL_LIBDIR STREQUAL "lib")
    set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE all)
endif()

configure_file(${PROJECT_SOURCE_DIR}/cmake/packaging/debian.cmake.in ${PROJECT_BINARY_DIR}/debian.cmake @ONLY)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_BINARY_DIR}/debian.cmake)
include(CPack)
