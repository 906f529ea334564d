// SPDX-License-Identifier: MIT
#include <abut/predicate/shared_corners.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <abut/narrow/crossing_points.hpp>
#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/samples.hpp"
#include "support/triangle_families.hpp"

// What two triangles have in common, against CGAL's exact kernel: how many corners it has, in what of each triangle each lies,
// in which order they come, and where they are. Triangles without area are CGAL's segments and points.

namespace abut::test {

namespace {

using kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using point_3 = kernel::Point_3;
using detail::shared_corners;

template <scalar T>
point_3 theirs(const vec3<T>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// A triangle, and what it is if it has no area.
struct their_triangle {
    std::array<point_3, 3> at;
    std::array<unsigned, 3> id{0, 1, 2};
    int corners = 3;

    template <scalar T>
    explicit their_triangle(const triangle<T>& t) : at{theirs(t.a), theirs(t.b), theirs(t.c)} {
        if (!CGAL::collinear(at[0], at[1], at[2])) return;
        unsigned least = 0, most = 0;
        for (unsigned i = 1; i < 3; ++i) {
            if (at[i] < at[least]) least = i;
            if (at[most] < at[i]) most = i;
        }
        corners = least == most ? 1 : 2;
        id = {std::min(least, most), std::max(least, most), 0};
    }
    [[nodiscard]] kernel::Triangle_3 face() const { return {at[0], at[1], at[2]}; }
    [[nodiscard]] kernel::Segment_3 segment() const { return {at[id[0]], at[id[1]]}; }
    [[nodiscard]] kernel::Vector_3 normal() const { return CGAL::cross_product(at[1] - at[0], at[2] - at[0]); }

    /// In what of it a point of it lies.
    [[nodiscard]] unsigned place_of(const point_3& p) const {
        for (int i = 0; i < corners; ++i) {
            if (at[id[static_cast<std::size_t>(i)]] == p) return id[static_cast<std::size_t>(i)];
        }
        const auto side = [&](unsigned i, unsigned j) { return kernel::Segment_3(at[i], at[j]).has_on(p); };
        if (corners == 3) {
            for (unsigned i = 0; i < 3; ++i) {
                if (side(i, (i + 1) % 3)) return 3 + i;
            }
            return 6;
        }
        return id[1] - id[0] == 1 ? 3 + id[0] : 5;
    }
};

void add_points(std::vector<point_3>& to, const point_3& p) { to.push_back(p); }
void add_points(std::vector<point_3>& to, const kernel::Segment_3& s) { to.insert(to.end(), {s.source(), s.target()}); }
void add_points(std::vector<point_3>& to, const kernel::Triangle_3& t) { to.insert(to.end(), {t[0], t[1], t[2]}); }
void add_points(std::vector<point_3>& to, const std::vector<point_3>& all) { to.insert(to.end(), all.begin(), all.end()); }

template <class S, class U>
std::vector<point_3> corners_of_common_part(const S& s, const U& t) {
    std::vector<point_3> all;
    if (const auto found = CGAL::intersection(s, t)) {
        boost::apply_visitor([&](const auto& part) { add_points(all, part); }, *found);
    }
    return all;
}
/// CGAL has no answer for a point and something else.
std::vector<point_3> corners_of_common_part(const point_3& p, const point_3& q) {
    return p == q ? std::vector<point_3>{p} : std::vector<point_3>{};
}
template <class U>
std::vector<point_3> corners_of_common_part(const point_3& p, const U& t) {
    return t.has_on(p) ? std::vector<point_3>{p} : std::vector<point_3>{};
}
template <class S>
std::vector<point_3> corners_of_common_part(const S& s, const point_3& p) {
    return corners_of_common_part(p, s);
}

std::vector<point_3> truth_of(const their_triangle& s, const their_triangle& t) {
    const auto with_t = [&](const auto& of_s) {
        return t.corners == 3   ? corners_of_common_part(of_s, t.face())
               : t.corners == 2 ? corners_of_common_part(of_s, t.segment())
                                : corners_of_common_part(of_s, t.at[0]);
    };
    return s.corners == 3 ? with_t(s.face()) : s.corners == 2 ? with_t(s.segment()) : with_t(s.at[0]);
}

/// What is wrong with an answer; null if nothing is.
template <scalar T>
const char* flaw_of(const triangle<T>& s, const triangle<T>& t, const shared_corners& found) {
    const their_triangle their_s(s), their_t(t);
    const std::vector<point_3> truth = truth_of(their_s, their_t);
    if (static_cast<int>(truth.size()) != found.count()) return "another number of corners";
    std::vector<point_3> at;
    for (int i = 0; i < found.count(); ++i) {
        const auto is_it = [&](const point_3& p) {
            return their_s.place_of(p) == found.in_first(i) && their_t.place_of(p) == found.in_second(i);
        };
        const auto p = std::find_if(truth.begin(), truth.end(), is_it);
        if (p == truth.end()) return "no such corner";
        if (std::find(at.begin(), at.end(), *p) != at.end()) return "a corner twice";
        at.push_back(*p);
        // Where it lies.
        const vec3<T> rounded = detail::point_of_corner(found, i, s, t);
        const auto largest = [](const triangle<T>& of) {
            double most = 0;
            for (const vec3<T>& v : {of.a, of.b, of.c}) {
                for (const T x : {v.x, v.y, v.z}) most = std::max(most, std::abs(static_cast<double>(x)));
            }
            return most;
        };
        const unsigned in_s = found.in_first(i), in_t = found.in_second(i);
        const double most = in_s < 6 && in_t < 6 ? std::max(largest(s), largest(t)) : in_s < 6 ? largest(s) : largest(t);
        const bool is_double = std::is_same_v<T, double>;
        const kernel::FT bound =
            kernel::FT(most) * (is_double ? 3 * 0x1p-53 : 0x1p-24 * (1 + 0x1p-4)) + 2 * kernel::FT(is_double ? 0x1p-1074 : 0x1p-149);
        const point_3 ours = theirs(rounded);
        for (int k = 0; k < 3; ++k) {
            if (CGAL::abs(ours[k] - (*p)[k]) > bound) return "a point off by more than its bound";
            if ((in_s < 3 || in_t < 3) && ours[k] != (*p)[k]) return "a vertex that is moved";
        }
    }
    if (at.size() == 2 && their_s.corners == 3 && their_t.corners == 3) {
        const auto line = CGAL::cross_product(their_s.normal(), their_t.normal());
        if (line != CGAL::NULL_VECTOR && line * (at[1] - at[0]) <= 0) return "a segment that runs backwards";
    }
    for (std::size_t i = 0; at.size() > 2 && i < at.size(); ++i) {
        const point_3 &p = at[i], &q = at[(i + 1) % at.size()], &r = at[(i + 2) % at.size()];
        if (CGAL::cross_product(q - p, r - q) * their_s.normal() <= 0) return "a polygon that does not turn";
    }
    return nullptr;
}

/// Two triangles of a small grid, which touch in all ways.
template <scalar T>
std::pair<triangle<T>, triangle<T>> on_grid(std::uint64_t k, int size, bool flat) {
    draws d(20270512, flat ? 2 : 1, k);
    const auto coordinate = [&] { return static_cast<T>(d.below(size)); };
    const auto place = [&] { return vec3<T>{coordinate(), coordinate(), flat ? T{1} : coordinate()}; };
    const triangle<T> s{place(), place(), place()};
    return {s, {place(), place(), place()}};
}

struct tally {
    std::uint64_t asked = 0, wrong = 0, certified = 0, by_count[8] = {};
    const char* flaw = nullptr;

    template <scalar T>
    void look(const triangle<T>& s, const triangle<T>& t) {
        ++asked;
        shared_corners found = detail::exact_corners(s, t);
        const shared_corners late = found.is_known() && asked % 16 != 0 ? found : detail::corners_at_any_span(s, t);
        const shared_corners first = detail::certified_corners(s, t);
        if (!found.is_known()) found = late;
        certified += first.is_known();
        ++by_count[found.count()];
        note(found == late ? nullptr : "stages that differ");
        note(!first.is_known() || first == found ? nullptr : "a certificate that is wrong");
        note(intersects<exact>(s, t) == (found.count() > 0) ? nullptr : "another decision than intersects");
        note(flaw_of(s, t, found));
    }

private:
    void note(const char* found) {
        wrong += found != nullptr;
        if (found != nullptr) flaw = found;
    }
};

}  // namespace

TEMPLATE_TEST_CASE("shared corners: as CGAL's exact kernel says, on small grids", "", float, double) {
    const std::uint64_t count = std::min<std::uint64_t>(sample_count(), 20000);
    for (const bool flat : {false, true}) {
        tally all;
        for (std::uint64_t k = 0; k < count; ++k) {
            const auto [s, t] = on_grid<TestType>(k, flat ? 6 : 3, flat);
            all.look(s, t);
        }
        std::printf("grid%s: %llu pairs, corners 0 to 6: %llu %llu %llu %llu %llu %llu %llu\n", flat ? " in a plane" : "",
                    static_cast<unsigned long long>(all.asked), static_cast<unsigned long long>(all.by_count[0]),
                    static_cast<unsigned long long>(all.by_count[1]), static_cast<unsigned long long>(all.by_count[2]),
                    static_cast<unsigned long long>(all.by_count[3]), static_cast<unsigned long long>(all.by_count[4]),
                    static_cast<unsigned long long>(all.by_count[5]), static_cast<unsigned long long>(all.by_count[6]));
        CAPTURE(flat, all.flaw == nullptr ? "" : all.flaw);
        CHECK(all.wrong == 0);
        CHECK(all.by_count[1] > count / 50);
        CHECK(all.by_count[2] > count / 50);
        if (!flat) continue;
        for (const int corners : {3, 4, 5}) CHECK(all.by_count[corners] > 10);
        CHECK(all.by_count[6] > 0);
    }
}

TEMPLATE_TEST_CASE("shared corners: as CGAL's exact kernel says, in all families of triangles", "", float, double) {
    const std::uint64_t count = std::min<std::uint64_t>(sample_count() / 10, 2000);
    std::uint64_t certified = 0, touching = 0;
    for (int i = 0; i < triangle_family_count; ++i) {
        const auto f = static_cast<triangle_family>(i);
        tally all;
        for (std::uint64_t k = 0; k < count; ++k) {
            const auto [s, t] = make_triangle_pair<TestType>(sample_seed, f, k);
            all.look(s, t);
        }
        CAPTURE(name_of(f), all.flaw == nullptr ? "" : all.flaw);
        CHECK(all.wrong == 0);
        certified += all.certified;
        touching += all.asked - all.by_count[0];
    }
    CHECK(certified > count * 5);
    CHECK(touching > count * 10);
}

TEMPLATE_TEST_CASE("shared corners: one point of an edge and a face, whoever asks", "", float, double) {
    using T = TestType;
    std::uint64_t met = 0, unlike = 0;
    for (std::uint64_t k = 0; k < 4000; ++k) {
        draws d(20270513, 3, k);
        const auto place = [&] { return vec3<T>{static_cast<T>(d.uniform(-1, 1)), static_cast<T>(d.uniform(-1, 1)), static_cast<T>(d.uniform(-1, 1))}; };
        const vec3<T> u = place(), v = place(), p = place(), q = place();
        const triangle<T> face{place(), place(), place()};
        const auto point_of = [&](const triangle<T>& s, unsigned side, const triangle<T>& t) -> std::optional<vec3<T>> {
            const shared_corners all = detail::exact_corners(s, t);
            for (int i = 0; i < all.count(); ++i) {
                if (all.in_first(i) == 3 + side && all.in_second(i) == 6) return detail::point_of_corner(all, i, s, t);
            }
            return {};
        };
        const auto swapped = [&](unsigned side, const triangle<T>& s) -> std::optional<vec3<T>> {
            const shared_corners all = detail::exact_corners(face, s);
            for (int i = 0; i < all.count(); ++i) {
                if (all.in_second(i) == 3 + side && all.in_first(i) == 6) return detail::point_of_corner(all, i, face, s);
            }
            return {};
        };
        const auto here = point_of({u, v, p}, 0, face);
        if (!here) continue;
        ++met;
        unlike += here != point_of({q, v, u}, 1, face);
        unlike += here != point_of({v, q, u}, 2, {face.b, face.a, face.c});
        unlike += here != swapped(2, {u, q, v});
    }
    CHECK(met > 200);
    CHECK(unlike == 0);
}

}  // namespace abut::test
