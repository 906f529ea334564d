// SPDX-License-Identifier: MIT
#pragma once

// Pairs of shapes that the host makes are measured where a policy works, and by the host: distances, points and contacts have
// the same bits.

#include <cstddef>
#include <cstring>
#include <vector>

#include <abut/abut.hpp>

#include "cuda/copied_pairs.hpp"
#include "support/catch.hpp"

namespace abut::test {

template <class S, class U>
struct measure_pairs {
    using T = scalar_type_of<S>;
    const copied_pair<S, U>* pairs;
    separation<T>* apart;
    contact<T>* how;
    ABUT_HD void operator()(std::size_t i) const {
        apart[i] = distance(pairs[i].s, pairs[i].t);
        const auto found = contact_of(pairs[i].s, pairs[i].t);
        how[i] = found ? *found : contact<T>{};
    }
};

/// Some of them touch, and some do not.
template <class S, class U, class Policy>
void check_same_measures(const Policy& on, const std::vector<copied_pair<S, U>>& pairs) {
    using T = scalar_type_of<S>;
    const std::size_t n = pairs.size();
    std::vector<separation<T>> here(n), there(n);
    std::vector<contact<T>> how_here(n), how_there(n);
    for_each_index(openmp{}, n, measure_pairs<S, U>{pairs.data(), here.data(), how_here.data()});
    const auto copies = copied(on, pairs);
    execution::buffer_of<Policy, separation<T>> apart(on, n);
    execution::buffer_of<Policy, contact<T>> how(on, n);
    for_each_index(on, n, measure_pairs<S, U>{copies.data(), apart.data(), how.data()});
    apart.read(there.data());
    how.read(how_there.data());
    std::size_t unlike = 0, touching = 0;
    for (std::size_t i = 0; i < n; ++i) {
        unlike += std::memcmp(&here[i], &there[i], sizeof here[i]) != 0;
        unlike += std::memcmp(&how_here[i], &how_there[i], sizeof how_here[i]) != 0;
        touching += here[i].distance == 0;
    }
    CHECK(unlike == 0);
    CHECK(touching > n / 50);
    CHECK(touching < n);
}

}  // namespace abut::test
