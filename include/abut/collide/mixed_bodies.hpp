// SPDX-License-Identifier: MIT
#pragma once

// mixed_bodies: scenes of `bodies` (bodies.hpp) of different kinds of indices, numbered through. What is asked of them is in
// mixed_questions.hpp.

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include <abut/collide/bodies.hpp>
#include <abut/collide/body_pairs.hpp>
#include <abut/collide/body_rows.hpp>

namespace abut {

/// Bodies of several kinds of indices as one scene, which make_bodies makes of several lists: those of the first list have
/// the first numbers, and so on. Queries of bodies (@ref many_bodies ) take it, as do `distance`, `nearest`, `raycast` and
/// those beside it, under one policy. Answers are those of one scene, in the same order: what a query says of two bodies is
/// what it says of these alone. A schedule reports on the last two kinds. Results take their memory twice while they are put
/// together. Each two kinds of shapes have to be decidable. Immutable; copies share everything, and any number of threads
/// may query it.
/// @ingroup many_bodies
template <class... Indices>
class mixed_bodies {
public:
    using index_type = std::tuple_element_t<0, std::tuple<Indices...>>;  ///< of the first kind
    using scalar_type = typename index_type::scalar_type;                ///< float or double
    using memory_space = typename index_type::memory_space;              ///< where the memory lies
    static_assert((std::same_as<scalar_type, typename Indices::scalar_type> && ...),
                  "abut: the bodies of a scene have one scalar type, float or double");
    static_assert((std::same_as<memory_space, typename Indices::memory_space> && ...),
                  "abut: the bodies of a scene lie in the memory of one policy");

    /// Bodies that are there, one after another. Throws capacity_error if there are 2^31 or more.
    explicit mixed_bodies(bodies<Indices>... parts) : parts_(std::move(parts)...) {
        std::size_t number = 0, k = 0;
        std::apply([&](const auto&... part) { ((firsts_[k++] = number, number += part.size()), ...); }, parts_);
        firsts_[k] = number;
        detail::check_count(number, "abut::mixed_bodies");
    }

    /// Number of bodies of all kinds.
    [[nodiscard]] std::size_t size() const { return firsts_.back(); }
    /// Those of kind K, from 0 on; their numbers in the scene are first(K) more than their own.
    template <std::size_t K>
    [[nodiscard]] const auto& part() const {
        return std::get<K>(parts_);
    }
    /// The number of the first body of a kind.
    [[nodiscard]] std::uint32_t first(std::size_t kind) const { return static_cast<std::uint32_t>(firsts_[kind]); }
    /// The CUDA device that the bodies lie on; -1 for the host.
    [[nodiscard]] int device() const { return part<0>().device(); }

private:
    std::tuple<bodies<Indices>...> parts_;
    std::array<std::size_t, sizeof...(Indices) + 1> firsts_;
};

namespace detail {

template <class... Indices>
inline constexpr bool is_mixed_bodies<mixed_bodies<Indices...>> = true;

/// What becomes a part: a list, or bodies, in one policy's memory.
template <class X>
concept bodies_of_one_kind = many_bodies<X> && is_bodies<X>;

/// How messages name a body of a kind.
struct name_in_mixed {
    std::size_t kind, first;
    std::string operator()(std::size_t i) const {
        return name_of_body(first + i) + " (" + std::to_string(i) + " of list " + std::to_string(kind) + ")";
    }
};
/// Bodies of lists one after another, which are called by the name that they have in the scene.
template <class Policy>
struct take_parts {
    const Policy& on;
    std::size_t kind = 0, first = 0;

    template <class X>
    auto operator()(const X& x) {
        constexpr const char* function = "abut::make_bodies";
        const name_in_mixed name{kind++, std::exchange(first, first + x.size())};
        if constexpr (is_list_of_bodies<X>) {
            return bodies_of(on, x, function, name);
        } else {
            require_same_device(on, x, function);
            return x;
        }
    }
};

/// make(part, number of the kind) of each, in order: a scene of what it makes.
template <class... Indices, class Make>
auto with_parts(const mixed_bodies<Indices...>& all, const Make& make) {
    return [&]<std::size_t... K>(std::index_sequence<K...>) {
        return mixed_bodies<Indices...>{make(all.template part<K>(), K)...};
    }
    (std::index_sequence_for<Indices...>());
}

/// The same bodies under other poses: poses_of(first, n, where) puts n poses there.
template <class Policy, class... Indices, class PosesOf>
auto refit_parts(const Policy& on, const mixed_bodies<Indices...>& all, const PosesOf& poses_of) {
    return with_parts(all, [&](const auto& part, std::size_t k) {
        execution::buffer_of<Policy, rigid<typename mixed_bodies<Indices...>::scalar_type>> own(on, part.size());
        poses_of(all.first(k), part.size(), own);
        return settle_bodies(on, move_bodies(on, part, std::move(own), name_in_mixed{k, all.first(k)}));
    });
}

/// Numbers of two parts' bodies in the whole scene.
struct bodies_of_parts {
    std::uint32_t first_a = 0, first_b = 0;

    template <class Found>
    [[nodiscard]] ABUT_HD Found named(Found found) const {
        if constexpr (std::same_as<Found, index_pair>) {
            found.a += first_a, found.b += first_b;
        } else {
            found.body_a += first_a, found.body_b += first_b;
        }
        return found;
    }
};
/// Two parts, or one and itself.
template <bool One, class IndexA, class IndexB>
struct two_parts {
    const bodies<IndexA>& a;
    const bodies<IndexB>& b;
    bodies_of_parts names;

    [[nodiscard]] auto scene() const {
        if constexpr (One) {
            return a;
        } else {
            return between(a, b);
        }
    }
};
template <std::size_t P, std::size_t Q, class... Indices, class Visit>
bool is_over_at_parts([[maybe_unused]] const mixed_bodies<Indices...>& all, [[maybe_unused]] const Visit& visit) {
    if constexpr (Q < sizeof...(Indices)) {
        using index_a = std::tuple_element_t<P, std::tuple<Indices...>>;
        using index_b = std::tuple_element_t<Q, std::tuple<Indices...>>;
        const bodies<index_a>& a = all.template part<P>();
        const bodies<index_b>& b = all.template part<Q>();
        if (a.tree().size() < (P == Q ? 2 : 1) || b.tree().size() == 0) return false;
        return visit(two_parts<P == Q, index_a, index_b>{a, b, {all.first(P), all.first(Q)}});
    } else {
        return false;
    }
}
/// visit(two_parts) of each two of which bodies may meet, until it says true: first of each part and itself.
template <class... Indices, class Visit>
void for_each_two_parts(const mixed_bodies<Indices...>& all, const Visit& visit) {
    constexpr std::size_t n = sizeof...(Indices);
    [&]<std::size_t... K>(std::index_sequence<K...>) { return (is_over_at_parts<K % n, K % n + K / n>(all, visit) || ...); }
    (std::make_index_sequence<n * n>());
}

}  // namespace detail

/// @addtogroup many_bodies
///@{

/// Bodies of several kinds as one scene: `mixed_bodies` of lists of posed indices or of `bodies`, those of the first
/// argument with the first numbers. The indices of one argument are of one type. Throws as for one list; messages name a
/// body by its number in the scene, and by its number and that of its list. `bodies` are shared, not copied.
///
///     const auto scene = abut::make_bodies(on, machines, crates, grains);
///     for (const auto& hit : to_host(abut::pairs(on, scene))) use(hit.body_a, hit.a, hit.body_b, hit.b);
template <execution_policy Policy, detail::bodies_of_one_kind First, detail::bodies_of_one_kind Second,
          detail::bodies_of_one_kind... More>
[[nodiscard]] auto make_bodies(const Policy& on, const First& first, const Second& second, const More&... more) {
    using detail::index_of_bodies;
    if constexpr (detail::can_be_listed<Policy, typename index_of_bodies<First>::type,
                                        typename index_of_bodies<Second>::type, typename index_of_bodies<More>::type...>()) {
        detail::take_parts<Policy> take{on};
        return mixed_bodies<typename index_of_bodies<First>::type, typename index_of_bodies<Second>::type,
                            typename index_of_bodies<More>::type...>{take(first), take(second), take(more)...};
    } else {
        return detail::refused();
    }
}

/// The same bodies under other poses, one for each body of the scene, as of one kind.
///@{
template <execution_policy Policy, class... Indices>
[[nodiscard]] auto refit(
    const Policy& on, const mixed_bodies<Indices...>& all,
    std::type_identity_t<std::span<const rigid<typename mixed_bodies<Indices...>::scalar_type>>> poses) {
    detail::check_refit(on, all, poses.size());
    return detail::refit_parts(
        on, all, [&](std::size_t first, std::size_t n, auto& own) { upload(on, poses.data() + first, n, own.data()); });
}
template <execution_policy Policy, class... Indices, memory_space Space>
[[nodiscard]] auto refit(const Policy& on, const mixed_bodies<Indices...>& all,
                         const poses_view<typename mixed_bodies<Indices...>::scalar_type, Space>& poses) {
    constexpr bool there = std::same_as<Space, space_of<Policy>>;
    static_assert(there, "abut: the poses lie in other memory than the policy works in");
    if constexpr (there) {
        detail::check_refit(on, all, poses.count);
        require_access(on, poses.first, "abut::refit");
        return detail::refit_parts(
            on, all, [&](std::size_t first, std::size_t n, auto& own) { copy(on, poses.first + first, n, own.data()); });
    } else {
        return detail::refused();
    }
}
///@}

/// Scenes of several kinds are no argument of `between`, and this says so.
template <class A, class B>
    requires(detail::is_mixed_bodies<A> || detail::is_mixed_bodies<B>)
void between(const A&, const B&) {
    static_assert(many_bodies<A> && many_bodies<B>,
                  "abut: between takes scenes of one kind each; of several kinds make one scene, whose filter says which bodies meet");
}

///@}

}  // namespace abut
