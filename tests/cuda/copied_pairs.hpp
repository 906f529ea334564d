// SPDX-License-Identifier: MIT
#pragma once

// Pairs that the host makes, since their constructions need its lists or its long numbers. They are copied to where a policy
// works, and decided there by every stage, against what the host decides: that is right, as tests of the predicates compare
// it with oracles. The policy is a parameter, so that hosts can try what devices are to be asked.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/predicate/within.hpp>
#include <abut/shape/hull.hpp>

#include "support/catch.hpp"
#include "support/samples.hpp"

namespace abut::test {

/// A hull, as where its points are in a list that is copied too.
template <scalar T>
struct points_at {
    using scalar_type = T;
    std::uint32_t first, count;
};

/// The distance is for `within` alone.
template <class S, class U>
struct copied_pair {
    S s;
    U t;
    double distance;
};

template <class S, class T>
ABUT_HD S shape_over(const vec3<T>*, const S& s) {
    return s;
}
template <class T>
ABUT_HD hull<T> shape_over(const vec3<T>* points, const points_at<T>& s) {
    return {points + s.first, s.count};
}

/// What is asked of a pair.
struct asked_of_pair {
    bool filtered_says, exact_says, fast_says, resolve_says;
    verdict by_filter, late, by_limbs;

    /// Whether anything but `fast` contradicts this.
    [[nodiscard]] bool contradicts(bool truth) const {
        const verdict lie = to_verdict(!truth);
        return filtered_says != truth || exact_says != truth || resolve_says != truth || by_filter == lie || late == lie ||
               by_limbs == lie;
    }
};

/// The last stage is slow: all pairs that need it, and some that do not.
ABUT_HD inline bool last_is_asked(verdict by_limbs, std::size_t i) { return by_limbs == verdict::unknown || i % 16 == 0; }

/// The questions: stages in the order in which they are written, and the answer of all of them in the other order too.
///@{
struct whether_they_meet {
    template <class S, class U>
    static ABUT_HD asked_of_pair ask(const S& s, const U& t, double, std::size_t i) {
        if constexpr (decidable_pair<S, U>) {
            asked_of_pair said{intersects(s, t),       intersects<exact>(t, s), intersects<fast>(s, t), false,
                               decide<filtered>(s, t), verdict::unknown,        decide<exact>(s, t)};
            if constexpr (requires { decide_late<filtered>(s, t); }) said.late = decide_late<filtered>(s, t);
            said.resolve_says = last_is_asked(said.by_limbs, i) ? resolve(s, t) : said.exact_says;
            return said;
        } else {
            return ask(t, s, 0.0, i);
        }
    }
};
struct whether_they_are_within {
    template <class S, class U>
    static ABUT_HD asked_of_pair ask(const S& s, const U& t, double d, std::size_t i) {
        if constexpr (detail::within_as_given<S, U>) {
            asked_of_pair said{within(s, t, d),
                               within<exact>(t, s, d),
                               within<fast>(s, t, d),
                               false,
                               detail::decide_within<filtered>(s, t, d),
                               verdict::unknown,
                               detail::decide_within<exact>(s, t, d)};
            if constexpr (requires { detail::decide_within_late<filtered>(s, t, d); }) {
                said.late = detail::decide_within_late<filtered>(s, t, d);
            }
            said.resolve_says = last_is_asked(said.by_limbs, i) ? detail::resolve_within(s, t, d) : said.exact_says;
            return said;
        } else {
            return ask(t, s, d, i);
        }
    }
};
///@}

template <class Question, class T, class S, class U>
struct all_stages {
    const copied_pair<S, U>* pairs;
    const vec3<T>* points;
    asked_of_pair* said;

    ABUT_HD void operator()(std::size_t i) const {
        const copied_pair<S, U>& p = pairs[i];
        said[i] = Question::ask(shape_over(points, p.s), shape_over(points, p.t), p.distance, i);
    }
};

struct copied_counts {
    std::size_t pairs = 0, hits = 0, filter = 0;
    std::size_t wrong = 0, wrong_fast = 0, host_wrong = 0;
    std::size_t other_limbs = 0;  ///< integers that decide on one side alone

    copied_counts& operator+=(const copied_counts& o) {
        pairs += o.pairs, hits += o.hits, filter += o.filter, wrong += o.wrong, wrong_fast += o.wrong_fast;
        host_wrong += o.host_wrong, other_limbs += o.other_limbs;
        return *this;
    }
};

template <class Policy, class T>
execution::buffer_of<Policy, T> copied(const Policy& on, const std::vector<T>& values) {
    execution::buffer_of<Policy, T> there(on, values.size());
    upload(on, values.data(), values.size(), there.data());
    return there;
}

/// Pairs, of which hulls have their points in the list.
template <class Question, class T, class Policy, class S, class U>
copied_counts decide_copied(const Policy& on, const std::vector<copied_pair<S, U>>& pairs,
                            const std::vector<vec3<T>>& points = {}) {
    const std::size_t n = pairs.size();
    std::vector<asked_of_pair> here(n), there(n);
    for_each_index(openmp{}, n, all_stages<Question, T, S, U>{pairs.data(), points.data(), here.data()});
    const auto copied_pairs = copied(on, pairs);
    const auto copied_points = copied(on, points);
    execution::buffer_of<Policy, asked_of_pair> said(on, n);
    for_each_index(on, n, all_stages<Question, T, S, U>{copied_pairs.data(), copied_points.data(), said.data()});
    said.read(there.data());
    copied_counts sum;
    for (std::size_t i = 0; i < n; ++i) {
        const bool truth = here[i].exact_says;
        ++sum.pairs;
        sum.hits += truth;
        sum.filter += there[i].by_filter != verdict::unknown;
        sum.wrong += there[i].contradicts(truth);
        sum.wrong_fast += there[i].fast_says != truth;
        sum.host_wrong += here[i].contradicts(truth);
        sum.other_limbs += there[i].by_limbs != here[i].by_limbs;
    }
    return sum;
}

/// n pairs in as many threads as there are cores: make(i) is number i.
template <class Make>
auto make_pairs(std::size_t n, const Make& make) {
    std::vector<decltype(make(n))> made(n);
    in_threads<int>(n, [&](std::uint64_t first, std::uint64_t last, int&) {
        for (std::uint64_t i = first; i < last; ++i) made[i] = make(i);
    });
    return made;
}

template <class T>
void check_counts(const char* family, const copied_counts& sum) {
    const auto percent = [&sum](std::size_t k) { return 100.0 * static_cast<double>(k) / static_cast<double>(sum.pairs); };
    std::printf("%-24s %-6s n %zu, hits %5.1f %%, filter %5.1f %%, wrong %zu, integers that differ %zu, wrong of fast %zu\n",
                family, sizeof(T) == 4 ? "float" : "double", sum.pairs, percent(sum.hits), percent(sum.filter), sum.wrong,
                sum.other_limbs, sum.wrong_fast);
    std::fflush(stdout);
    INFO(family);
    CHECK(sum.pairs > 0);
    CHECK(sum.wrong == 0);
    CHECK(sum.host_wrong == 0);
    CHECK(sum.other_limbs == 0);
}

/// That at least this share of all hits, and misses.
inline void check_share(double least, const copied_counts& sum) {
    CHECK(is_share_above(least, sum.hits, sum.pairs));
    CHECK(is_share_above(least, sum.pairs - sum.hits, sum.pairs));
}

}  // namespace abut::test
