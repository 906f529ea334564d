// SPDX-License-Identifier: MIT

// Points, segments, spheres, boxes, capsules and planes, each with each, and rays.

#include "pairs.hpp"
#include "questions.hpp"

namespace platform {

namespace {

template <abut::scalar T>
void ask(table& to) {
    using namespace abut;
    using point = vec3<T>;
    using box = aabb<T>;
    ask_pair<point, point>(to, "point-point", {});
    ask_pair<point, segment<T>>(to, "point-segment", {});
    ask_pair<point, sphere<T>>(to, "point-sphere", {});
    ask_pair<point, box>(to, "point-box", {});
    ask_pair<point, capsule<T>>(to, "point-capsule", {});
    ask_pair<point, plane<T>>(to, "point-plane", {});
    ask_pair<segment<T>, segment<T>>(to, "segment-segment", {});
    ask_pair<segment<T>, sphere<T>>(to, "segment-sphere", {});
    ask_pair<segment<T>, box>(to, "segment-box", {});
    ask_pair<segment<T>, capsule<T>>(to, "segment-capsule", {});
    ask_pair<segment<T>, plane<T>>(to, "segment-plane", {});
    ask_pair<sphere<T>, sphere<T>>(to, "sphere-sphere", {});
    ask_pair<sphere<T>, box>(to, "sphere-box", {});
    ask_pair<sphere<T>, capsule<T>>(to, "sphere-capsule", {});
    ask_pair<sphere<T>, plane<T>>(to, "sphere-plane", {});
    ask_pair<box, box>(to, "box-box", {});
    ask_pair<box, capsule<T>>(to, "box-capsule", {});
    ask_pair<box, plane<T>>(to, "box-plane", {});
    ask_pair<capsule<T>, capsule<T>>(to, "capsule-capsule", {});
    ask_pair<capsule<T>, plane<T>>(to, "capsule-plane", {});
    ask_pair<plane<T>, plane<T>>(to, "plane-plane", {});
    ask_pair<ray<T>, sphere<T>>(to, "ray-sphere", {});
    ask_pair<ray<T>, box>(to, "ray-box", {});
    ask_pair<ray<T>, capsule<T>>(to, "ray-capsule", {});
}

}  // namespace

void ask_simple(table& to) {
    ask<float>(to);
    ask<double>(to);
}

}  // namespace platform
