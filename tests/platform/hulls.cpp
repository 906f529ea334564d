// SPDX-License-Identifier: MIT

// A convex hull and another shape, but cylinders and cones.

#include "pairs.hpp"
#include "questions.hpp"

namespace platform {

namespace {

template <abut::scalar T>
void ask(table& to) {
    using namespace abut;
    using point = vec3<T>;
    using box = aabb<T>;
    ask_pair<hull<T>, hull<T>>(to, "hull-hull", {20000, 2500});
    ask_pair<hull<T>, triangle<T>>(to, "hull-triangle", {20000, 2500});
    ask_pair<hull<T>, segment<T>>(to, "hull-segment", {20000, 2500});
    ask_pair<hull<T>, point>(to, "hull-point", {20000, 5000});
    ask_pair<hull<T>, box>(to, "hull-box", {20000, 2500});
    ask_pair<hull<T>, sphere<T>>(to, "hull-sphere", {20000, 2500});
    ask_pair<hull<T>, capsule<T>>(to, "hull-capsule", {20000, 2500});
    ask_pair<hull<T>, plane<T>>(to, "hull-plane", {});
    ask_pair<ray<T>, hull<T>>(to, "ray-hull", {20000, 2500});
}

}  // namespace

void ask_hulls(table& to) {
    ask<float>(to);
    ask<double>(to);
}

}  // namespace platform
