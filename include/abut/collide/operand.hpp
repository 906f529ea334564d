// SPDX-License-Identifier: MIT
#pragma once

// Operands: the arguments of a query, brought to where its policy works. An operand has shapes, and if it is an index also a
// way to look in it; under a pose both are placed.

#include <concepts>
#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/error.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/grid.hpp>
#include <abut/index/least_ids.hpp>
#include <abut/index/operand.hpp>
#include <abut/shape/moved.hpp>
#include <abut/shape/posed.hpp>
#include <abut/traverse/bvh_walk.hpp>
#include <abut/traverse/grid_walk.hpp>
#include <abut/traverse/moved_walk.hpp>
#include <abut/traverse/posed_walk.hpp>

namespace abut::detail {

/// Stands for the topology of a tree (index/bvh.hpp) as long as somebody holds it; what has been let go equals nothing.
using topology = std::weak_ptr<const void>;

/// A set, a view of one, or one shape.
template <class Resident>
struct plain_operand {
    static constexpr bool is_indexed = false, has_tree = false, is_posed = false;
    Resident set;

    [[nodiscard]] auto shapes() const { return view_of(set); }
};

/// An index and the set that it keeps.
template <class Index>
struct indexed_operand;

template <class Set, memory_space Space, class Layout>
struct indexed_operand<bvh<Set, Space, Layout>> {
    static constexpr bool is_indexed = true, has_tree = true, is_posed = false;
    using T = typename Set::scalar_type;
    bvh<Set, Space, Layout> index;

    [[nodiscard]] auto shapes() const { return view_of(index.set()); }
    [[nodiscard]] auto tree() const { return index.view(); }
    [[nodiscard]] auto walk() const { return bvh_walk<typename bvh<Set, Space, Layout>::view_type>{tree()}; }
    /// What a refitted tree has in common with the one that it comes of.
    [[nodiscard]] topology shape_of_tree() const requires std::same_as<Layout, standard_layout> {
        return index.stored().plan;
    }
    /// Whether node k lies between leaves k and k + 1 of an order.
    [[nodiscard]] bool is_along_curve() const requires std::same_as<Layout, standard_layout> {
        return index.stored().along_curve;
    }
    /// Itself, which may have least ids (index/least_ids.hpp).
    [[nodiscard]] const auto& tree_with_least_ids() const { return index; }
    /// Around all shapes, of which there are some.
    template <class Policy>
    [[nodiscard]] aabb<T> bounds(const Policy&) const {
        return index.bounds();
    }
};

template <class Set, memory_space Space>
struct indexed_operand<grid<Set, Space>> {
    static constexpr bool is_indexed = true, has_tree = false, is_posed = false;
    using T = typename Set::scalar_type;
    grid<Set, Space> index;

    [[nodiscard]] auto shapes() const { return view_of(index.set()); }
    [[nodiscard]] auto walk() const { return grid_walk<typename grid<Set, Space>::view_type>{index.view()}; }
    [[nodiscard]] const auto* clearances() const { return index.clearances(); }
    template <class Policy>
    [[nodiscard]] aabb<T> bounds(const Policy& on) const {
        aabb<T> box;
        download(on, &index.view().frame->bounds, 1, &box);
        return box;
    }
};

/// A tree whose nodes have the same numbers after a refit.
template <class Operand>
concept has_topology = requires(const Operand& x) {
    { x.shape_of_tree() } -> std::same_as<topology>;
};

/// A tree, posed or not, that may have least ids.
template <class Operand>
concept may_have_least_ids = requires(const Operand& x) {
    x.tree_with_least_ids();
};

/// An operand under a pose. Nothing is copied: shapes are placed as they are read, and an index is looked in in its frame.
template <class Operand, scalar T>
struct posed_operand {
    static constexpr bool is_indexed = Operand::is_indexed, has_tree = Operand::has_tree, is_posed = true;
    Operand operand;
    rigid<T> pose;
    aabb<T> around;  ///< an index's shapes, in their frame

    [[nodiscard]] auto shapes() const { return posed_view<decltype(operand.shapes())>{operand.shapes(), pose}; }
    [[nodiscard]] auto tree() const { return operand.tree(); }
    [[nodiscard]] topology shape_of_tree() const requires has_topology<Operand> { return operand.shape_of_tree(); }
    [[nodiscard]] bool is_along_curve() const requires has_topology<Operand> { return operand.is_along_curve(); }
    [[nodiscard]] auto walk() const { return posed_walk<decltype(operand.walk())>(operand.walk(), pose, around); }
    [[nodiscard]] const auto& tree_with_least_ids() const requires may_have_least_ids<Operand> {
        return operand.tree_with_least_ids();
    }
};

/// An operand that goes along a way. Shapes are put on it as they are read, and boxes grow where they are looked at.
template <class Operand, scalar T>
struct moved_operand {
    static constexpr bool is_indexed = Operand::is_indexed, has_tree = Operand::has_tree, is_posed = Operand::is_posed;
    Operand operand;
    vec3<T> way;

    [[nodiscard]] auto shapes() const { return moved_view<decltype(operand.shapes())>{operand.shapes(), way}; }
    [[nodiscard]] auto tree() const { return operand.tree(); }
    [[nodiscard]] auto walk() const { return moved_walk<decltype(operand.walk())>{operand.walk(), way}; }
};
template <class X>
inline constexpr bool is_moved_operand = false;
template <class Operand, scalar T>
inline constexpr bool is_moved_operand<moved_operand<Operand, T>> = true;

/// How an operand's shapes are seen: as they are.
struct as_they_are {};
/// An operand whose shapes are seen in another way: `Sight` makes of a view of them one of as many shapes, with the same
/// boxes.
template <operand X, class Sight>
struct seen_operand : X {
    Sight sight;
    [[nodiscard]] auto shapes() const { return sight(X::shapes()); }
};
template <operand X, class Sight>
auto see(X x, const Sight& sight) {
    if constexpr (std::same_as<Sight, as_they_are>) {
        return x;
    } else {
        return seen_operand<X, Sight>{std::move(x), sight};
    }
}

template <class X>
inline constexpr bool is_index = requires {
    sizeof(indexed_operand<X>);
};

/// The shape of an argument.
template <class X>
struct shape_of_argument : shape_of_object<X> {};
template <class Object>
struct shape_of_argument<posed_object<Object>> {
    using type = placed_shape<typename shape_of_object<Object>::type>;
};
template <class Object>
struct shape_of_argument<moved_object<Object>> {
    using type = swept<typename shape_of_argument<Object>::type>;
};
template <operand X>
struct shape_of_argument<X> {
    using type = typename decltype(std::declval<const X&>().shapes())::shape_type;
};

/// Whether an argument is made of shapes of one kind. Indices of impacts, bodies and what is divided are not.
template <class X>
consteval bool has_shape() {
    if constexpr (is_posed<X> || is_moved<X>) {
        return has_shape<decltype(X::object)>();
    } else {
        return operand<X> || shape<X> || requires { typename X::shape_type; };
    }
}
/// Whether the shapes of an argument go along ways.
template <class X>
inline constexpr bool goes_on_ways = false;
template <class X>
    requires(has_shape<X>()) && is_swept<typename shape_of_argument<X>::type>
inline constexpr bool goes_on_ways<X> = true;

/// Whether make_operand takes it.
template <class Policy, class X>
consteval bool can_be_asked() {
    if constexpr (is_posed<X>) {
        return can_be_asked<Policy, decltype(X::object)>();
    } else if constexpr (is_moved<X>) {
        return can_be_asked<Policy, decltype(X::object)>();
    } else if constexpr (is_index<X>) {
        return lies_there<Policy, X>();
    } else {
        return can_reside<Policy, X>();
    }
}

/// Whether two arguments, which can be asked, have one scalar type.
template <class X, class Y>
consteval bool have_one_scalar() {
    using scalar_x = scalar_type_of<typename shape_of_argument<X>::type>;
    constexpr bool one = std::same_as<scalar_x, scalar_type_of<typename shape_of_argument<Y>::type>>;
    static_assert(one, "abut: both sides of a query need the same scalar type, float or double");
    return one;
}

/// `x` for the policy, which can be asked; errors are thrown in the name of `function`. An operand stays as it is: it has
/// been looked at where it was made.
template <input Input = input::checked, class Policy, class X>
auto make_operand(const Policy& on, const X& x, const char* function) {
    if constexpr (operand<X>) {
        return x;
    } else if constexpr (is_posed<X>) {
        check(x.pose, function);
        using operand_type = decltype(make_operand<Input>(on, x.object, function));
        posed_operand<operand_type, typename X::scalar_type> placed{make_operand<Input>(on, x.object, function), x.pose, {}};
        bool surely_finite = placed.shapes().size() == 0 || Input == input::trusted;
        if constexpr (operand_type::is_indexed) {
            if (placed.shapes().size() > 0) {
                placed.around = placed.operand.bounds(on);
                surely_finite |= stays_finite(x.pose, placed.around);
            }
        }
        if (!surely_finite) check(on, placed.shapes(), function);
        return placed;
    } else if constexpr (is_moved<X>) {
        if (!is_valid(x.way)) {
            const shape_flaw flaw = flaw_of(x.way);
            throw invalid_geometry(function, "way", 0, std::string(flaw.of) + flaw.what, flaw.value);
        }
        using operand_type = decltype(make_operand<Input>(on, x.object, function));
        return moved_operand<operand_type, typename X::scalar_type>{make_operand<Input>(on, x.object, function), x.way};
    } else if constexpr (is_index<X>) {
        require_same_device(on, x, function);
        return indexed_operand<X>{x};
    } else {
        auto set = make_resident<Input>(on, x, function);
        return plain_operand<decltype(set)>{std::move(set)};
    }
}

}  // namespace abut::detail
