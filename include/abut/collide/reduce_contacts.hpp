// SPDX-License-Identifier: MIT
#pragma once

// reduce_contacts: few contacts that hold two bodies apart nearly as well as all of them do. Two methods: one contact for
// each cell of a six-dimensional grid over positions and normals, and the contacts that are extreme in fixed directions.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/contacts.hpp>
#include <abut/collide/options.hpp>
#include <abut/error.hpp>
#include <abut/execution/host.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/narrow/wrench.hpp>
#include <abut/shape/bounds.hpp>

namespace abut {

/// @addtogroup contacts
///@{

/// How contacts are chosen.
enum class contact_reduction : unsigned char {
    /// N. Backman's (Collision Detection of Triangle Meshes using GPU, 2011, section 5.3.5): of all contacts whose position
    /// and normal fall into one cell of a six-dimensional grid, the one that is farthest from the grid's middle.
    binning,
    /// Of contacts of like normals the extreme ones: those that reach farthest in one of 210 directions of the space of
    /// forces and torques, beginning with those that the chosen ones miss most.
    extremes
};

/// Options of `reduce_contacts`.
struct reduce_options {
    /// Cells of the grid along each of its six axes, 1 to 1024. For binning alone: with `extremes` it stays at 8.
    int bins = 8;
    /// No more contacts than this, but at least 1. Where this is less than all, binning takes the coarsest grid, of at most
    /// `bins` cells an axis, that keeps as many, and of those the ones that are farthest from the middle.
    std::size_t most = static_cast<std::size_t>(-1);
    /// How they are chosen.
    contact_reduction method = contact_reduction::extremes;
};

namespace detail {

template <scalar T>
struct position_box {
    const contact<T>* contacts;
    ABUT_HD aabb<T> operator()(std::size_t i) const { return bounds(contacts[i].point); }
};
/// The order of ids, which settles every tie.
template <scalar T>
ABUT_HD constexpr std::uint64_t id_key(const contact<T>& c) {
    return std::uint64_t{c.a} << 32 | c.b;
}

// --- binning --------------------------------------------------------------------------------------------------------------

template <scalar T>
struct key_by_ids {
    const contact<T>* contacts;
    ABUT_HD std::uint64_t operator()(std::size_t i) const { return id_key(contacts[i]); }
};

/// The farthest from the middle first. Bit patterns of numbers that are not negative come in the numbers' order.
template <scalar T>
struct key_by_distance {
    const contact<T>* contacts;
    contact_math::contact_frame frame;
    ABUT_HD std::uint64_t operator()(std::size_t i) const {
        using namespace contact_math;
        const point p = frame(contacts[i].point), n = wrench_of(contacts[i], frame).force;
        const double square = plain_sum(plain_dot(p, p), plain_dot(n, n));
        return ~ABUT_BIT_CAST(std::uint64_t, square + 0.0);
    }
};

/// The cell of the grid: positions and normals are in [-1, 1] along each axis.
template <scalar T>
struct key_by_cell {
    const contact<T>* contacts;
    contact_math::contact_frame frame;
    int bins;
    ABUT_HD std::uint64_t operator()(std::size_t i) const {
        using namespace contact_math;
        const point p = frame(contacts[i].point), n = wrench_of(contacts[i], frame).force;
        std::uint64_t key = 0;
        const double axis[6] = {p.x, p.y, p.z, n.x, n.y, n.z};
        for (const double x : axis) key = key * static_cast<std::uint64_t>(bins) + cell(x);
        return key;
    }

private:
    ABUT_HD std::uint64_t cell(double x) const {
        using namespace contact_math;
        const double at = plain_product(plain_sum(x, 1.0) / 2, static_cast<double>(bins));
        if (!(at > 0)) return 0;
        return at < bins ? static_cast<std::uint64_t>(at) : static_cast<std::uint64_t>(bins - 1);
    }
};

template <class Key>
struct write_keys {
    Key key;
    const std::uint32_t* order;
    std::uint64_t* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = key(order[i]); }
};

struct starts_run {
    const std::uint64_t* keys;
    ABUT_HD bool operator()(std::size_t i) const { return i == 0 || keys[i] != keys[i - 1]; }
};

template <scalar T>
struct gather_ordered {
    const contact<T>* from;
    const std::uint32_t* order;
    const std::uint32_t* which;  ///< places in the order, or null for all
    contact<T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = from[order[which == nullptr ? i : which[i]]]; }
};

/// An order of contacts, made by stable sorts, the last of which counts most.
template <class Policy>
class contact_order {
public:
    contact_order(const Policy& policy, std::size_t n) : order_(policy, n), keys_(policy, n) {
        for_each_index(policy, n, execution::write_index<std::remove_cvref_t<decltype(*order_.data())>>{order_.data()});
    }
    template <class Key>
    void sort(const Policy& on, const Key& key, int bits) {
        for_each_index(on, order_.size(), write_keys<Key>{key, order_.data(), keys_.data()});
        sort_by_key(on, keys_, order_, bits);
    }
    [[nodiscard]] const std::uint32_t* order() const { return order_.data(); }
    /// The keys of the last sort, in order.
    [[nodiscard]] const std::uint64_t* keys() const { return keys_.data(); }

private:
    execution::buffer_of<Policy, std::uint32_t> order_;
    execution::buffer_of<Policy, std::uint64_t> keys_;
};

template <class Policy, scalar T>
auto sorted_by_ids(const Policy& on, execution::buffer_of<Policy, contact<T>> contacts) {
    contact_order<Policy> order(on, contacts.size());
    order.sort(on, key_by_ids<T>{contacts.data()}, 64);
    execution::buffer_of<Policy, contact<T>> sorted(on, contacts.size());
    for_each_index(on, contacts.size(), gather_ordered<T>{contacts.data(), order.order(), nullptr, sorted.data()});
    return sorted;
}

/// Sorted from the farthest to the nearest.
template <class Policy, scalar T>
auto sorted_by_distance(const Policy& on, const contact<T>* all, std::size_t n, const contact_math::contact_frame& frame) {
    contact_order<Policy> order(on, n);
    order.sort(on, key_by_ids<T>{all}, 64);
    order.sort(on, key_by_distance<T>{all, frame}, 64);
    return order;
}

/// The farthest contact of each cell.
template <class Policy, scalar T>
auto farthest_of_cells(const Policy& on, const contact<T>* all, std::size_t n, const contact_math::contact_frame& frame,
                       int bins) {
    contact_order<Policy> order = sorted_by_distance<Policy, T>(on, all, n, frame);
    order.sort(on, key_by_cell<T>{all, frame, bins}, 6 * id_bits(static_cast<std::size_t>(bins)) + 1);
    execution::buffer_of<Policy, std::uint32_t> first(on, n);
    const std::size_t kept = compact(on, n, starts_run{order.keys()}, first.data());
    execution::buffer_of<Policy, contact<T>> few(on, kept);
    for_each_index(on, kept, gather_ordered<T>{all, order.order(), first.data(), few.data()});
    return few;
}

template <class Policy, scalar T>
auto binned(const Policy& on, const contact<T>* all, std::size_t n, const contact_math::contact_frame& frame,
            const reduce_options& options) {
    int bins = options.most < n ? 1 : options.bins;
    auto few = farthest_of_cells<Policy, T>(on, all, n, frame, bins);
    while (few.size() < options.most && bins < options.bins) few = farthest_of_cells<Policy, T>(on, all, n, frame, ++bins);
    if (few.size() > options.most) {
        const auto order = sorted_by_distance<Policy, T>(on, few.data(), few.size(), frame);
        execution::buffer_of<Policy, contact<T>> fewer(on, options.most);
        for_each_index(on, options.most, gather_ordered<T>{few.data(), order.order(), nullptr, fewer.data()});
        few = std::move(fewer);
    }
    return sorted_by_ids<Policy, T>(on, std::move(few));
}

// --- extremes -------------------------------------------------------------------------------------------------------------

/// Whether a contact with this value comes before another.
template <scalar T>
ABUT_HD bool is_better(double value, const contact<T>& c, double other_value, const contact<T>& other) {
    return value > other_value || (value == other_value && id_key(c) < id_key(other));
}

/// How far the wrench of contact i reaches in direction j.
template <scalar T>
struct wrench_value {
    const contact<T>* contacts;
    const contact_math::wrench* wrenches;
    ABUT_HD double operator()(std::size_t i, int j) const { return dot(wrenches[i], contact_math::wrench_direction(j)); }
};

template <scalar T>
struct write_wrench {
    const contact<T>* contacts;
    contact_math::contact_frame frame;
    contact_math::wrench* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = contact_math::wrench_of(contacts[i], frame); }
};

/// The best contact of a part of all, for each direction.
template <scalar T>
struct best_of_part {
    wrench_value<T> value;
    std::size_t n, parts;
    std::uint32_t* best;  ///< parts rows of direction_count
    ABUT_HD void operator()(std::size_t k) const {
        const std::size_t columns = contact_math::direction_count, part = k / columns;
        const int j = static_cast<int>(k % columns);
        std::size_t found = part;
        double most = value(found, j);
        for (std::size_t i = part + parts; i < n; i += parts) {
            const double v = value(i, j);
            if (is_better(v, value.contacts[i], most, value.contacts[found])) most = v, found = i;
        }
        best[k] = static_cast<std::uint32_t>(found);
    }
};

/// The best of all parts, in row 0.
template <scalar T>
struct best_of_parts {
    wrench_value<T> value;
    std::size_t parts;
    std::uint32_t* best;
    contact<T>* out;
    ABUT_HD void operator()(std::size_t k) const {
        const std::size_t columns = contact_math::direction_count;
        const int j = static_cast<int>(k);
        std::size_t found = best[k];
        double most = value(found, j);
        for (std::size_t part = 1; part < parts; ++part) {
            const std::size_t i = best[part * columns + k];
            const double v = value(i, j);
            if (is_better(v, value.contacts[i], most, value.contacts[found])) most = v, found = i;
        }
        out[k] = value.contacts[found];
    }
};

/// Chooses among the extreme contacts of each direction, on the host: again and again the one of the direction in which the
/// chosen ones fall short most (of equals the first direction), where none reach 0.
template <scalar T>
std::vector<contact<T>> chosen_extremes(const std::vector<contact<T>>& extreme, const contact_math::contact_frame& frame,
                                        std::size_t most) {
    using namespace contact_math;
    constexpr std::size_t n = direction_count;
    std::vector<wrench> direction(n);
    std::vector<double> missing(n), reach(n);
    for (std::size_t j = 0; j < n; ++j) {
        direction[j] = wrench_direction(static_cast<int>(j));
        missing[j] = reach[j] = dot(wrench_of(extreme[j], frame), direction[j]);
    }
    std::vector<contact<T>> chosen;
    while (chosen.size() < most) {
        std::size_t worst = 0;
        for (std::size_t j = 1; j < n; ++j) worst = missing[j] > missing[worst] ? j : worst;
        if (!(missing[worst] > 0)) break;
        chosen.push_back(extreme[worst]);
        const wrench w = wrench_of(extreme[worst], frame);
        for (std::size_t j = 0; j < n; ++j) missing[j] = least(missing[j], plain_sum(reach[j], -dot(w, direction[j])));
    }
    return chosen;
}

template <class Policy, scalar T>
auto extremes(const Policy& on, const contact<T>* all, std::size_t n, const contact_math::contact_frame& frame,
              const reduce_options& options) {
    constexpr std::size_t columns = contact_math::direction_count;
    const std::size_t parts = n < 65536 ? (n + 255) / 256 : 256;
    execution::buffer_of<Policy, std::uint32_t> best(on, parts * columns);
    execution::buffer_of<Policy, contact<T>> extreme(on, columns);
    execution::buffer_of<Policy, contact_math::wrench> wrenches(on, n);
    for_each_index(on, n, write_wrench<T>{all, frame, wrenches.data()});
    const wrench_value<T> value{all, wrenches.data()};
    for_each_index(on, parts * columns, best_of_part<T>{value, n, parts, best.data()});
    for_each_index(on, columns, best_of_parts<T>{value, parts, best.data(), extreme.data()});
    std::vector<contact<T>> found(columns);
    download(on, extreme.data(), columns, found.data());
    const auto chosen = chosen_extremes(found, frame, options.most);
    execution::buffer_of<Policy, contact<T>> few(on, chosen.size());
    upload(on, chosen.data(), chosen.size(), few.data());
    return sorted_by_ids<Policy, T>(on, std::move(few));
}

}  // namespace detail

/// A few of the contacts `all`, in the policy's memory and sorted by a, then b; none of none. They should be the contacts of
/// one pair of bodies: positions and normals are looked at, and depths play no part. Which ones stay does not depend on the
/// policy, on threads or on the order of `all`. Of contacts that are as good as each other the one with the smallest ids
/// stays.
///
/// `binning` brings positions to [-1, 1], about the middle of the box around them and by half its longest side. It cuts
/// [-1, 1]^6 of positions and normals into `bins` cells an axis. Of a cell the contact stays whose six numbers are farthest
/// from 0. `extremes`, the default, keeps contacts whose wrench (normal, and its torque about that middle) reaches farthest.
/// docs/contacts.md says how much of the cone of wrenches either keeps. Of meshes take contacts without the sideways ones,
/// which only seem to hold the bodies apart.
///
/// Throws error where bins is not in 1..1024, or another than 8 with `extremes`, or most is 0, and capacity_error for 2^32
/// contacts or more.
///
///     const auto few = abut::reduce_contacts(on, abut::contacts(on, a, b, {.discard_sideways = true}), {.most = 4});
template <execution_policy Policy, scalar T>
[[nodiscard]] auto reduce_contacts(const Policy& on, const result<contact<T>, space_of<Policy>>& all,
                                   const reduce_options& options = {}) {
    using outcome = result<contact<T>, space_of<Policy>>;
    if (options.bins < 1 || options.bins > 1024) {
        throw error("abut::reduce_contacts: bins is " + std::to_string(options.bins) + ", not in 1..1024");
    }
    if (options.bins != reduce_options().bins && options.method != contact_reduction::binning) {
        throw error("abut::reduce_contacts: bins is " + std::to_string(options.bins) +
                    ", which is for binning; expected .method = abut::contact_reduction::binning beside it");
    }
    if (options.most == 0) throw error("abut::reduce_contacts: most is 0");
    const std::size_t n = all.size();
    if (n == 0) return outcome();
    if (n > 0xffffffff)
        throw capacity_error("abut::reduce_contacts: " + std::to_string(n) + " contacts, more than 2^32 - 1");
    const aabb<T> box = reduce(on, n, empty_box<T>(), detail::merge_boxes{}, detail::position_box<T>{all.data()});
    const auto frame = detail::contact_math::contact_frame::around(box);
    auto few = options.method == contact_reduction::binning ? detail::binned<Policy, T>(on, all.data(), n, frame, options)
                                                            : detail::extremes<Policy, T>(on, all.data(), n, frame, options);
    synchronize(on);
    return outcome(std::move(few));
}
/// Contacts of many bodies, or of the entries of a list, are refused: which stay is told of one pair of bodies.
template <execution_policy Policy, class Found, memory_space Space>
    requires(!std::same_as<Found, contact<std::remove_cvref_t<decltype(Found::depth)>>>)
void reduce_contacts(const Policy&, const result<Found, Space>&, const reduce_options& = {}) {
    static_assert(std::same_as<Found, void>, "abut: reduce_contacts takes the contacts of one pair of bodies, a result of contact: those that "
                                             "contacts(on, a, b) has of the two");
}

///@}

}  // namespace abut
