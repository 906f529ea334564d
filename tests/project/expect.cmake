# SPDX-License-Identifier: MIT
#
# Runs a program and looks at all that comes of it: cmake -D ... -P expect.cmake -- PROGRAM ARGUMENT...
#   status   its exit status (0)
#   says     a regular expression that what it prints has to match; stdout first, then stderr
#   files    files that it has to write, which are removed before; not empty
#   partial  true: it prints results before it fails
# Any other program that fails has to say why in one line on stderr, and print nothing else. Where no CUDA device can be used
# it is skipped, if ABUT_REQUIRE does not ask for one.

set(command "")
set(is_command FALSE)
math(EXPR last "${CMAKE_ARGC} - 1")
foreach(i RANGE ${last})
    if(is_command)
        list(APPEND command "${CMAKE_ARGV${i}}")
    elseif(CMAKE_ARGV${i} STREQUAL "--")
        set(is_command TRUE)
    endif()
endforeach()
if(NOT DEFINED status)
    set(status 0)
endif()
if(files)
    file(REMOVE ${files})
endif()

execute_process(COMMAND ${command} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE err)
if(err MATCHES "no CUDA device can be used here" AND NOT " $ENV{ABUT_REQUIRE} " MATCHES " device ")
    message("abut skips: no CUDA device can be used here")
    return()
endif()
message("${out}${err}")
if(NOT result EQUAL status)
    message(FATAL_ERROR "exit status ${result}, expected ${status}")
endif()
if(NOT status EQUAL 0 AND NOT partial AND (NOT out STREQUAL "" OR NOT err MATCHES "^[^\n]+\n$"))
    message(FATAL_ERROR "expected one line on stderr, and nothing else")
endif()
if(says AND NOT "${out}${err}" MATCHES "${says}")
    message(FATAL_ERROR "expected, as a regular expression: ${says}")
endif()
foreach(file IN LISTS files)
    if(NOT EXISTS ${file})
        message(FATAL_ERROR "not written: ${file}")
    endif()
    file(SIZE ${file} size)
    if(size EQUAL 0)
        message(FATAL_ERROR "empty: ${file}")
    endif()
endforeach()
