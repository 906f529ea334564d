// SPDX-License-Identifier: MIT
#pragma once

// impact_details: where each of a list of impacts is, along which normal, and how fast. Queries leave that out, and whoever
// asks for it pays for it.

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <abut/collide/features.hpp>
#include <abut/collide/impact_index.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/error.hpp>
#include <abut/index/operand.hpp>
#include <abut/narrow/impact_detail.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/motion.hpp>

namespace abut {

namespace detail {

/// The mesh in motion that an argument of a query is.
template <class Policy, class X>
auto mesh_of_impacts(const Policy& on, const X& x, const char* function) {
    if constexpr (is_impact_index<X>) {
        require_same_device(on, x, function);
        return x.mesh();
    } else if constexpr (is_motion<X>) {
        return make_resident(on, x, function);
    } else {
        const auto at_rest = make_resident(on, x, function);
        return moving_set<std::remove_const_t<decltype(at_rest)>>(at_rest, at_rest);
    }
}

struct details_at_time {
    double time;
    template <class S, class U>
    ABUT_HD impact_detail operator()(const S& s, const U& t) const {
        return details_at(s, t, time);
    }
};

/// The first impact with a kind or a vertex that is none.
template <scalar T>
struct bad_impact {
    const impact<T>* all;
    std::size_t of_a, of_b;  ///< vertices
    ABUT_HD std::size_t operator()(std::size_t i) const {
        const auto* const v = reinterpret_cast<const std::uint32_t*>(&all[i].vertices);
        const feature_pair kind = all[i].kind;
        const bool is_kind =
            kind == feature_pair::vertex_face || kind == feature_pair::face_vertex || kind == feature_pair::edge_edge;
        bool good = is_kind && all[i].time >= 0 && all[i].time <= 1;
        for (int k = 0; k < 4; ++k) {
            good = good && v[k] < (is_of_first(kind, k) ? of_a : of_b);
        }
        return good ? none_is_bad : i;
    }
};

}  // namespace detail

/// @addtogroup motion
///@{

/// What is known of an impact: see impact_detail. `a` and `b` are the meshes of the query as moving views, of a self query
/// the same one twice; reads their vertices, on hosts and devices. The normal goes from b's feature to a's, of a self query
/// from the second feature to the first.
///
///     const auto step = abut::moving(cloth_t0, cloth_t1);
///     for (const auto& i : abut::self_impacts(on, step)) use(i, abut::details_of(i, step.view(), step.view()));
template <scalar T, memory_space Space>
[[nodiscard]] ABUT_HD impact_detail details_of(const impact<T>& found, const moving_view<mesh_view<T, Space>>& a,
                                               const moving_view<mesh_view<T, Space>>& b) {
    impact_detail of = detail::with_features_of(found, a, b, detail::details_at_time{found.time});
    if (found.kind == feature_pair::face_vertex) of.normal = -1.0 * of.normal;
    return of;
}

///@}

namespace detail {

template <scalar T, memory_space Space>
struct write_impact_detail {
    const impact<T>* all;
    moving_view<mesh_view<T, Space>> a, b;
    impact_detail* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = details_of(all[i], a, b); }
};

}  // namespace detail

/// @addtogroup motion
///@{

/// What is known of each impact of a list, in its order: a `result` of impact_detail in the policy's memory, 104 bytes each.
/// `found` lies there too; `a` and `b` are the arguments of its query, of a self query the same one twice. Throws `error`
/// for an impact whose vertices these meshes do not have, with its number.
///
///     const auto step = abut::moving(cloth_t0, cloth_t1);
///     const auto found = abut::impacts(on, step, ball);
///     const auto details = abut::impact_details(on, found, step, ball);
template <execution_policy Policy, scalar T, memory_space Space, class X, class Y>
    requires std::same_as<Space, space_of<Policy>>
[[nodiscard]] auto impact_details(const Policy& on, const result<impact<T>, Space>& found, const X& a, const Y& b) {
    constexpr const char* function = "abut::impact_details";
    if constexpr (detail::can_meet<Policy, X, Y>()) {
        const auto x = detail::mesh_of_impacts(on, a, function), y = detail::mesh_of_impacts(on, b, function);
        const std::size_t of_x = x.t0().view().vertices.count, of_y = y.t0().view().vertices.count;
        const std::size_t bad = reduce(on, found.size(), detail::none_is_bad, detail::minimum{},
                                       detail::bad_impact<T>{found.data(), of_x, of_y});
        if (bad != detail::none_is_bad) {
            throw error(std::string(function) + ": impact " + std::to_string(bad) + " is none of meshes of " +
                        std::to_string(of_x) + " and " + std::to_string(of_y) + " vertices");
        }
        execution::buffer_of<Policy, impact_detail> out(on, found.size());
        for_each_index(on, found.size(),
                       detail::write_impact_detail<T, Space>{found.data(), x.view(), y.view(), out.data()});
        return result<impact_detail, Space>(std::move(out));
    } else {
        return result<impact_detail, Space>();
    }
}

///@}

}  // namespace abut
