// SPDX-License-Identifier: MIT
#pragma once

// Brings a set to where a policy works: what every index and query does first with its arguments.

#include <concepts>
#include <cstddef>
#include <string>

#include <abut/error.hpp>
#include <abut/execution/policy.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/hulls.hpp>   // its check has to be known here
#include <abut/shape/motion.hpp>  // and its
#include <abut/shape/rows.hpp>
#include <abut/shape/set.hpp>

namespace abut::detail {

template <class X>
concept is_shape = shape<X>;

/// An owner, a view, or one shape.
template <class X>
concept set_like = shape_set<X> || shape_view<X> || shape<X>;

/// An argument of a query in the policy's memory, one side of a pairing: `shapes()` gives its shapes where they are in the
/// world. An index says how it is walked (collide/operand.hpp).
template <class X>
concept operand = requires(const X& x) {
    { X::is_indexed } -> std::convertible_to<bool>;
    { X::has_tree } -> std::convertible_to<bool>;
    { X::is_posed } -> std::convertible_to<bool>;
    { x.shapes() } -> shape_view;
}
&&(!X::is_indexed || requires(const X& x) { x.walk(); }) && (!X::has_tree || requires(const X& x) { x.tree(); });

/// What stands in the place of a call's outcome that was refused when it was compiled. Other calls take it in silence, so
/// that the compiler says one thing.
struct refused {
    [[nodiscard]] std::size_t size() const { return 0; }
};

/// A container of shapes, which is no set yet.
template <class X>
concept array_of_shapes = array_like<X> && shape<element_of<X>>;

// What calls ask of the types of their arguments before they touch them: true, or else one line of the compiler says what is
// wrong. The calls do nothing then, so that no other line follows.

/// Whether an index lies where the policy works.
template <class Policy, class Index>
consteval bool lies_there() {
    constexpr bool there = std::same_as<typename Index::memory_space, space_of<Policy>>;
    static_assert(there, "abut: the index lies in other memory than the policy works in; make it with the same policy");
    return there;
}

/// Whether make_resident takes it.
template <class Policy, class Set>
consteval bool can_reside() {
    if constexpr (std::same_as<Set, refused>) {
        return false;
    } else if constexpr (array_of_shapes<Set>) {
        static_assert(!array_of_shapes<Set>,
                      "abut: an array is no set: make one of it, as abut::spheres<float>(array), or a view, as "
                      "abut::spheres_view<float>(array.data(), array.size())");
        return false;
    } else if constexpr (!set_like<Set>) {
        static_assert(
            set_like<Set>,
            "abut: expected a set (mesh, triangle_soup, spheres, ...), a view of one, or one shape; a type is a shape "
            "if it is plain data and has bounds(shape) in its namespace, as docs/extending.md says");
        return false;
    } else if constexpr (shape<Set>) {
        constexpr bool whole = !refers_to_memory<Set> || std::same_as<space_of<Policy>, host_space>;
        static_assert(whole,
                      "abut: a hull alone lies in host memory and the policy works elsewhere; make a set, abut::hulls");
        return whole;
    } else {
        using space = typename Set::memory_space;
        constexpr bool there = std::same_as<space, space_of<Policy>>, on_host = std::same_as<space, host_space>;
        static_assert(there || on_host,
                      "abut: a host policy cannot read a set in device memory; copy_to(policy, set) brings it over");
        static_assert(there || !on_host || !shape_view<Set>,
                      "abut: this view is over host memory and the policy works elsewhere; make a set of it first; or, where "
                      "its arrays lie in device memory, say so in its type: mesh_view<T, abut::device_space>, say");
        return there || (on_host && !shape_view<Set>);
    }
}

/// Whether elements that lie in the policy's memory are looked at, for which a call has to wait.
enum class input : bool {
    checked,
    trusted
};

/// `set` in the policy's memory: an owner that lies there already is shared, one in host memory is copied under cuda; a view
/// is checked and stays where it is; one shape is checked and becomes a view that carries it.
template <input Input = input::checked, execution_policy Policy, class Set>
auto make_resident(const Policy& on, const Set& set, const char* function) {
    if constexpr (!can_reside<Policy, Set>()) {
        return refused{};
    } else if constexpr (shape<Set>) {
        const single_view<Set, space_of<Policy>> view{set};
        detail::check(on, view, function);
        return view;
    } else {
        if constexpr (shape_view<Set>) {
            if constexpr (Input == input::checked) {
                detail::check(on, set, function);
            } else {
                check_count(set.size(), function);
            }
            return set;
        } else if constexpr (std::same_as<typename Set::memory_space, space_of<Policy>>) {
            if (set.size() > 0 && set.device() != device_of(on)) {
                throw error(std::string(function) + ": the set lies on device " + std::to_string(set.device()) +
                            ", the policy works on device " + std::to_string(device_of(on)));
            }
            return set;
        } else {
            return set.copied_to(on);
        }
    }
}

/// Throws if an index lies on another device than the policy's.
template <execution_policy Policy, class Index>
void require_same_device(const Policy& on, const Index& index, const char* function) {
    if (index.size() > 0 && index.device() != device_of(on)) {
        throw error(std::string(function) + ": the index lies on device " + std::to_string(index.device()) +
                    ", the policy works on device " + std::to_string(device_of(on)));
    }
}

template <class Resident>
auto view_of(const Resident& set) {
    if constexpr (shape_view<Resident>) {
        return set;
    } else {
        return set.view();
    }
}

}  // namespace abut::detail
