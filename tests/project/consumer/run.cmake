# SPDX-License-Identifier: MIT
#
# Builds and runs the consumer beside this file against an install tree of `build`, against `build` itself, or with `source`
# as a part of it. It starts from nothing each time.

function(step)
    cmake_parse_arguments(PARSE_ARGV 0 arg "FAILS" "MUST_SAY" "")
    list(JOIN arg_UNPARSED_ARGUMENTS " " shown)
    message("-- ${shown}")
    execute_process(COMMAND ${arg_UNPARSED_ARGUMENTS} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
    message("${said}")
    if((arg_FAILS AND status EQUAL 0) OR (NOT arg_FAILS AND NOT status EQUAL 0))
        message(FATAL_ERROR "consumer: unexpected status ${status}")
    endif()
    if(arg_MUST_SAY AND NOT said MATCHES "${arg_MUST_SAY}")
        message(FATAL_ERROR "consumer: expected to read: ${arg_MUST_SAY}")
    endif()
    set(said "${said}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${work})
set(prefix ${build})
if(tree STREQUAL "install")
    set(prefix ${work}/stage)
    step(${CMAKE_COMMAND} --install ${build} --prefix ${prefix})
    if(NOT EXISTS ${prefix}/share/doc/abut/LICENSE)
        message(FATAL_ERROR "consumer: the licence is not installed")
    endif()
endif()

set(configure ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -G ${generator} -D CMAKE_CXX_COMPILER=${compiler}
    -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)

if(tree STREQUAL "subdirectory")
    step(${configure} -B ${work}/build -D CONSUMER_SUBDIRECTORY=${source})
    step(${CMAKE_COMMAND} --build ${work}/build)
    step(${work}/build/touch MUST_SAY "touching: 0 1")
elseif(form STREQUAL "cpu")
    step(${configure} -B ${work}/wrong-version -D CONSUMER_VERSION=99 FAILS MUST_SAY "version: ${version}")
    step(${configure} -B ${work}/no-such-component -D CONSUMER_COMPONENTS=no_such_component FAILS)
    set(components "")
    if(io)
        set(components io)
    endif()
    step(${configure} -B ${work}/build -D CMAKE_BUILD_TYPE=Release -D CONSUMER_VERSION=${version}
         -D CONSUMER_COMPONENTS=${components})
    step(${CMAKE_COMMAND} --build ${work}/build)
    step(${work}/build/touch MUST_SAY "touching: 0 1")
    # Where this machine has OpenMP, another that uses the same tree may have none.
    step(${configure} -B ${work}/no-openmp -D CMAKE_DISABLE_FIND_PACKAGE_OpenMP=ON MUST_SAY "there is no OpenMP here")
    step(${CMAKE_COMMAND} --build ${work}/no-openmp)
    step(${work}/no-openmp/touch MUST_SAY "touching: 0 1")
else()
    step(${configure} -B ${work}/build -D CMAKE_BUILD_TYPE=Release -D CONSUMER_CUDA=ON
         -D CMAKE_CUDA_COMPILER=${cuda_compiler} -D CMAKE_CUDA_ARCHITECTURES=${cuda_architectures})
    step(${CMAKE_COMMAND} --build ${work}/build)
    step(${work}/build/touch_cuda MUST_SAY "touching: 0 1|abut skips: ")
endif()
