// SPDX-License-Identifier: MIT

#include <abut/collide/mixed_list.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <abut/abut.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

// Lists whose entries are of several kinds say of each entry what loops over its placed shapes say, and what the two indices alone
// are told of.

namespace abut::test {

/// How many pairs of an entry's shapes touch, by the exact predicate alone; those of them that `wants(a, b)`.
template <class Pair, class Wants>
std::uint64_t touching_in(const Pair& entry, const Wants& wants) {
    const auto a = entry.a.object.set().view();
    const auto b = entry.b.object.set().view();
    std::uint64_t n = 0;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = 0; j < b.size(); ++j) {
            n += wants(i, j) && intersects<exact>(place(entry.a.pose, a[i]), place(entry.b.pose, b[j]));
        }
    }
    return n;
}

template <class Policy, scalar T>
void check_mixed_list(const Policy& on) {
    uniform random(41);
    const auto at = [&] { return vec3<T>{T(2 * random() - 1), T(2 * random() - 1), T(2 * random() - 1)}; };
    std::vector<sphere<T>> balls;
    std::vector<aabb<T>> crates;
    std::vector<capsule<T>> pills;
    std::vector<vec3<T>> corners;
    std::vector<face> faces;
    for (std::uint32_t k = 0; k < 40; ++k) {
        balls.push_back({at(), T(0.1) + T(0.1 * random())});
        const vec3<T> p = at(), q = at();
        crates.push_back({p, p + vec3<T>{T(0.2), T(0.3), T(0.1)}});
        pills.push_back({{q, q + T(0.3) * at()}, T(0.05)});
        for (int c = 0; c < 3; ++c) corners.push_back(p + T(0.5) * at());
        faces.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    }
    const auto of_balls = make_bvh(on, spheres<T>(balls));
    const auto of_crates = make_bvh(on, boxes<T>(crates));
    const auto of_pills = make_bvh(on, capsules<T>(pills));
    const auto of_faces = make_bvh(on, mesh<T>(corners, faces));
    using ball_tree = std::remove_const_t<decltype(of_balls)>;
    using crate_tree = std::remove_const_t<decltype(of_crates)>;
    using pill_tree = std::remove_const_t<decltype(of_pills)>;
    using face_tree = std::remove_const_t<decltype(of_faces)>;
    using entry = std::variant<posed_pair<ball_tree, face_tree>, posed_pair<crate_tree, face_tree>, posed_pair<face_tree>,
                               posed_pair<pill_tree, ball_tree>, posed_pair<face_tree>>;
    const auto pose = [&] {
        rigid<T> p;
        p.translation = T(1.5) * at();
        return p;
    };
    std::vector<entry> list;
    for (int k = 0; k < 60; ++k) {
        switch (random.below(4)) {  // nothing is of the last kind but for one
            case 0: list.emplace_back(std::in_place_index<0>, std::variant_alternative_t<0, entry>{posed(of_balls, pose()), posed(of_faces, pose())}); break;
            case 1: list.emplace_back(std::in_place_index<1>, std::variant_alternative_t<1, entry>{posed(of_crates, pose()), posed(of_faces, pose())}); break;
            case 2: list.emplace_back(std::in_place_index<2>, std::variant_alternative_t<2, entry>{posed(of_faces, pose()), posed(of_faces, pose())}); break;
            default: list.emplace_back(std::in_place_index<3>, std::variant_alternative_t<3, entry>{posed(of_pills, pose()), posed(of_balls, pose())}); break;
        }
    }
    list.emplace_back(std::in_place_index<4>, std::variant_alternative_t<4, entry>{posed(of_faces, pose()), posed(of_faces, pose())});

    const auto odd = [](const tagged_pair& of) { return (of.pair + of.a + of.b) % 2 == 1; };
    const list_options<decltype(odd)> of_odd{.filter = odd};
    const auto touch = to_host(any_each(on, list)), touch_odd = to_host(any_each(on, list, of_odd));
    const auto counts = to_host(count_each(on, list)), counts_odd = to_host(count_each(on, list, of_odd));
    const auto near = to_host(any_within_each(on, list, 0.25));
    const auto apart = to_host(distance(on, list));
    REQUIRE(touch.size() == list.size());
    REQUIRE(apart.size() == list.size());
    std::size_t wrong = 0, touching = 0, close = 0;
    for (std::uint32_t i = 0; i < list.size(); ++i) {
        std::visit(
            [&](const auto& of) {
                const auto n = touching_in(of, [](std::uint32_t, std::uint32_t) { return true; });
                const auto n_odd = touching_in(of, [&](std::uint32_t a, std::uint32_t b) { return odd({i, a, b}); });
                wrong += counts[i] != n || counts_odd[i] != n_odd || touch[i] != (n > 0) || touch_odd[i] != (n_odd > 0);
                const auto alone = distance(on, of.a, of.b);
                wrong += !alone || !(apart[i] == *alone) || (apart[i].distance == 0) != (n > 0);
                wrong += near[i] != any_within(on, of.a, of.b, 0.25);
                touching += n > 0;
                close += near[i] != 0;
            },
            list[i]);
    }
    CHECK(wrong == 0);
    CHECK(touching > 10);
    CHECK(touching < close);
    CHECK(close < list.size());

    CHECK(any_each(on, std::vector<entry>()).size() == 0);
    // Errors have the places of the whole list.
    std::get<4>(list.back()).b.pose.rotation[0] = 2;
    std::string message;
    try {
        (void)any_each(on, list);
    } catch (const invalid_geometry& e) {
        message = e.what();
    }
    CHECK(message.find("entry 60 of the list") != std::string::npos);
}

}  // namespace abut::test

TEST_CASE("mixed_list: entries of several kinds") {
    abut::test::check_mixed_list<abut::serial, float>(abut::serial{});
    abut::test::check_mixed_list<abut::serial, double>(abut::serial{});
    abut::test::check_mixed_list<abut::openmp, float>(abut::openmp{3});
}
