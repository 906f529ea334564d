// SPDX-License-Identifier: MIT
#pragma once

// Embree, whichever of its generations the machine has (Debian 12: version 3; Ubuntu 24.04: version 4).

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
