// SPDX-License-Identifier: MIT
#pragma once

// A relation that the library does not have, as one file beside its predicate: two triangles touch, and look in opposite
// directions. It is then asked of two sets, of one, of lists and of bodies, on every executor (collide/question.hpp).
// Coordinates of the scene are small numbers of eighths, so that plain arithmetic is exact.

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <abut/abut.hpp>

namespace abut::test {

template <scalar T>
ABUT_HD bool look_opposite(const triangle<T>& s, const triangle<T>& t) {
    return dot(cross(s.b - s.a, s.c - s.a), cross(t.b - t.a, t.c - t.a)) < 0;
}

/// Decides it: `touch`, and the directions.
template <arithmetic A>
struct touch_opposite : detail::touch<A> {
    template <class S, class U>
    ABUT_HD verdict decide(const S& s, const U& t) const {
        return look_opposite(s, t) ? detail::touch<A>::decide(s, t) : verdict::no;
    }
    template <class S, class U>
    ABUT_HD verdict finish(const S& s, const U& t) const {
        return look_opposite(s, t) ? detail::touch<A>::finish(s, t) : verdict::no;
    }
    template <class S, class U>
    bool resolve(const S& s, const U& t) const {
        return look_opposite(s, t) && detail::touch<A>::resolve(s, t);
    }
};
struct touching_opposite : detail::relation {
    template <arithmetic A>
    [[nodiscard]] touch_opposite<A> judge() const {
        return {};
    }
    template <class S, class U>
    static consteval bool decides() {
        return std::same_as<S, triangle<scalar_type_of<S>>> && std::same_as<S, U>;
    }
};

// Its fronts.

template <arithmetic A = filtered, executor On, class X, class Y>
    requires(!detail::scene<X>)
auto opposite_pairs(const On& on, const X& a, const Y& b) {
    return ask_pairs(on, detail::ask_for<A>(touching_opposite{}, detail::all_pairs{}), detail::two{a, b}, query_options<>{},
                     "opposite_pairs");
}
template <arithmetic A = filtered, executor On, detail::scene Scene>
auto opposite_pairs(const On& on, const Scene& scene) {
    return ask_pairs(on, detail::ask_for<A>(touching_opposite{}, detail::all_pairs{}), detail::whole(scene),
                     detail::default_options<Scene>{}, "opposite_pairs");
}
template <arithmetic A = filtered, executor On, class X>
auto opposite_self_pairs(const On& on, const X& x) {
    return ask_pairs(on, detail::ask_for<A>(touching_opposite{}, detail::all_pairs{}), detail::alone{x}, query_options<>{},
                     "opposite_self_pairs");
}
template <arithmetic A = filtered, executor On, class X, class Y>
    requires(!detail::scene<X>)
auto count_opposite(const On& on, const X& a, const Y& b) {
    return ask_pairs(on, detail::ask_for<A>(touching_opposite{}, detail::how_many{}), detail::two{a, b}, query_options<>{},
                     "count_opposite");
}

/// Triangles in a box of 4 by 3 by 3.
inline std::vector<triangle<float>> lattice_triangles(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> place(0, 24), side(-6, 6);
    std::vector<triangle<float>> all;
    while (all.size() < n) {
        const auto at = [](int x, int y, int z) {
            return vec3<float>{static_cast<float>(x) / 8, static_cast<float>(y) / 8, static_cast<float>(z) / 8};
        };
        const int x = place(random), y = place(random), z = place(random);
        all.push_back({at(x, y, z), at(x + side(random), y + side(random), z + side(random)),
                       at(x + side(random), y + side(random), z + side(random))});
    }
    return all;
}
/// By the definition: every pair, decided by integers of any length.
inline std::vector<index_pair> opposite_by_definition(const std::vector<triangle<float>>& a,
                                                      const std::vector<triangle<float>>& b, bool one_set = false) {
    std::vector<index_pair> found;
    for (std::uint32_t i = 0; i < a.size(); ++i) {
        for (std::uint32_t j = one_set ? i + 1 : 0; j < b.size(); ++j) {
            if (look_opposite(a[i], b[j]) && resolve(a[i], b[j])) found.push_back({i, j});
        }
    }
    return found;
}

}  // namespace abut::test
