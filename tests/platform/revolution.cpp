// SPDX-License-Identifier: MIT

// A cylinder or a cone, and a shape without a disc.

#include "pairs.hpp"
#include "questions.hpp"

namespace platform {

namespace {

template <abut::scalar T>
void ask(table& to) {
    using namespace abut;
    using point = vec3<T>;
    using box = aabb<T>;
    ask_pair<cylinder<T>, triangle<T>>(to, "cylinder-triangle", {20000, 5000});
    ask_pair<cylinder<T>, segment<T>>(to, "cylinder-segment", {});
    ask_pair<cylinder<T>, point>(to, "cylinder-point", {});
    ask_pair<cylinder<T>, sphere<T>>(to, "cylinder-sphere", {});
    ask_pair<cylinder<T>, box>(to, "cylinder-box", {20000, 5000});
    ask_pair<cylinder<T>, plane<T>>(to, "cylinder-plane", {});
    ask_pair<ray<T>, cylinder<T>>(to, "ray-cylinder", {});
    ask_pair<cone<T>, triangle<T>>(to, "cone-triangle", {20000, 5000});
    ask_pair<cone<T>, segment<T>>(to, "cone-segment", {});
    ask_pair<cone<T>, point>(to, "cone-point", {});
    ask_pair<cone<T>, sphere<T>>(to, "cone-sphere", {});
    ask_pair<cone<T>, box>(to, "cone-box", {20000, 5000});
    ask_pair<cone<T>, plane<T>>(to, "cone-plane", {});
    ask_pair<ray<T>, cone<T>>(to, "ray-cone", {});
}

}  // namespace

void ask_revolution(table& to) {
    ask<float>(to);
    ask<double>(to);
}

}  // namespace platform
