// SPDX-License-Identifier: MIT
//
// The impacts of all parts are those of the mesh that is all parts one after another, bit for bit.

#include <abut/mpi.hpp>
#include <abut/experimental/pair_rules.hpp>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "distributed/world.hpp"

namespace abut::test {

namespace {

/// A mesh at two times.
template <scalar T>
struct frames {
    std::vector<vec3<T>> at_t0, at_t1;
    std::vector<face> faces;

    [[nodiscard]] moving_set<mesh<T, host_space>> set() const {
        const mesh<T> t0(at_t0, faces);
        return moving(t0, t0.with_vertices(serial{}, at_t1));
    }
    void add(const frames& other) {
        const auto first = static_cast<std::uint32_t>(at_t0.size());
        at_t0.insert(at_t0.end(), other.at_t0.begin(), other.at_t0.end());
        at_t1.insert(at_t1.end(), other.at_t1.begin(), other.at_t1.end());
        for (const face& f : other.faces) faces.push_back({f[0] + first, f[1] + first, f[2] + first});
    }
};

/// A sheet of n x n squares at a height, with uneven corners on a lattice, that moves by `way`; and some vertices that no
/// face has.
template <scalar T>
frames<T> make_sheet(std::uint32_t n, T height, T way, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> jitter(-3, 3);
    frames<T> sheet;
    const auto off = [&] { return static_cast<T>(jitter(random)) / 8; };
    for (std::uint32_t i = 0; i <= n; ++i) {
        for (std::uint32_t j = 0; j <= n; ++j) {
            const T x = static_cast<T>(i) + off(), y = static_cast<T>(j) + off(), z = height + off();
            sheet.at_t0.push_back({x, y, z});
            sheet.at_t1.push_back({x + off(), y + off(), z + way + off()});
        }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t v = i * (n + 1) + j;
            sheet.faces.push_back({v, v + 1, v + n + 1});
            sheet.faces.push_back({v + 1, v + n + 2, v + n + 1});
        }
    }
    for (int k = 0; k < 20; ++k) {
        const T x = static_cast<T>(k % 5), y = static_cast<T>(k / 5);
        sheet.at_t0.push_back({x, y, height});
        sheet.at_t1.push_back({x, y, height + 2 * way});
    }
    return sheet;
}

/// The part of some faces, with their vertices in the order of the whole; the last part also has those of no face.
template <scalar T>
frames<T> part_of_frames(const frames<T>& all, division how, int rank, int ranks) {
    const auto faces = part_of(all.faces, how, rank, ranks);
    std::vector<std::uint32_t> number(all.at_t0.size(), no_id);
    for (const face& f : faces) {
        for (const std::uint32_t v : f) number[v] = 0;
    }
    frames<T> part;
    const std::size_t loose = all.at_t0.size() - 20;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] == no_id && !(v >= loose && rank == ranks - 1)) continue;
        number[v] = static_cast<std::uint32_t>(part.at_t0.size());
        part.at_t0.push_back(all.at_t0[v]);
        part.at_t1.push_back(all.at_t1[v]);
    }
    for (const face& f : faces) part.faces.push_back({number[f[0]], number[f[1]], number[f[2]]});
    return part;
}

template <scalar T>
frames<T> joined_parts(const frames<T>& all, division how, int ranks) {
    frames<T> whole;
    for (int rank = 0; rank < ranks; ++rank) whole.add(part_of_frames(all, how, rank, ranks));
    return whole;
}

template <motion_arithmetic A, class Local, class X, class Y, class WholeX, class WholeY>
void check_impacts(const distributed<Local>& on, const X& x, const Y& y, const WholeX& whole_x, const WholeY& whole_y,
                   const impact_options& options = {}) {
    using T = typename X::scalar_type;
    std::vector<global_impact<T>> expected;
    for (const auto& i : impacts<A>(serial{}, whole_x, whole_y, options).to_host()) {
        expected.push_back({i.kind, {i.vertices[0], i.vertices[1], i.vertices[2], i.vertices[3]}, i.time});
    }
    CHECK(expected.size() > 100);
    const auto mine = impacts<A>(on, x, y, options).to_host();
    const auto by_kind = [](const auto& a, const auto& b) { return a.kind < b.kind; };
    CHECK(on_all(on.ranks(), std::is_sorted(mine.begin(), mine.end(), by_kind)));
    auto found = lists_of_all(on.ranks(), mine);
    std::stable_sort(found.begin(), found.end(), by_kind);
    CHECK(found == expected);
}

template <class Local, scalar T>
void check_sheets(const distributed<Local>& on, division how_x, division how_y) {
    CAPTURE(static_cast<int>(how_x), static_cast<int>(how_y), on.size());
    const auto all_x = make_sheet<T>(12, T(0), T(1), 1), all_y = make_sheet<T>(10, T(2), T(-1), 2);
    const auto x = part_of_frames(all_x, how_x, on.rank(), on.size()).set();
    const auto y = part_of_frames(all_y, how_y, on.rank(), on.size()).set();
    const auto whole_x = joined_parts(all_x, how_x, on.size()).set(), whole_y = joined_parts(all_y, how_y, on.size()).set();
    check_impacts<filtered>(on, x, y, whole_x, whole_y);
    check_impacts<conservative>(on, x, y, whole_x, whole_y, {.bounds = {.separation = 0.125}});
    check_impacts<filtered>(on, make_impact_index(on.local(), x), y, whole_x, whole_y);
    check_impacts<filtered>(on, x.t1(), make_impact_index(on.local(), y), whole_x.t1(), whole_y);
}

}  // namespace

TEST_CASE("distributed: impacts of all parts") {
    for (const division how : divisions) check_sheets<serial, float>(distributed(world(), serial{}), how, division::even);
    check_sheets<openmp, double>(distributed(world(), openmp{2}), division::even, division::uneven);
}

TEST_CASE("distributed: impacts of what only comes near") {
    const distributed on(world(), serial{});
    const auto all_x = make_sheet<float>(12, 0, 0, 6), all_y = make_sheet<float>(10, 2, 0, 7);
    const auto x = part_of_frames(all_x, division::even, on.rank(), on.size()).set();
    const auto y = part_of_frames(all_y, division::even, on.rank(), on.size()).set();
    const auto whole_x = joined_parts(all_x, division::even, on.size()).set();
    const auto whole_y = joined_parts(all_y, division::even, on.size()).set();
    CHECK(impacts(serial{}, whole_x, whole_y).empty());
    check_impacts<conservative>(on, x, y, whole_x, whole_y, {.bounds = {.separation = 1.75}});
}

TEST_CASE("distributed: impacts by a rule of faces") {
    const distributed on(world(), serial{});
    const auto all_x = make_sheet<float>(12, 0, 1, 3), all_y = make_sheet<float>(10, 2, -1, 4);
    const auto x = part_of_frames(all_x, division::even, on.rank(), on.size()).set();
    const auto y = part_of_frames(all_y, division::even, on.rank(), on.size()).set();
    const auto whole_x = joined_parts(all_x, division::even, on.size()).set();
    const auto whole_y = joined_parts(all_y, division::even, on.size()).set();
    constexpr pair_rule rule = pair_rule::representative_triangles;
    check_impacts<filtered>(on, make_impact_index<rule>(on.local(), x), y, make_impact_index<rule>(serial{}, whole_x),
                            whole_y);
}

TEST_CASE("distributed: impacts of a mesh with itself, and what comes first") {
    const distributed on(world(), openmp{2});
    const auto global = [](const auto& i) {
        return global_impact<float>{i.kind, {i.vertices[0], i.vertices[1], i.vertices[2], i.vertices[3]}, i.time};
    };
    for (const division how : divisions) {
        CAPTURE(static_cast<int>(how), on.size());
        auto all = make_sheet<float>(8, 0, 1, 8);
        all.add(make_sheet<float>(8, 2, -1, 9));
        const auto x = part_of_frames(all, how, on.rank(), on.size()).set();
        const auto whole = joined_parts(all, how, on.size()).set();
        std::vector<global_impact<float>> expected;
        for (const auto& i : self_impacts(serial{}, whole).to_host()) expected.push_back(global(i));
        CHECK(expected.size() > 100);
        const auto by_kind = [](const auto& a, const auto& b) { return a.kind < b.kind; };
        for (const bool indexed : {false, true}) {
            const auto mine =
                indexed ? self_impacts(on, make_impact_index(on.local(), x)).to_host() : self_impacts(on, x).to_host();
            auto found = lists_of_all(on.ranks(), mine);
            std::stable_sort(found.begin(), found.end(), by_kind);
            CHECK(found == expected);
        }
        const auto first = first_self_impact(serial{}, whole);
        REQUIRE(first.has_value());
        CHECK(first_self_impact(on, x) == global(*first));
        CHECK(first_self_impact<exact>(on, x) == global(*first));

        const auto all_y = make_sheet<float>(6, 1, 0, 10);
        const auto y = part_of_frames(all_y, division::even, on.rank(), on.size()).set();
        const auto whole_y = joined_parts(all_y, division::even, on.size()).set();
        const auto between = first_impact(serial{}, whole, whole_y);
        REQUIRE(between.has_value());
        CHECK(first_impact(on, x, y) == global(*between));
        CHECK(safe_step(on, x, y) == safe_step(serial{}, whole, whole_y));
    }
    const auto far = make_sheet<float>(4, 50, 1, 11), near = make_sheet<float>(4, 0, 1, 12);
    const auto x = part_of_frames(near, division::even, on.rank(), on.size()).set();
    const auto y = part_of_frames(far, division::even, on.rank(), on.size()).set();
    CHECK(!first_impact(on, x, y).has_value());
}

TEST_CASE("distributed: the first of impacts at one time is that of one machine") {
    // Equal steps from a lattice onto one plane: whatever meets, meets at half the step.
    const distributed on(world(), serial{});
    frames<float> sheet, floor;
    for (std::uint32_t i = 0; i < 30; ++i) {
        const auto add = [&](frames<float>& to, float z, float way) {
            const auto v = static_cast<std::uint32_t>(to.at_t0.size());
            const auto x = static_cast<float>(3 * (i % 6)), y = static_cast<float>(3 * (i / 6));
            for (const vec3<float> p : {vec3<float>{x, y, z}, vec3<float>{x + 2, y, z}, vec3<float>{x, y + 2, z}}) {
                to.at_t0.push_back(p);
                to.at_t1.push_back({p.x, p.y, p.z + way});
            }
            to.faces.push_back({v, v + 1, v + 2});
        };
        add(sheet, 1, -2);
        add(floor, 0, 0);
    }
    for (int k = 0; k < 20; ++k) {  // which no face has, as make_sheet ends
        for (frames<float>* all : {&sheet, &floor}) all->at_t0.push_back({0, 0, 900}), all->at_t1.push_back({0, 0, 900});
    }
    for (const division how : divisions) {
        for (const division other : divisions) {
            const auto x = part_of_frames(sheet, how, on.rank(), on.size()).set();
            const auto y = part_of_frames(floor, other, on.rank(), on.size()).set();
            const auto expected = first_impact(serial{}, joined_parts(sheet, how, on.size()).set(),
                                               joined_parts(floor, other, on.size()).set());
            const auto found = first_impact(on, x, y);
            REQUIRE((expected.has_value() && found.has_value()));
            CHECK(found->time == expected->time);
            CHECK(found->kind == expected->kind);
            for (std::size_t k = 0; k < 4; ++k) CHECK(found->vertices[k] == expected->vertices[k]);
        }
    }
}

TEST_CASE("distributed: impacts where a rank fails, and then again") {
    const distributed on(world(), serial{});
    const auto all = make_sheet<float>(6, 0, 1, 5);
    const auto x = part_of_frames(all, division::even, on.rank(), on.size()).set();
    const int bad = on.size() - 1;
    impact_options options;
    if (on.rank() == bad) options.bounds.separation = -1;
    int thrown = 0;
    try {
        (void)impacts<conservative>(on, x, x, options);
    } catch (const distributed_error& e) {
        thrown = e.rank() == bad ? 2 : 3;
    } catch (const error&) {
        thrown = 1;
    }
    CHECK(on_all(on.ranks(), thrown == (on.rank() == bad ? 1 : 2)));
    const auto whole = joined_parts(all, division::even, on.size()).set();
    check_impacts<filtered>(on, x, x, whole, whole);
}

}  // namespace abut::test
