// SPDX-License-Identifier: MIT
//
// usage: bench_closed_forms [--json=OUT.json] [--runs=N] [--only=TEXT]
//
// One pair at a time on one core, of shapes whose distances and contacts have closed forms: points, segments, triangles,
// spheres, capsules, boxes, boxes under a pose, planes and half spaces, in general position beside each other. Rows, of
// names that contain TEXT, are KIND/SCALAR/QUESTION/WHICH:
//
//   boolean, distance, contact    `intersects`, `distance` and `contact_of`
//   all, apart, touching          2,000 pairs as they are drawn, and 1,000 of either answer
//   parallel                      of capsules whose axes are parallel but for rounding
//
// ns is the least of N runs (15) over the pairs. bench_peers has some of these beside other libraries.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <time.h>

#include <abut/narrow/contact.hpp>
#include <abut/narrow/distance.hpp>

#include "../tests/support/draws.hpp"
#include "../tests/support/poses.hpp"
#include "results.hpp"

namespace {

using abut::vec3;
using abut::test::draws;

/// A shape around the origin, in a cube of side 2 `far`.
template <class S>
S drawn(draws& d, double far) {
    using T = abut::scalar_type_of<S>;
    const auto point = [&](double half) {
        return vec3<T>{T(d.uniform(-half, half)), T(d.uniform(-half, half)), T(d.uniform(-half, half))};
    };
    const auto size = [&] { return T(d.uniform(0.2, 0.6)); };
    const vec3<T> at = point(far);
    if constexpr (std::same_as<S, vec3<T>>) {
        return at;
    } else if constexpr (std::same_as<S, abut::sphere<T>>) {
        return {at, size()};
    } else if constexpr (std::same_as<S, abut::segment<T>>) {
        return {at, at + point(1.2)};
    } else if constexpr (std::same_as<S, abut::capsule<T>>) {
        return {{at, at + point(1.2)}, size()};
    } else if constexpr (std::same_as<S, abut::triangle<T>>) {
        return {at + point(0.6), at + point(0.6), at + point(0.6)};
    } else if constexpr (std::same_as<S, abut::aabb<T>>) {
        const vec3<T> half{size(), size(), size()};
        return {at - half, at + half};
    } else if constexpr (std::same_as<S, abut::placed_box<T>>) {
        abut::rigid<T> pose;
        abut::test::construction::set_rotation(pose, d.uniform(-1, 1), d.uniform(-1, 1), d.uniform(-1, 1), d.uniform(-1, 1));
        pose.translation = at;
        return place(pose, drawn<abut::aabb<T>>(d, 0));
    } else {
        return {point(1), T(d.uniform(-far, far))};
    }
}

template <class S, class U>
using pairs_of = std::vector<std::pair<S, U>>;

volatile double sink = 0;

template <class S, class U, class Ask>
double least_ns(const pairs_of<S, U>& pairs, int runs, const Ask& ask) {
    double least = 1e300;
    for (int run = 0; run < runs; ++run) {
        timespec from{}, to{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &from);
        double sum = 0;
        for (const auto& [s, t] : pairs) sum += ask(s, t);
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &to);
        sink = sum;
        least = std::min(least, 1e9 * double(to.tv_sec - from.tv_sec) + double(to.tv_nsec - from.tv_nsec));
    }
    return least / double(pairs.size());
}

struct report {
    bench::results& out;
    int runs;
    std::string only;

    template <class S, class U>
    void add(const std::string& kind, const char* which, const pairs_of<S, U>& pairs) const {
        if (pairs.empty()) return;
        const std::string scalar = sizeof(abut::scalar_type_of<S>) == 4 ? "float" : "double";
        const auto one = [&](const char* question, const auto& ask) {
            const std::string name = bench::joined({kind, scalar, question, which});
            if (name.find(only) != std::string::npos) out.add(name, {{"ns", least_ns(pairs, runs, ask)}});
        };
        one("boolean", [](const S& s, const U& t) { return abut::intersects(s, t) ? 1.0 : 0.0; });
        one("distance", [](const S& s, const U& t) { return double(abut::distance(s, t).distance); });
        one("contact", [](const S& s, const U& t) {
            const auto found = abut::contact_of(s, t);
            return found ? double(found->depth) : 0.0;
        });
    }
    template <class S, class U>
    void add(const std::string& kind, double far) const {
        pairs_of<S, U> all, apart, touching;
        draws d(20261128, 1, 0);
        for (int i = 0; i < 40000 && (apart.size() < 1000 || touching.size() < 1000); ++i) {
            const S s = drawn<S>(d, far);
            const U t = drawn<U>(d, far);
            auto& like = abut::intersects(s, t) ? touching : apart;
            if (all.size() < 2000) all.emplace_back(s, t);
            if (like.size() < 1000) like.emplace_back(s, t);
        }
        add(kind, "all", all);
        add(kind, "apart", apart);
        add(kind, "touching", touching);
    }
};

template <class T>
void add_all(const report& to) {
    using namespace abut;
    to.add<sphere<T>, sphere<T>>("sphere_sphere", 0.6);
    to.add<sphere<T>, capsule<T>>("sphere_capsule", 0.7);
    to.add<capsule<T>, capsule<T>>("capsule_capsule", 0.7);
    to.add<aabb<T>, sphere<T>>("box_sphere", 0.8);
    to.add<aabb<T>, capsule<T>>("box_capsule", 0.8);
    to.add<aabb<T>, aabb<T>>("box_box", 0.8);
    to.add<placed_box<T>, sphere<T>>("placed_box_sphere", 0.8);
    to.add<placed_box<T>, capsule<T>>("placed_box_capsule", 0.8);
    to.add<placed_box<T>, placed_box<T>>("placed_box_placed_box", 0.8);
    to.add<vec3<T>, capsule<T>>("point_capsule", 0.6);
    to.add<segment<T>, segment<T>>("segment_segment", 0.6);
    to.add<segment<T>, capsule<T>>("segment_capsule", 0.6);
    to.add<aabb<T>, segment<T>>("box_segment", 0.8);
    to.add<sphere<T>, triangle<T>>("sphere_triangle", 0.6);
    to.add<capsule<T>, triangle<T>>("capsule_triangle", 0.6);
    to.add<plane<T>, sphere<T>>("plane_sphere", 0.6);
    to.add<plane<T>, capsule<T>>("plane_capsule", 0.6);
    to.add<plane<T>, aabb<T>>("plane_box", 0.6);
    to.add<half_space<T>, sphere<T>>("half_space_sphere", 0.6);
    to.add<half_space<T>, capsule<T>>("half_space_capsule", 0.6);
    to.add<half_space<T>, aabb<T>>("half_space_box", 0.6);
    pairs_of<capsule<T>, capsule<T>> parallel;
    draws d(20261128, 2, 0);
    while (parallel.size() < 2000) {
        const auto s = drawn<capsule<T>>(d, 0.7);
        auto t = drawn<capsule<T>>(d, 0.7);
        t.axis.b = t.axis.a + static_cast<T>(d.uniform(-1, 1)) * (s.axis.b - s.axis.a);
        parallel.emplace_back(s, t);
    }
    to.add("capsule_capsule", "parallel", parallel);
}

}  // namespace

int main(int argc, char** argv) {
    const std::string path = bench::take_argument(argc, argv, "--json");
    try {
        const int runs = std::stoi(bench::take_argument(argc, argv, "--runs", "15"));
        const std::string only = bench::take_argument(argc, argv, "--only");
        if (argc > 1) throw std::runtime_error(std::string("no such argument: ") + argv[1]);
        bench::results out("bench_closed_forms");
        const report to{out, runs, only};
        add_all<double>(to);
        add_all<float>(to);
        if (!path.empty()) out.write(path);
        return 0;
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_closed_forms: %s\n", problem.what());
        return 1;
    }
}
