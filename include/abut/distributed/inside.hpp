// SPDX-License-Identifier: MIT
#pragma once

// inside and signed_distance of a closed mesh whose parts lie on many ranks. A part says whether the way up from a point
// crosses an odd number of its triangles.

#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/collide/inside.hpp>
#include <abut/collide/row_questions.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/nearest.hpp>
#include <abut/distributed/rows.hpp>

namespace abut {

namespace detail {

/// Whether `inside` of ranks takes both arguments.
template <arithmetic A, class Local, class X, class Points>
consteval bool can_contain_globally() {
    constexpr bool is_decided = !std::same_as<A, fast>;
    static_assert(is_decided, "abut: inside is decided by `filtered` or `exact`");
    if constexpr (is_decided && can_be_near<Local, X, Points>()) {
        using shape_type = typename shape_of_argument<X>::type;
        constexpr bool are = std::same_as<shape_type, triangle<scalar_type_of<shape_type>>>;
        static_assert(are, "abut: inside looks into a closed mesh: the parts of one are triangles");
        return are;
    } else {
        return false;
    }
}

template <arithmetic A, class Local, class X, class Points>
auto inside_of_parts(const distributed<Local>& on, const X& mesh, const Points& points, const inside_options& options,
                     const char* function) {
    using T = scalar_type_of<typename shape_of_argument<X>::type>;
    const auto here = bring_rows_and_shapes(
        on, mesh, points, function,
        [](const auto& policy, const auto& rows, const char* name) { return make_points<T>(policy, rows, name); },
        [&](const auto&, const auto&) {
            if (options.known_closed) return;
            throw error(std::string(function) +
                        ": no rank has all of a mesh to find out whether it is closed; expected {.known_closed = true}");
        });
    return answers_of_ranks(on, here, ask_inside<A>{}, [](auto found) { return found; });
}

template <scalar T>
struct write_globally_signed {
    const global_neighbor<T>* nearest;
    const containment* where;
    global_neighbor<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        out[i] = nearest[i];
        if (where[i] == containment::inside) out[i].distance = -out[i].distance;
        if (where[i] == containment::on_surface) out[i].distance = 0;
    }
};

}  // namespace detail

/// @addtogroup distributed
///@{

/// For each of this rank's `points` whether it is inside of the closed mesh that all parts are together: a `result` of
/// `containment`, in the order of the points. `mesh` is this rank's part, a mesh or triangles, or a tree of them; `points`
/// are as of `nearest`. Whether the mesh is closed no rank can see. So the caller has to know it, and says {.known_closed =
/// true}, or else an `error` is thrown. Points go to the ranks that have something above them.
template <arithmetic A = filtered, execution_policy Local, class X, class Points>
[[nodiscard]] auto inside(const distributed<Local>& on, const X& mesh, const Points& points,
                          const inside_options& options = {}) {
    using answer = result<containment, space_of<Local>>;
    if constexpr (detail::can_contain_globally<A, Local, X, Points>()) {
        return answer(detail::inside_of_parts<A>(on, mesh, points, options, "abut::inside"));
    } else {
        return answer();
    }
}

/// For each of this rank's `points` what `nearest` of ranks says of it, with a distance that is below 0 where the point is
/// inside, and 0 where it is on the surface. Arguments and options are those of `inside`.
template <execution_policy Local, class X, class Points>
[[nodiscard]] auto signed_distance(const distributed<Local>& on, const X& mesh, const Points& points,
                                   const inside_options& options = {}) {
    if constexpr (detail::can_contain_globally<filtered, Local, X, Points>()) {
        constexpr const char* function = "abut::signed_distance";
        using T = scalar_type_of<typename detail::shape_of_argument<X>::type>;
        const Local& local = on.local();
        const auto where = detail::inside_of_parts<filtered>(on, mesh, points, options, function);
        const auto near = detail::nearest_of_parts(on, mesh, points, 1, function);
        result<global_neighbor<T>, space_of<Local>> found;
        detail::attempts attempt;
        attempt([&] {
            execution::buffer_of<Local, global_neighbor<T>> out(local, near.size());
            for_each_index(local, near.size(), detail::write_globally_signed<T>{near.data(), where.data(), out.data()});
            synchronize(local);
            found = result<global_neighbor<T>, space_of<Local>>(std::move(out));
        });
        attempt.settle(on.ranks());
        return found;
    } else {
        return result<global_neighbor<float>, space_of<Local>>();
    }
}

///@}

}  // namespace abut
