// SPDX-License-Identifier: MIT

// A triangle and another shape.

#include "pairs.hpp"
#include "questions.hpp"

namespace platform {

namespace {

template <abut::scalar T>
void ask(table& to) {
    using namespace abut;
    using point = vec3<T>;
    using box = aabb<T>;
    ask_pair<triangle<T>, triangle<T>>(to, "triangle-triangle", {});
    ask_pair<triangle<T>, segment<T>>(to, "triangle-segment", {});
    ask_pair<triangle<T>, point>(to, "triangle-point", {});
    ask_pair<triangle<T>, sphere<T>>(to, "triangle-sphere", {});
    ask_pair<triangle<T>, box>(to, "triangle-box", {});
    ask_pair<triangle<T>, plane<T>>(to, "triangle-plane", {});
    ask_pair<triangle<T>, capsule<T>>(to, "triangle-capsule", {});
    ask_pair<ray<T>, triangle<T>>(to, "ray-triangle", {});
}

}  // namespace

void ask_triangles(table& to) {
    ask<float>(to);
    ask<double>(to);
}

}  // namespace platform
