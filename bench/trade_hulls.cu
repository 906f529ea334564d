// SPDX-License-Identifier: MIT
//
// usage: bench_trade_hulls_cuda [OUT.json]
//
// The pairs of bench/trade.cpp with a hull on CUDA, 262,144 of each, one a thread, by a plain kernel that calls
// `intersects`. The host makes them, and the device has all their points in one list. Truth and counters are those of
// bench/trade_cuda.hpp.

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "../tests/support/samples.hpp"
#include "trade_cuda.hpp"
#include "trade_hulls.hpp"

namespace {

using abut::test::point_list;

/// A hull, by where its points are in the list.
struct points_at {
    std::uint32_t first, count;
};

template <abut::scalar T>
ABUT_HD abut::hull<T> seen(const abut::vec3<T>* points, const points_at& s) {
    return {points + s.first, s.count};
}
template <abut::scalar T, class U>
ABUT_HD const U& seen(const abut::vec3<T>*, const U& t) {
    return t;
}

template <abut::arithmetic A, abut::scalar T, class U>
struct decide_hull_pair {
    const trade::pair<points_at, U>* pairs;
    const abut::vec3<T>* points;
    std::uint8_t* touches;
    ABUT_HD void operator()(std::size_t i) const {
        touches[i] = static_cast<std::uint8_t>(abut::intersects<A>(seen(points, pairs[i].s), seen(points, pairs[i].t)));
    }
};

template <class T>
auto copied(const abut::cuda& on, const std::vector<T>& values) {
    abut::execution::buffer_of<abut::cuda, T> there(on, values.size());
    upload(on, values.data(), values.size(), there.data());
    return there;
}

template <class Predicate, abut::scalar T>
void add_hulls(const abut::cuda& on, bench::table& out, trade::input in) {
    constexpr std::size_t count = std::size_t{1} << 18;
    using made_type = decltype(Predicate::template make<T>(in, 0));
    using other_type = decltype(made_type::t);
    constexpr bool are_hulls = std::is_same_v<other_type, point_list<T>>;
    using kept_type = std::conditional_t<are_hulls, points_at, other_type>;
    std::vector<made_type> made(count);
    abut::test::in_threads<int>(count, [&](std::uint64_t first, std::uint64_t last, int&) {
        for (std::uint64_t i = first; i < last; ++i) made[i] = Predicate::template make<T>(in, i);
    });

    std::vector<abut::vec3<T>> points;
    std::vector<trade::pair<points_at, kept_type>> listed;
    const auto append = [&points](const point_list<T>& of_hull) {
        const points_at at{static_cast<std::uint32_t>(points.size()), static_cast<std::uint32_t>(of_hull.size())};
        points.insert(points.end(), of_hull.begin(), of_hull.end());
        return at;
    };
    for (const made_type& p : made) {
        const points_at s = append(p.s);
        if constexpr (are_hulls) {
            listed.push_back({s, append(p.t)});
        } else {
            listed.push_back({s, p.t});
        }
    }
    std::vector<bool> truth;
    for (std::size_t i = 0; i < trade::truth_count; ++i) {
        truth.push_back(abut::intersects<abut::exact>(seen(points.data(), listed[i].s), seen(points.data(), listed[i].t)));
    }

    const auto all_points = copied(on, points);
    const auto pairs = copied(on, listed);
    abut::execution::buffer_of<abut::cuda, std::uint8_t> touches(on, count);
    const auto note = [&]<abut::arithmetic A>(A) {
        using trade::arithmetic_name, trade::scalar_name;
        const auto name = bench::joined({Predicate::name, trade::name_of(in), scalar_name<T>, arithmetic_name<A>});
        trade::add_row(on, out, name, count, truth, touches,
                       decide_hull_pair<A, T, kept_type>{pairs.data(), all_points.data(), touches.data()});
    };
    note(abut::fast{});
    note(abut::filtered{});
    note(abut::exact{});
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_trade_hulls_cuda", argc, argv, [](const abut::cuda& on, bench::table& out) {
        trade::for_each_hull_predicate([&]<class Predicate>(Predicate) {
            for (const trade::input in : trade::inputs) {
                add_hulls<Predicate, float>(on, out, in);
                add_hulls<Predicate, double>(on, out, in);
            }
        });
    });
}
