// SPDX-License-Identifier: MIT

// No step of culling loses a pair that touches, in any floating-point mode: each layout of trees, each bounding volume,
// grids and poses, with shapes at the ends of the range of numbers.

#include <cfenv>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/abut.hpp>
#include <abut/experimental/leafless.hpp>

#include "support/catch.hpp"
#include "support/draws.hpp"
#include "support/modes.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"

namespace abut::test {

namespace {

/// Where the coordinates of a scene come from. In each some are equal, so that shapes touch.
enum class coordinates {
    few_denormals,
    many_denormals,
    least_normals,
    small_normals,
    ones_and_denormals,
    mixed_exponents,
    largest,
    lattice,
};
constexpr const char* names_of_coordinates[] = {"few denormals",      "many denormals",  "least normals", "small normals",
                                                "ones and denormals", "mixed exponents", "largest",       "lattice"};

template <scalar T>
T draw_coordinate(draws& d, coordinates kind) {
    constexpr T tiny = construction::least_denormal<T>, normal = smallest_normal<T>;
    const T sign = d.below(2) == 0 ? T(-1) : T(1);
    const auto integer = [&d](int n) { return static_cast<T>(d.below(n)); };
    switch (kind) {
        case coordinates::few_denormals:
            return sign * integer(12) * tiny;
        case coordinates::many_denormals: {
            constexpr int coarse = sizeof(T) == 4 ? 1 : 1 << 29;  // 2^23 and 2^52 are the least normal numbers
            return sign * static_cast<T>(d.below(1 << 23)) * T(coarse) * tiny;
        }
        case coordinates::least_normals: {
            const T multiple = integer(4) * normal, steps = integer(7) - 3;
            return sign * (multiple + steps * tiny);
        }
        case coordinates::small_normals: {
            const T unit = sizeof(T) == 4 ? T(1e-34) : T(1e-305), whole = integer(5), part = static_cast<T>(d.uniform(0, 1));
            return sign * (d.below(2) == 0 ? whole / 4 : part) * unit;
        }
        case coordinates::ones_and_denormals: {
            const T small[] = {
                0, tiny, 3 * tiny, normal - tiny, normal, normal + tiny, 1 - unit_roundoff<T>, 1, 1 + 2 * unit_roundoff<T>};
            return sign * small[d.below(9)];
        }
        case coordinates::mixed_exponents: {
            constexpr int lowest = sizeof(T) == 4 ? -149 : -1074, highest = sizeof(T) == 4 ? 127 : 1023;
            const int exponent = lowest + d.below(12) * ((highest - lowest) / 11);  // few, so that some are equal
            const T mantissa = d.below(2) == 0 ? T(1) : T(1.5);
            return sign * std::ldexp(mantissa, exponent);
        }
        case coordinates::largest:
            return sign * (largest_finite<T> / 4) * integer(5);
        case coordinates::lattice:
            break;
    }
    return sign * integer(6);
}

template <scalar T>
struct scene {
    std::vector<triangle<T>> a, b;
    std::vector<sphere<T>> balls;
    std::vector<capsule<T>> capsules;
    std::vector<segment<T>> segments;
    std::vector<plane<T>> planes;
    std::vector<aabb<T>> boxes;
    std::vector<vec3<T>> points;

    scene(draws& d, coordinates kind) {
        const auto number = [&] { return draw_coordinate<T>(d, kind); };
        const auto radius = [&] { return detail::absolute(number()); };
        // Shapes are small in part: their corners differ in one coordinate.
        const auto point = [&] {
            const T x = number(), y = number();
            return vec3<T>{x, y, number()};
        };
        const auto beside = [&](vec3<T> p) {
            if (d.below(3) == 0) return point();
            const T x = number();
            (d.below(3) == 0 ? p.x : d.below(2) == 0 ? p.y : p.z) = x;
            return p;
        };
        const auto add_triangle = [&](std::vector<triangle<T>>& to) {
            const vec3<T> p = point(), q = beside(p), r = beside(q);
            to.push_back({p, q, r});
        };
        for (int i = 0; i < 24; ++i) {
            add_triangle(a);
            add_triangle(b);
        }
        for (int i = 0; i < 12; ++i) {
            const vec3<T> p = point(), q = beside(p);
            balls.push_back({p, radius()});
            capsules.push_back({{p, q}, radius()});
            segments.push_back({p, q});
            planes.push_back({point(), number()});
            boxes.push_back({detail::least(p, q), detail::greatest(p, q)});
            points.push_back(p);
        }
    }
};

/// What has overflowed where a pose puts it, queries refuse.
template <class Query, class T>
bool are_finite(const Query& query, const triangle<T>& target) {
    return is_valid(query) && is_valid(target);
}

/// Which of a set's shapes each query touches; by predicates alone, which no mode changes.
template <class Query, class T>
std::vector<std::vector<bool>> touching(const std::vector<Query>& queries, const std::vector<triangle<T>>& targets) {
    std::vector<std::vector<bool>> truth(queries.size(), std::vector<bool>(targets.size()));
    for (std::size_t i = 0; i < queries.size(); ++i) {
        for (std::size_t j = 0; j < targets.size(); ++j)
            truth[i][j] = are_finite(queries[i], targets[j]) && intersects(queries[i], targets[j]);
    }
    return truth;
}

struct tally {
    std::size_t hits = 0, lost = 0, found_twice = 0;

    /// Compares with how often each pair was found.
    void add(const std::vector<std::vector<bool>>& truth, const std::vector<std::vector<int>>& found) {
        for (std::size_t i = 0; i < truth.size(); ++i) {
            for (std::size_t j = 0; j < truth[i].size(); ++j) {
                hits += truth[i][j];
                lost += truth[i][j] && found[i][j] == 0;
                found_twice += found[i][j] > 1;
            }
        }
    }
};

/// What queries find in an index, one by one.
template <class Walk, class Query>
std::vector<std::vector<int>> walk_each(const Walk& walk, const std::vector<Query>& queries, std::size_t targets) {
    std::vector<std::vector<int>> found(queries.size(), std::vector<int>(targets));
    for (std::size_t i = 0; i < queries.size(); ++i) {
        auto reach = reach_of(queries[i]);
        if (!walk.may_touch(reach)) continue;
        typename Walk::cursor at;
        const auto never = [] { return false; };
        walk.for_each(reach, at, never, [&](std::uint32_t j) {
            ++found[i][j];
            return visit::proceed;
        });
    }
    return found;
}

/// What two trees find in each other, with the ids of the second one first.
template <class Walk>
std::vector<std::vector<int>> walk_both(const Walk& walk) {
    std::vector<std::vector<int>> found(walk.b.size(), std::vector<int>(walk.a.size()));
    std::vector<typename Walk::item> pending{walk.seed(0)};
    while (!pending.empty()) {
        const auto at = pending.back();
        pending.pop_back();
        walk.expand(
            at,
            [&](auto, bool is, const typename Walk::item& next) {
                if (is) pending.push_back(next);
            },
            [&](auto, bool is, std::uint32_t i, std::uint32_t j) { found[j][i] += is; });
    }
    return found;
}

/// One scene: its shapes and what of them touches.
template <scalar T>
struct known_scene {
    scene<T> shapes;
    std::vector<std::vector<bool>> triangles, balls, capsules, segments, planes, boxes, points;

    explicit known_scene(scene<T> s)
        : shapes(std::move(s)),
          triangles(touching(shapes.b, shapes.a)),
          balls(touching(shapes.balls, shapes.a)),
          capsules(touching(shapes.capsules, shapes.a)),
          segments(touching(shapes.segments, shapes.a)),
          planes(touching(shapes.planes, shapes.a)),
          boxes(touching(shapes.boxes, shapes.a)),
          points(touching(shapes.points, shapes.a)) {}

    template <class Walk>
    void check_queries(const Walk& walk, tally& sum) const {
        const std::size_t n = shapes.a.size();
        sum.add(triangles, walk_each(walk, shapes.b, n));
        sum.add(balls, walk_each(walk, shapes.balls, n));
        sum.add(capsules, walk_each(walk, shapes.capsules, n));
        sum.add(segments, walk_each(walk, shapes.segments, n));
        sum.add(planes, walk_each(walk, shapes.planes, n));
        sum.add(boxes, walk_each(walk, shapes.boxes, n));
        sum.add(points, walk_each(walk, shapes.points, n));
    }
};

/// The trees over the scene's triangles, in each layout: calls use(name, tree a, tree b).
template <scalar T, class Use>
void for_each_layout(const scene<T>& shapes, const Use& use) {
    const serial on;
    const triangle_soup<T> a(shapes.a), b(shapes.b);
    const auto linear = make_bvh(on, a), other = make_bvh(on, b);
    use("linear", linear, other);
    use("mean_split", make_bvh(on, a, {.builder = bvh_builder::mean_split}),
        make_bvh(on, b, {.builder = bvh_builder::mean_split}));
    use("sah", make_bvh(on, a, {.builder = bvh_builder::sah}), make_bvh(on, b, {.builder = bvh_builder::sah}));
    use("ploc", make_bvh(on, a, {.builder = bvh_builder::ploc}), make_bvh(on, b, {.builder = bvh_builder::ploc}));
    use("refit", refit(on, other, a), refit(on, linear, b));
    use("quantised", quantised(on, linear), quantised(on, other));
    use("leafless", leafless(on, linear), leafless(on, other));
    use("wide", wide(on, linear), wide(on, other));
    use("spheres", bounded_by<sphere<T>>(on, linear), bounded_by<sphere<T>>(on, other));
    use("boxes", bounded_by<aabb<T>>(on, linear), bounded_by<aabb<T>>(on, other));
    use("oriented", oriented(on, linear), oriented(on, other));
    use("14-DOPs", bounded_by<kdop<T, 14>>(on, linear), bounded_by<kdop<T, 14>>(on, other));
    use("18-DOPs", bounded_by<kdop<T, 18>>(on, linear), bounded_by<kdop<T, 18>>(on, other));
    use("26-DOPs", bounded_by<kdop<T, 26>>(on, linear), bounded_by<kdop<T, 26>>(on, other));
}

template <class Tree>
auto walk_over(const Tree& tree) {
    return detail::bvh_walk<typename Tree::view_type>{tree.view()};
}
template <class Set, class Space>
auto walk_over(const grid<Set, Space>& index) {
    return detail::grid_walk<typename grid<Set, Space>::view_type>{index.view()};
}

void check_tally(const char* name, const tally& sum) {
    CAPTURE(name, sum.hits);
    CHECK(sum.lost == 0);
    CHECK(sum.found_twice == 0);
}

/// Builds in one mode and queries in another.
template <scalar T>
void check_scene(const known_scene<T>& known, const floating_mode& built, const floating_mode& queried) {
    std::size_t hits = 0;
    const auto check = [&](const char* name, const tally& sum) {
        check_tally(name, sum);
        hits += sum.hits;
    };
    const auto query = [&](const char* name, const auto& a, const auto& b) {
        in_mode(queried, [&] {
            using view = typename std::remove_cvref_t<decltype(a)>::view_type;
            tally sum;
            sum.add(known.triangles, walk_both(detail::pair_walk<view, view, detail::same_frame>{a.view(), b.view(), {}}));
            known.check_queries(walk_over(a), sum);
            check(name, sum);
        });
    };
    in_mode(built, [&] { for_each_layout(known.shapes, query); });
    CHECK(hits > 0);
}

/// The same of grids, in one mode.
template <scalar T>
void check_grids(const known_scene<T>& known) {
    for (const double width : {0.0, 1e-300}) {
        tally sum;
        known.check_queries(walk_over(make_grid(serial{}, triangle_soup<T>(known.shapes.a), width)), sum);
        check_tally("grid", sum);
    }
}

/// Shapes where a pose puts them, as the mode that is in force rounds that.
template <class Shape, class T>
std::vector<Shape> placed(const rigid<T>& pose, std::vector<Shape> shapes) {
    for (Shape& s : shapes) s = place(pose, s);
    return shapes;
}

/// Two scenes under poses; both are built, posed, culled and decided in the mode that is in force.
template <scalar T>
std::size_t check_posed(const scene<T>& shapes, const rigid<T>& pose_a, const rigid<T>& pose_b) {
    std::size_t hits = 0;
    const std::vector<triangle<T>> world_a = placed(pose_a, shapes.a);
    const auto triangles = touching(placed(pose_b, shapes.b), world_a);
    const std::vector<sphere<T>> world_balls = placed(pose_b, shapes.balls);
    const std::vector<capsule<T>> world_capsules = placed(pose_b, shapes.capsules);
    const auto balls = touching(world_balls, world_a);
    const auto capsules = touching(world_capsules, world_a);
    const auto check = [&](const char* name, const tally& sum) {
        check_tally(name, sum);
        hits += sum.hits;
    };
    for_each_layout(shapes, [&](const char* name, const auto& a, const auto& b) {
        using view = typename std::remove_cvref_t<decltype(a)>::view_type;
        const aabb<T> around_a = a.bounds(), around_b = b.bounds();
        const detail::two_frames<T> frames{make_relative_pose(pose_a, around_a, pose_b, around_b)};
        tally sum;
        sum.add(triangles, walk_both(detail::pair_walk<view, view, detail::two_frames<T>>{a.view(), b.view(), frames}));
        check(name, sum);
    });
    const triangle_soup<T> soup(shapes.a);
    const auto check_queries = [&](const char* name, const auto& index, const aabb<T>& around) {
        const auto walk = walk_over(index);
        const detail::posed_walk<std::remove_const_t<decltype(walk)>> moved(walk, pose_a, around);
        tally sum;
        sum.add(balls, walk_each(moved, world_balls, shapes.a.size()));
        sum.add(capsules, walk_each(moved, world_capsules, shapes.a.size()));
        check(name, sum);
    };
    const auto tree = make_bvh(serial{}, soup);
    check_queries("posed tree", tree, tree.bounds());
    const auto cells = make_grid(serial{}, soup);
    check_queries("posed grid", cells, cells.view().frame->bounds);
    return hits;
}

}  // namespace

TEMPLATE_TEST_CASE("modes: no walk loses a pair, whatever becomes of denormals and however numbers are rounded", "", float,
                   double) {
    using T = TestType;
    for (int kind = 0; kind < 8; ++kind) {
        for (std::uint64_t round = 0; round < 3; ++round) {
            draws d(sample_seed, 90 + static_cast<std::uint64_t>(kind), round);
            const known_scene<T> known(scene<T>(d, static_cast<coordinates>(kind)));
            for (const floating_mode& mode : floating_modes()) {
                CAPTURE(names_of_coordinates[kind], round, mode.name);
                check_scene(known, floating_modes().front(), mode);
                if (mode.rounding != FE_TONEAREST || mode.flags != 0) check_scene(known, mode, mode);
                in_mode(mode, [&] { check_grids(known); });
            }
        }
    }
}

TEMPLATE_TEST_CASE("modes: nor does it between posed objects", "", float, double) {
    using T = TestType;
    for (int kind = 0; kind < 8; ++kind) {
        if (static_cast<coordinates>(kind) == coordinates::largest) continue;  // placed, they overflow
        std::size_t hits = 0;
        for (std::uint64_t round = 0; round < 4; ++round) {
            draws d(sample_seed, 110 + static_cast<std::uint64_t>(kind), round);
            const auto number = [&] { return draw_coordinate<T>(d, static_cast<coordinates>(kind)); };
            const auto pose = [&] {
                rigid<T> r = make_rotation<T>(d);
                const T x = number(), y = number();
                r.translation = {x, y, number()};
                return r;
            };
            scene<T> shapes(d, static_cast<coordinates>(kind));
            const rigid<T> pose_a = pose(), pose_b = pose();
            // Some of b's shapes are where some of a's are, but for rounding.
            const rigid<T> back = inverse(pose_b);
            for (std::size_t i = 0; i < shapes.b.size(); i += 2) {
                shapes.b[i] = place(back, place(pose_a, shapes.a[i]));
            }
            for (std::size_t i = 0; i < shapes.balls.size(); i += 2) {
                shapes.balls[i].center = place(back, place(pose_a, shapes.a[i].b));
                shapes.capsules[i].axis.b = place(back, place(pose_a, shapes.a[i].c));
            }
            for (const floating_mode& mode : floating_modes()) {
                CAPTURE(names_of_coordinates[kind], round, mode.name);
                in_mode(mode, [&] { hits += check_posed(shapes, pose_a, pose_b); });
            }
        }
        CAPTURE(names_of_coordinates[kind]);
        CHECK(hits > 500);
    }
}

TEMPLATE_TEST_CASE("modes: nothing overflows, is invalid or divides by zero in a scene that is not extreme", "", float,
                   double) {
    using T = TestType;
#if defined(__clang__)
    constexpr int exceptions = FE_OVERFLOW | FE_DIVBYZERO;  // it may convert to int what a branch then leaves unused
#else
    constexpr int exceptions = FE_OVERFLOW | FE_DIVBYZERO | FE_INVALID;
#endif
    for (const bool flat : {false, true}) {
        draws d(sample_seed, 130, flat);
        scene<T> shapes(d, coordinates::lattice);
        if (flat) {
            for (triangle<T>& t : shapes.a) t.a.z = t.b.z = t.c.z = 0;
        }
        const known_scene<T> known(shapes);
        const auto check = [](const char* name, const auto& body) {
            std::feclearexcept(FE_ALL_EXCEPT);
            body();
            CAPTURE(name);
            CHECK(std::fetestexcept(exceptions) == 0);
        };
        check("layouts", [&] { check_scene(known, floating_modes().front(), floating_modes().front()); });
        check("grids", [&] { check_grids(known); });
        check("quality", [&] { (void)quality(make_bvh(serial{}, triangle_soup<T>(shapes.a))); });
    }
}

}  // namespace abut::test
