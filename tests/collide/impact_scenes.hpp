// SPDX-License-Identifier: MIT
#pragma once

// Frames of real simulations (shared/data/ccd, or ABUT_DATA), and what is known of them: each pair of features that touches,
// with its time. Where they are not there, tests skip.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include <abut/abut.hpp>

#include "collide/impact_cases.hpp"
#include "support/catch.hpp"
#include "support/ccd_scene.hpp"

namespace abut::test {

template <class T>
std::vector<vec3<T>> as(const std::vector<vec3<double>>& points) {
    std::vector<vec3<T>> r;
    for (const auto& p : points) r.push_back({static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.z)});
    return r;
}

template <class T>
moving_set<mesh<T>> set_of(const ccd_scene& scene) {
    const mesh<T> first(as<T>(scene.t0), scene.faces);
    return moving(first, first.with_vertices(serial{}, as<T>(scene.t1)));
}

/// The rows that hit, in the order of impacts, with the times of the truth.
template <class T>
std::vector<impact<T>> rows_that_hit(const std::filesystem::path& folder, const ccd_scene& scene, std::size_t& misses) {
    std::map<face, std::uint32_t> number;
    for (std::uint32_t f = 0; f < scene.faces.size(); ++f) number.try_emplace(scene.faces[f], f);
    std::vector<edge> edges;
    for (const face& f : scene.faces) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = f[i], b = f[(i + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b)});
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    const auto number_of = [&](edge e) {
        return static_cast<std::uint32_t>(std::lower_bound(edges.begin(), edges.end(), e) - edges.begin());
    };
    impact_list<T> all;
    for (const motion_kind kind : {motion_kind::vertex_face, motion_kind::edge_edge}) {
        for (const ccd_truth_row& row : read_ccd_truth(folder, kind)) {
            misses += !row.hit;
            if (!row.hit) continue;
            std::array<std::uint32_t, 4> v = row.vertices;
            if (kind == motion_kind::vertex_face) {
                all.push_back({v[0], number.at({v[1], v[2], v[3]}), {feature_pair::vertex_face, v, row.time}});
                continue;
            }
            edge e{std::min(v[0], v[1]), std::max(v[0], v[1])}, f{std::min(v[2], v[3]), std::max(v[2], v[3])};
            if (f < e) std::swap(e, f);
            all.push_back({number_of(e), number_of(f), {feature_pair::edge_edge, {e[0], e[1], f[0], f[1]}, row.time}});
        }
    }
    return in_order(all);
}

/// Exactly the rows, in order, with times no more than 2^-40 below those of the truth, which are good to 2^-60 and rounded.
template <class T>
void check_rows(const std::vector<impact<T>>& found, const std::vector<impact<T>>& rows) {
    REQUIRE(found.size() == rows.size());
    std::size_t other = 0, late = 0, early = 0, uneven = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double slack = 0x1p-60 + std::nextafter(rows[i].time, 2) - rows[i].time;
        other += found[i].kind != rows[i].kind || found[i].vertices != rows[i].vertices;
        late += found[i].time > rows[i].time + slack;
        early += found[i].time < rows[i].time - 0x1p-40 - slack;
        const double cells = std::ldexp(found[i].time, 40);
        uneven += cells != std::floor(cells);
    }
    CHECK(other == 0);
    CHECK(late == 0);
    CHECK(early == 0);
    CHECK(uneven == 0);
}

/// All that `self_impacts` says of a scene, which is the truth.
template <class T, class Policy>
void check_scene(const Policy& on, const char* name) {
    const auto folder = ccd_folder(name);
    REQUIRE(folder);
    CAPTURE(name);
    const ccd_scene scene = read_ccd_scene(*folder);
    std::size_t misses = 0;
    const auto rows = rows_that_hit<T>(*folder, scene, misses);
    const auto set = set_of<T>(scene);
    const auto index = make_impact_index(on, set);
    const auto found = to_host(self_impacts(on, index));
    check_rows(found, rows);
    CHECK(to_host(self_impacts(on, set)) == found);
    CHECK(to_host(self_impacts(on, refit(on, index, set))) == found);
    const auto first = first_self_impact(on, index);
    REQUIRE(first);
    CHECK(*first ==
          *std::min_element(found.begin(), found.end(), [](const auto& i, const auto& j) { return i.time < j.time; }));
    // Every candidate by integers: a minute and more where there are millions.
    if (scene.faces.size() < 20000 || sample_count() > 5000) CHECK(to_host(self_impacts<exact>(on, index)) == found);
    const auto careful = to_host(self_impacts<conservative>(on, index));
    CHECK(missed_or_late(found, careful) == 0);
    CHECK(careful.size() >= found.size());
    CHECK(careful.size() <= found.size() + misses + found.size() / 10);
}

}  // namespace abut::test
