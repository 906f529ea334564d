// SPDX-License-Identifier: MIT
//
// Prints sums of all bits of distances and contacts, of shapes beside which searches and rounding come in. canary.sh
// compares what it prints where compilers may join products and sums, and where they may not.

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <abut/narrow/contact.hpp>
#include <abut/narrow/distance.hpp>

#include "support/cone_pair_families.hpp"
#include "support/revolution_solid.hpp"

namespace abut::test {

namespace {

constexpr std::uint64_t canary_seed = 20261127;

/// FNV-1a.
struct sum_of_bits {
    std::uint64_t sum = 14695981039346656037u;
    std::uint64_t pairs = 0, touching = 0;

    template <class X>
    void add(const X& x) {
        unsigned char bytes[sizeof x];
        std::memcpy(bytes, &x, sizeof x);
        for (const unsigned char b : bytes) sum = (sum ^ b) * 1099511628211u;
    }
    template <class S, class U>
    void add_pair(const S& s, const U& t) {
        if (!is_valid(s) || !is_valid(t)) return;
        const auto apart = distance(s, t);
        add(apart);
        ++pairs;
        if (apart.distance != 0) return;
        ++touching;
        add(*contact_of(s, t));
    }
    void print(const char* name) const {
        std::printf("%s: %llu pairs, %llu touch, %016llx\n", name, static_cast<unsigned long long>(pairs),
                    static_cast<unsigned long long>(touching), static_cast<unsigned long long>(sum));
    }
};

template <class Solid>
void print_hulls(const char* name) {
    using T = scalar_type_of<Solid>;
    sum_of_bits sum;
    each_revolution_case<Solid>(canary_seed, 50, [&](const std::string& family, std::uint64_t k, const auto& c) {
        if (family == name_of(revolution_family::all_bit_patterns)) return;  // which may take seconds
        const auto points = points_beside(canary_seed, c, k);
        sum.add_pair(solid_of<Solid>(c.axis, c.radius), hull<T>(points.data(), points.size()));
    });
    sum.print(name);
}

template <class Other>
void print_rounds(const char* name) {
    sum_of_bits sum;
    for (int i = 0; i < cone_family_count; ++i) {
        const auto f = static_cast<cone_family>(i);
        for (std::uint64_t k = 0; k < (f == cone_family::near_contact ? 3 : 60); ++k) {
            const auto c = make_cone_pair<Other>(canary_seed, f, k);
            sum.add_pair(cone_of(c), other_of<Other>(c));
        }
    }
    sum.print(name);
}

/// Boxes of denormal corners, of which every other one has halves that are rounded, and planes along their axes.
template <scalar T>
void print_boxes(const char* name) {
    sum_of_bits sum;
    const T least = construction::least_denormal<T>;
    for (int i = 0; i < 64; ++i) {
        const T low = static_cast<T>(i % 8) * least, high = static_cast<T>(7 + i / 8) * least;
        const aabb<T> box{{low, -high, low}, {high, low, high}};
        sum.add_pair(plane<T>{{0, 0, 1}, high}, box);
        sum.add_pair(plane<T>{{1, 0, 0}, low}, box);
        sum.add_pair(plane<T>{{0, 1, 1}, 0}, box);
    }
    sum.print(name);
}

}  // namespace

}  // namespace abut::test

int main() {
    using namespace abut;
    test::print_hulls<cylinder<double>>("cylinders and hulls, double");
    test::print_hulls<cone<float>>("cones and hulls, float");
    test::print_rounds<cone<double>>("two cones, double");
    test::print_boxes<float>("planes and boxes, float");
    test::print_boxes<double>("planes and boxes, double");
}
