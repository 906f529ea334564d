// SPDX-License-Identifier: MIT
#pragma once

// Whether a policy's kernels decide as they have to: small tables of pairs of each kind, with known answers. Included where
// ABUT_ALLOW_UNTESTED_NVCC is said, of which config.hpp tells: then the first call on a device asks this. It finds a
// compiler that gets the arithmetic wrong everywhere; it is no proof that all is right.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <type_traits>

#include <abut/arithmetic/self_test.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/error.hpp>
#include <abut/execution/generic.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/predicate/within.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/moving_shape.hpp>

namespace abut::detail {

inline constexpr std::size_t self_test_pairs = 64;

/// The numbers of pair k, small integers, so that many pairs just touch; in one of four ways, since each leaves the decision
/// to another stage: as they are, far from the origin, of very different size, and moved by very little.
template <scalar T>
class drawn_numbers {
public:
    ABUT_HD explicit constexpr drawn_numbers(std::size_t k)
        : state_(k * 0x9e3779b97f4a7c15u + 1), way_(static_cast<int>(k % 4)) {}

    ABUT_HD constexpr T coordinate() {
        const std::uint64_t bits = next();
        const T n = static_cast<T>(static_cast<int>(bits % 5) - 2);
        const auto pick = static_cast<int>(bits / 5 % 3);
        if (way_ == 1) return n + T(0x1p20);
        if (way_ == 2) return pick == 0 ? n : pick == 1 ? n * T(0x1p-30) : n * T(0x1p28);
        if (way_ == 3) return n + static_cast<T>(pick - 1) * T(0x1p-21);
        return n;
    }
    ABUT_HD constexpr T length() { return static_cast<T>(next() % 3 + 1) * T(0.5); }
    ABUT_HD constexpr vec3<T> point() {
        const T x = coordinate(), y = coordinate(), z = coordinate();
        return {x, y, z};
    }

private:
    /// Steele, Lea, Flood 2014: SplitMix64.
    ABUT_HD constexpr std::uint64_t next() {
        std::uint64_t x = state_ += 0x9e3779b97f4a7c15u;
        x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
        x = (x ^ x >> 27) * 0x94d049bb133111ebu;
        return (x ^ x >> 31) >> 8;
    }
    std::uint64_t state_;
    int way_;
};

template <class S>
struct drawn {
    using scalar_type = scalar_type_of<S>;
    S shape;

    ABUT_HD explicit constexpr drawn(drawn_numbers<scalar_type>& n) : shape{} {
        using T = scalar_type;
        if constexpr (std::same_as<S, vec3<T>>) {
            shape = n.point();
        } else if constexpr (std::same_as<S, triangle<T>>) {
            shape.a = n.point(), shape.b = n.point(), shape.c = n.point();
        } else if constexpr (std::same_as<S, segment<T>>) {
            shape.a = n.point(), shape.b = n.point();
        } else if constexpr (std::same_as<S, sphere<T>>) {
            shape.center = n.point(), shape.radius = n.length();
        } else if constexpr (std::same_as<S, aabb<T>>) {
            const vec3<T> p = n.point(), q = n.point();
            const auto less = [](T a, T b) { return a < b ? a : b; };
            const auto more = [](T a, T b) { return a < b ? b : a; };
            shape.lower = {less(p.x, q.x), less(p.y, q.y), less(p.z, q.z)};
            shape.upper = {more(p.x, q.x), more(p.y, q.y), more(p.z, q.z)};
        } else if constexpr (std::same_as<S, plane<T>>) {
            shape.normal = n.point(), shape.offset = n.coordinate();
        } else if constexpr (std::same_as<S, ray<T>>) {
            shape.origin = n.point(), shape.direction = n.point();
        } else if constexpr (std::same_as<S, cone<T>>) {
            shape.apex = n.point(), shape.base_center = n.point(), shape.radius = n.length();
        } else if constexpr (std::same_as<S, capsule<T>> || std::same_as<S, cylinder<T>>) {
            shape.axis.a = n.point(), shape.axis.b = n.point(), shape.radius = n.length();
        } else {  // in motion
            shape.t0 = drawn<decltype(S::t0)>(n).shape, shape.t1 = drawn<decltype(S::t1)>(n).shape;
        }
    }
};

/// A hull of four points, where they lie.
template <scalar T>
struct drawn<hull<T>> {
    vec3<T> points[4];
    hull<T> shape;
    ABUT_HD explicit constexpr drawn(drawn_numbers<T>& n)
        : points{n.point(), n.point(), n.point(), n.point()}, shape(points, 4) {}
    drawn(const drawn&) = delete;
    drawn& operator=(const drawn&) = delete;
};

/// How a query decides, as far as a kernel does, and then in integers alone.
struct meet_in_kernels {
    template <class S, class U>
    ABUT_HD static constexpr verdict by_query(const S& s, const U& t) {
        const verdict v = abut::decide<filtered>(s, t);
        return v == verdict::unknown ? decide_open<filtered>(s, t) : v;
    }
    template <class S, class U>
    ABUT_HD static constexpr verdict by_integers(const S& s, const U& t) {
        return abut::decide<exact>(s, t);
    }
};
struct near_in_kernels {
    static constexpr double distance = 0.5;
    template <class S, class U>
    ABUT_HD static constexpr verdict by_query(const S& s, const U& t) {
        const verdict v = decide_within<filtered>(s, t, distance);
        return v == verdict::unknown ? decide_within_open<filtered>(s, t, distance) : v;
    }
    template <class S, class U>
    ABUT_HD static constexpr verdict by_integers(const S& s, const U& t) {
        return decide_within<exact>(s, t, distance);
    }
};

/// Kernels have no integers for motion: they leave what is close to the host.
struct meet_in_motion {
    template <class S, class U>
    ABUT_HD static verdict by_query(const S& s, const U& t) {
        const time_in_motion<filtered> judge{};
        const verdict v = judge.decide(s, t);
        if (v == verdict::no) return v;
        const double time = judge.time(s, t);
        return time >= 0 ? verdict::yes : time == time_in_bits::none ? verdict::no : verdict::unknown;
    }
    template <class S, class U>
    ABUT_HD static verdict by_integers(const S& s, const U& t) {
        return by_query(s, t);
    }
};

/// Writes 0 for no, 1 for yes, 2 for what a kernel leaves to others, and the same of integers, times 4.
template <class Question, class S, class U>
struct decide_drawn {
    unsigned char* out;
    ABUT_HD void operator()(std::size_t k) const {
        drawn_numbers<scalar_type_of<S>> numbers(k);
        const drawn<S> s(numbers);
        const drawn<U> t(numbers);
        const auto code = [](verdict v) { return v == verdict::no ? 0 : v == verdict::yes ? 1 : 2; };
        out[k] = static_cast<unsigned char>(code(Question::by_query(s.shape, t.shape)) +
                                            4 * code(Question::by_integers(s.shape, t.shape)));
    }
};

struct report_arithmetic {
    unsigned char* out;
    ABUT_HD void operator()(std::size_t k) const { out[k] = self_test().passed() ? 0 : 1; }
};

/// A kind of pair, and which of the pairs touch: bit k for pair k.
template <class Question, class S, class U>
struct known_pairs {
    const char* name;
    std::uint64_t touch;
};

/// visit(known_pairs) for each kind.
template <class Visit>
void for_each_known(const Visit& visit) {
    using meet = meet_in_kernels;
    using near = near_in_kernels;
    using moving = meet_in_motion;
    using F = float;
    using D = double;
    visit(known_pairs<meet, triangle<F>, triangle<F>>{"triangle, triangle", 0x1e002390281fb022u});
    visit(known_pairs<meet, triangle<D>, triangle<D>>{"triangle, triangle, double", 0x1e002390281fb022u});
    visit(known_pairs<meet, segment<F>, triangle<F>>{"segment, triangle", 0x3000188100802500u});
    visit(known_pairs<meet, ray<F>, triangle<F>>{"ray, triangle", 0x1000088000800400u});
    visit(known_pairs<meet, sphere<F>, triangle<F>>{"sphere, triangle", 0x0040301900010222u});
    visit(known_pairs<meet, sphere<D>, triangle<D>>{"sphere, triangle, double", 0x0040301900010222u});
    visit(known_pairs<meet, sphere<F>, segment<F>>{"sphere, segment", 0x0040300900000220u});
    visit(known_pairs<meet, sphere<F>, sphere<F>>{"sphere, sphere", 0x80200009c0040030u});
    visit(known_pairs<meet, aabb<F>, triangle<F>>{"box, triangle", 0x700938e1b8bb3f08u});
    visit(known_pairs<meet, aabb<F>, segment<F>>{"box, segment", 0x700938e118381308u});
    visit(known_pairs<meet, aabb<F>, sphere<F>>{"box, sphere", 0x108c08013800130au});
    visit(known_pairs<meet, aabb<F>, aabb<F>>{"box, box", 0xf00b38e118bb17feu});
    visit(known_pairs<meet, capsule<F>, triangle<F>>{"capsule, triangle", 0x3e403bbfa0e33ba8u});
    visit(known_pairs<meet, capsule<F>, capsule<F>>{"capsule, capsule", 0x1bcc3bbbf1b3febau});
    visit(known_pairs<meet, cylinder<F>, triangle<F>>{"cylinder, triangle", 0x3e403bb720e33ba8u});
    visit(known_pairs<meet, cylinder<F>, sphere<F>>{"cylinder, sphere", 0x18400301b830020bu});
    visit(known_pairs<meet, cone<F>, triangle<F>>{"cone, triangle", 0x1c002ab720423188u});
    visit(known_pairs<meet, hull<F>, triangle<F>>{"hull, triangle", 0x03c0247a2b83bfacu});
    visit(known_pairs<meet, hull<F>, hull<F>>{"hull, hull", 0x23fe37ff6ff3ffbfu});
    visit(known_pairs<meet, plane<F>, triangle<F>>{"plane, triangle", 0x8c8ddddd919d9d9du});
    visit(known_pairs<near, triangle<F>, triangle<F>>{"triangle within a distance of a triangle", 0x3e4323bc789fffa3u});
    visit(known_pairs<near, sphere<F>, triangle<F>>{"sphere within a distance of a triangle", 0x1040391940150236u});
    visit(known_pairs<moving, motion<vec3<F>>, motion<triangle<F>>>{"point and triangle in motion", 0x0000000128880500u});
    visit(known_pairs<moving, motion<segment<F>>, motion<segment<F>>>{"edges in motion", 0x0200022006a0381au});
}

/// Which pairs are decided otherwise than they have to be, or not at all although they could be: bit k for pair k.
template <class Policy, class Question, class S, class U>
std::uint64_t wrong_of(const Policy& on, const known_pairs<Question, S, U>& known) {
    execution::buffer_of<Policy, unsigned char> there(on, self_test_pairs);
    for_each_index(on, self_test_pairs, decide_drawn<Question, S, U>{there.data()});
    unsigned char here[self_test_pairs];
    download(on, there.data(), self_test_pairs, here);
    std::uint64_t wrong = 0;
    for (std::size_t k = 0; k < self_test_pairs; ++k) {
        const unsigned right = known.touch >> k & 1u;
        for (const unsigned said : {here[k] % 4u, here[k] / 4u}) {
            if (said != right && !(said == 2 && std::same_as<Question, meet_in_motion>)) wrong |= std::uint64_t{1} << k;
        }
    }
    return wrong;
}

/// Throws abut::error where the policy's kernels decide any of the known pairs wrongly. Waits.
template <class Policy>
void require_right_decisions(const Policy& on, const char* function) {
    const char* const advice =
        ": this compiler or device is not to be trusted with exact answers (ABUT_ALLOW_UNTESTED_NVCC)";
    execution::buffer_of<Policy, unsigned char> there(on, 1);
    for_each_index(on, 1, report_arithmetic{there.data()});
    unsigned char bad = 0;
    download(on, there.data(), 1, &bad);
    if (bad != 0)
        throw error(std::string(function) + ": self-test: arithmetic is not IEEE's, or not kept as it is written" + advice);
    for_each_known([&](const auto& known) {
        const std::uint64_t wrong = wrong_of(on, known);
        if (wrong == 0) return;
        int count = 0;
        for (std::uint64_t left = wrong; left != 0; left &= left - 1) ++count;
        throw error(std::string(function) + ": self-test: wrong for " + std::to_string(count) + " of " +
                    std::to_string(self_test_pairs) + " pairs (" + known.name + ")" + advice);
    });
}

}  // namespace abut::detail

namespace abut::execution::detail {

/// At the first call on a device in a process; where it throws, at the next one again. The calls that it makes itself pass.
template <class Policy>
void require_right_decisions_once(const Policy& on, int device) {
    static std::recursive_mutex mutex;
    static std::set<int> begun;
    const std::scoped_lock lock(mutex);
    if (!begun.insert(device).second) return;
    try {
        abut::detail::require_right_decisions(on, "abut::cuda");
    } catch (...) {
        begun.erase(device);
        throw;
    }
}

}  // namespace abut::execution::detail
