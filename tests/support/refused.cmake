# SPDX-License-Identifier: MIT
#
# usage: cmake -D source=FILE [-D precompiled=HEADER] -P refused.cmake -- COMPILER ARGUMENT...
#
# Runs the compiler on a source that must not compile. HEADER is included first, where the source asks for no options and defines
# nothing: what g++ has read before would not be valid then. Comments of the source say what is expected:
#   // expect: REGEX     the first error matches it
#   // options: WORDS    further arguments of the compiler
#   // errors: N         the compiler prints at most N errors; 1 in a .cpp file that does not say, any number in a .cu file

set(command "")
set(mine TRUE)
math(EXPR last "${CMAKE_ARGC} - 1")
foreach(i RANGE ${last})
    if(mine)
        if(CMAKE_ARGV${i} STREQUAL "--")
            set(mine FALSE)
        endif()
    else()
        list(APPEND command "${CMAKE_ARGV${i}}")
    endif()
endforeach()

file(STRINGS ${source} expect REGEX "^// expect: ")
string(REPLACE "// expect: " "" expect "${expect}")
string(REPLACE "\\;" "," expect "${expect}")  # as in what is said, below
file(STRINGS ${source} options REGEX "^// options: ")
string(REPLACE "// options: " "" options "${options}")
separate_arguments(options)
file(STRINGS ${source} most REGEX "^// errors: [0-9]+")
string(REGEX MATCH "[0-9]+" most "${most}")
if(NOT most AND source MATCHES "\\.cpp$")
    set(most 1)
endif()

set(first "")
file(STRINGS ${source} defines REGEX "^#(define|undef)")
if(precompiled AND NOT options AND NOT defines AND source MATCHES "\\.cpp$")
    set(first -include ${precompiled})
endif()
execute_process(COMMAND ${command} ${options} ${first} ${source} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
message("${said}")
if(status EQUAL 0)
    message(FATAL_ERROR "refused: it compiles")
endif()
string(REPLACE ";" "," said "${said}")
string(REGEX MATCHALL "(^|\n)[^\n]*error( #[0-9]+-D)?: [^\n]*" errors "${said}")
list(LENGTH errors count)
if(count EQUAL 0)
    message(FATAL_ERROR "refused: no error is to be read")
endif()
list(GET errors 0 first)
if(NOT first MATCHES "${expect}")
    message(FATAL_ERROR "refused: expected that the first error matches: ${expect}")
endif()
if(most AND count GREATER most)
    message(FATAL_ERROR "refused: ${count} errors, where ${most} would do")
endif()
