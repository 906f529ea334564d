# SPDX-License-Identifier: MIT
#
# An overlay port: it takes the sources that it lies in, so that there is nothing to fetch. In a registry, vcpkg_from_git with the
# repository and a commit takes the place of the next line.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../.." ABSOLUTE)

set(VCPKG_BUILD_TYPE release)  # headers: there is nothing to debug
vcpkg_check_features(OUT_FEATURE_OPTIONS features FEATURES mpi ABUT_MPI)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS -DABUT_TESTS=OFF -DABUT_EXAMPLES=OFF -DABUT_BENCH=OFF ${features})
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/abut)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/lib" "${CURRENT_PACKAGES_DIR}/share/doc")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
