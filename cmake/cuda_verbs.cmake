# SPDX-License-Identifier: MIT
#
# abut::cuda_verbs: sorts, scans and selections on a device, compiled once, for CMAKE_CUDA_ARCHITECTURES. What links it compiles
# sooner. Tests and benchmarks do; with ABUT_CUDA_VERBS it is a part of all, and installed.

include_guard(DIRECTORY)
include(${CMAKE_CURRENT_LIST_DIR}/cuda.cmake)
if(NOT abut_cuda)
    message(FATAL_ERROR "ABUT_CUDA_VERBS=${ABUT_CUDA_VERBS} needs nvcc 13.0 or newer, which is not there, or not wanted (ABUT_CUDA)")
endif()

if(ABUT_QUICK_DEVICE_CODE)  # to see that it compiles; nothing is linked
    add_library(abut_cuda_verbs OBJECT ${CMAKE_CURRENT_LIST_DIR}/cuda_verbs.cu)
    set_target_properties(abut_cuda_verbs PROPERTIES CUDA_PTX_COMPILATION ON)
elseif(ABUT_CUDA_VERBS)
    add_library(abut_cuda_verbs STATIC ${CMAKE_CURRENT_LIST_DIR}/cuda_verbs.cu)
else()
    add_library(abut_cuda_verbs STATIC EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/cuda_verbs.cu)
endif()
add_library(abut::cuda_verbs ALIAS abut_cuda_verbs)
set_target_properties(abut_cuda_verbs PROPERTIES EXPORT_NAME cuda_verbs POSITION_INDEPENDENT_CODE ON)
target_link_libraries(abut_cuda_verbs PUBLIC abut)
# Of a tree without a build type too.
target_compile_options(abut_cuda_verbs PRIVATE $<$<CONFIG:>:-O2>)
target_compile_definitions(abut_cuda_verbs INTERFACE ABUT_CUDA_VERBS_COMPILED=1)

if(ABUT_CUDA_VERBS AND NOT ABUT_QUICK_DEVICE_CODE)
    install(TARGETS abut_cuda_verbs EXPORT abut-cuda-verbs-targets)
    install(EXPORT abut-cuda-verbs-targets NAMESPACE abut:: DESTINATION ${abut_cmake_dir})
    export(EXPORT abut-cuda-verbs-targets NAMESPACE abut::)
endif()
