// SPDX-License-Identifier: MIT

#include <abut/abut.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <random>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "support/catch.hpp"

// What is as near, or is met as soon: the least ids are found, and not by a visit of each tie. All coordinates are small
// integers, so that oracles need no formula of the library's: squared distances are integers.

namespace marks {

/// Counts what is measured, in any thread.
std::atomic<std::size_t> measured{0};
/// And what is decided.
std::atomic<std::size_t> decided{0};

/// A box by another name.
struct mark {
    using scalar_type = float;
    abut::aabb<float> box;
};
abut::aabb<float> bounds(const mark& m) { return m.box; }
mark place(const abut::rigid<float>& pose, const mark& m) {
    return {{place(pose, m.box.lower), place(pose, m.box.upper)}};  // poses of these tests turn nothing
}
bool resolve(const mark& m, const mark& n) { return overlaps(m.box, n.box); }
template <abut::arithmetic A>
abut::verdict decide(const mark& m, const mark& n) {
    ++decided;
    return abut::to_verdict(resolve(m, n));
}
abut::separation<float> separation_between(const mark& m, const mark& n) {
    ++measured;
    return abut::distance(m.box, n.box);
}
abut::vec3<float> nearest_point(const mark& m, const abut::vec3<float>& p) {
    ++measured;
    return abut::nearest_point(m.box, p);
}
template <abut::arithmetic A, class Line>
double hit_time(const Line& line, const mark& m) {
    ++measured;
    return abut::hit_time_of<A>(line, m.box);
}

}  // namespace marks

namespace abut::test {

using marks::mark;
using whole = std::int64_t;

struct cell {
    whole x, y, z, wide = 0;  ///< a box of so much along x and y, and none along z
};
mark mark_at(const cell& c) {
    const auto f = [](whole x) { return static_cast<float>(x); };
    return {{{f(c.x), f(c.y), f(c.z)}, {f(c.x + c.wide), f(c.y + c.wide), f(c.z)}}};
}
shapes<mark> marks_at(const std::vector<cell>& cells) {
    std::vector<mark> all;
    for (const cell& c : cells) all.push_back(mark_at(c));
    return shapes<mark>(all);
}
whole squared_gap(const cell& a, const cell& b) {
    const auto gap = [](whole x, whole wide_x, whole y, whole wide_y) {
        return std::max<whole>({x - (y + wide_y), y - (x + wide_x), 0});
    };
    const whole dx = gap(a.x, a.wide, b.x, b.wide), dy = gap(a.y, a.wide, b.y, b.wide), dz = a.z - b.z;
    return dx * dx + dy * dy + dz * dz;
}
index_pair nearest_of(const std::vector<cell>& a, const std::vector<cell>& b) {
    whole least = 1 << 30;
    index_pair best{};
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            const whole d = squared_gap(a[i], b[j]);
            if (d < least) least = d, best = {i, j};
        }
    }
    return best;
}
std::vector<cell> shuffled(std::vector<cell> cells, unsigned seed) {
    std::shuffle(cells.begin(), cells.end(), std::mt19937(seed));
    return cells;
}
/// So many copies of each place.
std::vector<cell> copies_of(const std::vector<cell>& places, std::size_t each, unsigned seed) {
    std::vector<cell> cells;
    for (const cell& c : places) cells.insert(cells.end(), each, c);
    return shuffled(cells, seed);
}
/// A plate of tiles in the plane z.
std::vector<cell> plate(whole side, whole z, unsigned seed) {
    std::vector<cell> cells;
    for (whole x = 0; x < side; ++x) {
        for (whole y = 0; y < side; ++y) cells.push_back({2 * x, 2 * y, z, 2});
    }
    return shuffled(cells, seed);
}
template <class Ask>
std::size_t measured_by(const Ask& ask) {
    marks::measured = 0;
    ask();
    return marks::measured;
}

/// Threads that begin together do not know each other's distances yet: each may ask as much as one thread alone.
std::size_t threads_of(const serial&) { return 1; }
std::size_t threads_of(const openmp& on) { return static_cast<std::size_t>(on.threads); }

/// Trees with and without least ids, of two layouts, one posed, and one side without a tree.
template <class Policy>
void check_pairs(const Policy& on, const std::vector<cell>& a, const std::vector<cell>& b, std::size_t most,
                 bool are_copies) {
    const auto set_a = marks_at(a), set_b = marks_at(b);
    const index_pair expected = nearest_of(a, b);
    const auto check = [&](const auto& x, const auto& y, std::size_t most_measured) {
        const std::size_t asked = measured_by([&] {
            const auto found = distance(on, x, y);
            REQUIRE(found);
            CHECK((index_pair{found->a, found->b} == expected));
        });
        CHECK(asked <= most_measured * threads_of(on));
    };
    const auto tree_a = make_bvh(on, set_a), tree_b = make_bvh(on, set_b);
    check(tree_a, tree_b, most);
    check(wide(on, tree_a), wide(on, tree_b), most);
    check(quantised(on, tree_a), wide(on, tree_b), are_copies ? most : a.size() * b.size());
    check(make_bvh(on, set_a, {.builder = bvh_builder::sah}), tree_b, most);
    check(make_bvh(on, set_a, {.least_ids = true}), make_bvh(on, set_b, {.least_ids = true}), most);
    check(tree_a, set_b, 30 * (a.size() + b.size()));
    check(set_a, tree_b, 30 * (a.size() + b.size()));
    check(set_a, wide(on, tree_b), 30 * (a.size() + b.size()));
    if (are_copies) {
        rigid<float> pose;
        pose.translation = {0, 0, 64};
        check(posed(tree_a, pose), posed(tree_b, pose), most);
    }
}

template <class Policy>
void check_all_pairs(const Policy& on) {
    const std::size_t each = 300;
    const auto one = copies_of({{0, 0, 0}}, 1000, 1), other = copies_of({{3, 4, 12}}, 1000, 2);
    check_pairs(on, one, other, 2000, true);
    // Four of the places are equally far from four others.
    const auto some = copies_of({{0, 0, 0}, {0, 9, 0}, {9, 0, 0}, {9, 9, 0}, {4, 4, -9}}, each, 3);
    const auto others = copies_of({{0, 0, 5}, {0, 9, 5}, {9, 0, 5}, {9, 9, 5}, {4, 4, 20}}, each, 4);
    check_pairs(on, some, others, 4000, true);
    check_pairs(on, copies_of({{0, 0, 0, 7}}, each, 5), copies_of({{9, 3, 1, 2}, {3, 9, 1, 2}}, each, 6), 2000, true);
}

/// Posed trees in lists and as bodies.
template <class Policy>
void check_entries(const Policy& on) {
    const std::size_t threads = threads_of(on);
    const auto one = copies_of({{0, 0, 0}, {0, 9, 0}}, 700, 21), other = copies_of({{0, 0, 5}, {0, 9, 5}, {9, 9, 5}}, 700, 22);
    const std::vector<cell> single{{3, 4, 12}};
    const auto moved = [](std::vector<cell> cells, whole z) {
        for (auto& c : cells) c.z += z;
        return cells;
    };
    const auto run = [&](const auto& layout) {
        const auto a = layout(make_bvh(on, marks_at(one))), b = layout(make_bvh(on, marks_at(other))), c = layout(make_bvh(on, marks_at(single)));
        using index = std::remove_const_t<decltype(a)>;
        const auto at = [](const index& x, whole z) {
            rigid<float> pose;
            pose.translation = {0, 0, static_cast<float>(z)};
            return posed(x, pose);
        };
        std::vector<posed_pair<index>> list;
        std::vector<index_pair> expected;
        for (whole z = 0; z < 6; ++z) {
            list.push_back({at(a, z), at(b, 0)}), expected.push_back(nearest_of(moved(one, z), other));  // they touch at 5
            list.push_back({at(b, 0), at(a, z)}), expected.push_back(nearest_of(other, moved(one, z)));
        }
        list.push_back({at(a, 2), at(c, 0)}), expected.push_back(nearest_of(moved(one, 2), single));
        list.push_back({at(c, 0), at(b, 1)}), expected.push_back(nearest_of(single, moved(other, 1)));
        const std::size_t asked = measured_by([&] {
            const auto found = to_host(distance(on, list));
            for (std::size_t i = 0; i < list.size(); ++i) CHECK((index_pair{found[i].a, found[i].b} == expected[i]));
        });
        CHECK(asked <= 500 * threads * list.size());
        CHECK(marks::decided <= 20'000 * threads);
        // Two pairs of bodies are as near; a body of one shape is far away.
        const auto check_bodies = [&](const std::vector<posed_object<index>>& bodies, index_pair of, index_pair ids) {
            const std::size_t of_bodies = measured_by([&] {
                const auto found = distance(on, bodies);
                REQUIRE(found);
                CHECK((index_pair{found->body_a, found->body_b} == of));
                CHECK((index_pair{found->a, found->b} == ids));
            });
            CHECK(of_bodies <= 4000 * threads);
        };
        check_bodies({at(c, 100), at(b, 0), at(a, 0), at(b, -10)}, {1, 2}, nearest_of(other, one));
        check_bodies({at(b, -10), at(c, 100), at(a, 0), at(b, 0)}, {0, 2}, nearest_of(moved(other, -10), one));
        check_bodies({at(a, 0), at(c, 0), at(b, -10)}, {0, 2}, nearest_of(one, moved(other, -10)));
        check_bodies({at(a, 5), at(c, 100), at(b, 0)}, {0, 2}, nearest_of(moved(one, 5), other));
    };
    run([](const auto& tree) { return tree; });
    run([&](const auto& tree) { return wide(on, tree); });
}

/// Trees keep what is found of copies: whoever asks again measures next to nothing, and a tree of moved shapes knows none of it.
template <class Policy>
void check_kept(const Policy& on) {
    auto a = copies_of({{0, 0, 0}}, 3000, 31), b = copies_of({{3, 4, 12}}, 3000, 32);
    const auto run = [&](const auto& layout) {
        const auto tree_a = layout(make_bvh(on, marks_at(a))), tree_b = layout(make_bvh(on, marks_at(b)));
        const auto ask = [&] {
            const auto found = distance(on, tree_a, tree_b);
            REQUIRE(found);
            CHECK((index_pair{found->a, found->b} == index_pair{0, 0}));
        };
        CHECK(measured_by(ask) > 50);
        CHECK(measured_by(ask) <= 10 * threads_of(on));
        rigid<float> pose;
        pose.translation = {0, 0, 64};
        const std::vector<posed_pair<std::remove_const_t<decltype(tree_a)>>> list{{posed(tree_a, pose), posed(tree_b, pose)}};
        CHECK(measured_by([&] { CHECK(to_host(distance(on, list))[0].b == 0); }) <= 30 * threads_of(on));
        // One row at a time asks the same tree.
        const auto fresh = layout(make_bvh(on, marks_at(a)));
        const std::vector<vec3<float>> point{{3, 4, 12}};
        const rays<float> line(std::vector<ray<float>>{{{0, 0, -5}, {0, 0, 1}}});
        const auto look = [&] { CHECK(to_host(nearest(on, fresh, point))[0].id == 0); };
        CHECK(measured_by(look) > 50);
        CHECK(measured_by(look) <= 10);
        CHECK(measured_by([&] { CHECK(to_host(raycast(on, fresh, line))[0].id == 0); }) <= 10);
        CHECK(measured_by([&] { CHECK(to_host(nearest(on, std::vector{posed(fresh, pose)}, point))[0].id == 0); }) <= 10);
        CHECK(to_host(nearest(on, fresh, point, 3))[2].id == 2);
        CHECK(measured_by(look) <= 10);
    };
    run([](const auto& tree) { return tree; });
    run([&](const auto& tree) { return wide(on, tree); });
    const auto tree_a = make_bvh(on, marks_at(a)), tree_b = make_bvh(on, marks_at(b));
    for (const std::uint32_t nearer : {2999u, 1234u}) {
        CHECK(distance(on, tree_a, tree_b)->b == 0);
        auto moved = b;
        moved[nearer].z = 11;
        const auto found = distance(on, tree_a, refit(on, tree_b, marks_at(moved)));
        CHECK((index_pair{found->a, found->b} == index_pair{0, nearer}));
    }
}

/// Many pairs touch, and the least of these is found without a look at all.
template <class Policy>
void check_touching(const Policy& on, const std::vector<cell>& a, const std::vector<cell>& b) {
    const auto set_a = marks_at(a), set_b = marks_at(b);
    const index_pair expected = nearest_of(a, b);
    REQUIRE(squared_gap(a[expected.a], b[expected.b]) == 0);
    const auto check = [&](const auto& x, const auto& y, std::size_t most) {
        marks::decided = 0;
        const auto found = distance(on, x, y);
        REQUIRE(found);
        CHECK((index_pair{found->a, found->b} == expected));
        CHECK(found->distance == 0);
        CHECK(marks::decided <= most * threads_of(on));
    };
    const auto tree_a = make_bvh(on, set_a), tree_b = make_bvh(on, set_b);
    const std::size_t few = 4 * (a.size() + b.size());
    check(tree_a, tree_b, few);
    check(wide(on, tree_a), wide(on, tree_b), few);
    check(quantised(on, tree_a), quantised(on, tree_b), few);
    check(quantised(on, tree_a), wide(on, tree_b), few);
    check(make_bvh(on, set_a, {.builder = bvh_builder::sah}), tree_b, few);
    check(make_bvh(on, set_a, {.least_ids = true}), make_bvh(on, set_b, {.least_ids = true}), few);
    check(posed(tree_a, rigid<float>{}), tree_b, few);
    check(posed(wide(on, tree_a), rigid<float>{}), posed(wide(on, tree_b), rigid<float>{}), few);
    check(set_a, tree_b, few);
    check(tree_a, set_b, few);
    check(set_a, set_b, a.size() * b.size());
}

template <class Policy>
void check_all_touching(const Policy& on) {
    const auto a = copies_of({{0, 0, 0}, {50, 0, 0}, {90, 0, 0, 3}}, 400, 23);
    check_touching(on, a, copies_of({{0, 0, 0}, {-50, 0, 0}, {91, 1, 0}}, 400, 24));
    check_touching(on, a, copies_of({{50, 0, 0}}, 500, 25));
    check_touching(on, plate(25, 0, 26), plate(25, 0, 27));
    std::vector<cell> far(300, {0, 0, 70}), near(300, {0, 0, 0});
    far.push_back({0, 0, 0});  // the last of all touches
    check_touching(on, far, near);
    check_touching(on, near, far);
}

template <class Policy>
void check_points(const Policy& on) {
    const auto cells = copies_of({{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {3, 3, 9}}, 500, 7);
    const auto set = marks_at(cells);
    std::vector<vec3<float>> points;
    std::vector<cell> from;
    std::mt19937 random(8);
    for (int k = 0; k < 300; ++k) {
        from.push_back({whole(random() % 9), whole(random() % 9), whole(random() % 9)});  // many are as near to two of them
        points.push_back(mark_at(from.back()).box.lower);
    }
    const auto in_order = [&](const cell& p, const auto& wanted) {
        std::vector<std::pair<whole, std::uint32_t>> all;
        for (std::uint32_t i = 0; i < cells.size(); ++i) {
            if (wanted(i)) all.emplace_back(squared_gap(p, cells[i]), i);
        }
        std::sort(all.begin(), all.end());
        return all;
    };
    const auto check = [&](const auto& index, std::size_t count, const auto& ask, const auto& wanted) {
        const auto found = to_host(ask(index));
        REQUIRE(found.size() == count * points.size());
        std::size_t wrong = 0;
        for (std::size_t k = 0; k < points.size(); ++k) {
            const auto expected = in_order(from[k], wanted);
            for (std::size_t j = 0; j < count; ++j) wrong += found[count * k + j].id != expected[j].second;
        }
        CHECK(wrong == 0);
    };
    const auto all = [](std::uint32_t) { return true; };
    const auto tree = make_bvh(on, set);
    const auto check_trees = [&](std::size_t count, const auto& ask) {
        const std::size_t most = 40 * points.size() + cells.size() / 4 + 100;
        CHECK(measured_by([&] { check(tree, count, ask, all); }) <= most + points.size() * count);
        CHECK(measured_by([&] { check(wide(on, tree), count, ask, all); }) <= most + points.size() * count);
        CHECK(measured_by([&] { check(posed(quantised(on, tree), rigid<float>{}), count, ask, all); }) <=
              most + points.size() * count);
        check(set, count, ask, all);
    };
    check_trees(1, [&](const auto& index) { return nearest(on, index, points); });
    check_trees(7, [&](const auto& index) { return nearest(on, index, points, 7); });
    check_trees(600, [&](const auto& index) { return nearest(on, index, points, 600); });
    // Bodies share an object: of equals the least body comes first.
    const auto check_bodies = [&](const auto& index, std::size_t count, const auto& ask) {
        std::remove_cvref_t<decltype(index)> copy = index;
        rigid<float> away;
        away.translation = {0, 0, 500};
        const std::vector bodies{posed(copy, away), posed(copy, rigid<float>{}), posed(copy, rigid<float>{})};
        const std::size_t asked = measured_by([&] {
            const auto found = to_host(ask(bodies));
            REQUIRE(found.size() == count * points.size());
            std::size_t wrong = 0;
            for (std::size_t k = 0; k < points.size(); ++k) {
                const auto expected = in_order(from[k], [](std::uint32_t) { return true; });
                std::vector<std::array<std::uint32_t, 2>> both;
                for (std::size_t j = 0; both.size() < count;) {
                    std::size_t end = j;
                    while (end < expected.size() && expected[end].first == expected[j].first) ++end;
                    for (const std::uint32_t body : {1u, 2u}) {
                        for (std::size_t i = j; i < end; ++i) both.push_back({body, expected[i].second});
                    }
                    j = end;
                }
                for (std::size_t j = 0; j < count; ++j) {
                    wrong += found[count * k + j].body != both[j][0] || found[count * k + j].id != both[j][1];
                }
            }
            CHECK(wrong == 0);
        });
        CHECK(asked <= (80 + 2 * count) * points.size() + cells.size());
    };
    check_bodies(tree, 1, [&](const auto& bodies) { return nearest(on, bodies, points); });
    check_bodies(wide(on, tree), 1, [&](const auto& bodies) { return nearest(on, bodies, points); });
    check_bodies(tree, 7, [&](const auto& bodies) { return nearest(on, bodies, points, 7); });
    check_bodies(quantised(on, tree), 700, [&](const auto& bodies) { return nearest(on, bodies, points, 700); });
    // A filter tells copies apart.
    const auto odd = [](std::uint32_t, std::uint32_t id) { return id % 2 == 1; };
    const nearest_options<decltype(odd)> of_odd{.count = 3, .filter = odd};
    check(
        tree, 3, [&](const auto& index) { return nearest(on, index, points, of_odd); },
        [&](std::uint32_t id) { return odd(0, id); });
}

template <class Policy>
void check_lines(const Policy& on) {
    // Two stacks, of copies at each height.
    const auto cells = copies_of({{0, 0, 1, 4}, {0, 0, 2, 4}, {0, 0, 7, 4}, {8, 0, 3, 4}, {8, 0, 4, 4}}, 400, 9);
    const auto tree = make_bvh(on, marks_at(cells));
    std::vector<ray<float>> all;
    std::vector<std::uint32_t> expected;
    std::mt19937 random(10);
    for (int k = 0; k < 400; ++k) {
        const whole x = whole(random() % 13), y = whole(random() % 6), z = whole(random() % 8);
        const float side = 0.25f;  // within a tile, or beside all
        all.push_back({{static_cast<float>(x) + side, static_cast<float>(y) + side, static_cast<float>(z)}, {0, 0, 1}});
        std::uint32_t first = no_id;
        for (std::uint32_t i = 0; i < cells.size(); ++i) {
            const cell& c = cells[i];
            if (x < c.x || x >= c.x + c.wide || y >= c.wide || c.z < z) continue;
            if (first == no_id || c.z < cells[first].z) first = i;
        }
        expected.push_back(first);
    }
    const rays<float> lines(all);
    const auto check = [&](const auto& index) {
        const std::size_t asked = measured_by([&] {
            const auto found = to_host(raycast(on, index, lines));
            std::size_t wrong = 0, hits = 0;
            for (std::size_t k = 0; k < found.size(); ++k) wrong += found[k].id != expected[k], hits += found[k].id != no_id;
            CHECK(wrong == 0);
            CHECK(hits > 50);
        });
        CHECK(asked <= 60 * lines.size() + cells.size());
    };
    check(tree);
    check(wide(on, tree));
    check(make_bvh(on, marks_at(cells), {.builder = bvh_builder::sah}));
    check(posed(tree, rigid<float>{}));
    const std::vector bodies{posed(tree, rigid<float>{}), posed(tree, rigid<float>{})};
    check(bodies);
    const auto in_bodies = to_host(raycast(on, bodies, lines));
    for (const auto& hit : in_bodies) CHECK((hit.id == no_id || hit.body == 0));
    const auto odd = [](std::uint32_t, std::uint32_t id) { return id % 2 == 1; };
    const auto of_odd = to_host(raycast(on, tree, lines, raycast_options<decltype(odd)>{.filter = odd}));
    for (std::size_t k = 0; k < of_odd.size(); ++k) {
        if (expected[k] == no_id || of_odd[k].id == no_id) continue;
        CHECK(of_odd[k].id % 2 == 1);
        CHECK(of_odd[k].id >= expected[k]);
    }
}

}  // namespace abut::test

using namespace abut;

TEST_CASE("ties: the distance of copies") {
    test::check_all_pairs(serial{});
    test::check_all_pairs(openmp{1});
    test::check_all_pairs(openmp{3});
}

TEST_CASE("ties: the distance of entries of a list, and of bodies") {
    test::check_entries(serial{});
    test::check_entries(openmp{3});
}

TEST_CASE("ties: what trees keep of their copies") {
    test::check_kept(serial{});
    test::check_kept(openmp{3});
    // Threads that ask first at the same time.
    const auto set = test::marks_at(test::copies_of({{0, 0, 0}}, 3000, 33)), other = test::marks_at(test::copies_of({{0, 0, 5}}, 3000, 34));
    for (int k = 0; k < 20; ++k) {
        const auto a = make_bvh(serial{}, set), b = make_bvh(serial{}, other);
        std::atomic<int> right{0};
        std::vector<std::thread> all;
        for (int i = 0; i < 4; ++i) {
            all.emplace_back([&, i] {
                const auto found = i % 2 == 0 ? distance(serial{}, a, b) : distance(serial{}, b, a);
                right += found && found->a == 0 && found->b == 0 && found->distance == 5;
            });
        }
        for (auto& one : all) one.join();
        CHECK(right == 4);
    }
}

TEST_CASE("ties: the first of many that touch") {
    test::check_all_touching(serial{});
    test::check_all_touching(openmp{1});
    test::check_all_touching(openmp{3});
}

TEST_CASE("ties: the distance of so many copies that a wide walk has no room for all that waits") {
    const std::vector<test::cell> one(4000, {0, 0, 0}), other(4000, {3, 4, 12});
    test::check_pairs(serial{}, one, other, 4000, true);
    test::check_pairs(openmp{3}, one, other, 8000, true);
}

TEST_CASE("ties: the distance of parallel plates") {
    const auto a = test::plate(30, 0, 11), b = test::plate(30, 1, 12);
    for (const auto& on : {openmp{1}, openmp{3}}) {
        test::check_pairs(serial{}, a, b, 2000, false);
        test::check_pairs(on, a, b, 2000, false);
    }
    // Beside each other: the edges are near, and all of these equally.
    auto beside = test::plate(30, 0, 13);
    for (auto& c : beside) c.x += 70;
    test::check_pairs(serial{}, a, beside, 2000, false);
}

TEST_CASE("ties: the nearest of copies, one and several") {
    test::check_points(serial{});
    test::check_points(openmp{3});
}

TEST_CASE("ties: rays that meet copies") {
    test::check_lines(serial{});
    test::check_lines(openmp{3});
}

TEST_CASE("ties: points on many shapes, which are no copies") {
    // All triangles of a fan have the corner in common; so all are at distance 0 from it.
    std::vector<vec3<float>> vertices{{0, 0, 0}};
    std::vector<std::array<std::uint32_t, 3>> faces;
    const std::uint32_t n = 600;
    for (std::uint32_t k = 0; k < n; ++k) {
        const auto x = static_cast<float>(k % 37) - 18, y = static_cast<float>(k % 41) - 20;
        vertices.push_back({x, y, static_cast<float>(k % 3) + 1});
    }
    for (std::uint32_t k = 0; k < n; ++k) faces.push_back({0, 1 + k, 1 + (k + 1) % n});
    std::shuffle(faces.begin(), faces.end(), std::mt19937(14));
    const serial on;
    const auto tree = make_bvh(on, mesh<float>(vertices, faces));
    const std::vector<vec3<float>> points(200, vec3<float>{0, 0, 0});
    for (const auto& near : to_host(nearest(on, tree, points))) CHECK(near.id == 0);
    const auto few = to_host(nearest(on, wide(on, tree), points, 5));
    for (std::size_t k = 0; k < few.size(); ++k) CHECK(few[k].id == k % 5);
}
