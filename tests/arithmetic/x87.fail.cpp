// SPDX-License-Identifier: MIT
// expect: abut: results need the precision of their types: compile without -mfpmath=387
#undef __FLT_EVAL_METHOD__
#define __FLT_EVAL_METHOD__ 2
#include <abut/arithmetic/error_free.hpp>
