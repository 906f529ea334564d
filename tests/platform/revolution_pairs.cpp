// SPDX-License-Identifier: MIT

// Two shapes with an axis, of which one is a cylinder or a cone, and such a one and a convex hull.

#include "pairs.hpp"
#include "questions.hpp"

namespace platform {

namespace {

template <abut::scalar T>
void ask(table& to) {
    using namespace abut;
    ask_pair<cylinder<T>, cylinder<T>>(to, "cylinder-cylinder", {2000, 500});
    ask_pair<cylinder<T>, cone<T>>(to, "cylinder-cone", {2000, 500});
    ask_pair<cone<T>, cone<T>>(to, "cone-cone", {2000, 500});
    ask_pair<capsule<T>, cylinder<T>>(to, "capsule-cylinder", {20000, 2500});
    ask_pair<capsule<T>, cone<T>>(to, "capsule-cone", {20000, 2500});
    ask_pair<hull<T>, cylinder<T>>(to, "hull-cylinder", {4000, 1000});
    ask_pair<hull<T>, cone<T>>(to, "hull-cone", {4000, 1000});
}

}  // namespace

void ask_revolution_pairs(table& to) {
    ask<float>(to);
    ask<double>(to);
}

}  // namespace platform
