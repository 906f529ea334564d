// SPDX-License-Identifier: MIT
// expect: a type is a shape if it is plain data and has bounds
#include <abut/abut.hpp>

namespace other {

struct unbounded {
    using scalar_type = float;
};

}  // namespace other

int main() { return static_cast<int>(abut::make_bvh(abut::serial{}, other::unbounded{}).size()); }
