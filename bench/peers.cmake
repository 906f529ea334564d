# SPDX-License-Identifier: MIT
#
# Libraries that no distribution packages, out of checkouts: ABUT_PEERS is a folder with coal/, fcpw/, ipc-toolkit/, libigl/ and tinybvh/,
# each where it is wanted. They are packages like others (cmake/development.cmake): a source that includes one that is not there is left out.

set(ABUT_PEERS "" CACHE PATH "Folder of checkouts of libraries that benchmarks are compared with: coal, fcpw, ipc-toolkit, libigl, tinybvh")

# The definition says which version of a peer it is.
function(abut_peer_version target name number)
    execute_process(COMMAND git -C ${ABUT_PEERS}/${name} log -1 --format=%h OUTPUT_VARIABLE commit ERROR_QUIET
                    OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(STRIP "${number} ${commit}" version)
    string(MAKE_C_IDENTIFIER ${name} name)
    string(TOUPPER ${name} name)
    target_compile_definitions(${target} INTERFACE "ABUT_${name}_VERSION=\"${version}\"")
endfunction()

# Coal's narrow phase, its trees of faces and its broad phases: all but files of meshes, serialisation and octrees, for which it wants
# more libraries. The headers that its own build writes say no more than what is visible and which version it is.
find_package(Eigen3 QUIET NO_MODULE)
if(EXISTS ${ABUT_PEERS}/coal/package.xml AND TARGET Eigen3::Eigen AND TARGET Boost::headers)
    file(STRINGS ${ABUT_PEERS}/coal/package.xml package REGEX "<version>")
    string(REGEX MATCH "([0-9]+)\\.([0-9]+)\\.([0-9]+)" version "${package}")
    set(headers ${CMAKE_CURRENT_BINARY_DIR}/peers)
    file(CONFIGURE OUTPUT ${headers}/coal/config.hh CONTENT "#pragma once
#define COAL_MAJOR_VERSION ${CMAKE_MATCH_1}
#define COAL_MINOR_VERSION ${CMAKE_MATCH_2}
#define COAL_PATCH_VERSION ${CMAKE_MATCH_3}
#define COAL_DLLAPI
#define COAL_LOCAL
#define COAL_EXPLICIT_INSTANTIATION_DECLARATION_DLLAPI
#define COAL_EXPLICIT_INSTANTIATION_DEFINITION_DLLAPI
")
    file(CONFIGURE OUTPUT ${headers}/coal/deprecated.hh CONTENT "#pragma once
#define COAL_DEPRECATED
#define COAL_DEPRECATED_MESSAGE(text)
")
    file(CONFIGURE OUTPUT ${headers}/coal/warning.hh CONTENT "#pragma once\n")
    file(GLOB_RECURSE sources ${ABUT_PEERS}/coal/src/*.cpp)
    list(FILTER sources EXCLUDE REGEX "/(mesh_loader|serialization)/|/octree.cpp$")
    add_library(abut_coal STATIC EXCLUDE_FROM_ALL ${sources})
    target_include_directories(abut_coal SYSTEM PUBLIC ${ABUT_PEERS}/coal/include ${headers})
    target_include_directories(abut_coal SYSTEM PRIVATE ${ABUT_PEERS}/coal/src)
    target_compile_features(abut_coal PUBLIC cxx_std_20)
    target_compile_options(abut_coal PRIVATE -w)
    target_link_libraries(abut_coal PUBLIC Eigen3::Eigen Boost::headers)
    abut_peer_version(abut_coal coal ${version})
endif()
abut_package(coal "<coal/" "coal in ABUT_PEERS" abut_coal)

# tinybvh is one header. Its tree of eight children wants AVX2, so its source alone is compiled with it.
if(EXISTS ${ABUT_PEERS}/tinybvh/tiny_bvh.h)
    file(STRINGS ${ABUT_PEERS}/tinybvh/tiny_bvh.h version REGEX "define TINY_BVH_VERSION_")
    string(REGEX REPLACE "[^0-9]+" "." version "${version}")
    string(REGEX MATCH "[0-9.]*[0-9]" version "${version}")
    add_library(abut_tinybvh INTERFACE)
    target_include_directories(abut_tinybvh SYSTEM INTERFACE ${ABUT_PEERS}/tinybvh)
    abut_peer_version(abut_tinybvh tinybvh ${version})
    set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/raycast/tinybvh.cpp PROPERTIES COMPILE_OPTIONS "-w;-mavx2;-mfma")
endif()
abut_package(tinybvh "<tiny_bvh" "tinybvh in ABUT_PEERS" abut_tinybvh)

# FCPW is headers too, in vectors of eight floats by the headers of Enoki that lie in its tree.
if(EXISTS ${ABUT_PEERS}/fcpw/include/fcpw/fcpw.h AND TARGET Eigen3::Eigen)
    add_library(abut_fcpw INTERFACE)
    target_include_directories(abut_fcpw SYSTEM INTERFACE ${ABUT_PEERS}/fcpw/include ${ABUT_PEERS}/fcpw/deps/enoki/include)
    target_compile_definitions(abut_fcpw INTERFACE FCPW_USE_ENOKI FCPW_SIMD_WIDTH=8)
    target_link_libraries(abut_fcpw INTERFACE Eigen3::Eigen)
    set_source_files_properties(${CMAKE_CURRENT_SOURCE_DIR}/nearest/fcpw.cpp PROPERTIES COMPILE_OPTIONS "-w;-mavx2;-mfma;-mbmi2;-mlzcnt")
endif()
abut_package(fcpw "<fcpw/" "fcpw in ABUT_PEERS" abut_fcpw)

# libigl's headers alone. Its version has no place in them.
if(EXISTS ${ABUT_PEERS}/libigl/include/igl/FastWindingNumberForSoups.h AND TARGET Eigen3::Eigen)
    add_library(abut_libigl INTERFACE)
    target_include_directories(abut_libigl SYSTEM INTERFACE ${ABUT_PEERS}/libigl/include)
    target_link_libraries(abut_libigl INTERFACE Eigen3::Eigen)
    abut_peer_version(abut_libigl libigl "")
endif()
abut_package(libigl "<igl/" "libigl in ABUT_PEERS" abut_libigl)

# Additive CCD of the IPC Toolkit, and the distances that it asks, compile alone: its logger, which wants spdlog, only warns there. The
# header that its own build writes says what is left out.
if(EXISTS ${ABUT_PEERS}/ipc-toolkit/src/ipc/ccd/additive_ccd.cpp AND TARGET Eigen3::Eigen)
    set(headers ${CMAKE_CURRENT_BINARY_DIR}/peers_ipc)
    file(READ ${ABUT_PEERS}/ipc-toolkit/src/ipc/config.hpp.in config)
    string(REGEX REPLACE "#cmakedefine[^\n]*" "" config "${config}")
    string(REPLACE "@IPC_TOOLKIT_VERTEX_DERIVATIVE_LAYOUT@" RowMajor config "${config}")
    file(CONFIGURE OUTPUT ${headers}/ipc/config.hpp CONTENT "${config}" @ONLY)
    file(CONFIGURE OUTPUT ${headers}/ipc/utils/logger.hpp CONTENT "#pragma once
#include <stdexcept>
#include <string>
namespace ipc {
struct silent_logger {
    template <class... A>
    void warn(const A&...) const {}
};
inline silent_logger logger() { return {}; }
template <class... A>
[[noreturn]] void log_and_throw_error(const std::string& what, const A&...) { throw std::runtime_error(what); }
}
" @ONLY)
    file(GLOB sources ${ABUT_PEERS}/ipc-toolkit/src/ipc/distance/*.cpp)
    list(FILTER sources EXCLUDE REGEX "mollifier")
    add_library(abut_ipc STATIC EXCLUDE_FROM_ALL ${sources} ${ABUT_PEERS}/ipc-toolkit/src/ipc/ccd/additive_ccd.cpp)
    target_include_directories(abut_ipc SYSTEM PUBLIC ${headers} ${ABUT_PEERS}/ipc-toolkit/src)
    target_compile_features(abut_ipc PUBLIC cxx_std_20)
    target_compile_options(abut_ipc PRIVATE -w)
    target_link_libraries(abut_ipc PUBLIC Eigen3::Eigen)
    abut_peer_version(abut_ipc ipc-toolkit "")
endif()
abut_package(ipc "<ipc/" "ipc-toolkit in ABUT_PEERS" abut_ipc)
