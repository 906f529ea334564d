// SPDX-License-Identifier: MIT
#pragma once

// What queries take beside their shapes, and what they give back.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/config.hpp>
#include <abut/collide/flag.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/schedule.hpp>
#include <abut/traverse/traversal.hpp>

namespace abut {

class front;  // to make one, include <abut/experimental/front.hpp>

/// @addtogroup queries
///@{

/// Ids of two shapes that touch: `a` in a query's first argument, `b` in its second.
struct index_pair {
    std::uint32_t a;  ///< id in the first argument's set
    std::uint32_t b;  ///< id in the second one's; of self queries the higher id

    friend constexpr bool operator==(const index_pair&, const index_pair&) = default;
    friend constexpr auto operator<=>(const index_pair&, const index_pair&) = default;
};

namespace detail {

/// What is said of braces in a call that hold a filter: their type is that of options without one.
template <class F>
consteval void refuse_unnamed_options() {
    static_assert(sizeof(F) == 0,
                  "abut: braces in a call do not tell the type of a filter: write abut::query_options{.filter = f} (or "
                  "contact_options, self_options, list_options, body_options); for clang before 17 "
                  "abut::query_options<decltype(f)>{.filter = f}");
}

}  // namespace detail

/// The filter that keeps every pair.
struct keep_all {
    /// For every pair.
    keep_all() = default;
    /// No other filter becomes this one: does not compile.
    template <class F>
    ABUT_HD constexpr keep_all(const F&) {
        detail::refuse_unnamed_options<F>();
    }
    /// true, whatever a query says of a pair: two ids, or a tagged_pair, or a body_pair
    template <class... Named>
    ABUT_HD constexpr bool operator()(const Named&...) const {
        return true;
    }
};

/// An argument of a query, the first or the second one.
enum class argument : unsigned char {
    automatic,  ///< whichever is thought better
    a,          ///< the first one
    b           ///< the second one
};

/// The schedule of a traversal where none is asked for. A host has no lazy stealing, and shares a list instead. On a device
/// the shared list takes up to an eighth less time where there is work everywhere, and 40 times as much where most of it
/// lies below a few pairs of nodes (docs/results/meshes.md). For traversals that open one node at a time it is faster
/// throughout.
template <traversal Traversal>
inline constexpr schedule default_schedule = Traversal == traversal::both_at_once || Traversal == traversal::from_front
                                                 ? schedule::lazy_work_stealing
                                                 : schedule::shared_list;

/// Options of `any`, `count`, `pairs` and `for_each_pair`. Without a filter, `{.sorted = false}` will do in a call; with
/// one, write the type's name: `query_options{.filter = f}` where f is a lambda or a functor. clang before 17 cannot deduce
/// the argument of an aggregate, and takes it as in the example.
///
///     const auto later = [](std::uint32_t a, std::uint32_t b) { return a < b; };
///     const auto hits = abut::pairs(on, mesh, other, abut::query_options<decltype(later)>{.filter = later});
///
/// Under cuda a filter runs on the device. A functor marked ABUT_HD needs no flag of nvcc's; a lambda needs
/// `--extended-lambda` and the mark, as in `[=] ABUT_HD(std::uint32_t a, std::uint32_t b) { return first[a] < b; }`, which
/// captures by value: pointers to device memory, no references. With other compilers ABUT_HD is nothing, so the same lambda
/// serves all policies.
///
/// How two trees are walked is a template argument, so that a program compiles what it asks for:
/// `query_options<keep_all, traversal::larger_first>{}`. It is for queries of two indices made by make_bvh, posed or not;
/// other queries take no notice of it. Who does what of that walk is another template argument, of all traversals but
/// breadth_first: `query_options<keep_all, traversal::both_at_once, schedule::shared_list>{}`.
template <class Filter = keep_all, traversal Traversal = traversal::both_at_once, schedule Schedule = default_schedule<Traversal>>
struct query_options {
    /// Pairs sorted by a, then b. Without it their order is any, and may differ from call to call.
    flag sorted = true;
    /// filter(id in a, id in b) -> bool: pairs for which it is false are neither tested nor reported. A trivially copyable
    /// functor, ABUT_HD under cuda; called concurrently.
    Filter filter = {};
    /// On a device, of pairs whose coordinates are too far apart for integers in registers, 2^124 in one pair: how many of
    /// them wait for the host at a time, 8 bytes and their shapes each. No other pairs wait.
    std::uint64_t most_pairs = std::uint64_t{1} << 18;
    /// Where neither side is an index: the one that stays close to the cores, a tile of it at a time (under cuda in shared
    /// memory), while the other streams by and is shared out among threads. By itself the smaller one. A single shape is
    /// always the resident side, and an index the one that is looked in. It changes times, not answers.
    argument resident = argument::automatic;
    /// Of traversal::breadth_first, and on a device of both_at_once by all schedules but the shared list: the depth at which
    /// it begins, 0 to most_start_depth. All nodes there of one tree are compared with all of the other one, whatever lies
    /// above them; a leaf above that depth counts as one of them. 0 and 1 are the roots' children. A tree that is too small
    /// to have so many levels if it were balanced begins at the last of those, and a node of wide_layout is two levels. On a
    /// device a deep start saves steps that cannot fill it; on a host it saves nothing.
    int start_depth = 6;
    /// Of walks of two trees but breadth_first: the schedule's own options, and where it reports to.
    schedule_options scheduling = {};
    /// Of traversal::from_front alone, which has to have one: where the query begins, and where it leaves its ends. Trees of
    /// two shapes or more in the standard layout have them, and other queries do as both_at_once does and let the front be.
    /// Where `any` or a visitor stops early, the front stays as it was, or all ends have been looked for before.
    abut::front* front = nullptr;
};

///@}

namespace detail {

/// The same options with another filter. All members are named here, so that none is lost.
template <class Filter, traversal Traversal, schedule Schedule, class Other>
query_options<Other, Traversal, Schedule> with_filter(const query_options<Filter, Traversal, Schedule>& options,
                                                      const Other& filter) {
    const auto& [sorted, old, most_pairs, resident, start_depth, scheduling, front] = options;
    return {sorted, filter, most_pairs, resident, start_depth, scheduling, front};
}

}  // namespace detail

/// @addtogroup queries
///@{

/// The outcome of a query in the policy's memory: contiguous and immutable.
template <class T, memory_space Space>
class result {
public:
    using value_type = T;        ///< what it consists of
    using memory_space = Space;  ///< where that lies

    /// Empty.
    result() = default;
    /// For queries: takes what they found.
    explicit result(execution::buffer<T, Space> values) : values_(std::move(values)) {}

    /// Number of elements.
    [[nodiscard]] std::size_t size() const { return values_.size(); }
    /// Whether there are none.
    [[nodiscard]] bool empty() const { return size() == 0; }
    /// The first of size() elements in a row, in the memory space of the policy that ran the query.
    [[nodiscard]] const T* data() const { return values_.data(); }
    /// Elements as those of an array, of results in host memory.
    ///@{
    [[nodiscard]] const T* begin() const
        requires std::same_as<Space, host_space>
    {
        return data();
    }
    [[nodiscard]] const T* end() const
        requires std::same_as<Space, host_space>
    {
        return data() + size();
    }
    [[nodiscard]] const T& operator[](std::size_t i) const
        requires std::same_as<Space, host_space>
    {
        return data()[i];
    }
    ///@}

    /// The elements in host memory. Waits for the copy. Throws std::bad_alloc, cuda_error.
    [[nodiscard]] std::vector<T> to_host() const {
        std::vector<T> copy(size());
        values_.read(copy.data());
        return copy;
    }

private:
    execution::buffer<T, Space> values_;
};

/// The elements of a result in host memory. Waits for the copy. Throws std::bad_alloc, cuda_error.
template <class T, memory_space Space>
[[nodiscard]] std::vector<T> to_host(const result<T, Space>& values) {
    return values.to_host();
}

///@}

}  // namespace abut
