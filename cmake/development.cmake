# SPDX-License-Identifier: MIT
#
# What tests, examples and benchmarks share: warnings, sanitizers, CUDA, and the packages that single sources ask for.

find_program(ABUT_CCACHE ccache)
if(ABUT_CCACHE)
    foreach(language IN ITEMS CXX CUDA)
        if(NOT DEFINED CMAKE_${language}_COMPILER_LAUNCHER)
            set(CMAKE_${language}_COMPILER_LAUNCHER ${ABUT_CCACHE})
        endif()
    endforeach()
endif()

# --- CUDA ---------------------------------------------------------------------------------------------------------------

include(${CMAKE_CURRENT_LIST_DIR}/cuda.cmake)
if(abut_cuda)
    include(${CMAKE_CURRENT_LIST_DIR}/cuda_verbs.cmake)
endif()

# --- warnings and sanitizers, for our own sources alone -----------------------------------------------------------------

set(abut_warnings -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
# nvcc's host pass writes line directives that -Wpedantic complains of, hence not there.
set(abut_cuda_warnings -Xcompiler=-Wall,-Wextra,-Wconversion,-Wshadow)

add_library(abut_development INTERFACE)
target_link_libraries(abut_development INTERFACE abut::abut)
target_compile_options(
    abut_development
    INTERFACE $<$<COMPILE_LANGUAGE:CXX>:${abut_warnings}>
              $<$<COMPILE_LANG_AND_ID:CUDA,NVIDIA>:${abut_cuda_warnings}>
              $<$<AND:$<BOOL:${ABUT_WERROR}>,$<COMPILE_LANGUAGE:CXX>>:-Werror>
              $<$<AND:$<BOOL:${ABUT_WERROR}>,$<COMPILE_LANG_AND_ID:CUDA,NVIDIA>>:-Werror=all-warnings>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # False alarms inside std::string (GCC bug 105651).
    target_compile_options(abut_development INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # In Boost 1.83's wide numbers, in branches that are never taken.
    target_compile_options(abut_development INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-array-bounds;-Wno-aggressive-loop-optimizations>)
endif()
if(ABUT_SANITIZE)
    target_compile_options(
        abut_development INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${ABUT_SANITIZE};-fno-sanitize-recover=all>
                                   $<$<COMPILE_LANGUAGE:CXX>:-fno-omit-frame-pointer>)
    target_link_options(abut_development INTERFACE -fsanitize=${ABUT_SANITIZE})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # its flow analysis does not understand its own instrumentation
        target_compile_options(abut_development INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-maybe-uninitialized>)
    endif()
endif()

# --- packages that sources ask for by including them --------------------------------------------------------------------
#
# A source that includes a package that is not there is left out, and a line says so; nothing else need be declared.
# abut_package(NAME, pattern of the include, Debian package, targets...): known, and found if all targets exist.

set(abut_packages "")
function(abut_package name pattern debian)
    set(found TRUE)
    foreach(target IN LISTS ARGN)
        if(NOT TARGET ${target})
            set(found FALSE)
        endif()
    endforeach()
    set(abut_packages ${abut_packages} ${name} PARENT_SCOPE)
    set(abut_package_${name}_pattern "${pattern}" PARENT_SCOPE)
    set(abut_package_${name}_debian ${debian} PARENT_SCOPE)
    set(abut_package_${name}_targets ${ARGN} PARENT_SCOPE)
    set(abut_package_${name}_found ${found} PARENT_SCOPE)
endfunction()

# abut_plain_library(target library [include folder]): a library without a CMake package of its own, as a target.
function(abut_plain_library target library)
    find_library(ABUT_LIBRARY_${library} ${library})
    if(ABUT_LIBRARY_${library} AND NOT TARGET ${target})
        add_library(${target} INTERFACE IMPORTED)
        target_link_libraries(${target} INTERFACE ${ABUT_LIBRARY_${library}})
        target_include_directories(${target} SYSTEM INTERFACE ${ARGN})
    endif()
endfunction()

# How programs are started on some ranks, whose number comes next. More ranks than cores, and also by root: Open MPI wants to be
# told, and others take no notice. Ranks that wait leave the core to others.
set(abut_mpiexec ${CMAKE_COMMAND} -E env OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1 OMPI_ALLOW_RUN_AS_ROOT=1
                 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_WAIT_POLICY=passive ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG})

find_package(Boost QUIET)
find_package(CLI11 QUIET)
find_package(nlohmann_json QUIET)
find_package(fcl QUIET)
abut_package(fcl "<fcl/" libfcl-dev fcl)
abut_package(boost "<boost/" libboost-dev Boost::headers)
abut_package(cli11 "<CLI/" libcli11-dev CLI11::CLI11)
abut_package(json "<nlohmann/" nlohmann-json3-dev nlohmann_json::nlohmann_json)
abut_package(mpi "<abut/mpi|<abut/distributed/|<mpi" libopenmpi-dev abut::mpi)
if(ABUT_TESTS)
    find_package(Catch2 QUIET)
    find_package(rapidcheck QUIET)
    find_package(Eigen3 QUIET NO_MODULE)
    abut_package(catch2 "<catch2/" catch2 Catch2::Catch2)
    abut_package(rapidcheck "<rapidcheck" librapidcheck-dev rapidcheck)
    abut_package(eigen "<Eigen/" libeigen3-dev Eigen3::Eigen)
endif()
if(ABUT_TESTS OR ABUT_BENCH)  # oracles of the tests, and what benchmarks include, whose sources the tests look at too
    abut_plain_library(abut_gmp gmp)
    abut_plain_library(abut_gmpxx gmpxx)
    abut_plain_library(abut_mpfr mpfr)
    find_path(ABUT_CGAL_INCLUDE CGAL/version.h)
    if(ABUT_CGAL_INCLUDE)
        add_library(abut_cgal INTERFACE IMPORTED)
        target_include_directories(abut_cgal SYSTEM INTERFACE ${ABUT_CGAL_INCLUDE})
    endif()
    abut_package(gmp "<gmp|<boost/multiprecision/gmp" libgmp-dev abut_gmp abut_gmpxx)
    abut_package(cgal "<CGAL/" libcgal-dev abut_cgal abut_gmp abut_mpfr)
    find_package(benchmark QUIET)
    find_package(embree QUIET)
    find_path(ABUT_BULLET_INCLUDE BulletCollision/Gimpact/btGImpactQuantizedBvh.h PATH_SUFFIXES bullet)
    if(ABUT_BULLET_INCLUDE)
        abut_plain_library(abut_bullet BulletCollision ${ABUT_BULLET_INCLUDE})
        abut_plain_library(abut_bullet_math LinearMath)
    endif()
    find_path(ABUT_NANOFLANN_INCLUDE nanoflann.hpp)
    if(ABUT_NANOFLANN_INCLUDE)
        add_library(abut_nanoflann INTERFACE IMPORTED)
        target_include_directories(abut_nanoflann SYSTEM INTERFACE ${ABUT_NANOFLANN_INCLUDE})
    endif()
    abut_package(benchmark "<benchmark/" libbenchmark-dev benchmark::benchmark)
    abut_package(embree "<embree" libembree-dev embree)
    abut_package(nanoflann "<nanoflann" libnanoflann-dev abut_nanoflann)
    abut_package(bullet "<BulletCollision/" libbullet-dev abut_bullet abut_bullet_math)
endif()

# The packages that a source includes, itself or through files of ours that it includes with quotes.
function(abut_packages_of source result)
    set(open ${source})
    set(seen "")
    set(used "")
    while(open)
        list(POP_FRONT open file)
        list(APPEND seen ${file})
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
        file(STRINGS ${file} includes REGEX "^[ \t]*#[ \t]*include")
        foreach(name IN LISTS abut_packages)
            if(includes MATCHES "${abut_package_${name}_pattern}")
                list(APPEND used ${name})
            endif()
        endforeach()
        get_filename_component(folder ${file} DIRECTORY)
        foreach(line IN LISTS includes)
            if(line MATCHES "include[ \t]*\"([^\"]+)\"")
                foreach(base IN ITEMS ${folder} ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR}/bench)
                    get_filename_component(next ${CMAKE_MATCH_1} ABSOLUTE BASE_DIR ${base})
                    if(EXISTS ${next} AND NOT next IN_LIST seen AND NOT next IN_LIST open)
                        list(APPEND open ${next})
                    endif()
                endforeach()
            endif()
        endforeach()
    endwhile()
    list(REMOVE_DUPLICATES used)
    set(${result} "${used}" PARENT_SCOPE)
endfunction()

# The packages that a source includes; it is `here` if all of them are, and a line says so if not. A package that is said to be
# installed, and is not found, is an error: what needs it would be left out unseen.
set(ABUT_INSTALLED_PACKAGES "" CACHE STRING "Debian packages that are installed, so that nothing may be left out for want of them")
function(abut_is_here source here packages)
    abut_packages_of(${source} used)
    set(missing "")
    foreach(name IN LISTS used)
        if(NOT abut_package_${name}_found)
            list(APPEND missing ${abut_package_${name}_debian})
        endif()
    endforeach()
    set(${packages} "${used}" PARENT_SCOPE)
    set(${here} TRUE PARENT_SCOPE)
    if(missing)
        cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE shown)
        foreach(package IN LISTS missing)
            if(package IN_LIST ABUT_INSTALLED_PACKAGES)
                message(SEND_ERROR "abut: ${shown} would be left out: ${package} is installed, but CMake does not find it")
            endif()
        endforeach()
        list(JOIN missing ", " missing)
        message(STATUS "abut: ${shown} is left out: not there: ${missing}")
        set(${here} FALSE PARENT_SCOPE)
    endif()
endfunction()

# abut_program(target sources...): an executable. With ABUT_QUICK_DEVICE_CODE a .cu file is compiled to PTX alone, in a third of the
# time: the host's compiler is left out.
function(abut_program target)
    if(ABUT_QUICK_DEVICE_CODE AND ARGN MATCHES "\\.cu$")
        add_library(${target} OBJECT ${ARGN})
        set_target_properties(${target} PROPERTIES CUDA_PTX_COMPILATION ON)
    else()
        add_executable(${target} ${ARGN})
        if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
            # To clang a local name hides one of another source that is compiled with it.
            set_target_properties(${target} PROPERTIES
                                  UNITY_BUILD_CODE_BEFORE_INCLUDE "#pragma GCC diagnostic ignored \"-Wshadow\"")
        endif()
    endif()
    target_link_libraries(${target} PRIVATE abut_development)
    if(ARGN MATCHES "\\.cu$")
        target_link_libraries(${target} PRIVATE abut_cuda_verbs)
    endif()
endfunction()

# abut_run_of(target result): the command that runs it; where it is PTX alone, one that says that it is skipped, with status 77.
function(abut_run_of target result)
    get_target_property(type ${target} TYPE)
    set(run $<TARGET_FILE:${target}>)
    if(type STREQUAL "OBJECT_LIBRARY")
        set(run sh ${PROJECT_SOURCE_DIR}/tests/support/skipped.sh device "no device is present: not run")
    endif()
    set(${result} "${run}" PARENT_SCOPE)
endfunction()

# abut_executable(name sources...): abut_program of those sources whose packages are there; none if none is left.
function(abut_executable target)
    set(sources "")
    set(used "")
    foreach(source IN LISTS ARGN)
        abut_is_here(${source} here packages)
        if(NOT here)
            continue()
        endif()
        list(APPEND sources ${source})
        list(APPEND used ${packages})
        if("cgal" IN_LIST packages)  # its interval arithmetic sets the rounding mode
            set_property(SOURCE ${source} APPEND PROPERTY COMPILE_OPTIONS -frounding-math)
        endif()
    endforeach()
    if(NOT sources)
        return()
    endif()
    list(REMOVE_DUPLICATES used)
    abut_program(${target} ${sources})
    foreach(name IN LISTS used)
        target_link_libraries(${target} PRIVATE ${abut_package_${name}_targets})
    endforeach()
endfunction()

# abut_executables(prefix result): of each *.cpp and *.cu of the folder one executable, <prefix><name>, and <prefix><name>_cuda for
# a .cu file; a folder <name> holds further sources of <name>.cpp. `result` gets the names, also of those that are left out.
function(abut_executables prefix result)
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
    if(abut_cuda)
        file(GLOB cuda_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cu)
    endif()
    set(targets "")
    foreach(source IN LISTS sources cuda_sources)
        cmake_path(GET source STEM stem)
        cmake_path(GET source EXTENSION extension)
        set(target ${prefix}${stem})
        set(peers "")
        if(extension STREQUAL ".cu")
            string(APPEND target _cuda)
        else()
            file(GLOB peers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${stem}/*.cpp)
        endif()
        abut_executable(${target} ${source} ${peers})
        list(APPEND targets ${target})
    endforeach()
    set(${result} "${targets}" PARENT_SCOPE)
endfunction()
