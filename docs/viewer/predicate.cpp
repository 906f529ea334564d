// SPDX-License-Identifier: MIT
//
// The library's decisions for docs/viewer, compiled to WebAssembly (build.mjs says how): whether two triangles touch by each
// arithmetic, their contact, and the list of configurations that the tests ask about. Sides of planes and the common part
// are shown too; they come from the tests' rational numbers, which share no formula with the library.
//
// All calls share one buffer, `numbers()`: what is asked goes in as 18 doubles, the corners of two triangles, and results
// come out. Text is a C string.

#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include <abut/narrow/contact.hpp>
#include <abut/predicate/intersects.hpp>

#include "predicate/common_part.hpp"
#include "predicate/configuration_pairs.hpp"

#define ABUT_VIEWER_CALL(name) extern "C" __attribute__((export_name(#name)))

#if defined(__wasm__)
// What is thrown ends the module: a trap, which the page reports.
extern "C" {
void* __cxa_allocate_exception(std::size_t) { std::abort(); }
void __cxa_free_exception(void*) { std::abort(); }
[[noreturn]] void __cxa_throw(void*, void*, void (*)(void*)) { std::abort(); }
void* __cxa_begin_catch(void*) { std::abort(); }
void __cxa_end_catch() { std::abort(); }
// Debian's compiler-rt for WebAssembly was built with stack protectors, and its libc has none.
std::size_t __stack_chk_guard = 0x2545f491;
[[noreturn]] void __stack_chk_fail() { std::abort(); }
}
#endif

namespace {

using namespace abut;

constexpr int capacity = 64;
double shared[capacity];

const std::vector<test::named_pair>& pairs() {
    static const std::vector<test::named_pair> all = test::all_pairs();
    return all;
}

template <scalar T>
vec3<T> corner(int i) {
    return {static_cast<T>(shared[3 * i]), static_cast<T>(shared[3 * i + 1]), static_cast<T>(shared[3 * i + 2])};
}
template <scalar T>
triangle<T> side(int which) {
    return {corner<T>(3 * which), corner<T>(3 * which + 1), corner<T>(3 * which + 2)};
}

/// Bits 0 to 2: what fast, filtered and exact answer.
template <scalar T>
int answers() {
    const triangle<T> s = side<T>(0), t = side<T>(1);
    return (intersects<fast>(s, t) ? 1 : 0) + (intersects<filtered>(s, t) ? 2 : 0) + (intersects<exact>(s, t) ? 4 : 0);
}

test::hull rational_side(int which) {
    test::hull corners;
    for (int i = 3 * which; i < 3 * which + 3; ++i) {
        corners.push_back({test::rational(shared[3 * i]), test::rational(shared[3 * i + 1]), test::rational(shared[3 * i + 2])});
    }
    return corners;
}

void put(const test::rational_point& p, int at) {
    shared[3 * at] = static_cast<double>(p.x);
    shared[3 * at + 1] = static_cast<double>(p.y);
    shared[3 * at + 2] = static_cast<double>(p.z);
}

template <scalar T>
int contact_into_shared() {
    const auto c = contact_of<exact>(side<T>(0), side<T>(1));
    if (!c) return 0;
    const T values[] = {c->point.x, c->point.y, c->point.z, c->normal.x, c->normal.y, c->normal.z, c->depth};
    for (int i = 0; i < 7; ++i) shared[i] = static_cast<double>(values[i]);
    return 1;
}

}  // namespace

ABUT_VIEWER_CALL(numbers) double* numbers() { return shared; }

ABUT_VIEWER_CALL(answers_float) int answers_float() { return answers<float>(); }
ABUT_VIEWER_CALL(answers_double) int answers_double() { return answers<double>(); }

/// 1 and point, normal and depth in the buffer, or 0.
ABUT_VIEWER_CALL(contact_float) int contact_float() { return contact_into_shared<float>(); }
ABUT_VIEWER_CALL(contact_double) int contact_double() { return contact_into_shared<double>(); }

/// The sides of the six corners of the other triangle's plane, -1, 0 or 1, into the buffer; 2 where the other has no plane.
ABUT_VIEWER_CALL(sides) void sides() {
    const test::hull corners[2] = {rational_side(0), rational_side(1)};
    for (int which = 0; which < 2; ++which) {
        const test::hull other = test::tidied(corners[1 - which]);
        const auto& plane = corners[1 - which];
        const test::rational_point normal = cross(plane[1] - plane[0], plane[2] - plane[0]);
        for (int i = 0; i < 3; ++i) {
            int sign = 2;
            if (other.size() == 3) {
                const test::rational excess = test::above(normal, plane[0]).excess(corners[which][static_cast<std::size_t>(i)]);
                sign = excess > 0 ? 1 : excess < 0 ? -1 : 0;
            }
            shared[3 * which + i] = sign;
        }
    }
}

/// The corners of what the two have in common into the buffer, up to 6, in order; returns how many.
ABUT_VIEWER_CALL(common_part) int common_part() {
    const test::hull part = test::common_part(test::tidied(rational_side(0)), test::tidied(rational_side(1)));
    for (std::size_t i = 0; i < part.size(); ++i) put(part[i], static_cast<int>(i));
    return static_cast<int>(part.size());
}

ABUT_VIEWER_CALL(configuration_count) int configuration_count() { return static_cast<int>(pairs().size()); }
ABUT_VIEWER_CALL(configuration_name) const char* configuration_name(int i) {
    return pairs()[static_cast<std::size_t>(i)].name.c_str();
}
/// 1 if it is written down as a hit; its corners are put into the buffer.
ABUT_VIEWER_CALL(configuration) int configuration(int i) {
    const test::named_pair& pair = pairs()[static_cast<std::size_t>(i)];
    const vec3<int> corners[] = {pair.a.a, pair.a.b, pair.a.c, pair.b.a, pair.b.b, pair.b.c};
    for (int k = 0; k < 6; ++k) put({corners[k].x, corners[k].y, corners[k].z}, k);
    return pair.hit ? 1 : 0;
}
