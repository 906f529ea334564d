// SPDX-License-Identifier: MIT
#pragma once

namespace abut {

/// What a visitor wants next. Stopping is best effort where visitors run concurrently.
enum class visit : unsigned char { proceed, stop };

}  // namespace abut
