// SPDX-License-Identifier: MIT
#pragma once

// start_contacts: of what `sweep` found, the contacts of shapes that touch at the start.

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/collide/sweep.hpp>
#include <abut/error.hpp>
#include <abut/narrow/contact.hpp>
#include <abut/shape/check.hpp>

namespace abut {

namespace detail {

/// The first row whose hit names a shape that is not there.
template <scalar T>
struct bad_sweep_hit {
    const sweep_hit<T>* found;
    std::size_t shapes;
    ABUT_HD std::size_t operator()(std::size_t i) const {
        return found[i].id == no_id || found[i].id < shapes ? none_is_bad : i;
    }
};
template <class Shapes, class Rows>
struct write_start_contacts {
    using T = typename Shapes::scalar_type;
    Shapes shapes;
    Rows rows;
    const sweep_hit<T>* found;
    contact<T>* out;

    /// A time of 0 may be a rounded one.
    ABUT_HD void operator()(std::size_t i) const {
        out[i] = {static_cast<std::uint32_t>(i), no_id, {0, 0, 0}, {0, 0, 0}, 0};
        if (found[i].id == no_id || !is_zero(found[i].t)) return;
        const auto mover = rows[i];
        const auto met = shapes[found[i].id];
        const bool touch = touch_at_start(mover, met);
        if (!touch) return;
        const contact<T> c = contact_in_any_order(mover.start, met);
        out[i] = {static_cast<std::uint32_t>(i), found[i].id, c.point, c.normal, c.depth};
    }
};

}  // namespace detail

/// The contacts of shapes that touch at the start: a `result` of `contact`, one for each row of what `sweep` found of the same
/// index and shapes. `a` is the number of the row, `b` the shape that is touched, and point, normal and depth are those of
/// `contacts`: the normal points from what is touched to the shape that goes, which is free of it once it is moved by the depth
/// along the normal. Where a row touches nothing, or later, `b` is `no_id` and the rest is 0. Of several shapes that are
/// touched at the start it is the one of `sweep`, with the least id; `contacts` has all.
///
/// Whether shapes touch at the start is decided exactly, whatever the sweep was asked with. A policy answers.
///
/// @par Memory
/// `found` lies in the policy's memory, as `sweep` leaves it, and so does the result, 36 bytes a row in float and 64 in double.
/// The other arguments are as those of `sweep`. Under `cuda` the stack is about that of `sweep` and of `contacts`.
///
/// @par Errors
/// - `error`: there are not as many rows as shapes, or a hit has an id that is not in the index.
/// - Those of `sweep` about its arguments.
///
/// @par Synchronisation
/// Returns when the answers are complete; under `cuda` it waits for the policy's stream.
///
///     const auto found = abut::sweep(on, index, movers);
///     for (const auto& c : abut::to_host(abut::start_contacts(on, found, index, movers))) {
///         if (c.b != abut::no_id) push_out(c.a, c.depth * c.normal);
///     }
///
/// @ingroup queries
template <execution_policy Policy, scalar T, class X, class Moving>
[[nodiscard]] auto start_contacts(const Policy& on, const result<sweep_hit<T>, space_of<Policy>>& found, const X& index,
                                  const Moving& moving) {
    using namespace detail;
    using answer = result<contact<T>, space_of<Policy>>;
    constexpr const char* function = "abut::start_contacts";
    if constexpr (!can_be_swept<Policy, X, Moving>()) {
        return answer();
    } else {
        using mover = decltype(shape_of_argument<Moving>::type::start);
        using met = typename shape_of_argument<X>::type;
        constexpr bool can = contact_pair<mover, met> || contact_pair<met, mover>;
        static_assert(can, "abut: there are no contacts of this pair of shapes; a shape of your own needs contact_between(s, t) beside it (docs/extending.md)");
        if constexpr (can) {
            const auto x = make_operand(on, index, function);
            const auto rows = make_operand(on, moving, function);
            const auto shapes = x.shapes();
            const auto movers = rows.shapes();
            if (found.size() != movers.size()) {
                throw error(std::string(function) + ": " + std::to_string(found.size()) + " hits; expected as many as shapes, " +
                            std::to_string(movers.size()));
            }
            const std::size_t bad =
                reduce(on, found.size(), none_is_bad, minimum{}, bad_sweep_hit<T>{found.data(), shapes.size()});
            if (bad != none_is_bad) {
                throw error(std::string(function) + ": hit " + std::to_string(bad) + " has an id of none of the " +
                            std::to_string(shapes.size()) + " shapes");
            }
            execution::buffer_of<Policy, contact<T>> out(on, found.size());
            for_each_index(on, found.size(),
                           write_start_contacts<std::remove_const_t<decltype(shapes)>, std::remove_const_t<decltype(movers)>>{
                               shapes, movers, found.data(), out.data()});
            synchronize(on);
            return answer(std::move(out));
        } else {
            return answer();
        }
    }
}

}  // namespace abut
