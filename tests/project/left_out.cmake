# SPDX-License-Identifier: MIT
#
# usage: cmake -D source=FOLDER -D build=FOLDER -D compiler=CXX -P left_out.cmake
#
# Configures the project as strangers do: where packages of the tests are missing, or BUILD_TESTING is OFF, it has no tests and
# says so in one line at most; where ABUT_TESTS asks for them, it stops.

# configure(EXPECTED STATUS PATTERN arguments...): fails where CMake ends or speaks otherwise.
function(configure status says)
    file(REMOVE_RECURSE ${build})
    execute_process(COMMAND ${CMAKE_COMMAND} -S ${source} -B ${build} -DCMAKE_CXX_COMPILER=${compiler} -DABUT_CUDA=OFF
                            -DABUT_MPI=OFF -DABUT_OPENMP=OFF -DABUT_EXAMPLES=OFF ${ARGN}
                    RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_VARIABLE said)
    if((result EQUAL 0 AND NOT status EQUAL 0) OR (status EQUAL 0 AND NOT result EQUAL 0) OR NOT said MATCHES "${says}")
        message(FATAL_ERROR "left_out: with ${ARGN} it ended with ${result}; expected ${status} and '${says}':\n${said}")
    endif()
    if(EXISTS ${build}/tests/CTestTestfile.cmake AND status EQUAL 0)
        message(FATAL_ERROR "left_out: with ${ARGN} there are tests")
    endif()
endfunction()

set(missing -DCMAKE_DISABLE_FIND_PACKAGE_rapidcheck=ON)
configure(0 "abut: the tests are left out: these packages are not there: librapidcheck-dev" ${missing})
configure(0 "Generating done" ${missing} -DBUILD_TESTING=OFF)
configure(0 "Generating done" -DBUILD_TESTING=OFF)
configure(1 "the tests need rapidcheck: install librapidcheck-dev" ${missing} -DABUT_TESTS=ON)
file(REMOVE_RECURSE ${build})
