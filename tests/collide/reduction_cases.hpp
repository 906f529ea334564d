// SPDX-License-Identifier: MIT
#pragma once

// What `reduce_contacts` promises on every policy, by its definition.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <abut/abut.hpp>

#include "contact_cases.hpp"
#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace abut::test {

template <class T, class Policy>
result<contact<T>, space_of<Policy>> result_of(const Policy& on, const contact_list<T>& contacts) {
    execution::buffer_of<Policy, contact<T>> copy(on, contacts.size());
    upload(on, contacts.data(), contacts.size(), copy.data());
    synchronize(on);
    return result<contact<T>, space_of<Policy>>(std::move(copy));
}

/// Contacts all over a body; some are equal but for their ids.
template <class T>
contact_list<T> random_contacts(std::size_t n, double offset, double size, uniform& random) {
    contact_list<T> all;
    for (std::uint32_t i = 0; i < n; ++i) {
        auto where = random.point<double>(-1, 1), normal = random.point<double>(-1, 1);
        const double length = std::sqrt(dot(normal, normal));
        where = size * where;
        contact<T> c{i / 7, i, {}, {}, static_cast<T>(random())};
        c.point = {static_cast<T>(where.x + offset), static_cast<T>(where.y), static_cast<T>(where.z)};
        c.normal = {static_cast<T>(normal.x / length), static_cast<T>(normal.y / length), static_cast<T>(normal.z / length)};
        if (i % 5 == 4) {
            c.point = all[i - 3].point;
            c.normal = all[i - 3].normal;
        }
        all.push_back(c);
    }
    return all;
}

/// Positions in [-1, 1], and normals.
template <class T>
std::vector<std::array<double, 6>> in_six_dimensions(const contact_list<T>& all) {
    vec3<double> lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
    for (const auto& c : all) {
        lower = detail::least(lower, detail::widened(c.point));
        upper = detail::greatest(upper, detail::widened(c.point));
    }
    const vec3<double> middle = 0.5 * (lower + upper), side = upper - lower;
    const double half = std::max({side.x, side.y, side.z}) / 2;
    std::vector<std::array<double, 6>> points;
    for (const auto& c : all) {
        const vec3<double> p = (1 / (half > 0 ? half : 1)) * (detail::widened(c.point) - middle);
        points.push_back({p.x, p.y, p.z, double(c.normal.x), double(c.normal.y), double(c.normal.z)});
    }
    return points;
}

template <class T>
bool is_kept(const contact_list<T>& few, const contact<T>& c) {
    return std::find(few.begin(), few.end(), c) != few.end();
}

/// One contact for each cell that has any, and in its cell none is farther from the middle. Cells are found anew, so
/// contacts within rounding of a cell's border may count for either.
template <class T>
void check_cells(const contact_list<T>& all, const contact_list<T>& few, int bins) {
    const auto points = in_six_dimensions(all);
    const auto square = [](const std::array<double, 6>& x) {
        double sum = 0;
        for (const double v : x) sum += v * v;
        return sum;
    };
    std::map<std::array<int, 6>, std::pair<double, std::size_t>> cells;  // the farthest, and how many are kept
    const auto cell = [&](std::size_t i) {
        std::array<int, 6> at{};
        for (std::size_t k = 0; k < 6; ++k) at[k] = std::clamp(static_cast<int>((points[i][k] + 1) / 2 * bins), 0, bins - 1);
        return at;
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
        auto& c = cells[cell(i)];
        c.first = std::max(c.first, square(points[i]));
        if (is_kept(few, all[i])) ++c.second;
    }
    CHECK(few.size() == cells.size());
    for (const auto& [at, c] : cells) CHECK(c.second == 1);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (is_kept(few, all[i])) CHECK(square(points[i]) >= cells[cell(i)].first * (1 - 1e-12));
    }
}

/// In each direction the kept ones reach as far as all.
template <class T>
void check_extremes(const contact_list<T>& all, const contact_list<T>& few) {
    const auto points = in_six_dimensions(all);
    for (int j = 0; j < detail::contact_math::direction_count; ++j) {
        const auto d = detail::contact_math::wrench_direction(j);
        double reach = -1, kept = -1;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const vec3<double> p{points[i][0], points[i][1], points[i][2]}, n{points[i][3], points[i][4], points[i][5]};
            const double value = dot(n, d.force) + dot(cross(p, n), d.torque);
            reach = std::max(reach, value);
            if (is_kept(few, all[i])) kept = std::max(kept, value);
        }
        CHECK(std::max(kept, 0.0) >= std::max(reach, 0.0) - 1e-12);
    }
}

template <class T, class Policy>
void check_reduced(const Policy& on, const contact_list<T>& all, uniform& random) {
    CAPTURE(all.size());
    const auto here = result_of(on, all), other_order = result_of(on, shuffled(all, random));
    const auto reduced = [&](const auto& contacts, const reduce_options& options) {
        return to_host(reduce_contacts(on, contacts, options));
    };
    for (const auto method : {contact_reduction::binning, contact_reduction::extremes}) {
        for (const std::size_t most : {std::size_t{1}, std::size_t{4}, std::size_t{9}, std::size_t{32}, ~std::size_t{0}}) {
            for (const int bins : {1, 3, 8, 1024}) {
                if (bins != 8 && method == contact_reduction::extremes) continue;
                const reduce_options options{.bins = bins, .most = most, .method = method};
                const auto few = reduced(here, options);
                CAPTURE(most, bins);
                CHECK(few.size() >= 1);
                CHECK(few.size() <= std::min(most, all.size()));
                CHECK(same_bits(few, sorted(few)));
                for (const auto& c : few) CHECK(is_kept(all, c));
                CHECK(same_bits(reduced(other_order, options), few));
                const auto on_host = reduce_contacts(serial{}, result_of(serial{}, all), options);
                CHECK(same_bits(to_host(on_host), few));
                // One of contacts that differ in their ids alone is enough, and it is the first.
                for (const auto& c : few) {
                    if (c.b % 5 == 4)
                        CHECK_FALSE((c.b >= 4 && all[c.b - 3].point == c.point && all[c.b - 3].normal == c.normal));
                }
            }
        }
    }
    for (const int bins : {1, 2, 5}) {
        check_cells(all, reduced(here, {.bins = bins, .method = contact_reduction::binning}), bins);
    }
    check_extremes(all, reduced(here, {}));
    CHECK(same_bits(reduced(here, {}), reduced(here, {.method = contact_reduction::extremes})));
}

template <class T, class Policy>
void check_all_reductions(const Policy& on) {
    constexpr std::uint64_t seed = 20261131;
    std::printf("contact reduction: seed %llu\n", static_cast<unsigned long long>(seed));
    uniform random(seed);
    check_reduced(on, random_contacts<T>(1, 0, 1, random), random);
    check_reduced(on, random_contacts<T>(300, 0, 1, random), random);
    check_reduced(on, random_contacts<T>(1500, 3, 1e-3, random), random);
    check_reduced(on, random_contacts<T>(40, 0, sizeof(T) == 4 ? 1e-40 : 1e-305, random), random);
    check_reduced(on, random_contacts<T>(40, 0, sizeof(T) == 4 ? 3e38 : 8e299, random), random);
    check_reduced(on, random_contacts<T>(100, 1, 0, random), random);  // all in one place
    const auto none = result_of(on, contact_list<T>());
    CHECK(reduce_contacts(on, none).empty());
    CHECK(reduce_contacts(on, none, {.method = contact_reduction::binning}).empty());
    const auto one = result_of(on, random_contacts<T>(1, 0, 1, random));
    CHECK_THROWS_AS(reduce_contacts(on, one, {.bins = 0}), error);
    CHECK_THROWS_AS(reduce_contacts(on, one, {.bins = -3}), error);
    CHECK_THROWS_AS(reduce_contacts(on, one, {.bins = 1025}), error);
    CHECK_THROWS_AS(reduce_contacts(on, one, {.most = 0}), error);
    CHECK_THROWS_WITH(reduce_contacts(on, one, {.bins = 3}),
                      "abut::reduce_contacts: bins is 3, which is for binning; expected .method = "
                      "abut::contact_reduction::binning beside it");
    CHECK_THROWS_AS(reduce_contacts(on, none, {.bins = 0}), error);
}

}  // namespace abut::test
