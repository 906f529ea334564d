// SPDX-License-Identifier: MIT
#pragma once

// Shapes one after another in memory of their own, to be sent to another rank: most as they are, hulls as points and where
// each one's begin. What came is a view of a set again.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <abut/collide/parts.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/copy_view.hpp>
#include <abut/shape/hulls.hpp>
#include <abut/shape/set.hpp>
#include <abut/shape/view.hpp>

#include <mpi.h>

namespace abut::detail {

/// Whether room is for a message, or for values that stay.
enum class in_message : bool {
    no,
    yes
};

/// Room for values of a message: in the policy's memory, and where that is not the host's, on the host as well. Whoever uses
/// what came waits for the policy before the room is used again.
template <class Policy, class T>
class message_room {
public:
    message_room(const Policy& policy, std::size_t n, in_message is = in_message::yes)
        : direct_(host_policy<Policy> || mpi_reads_devices()),
          there_(policy, n),
          here_(serial{}, host_policy<Policy> || is == in_message::no ? 0 : n) {
        if (direct_) synchronize(policy);
    }

    /// In the policy's memory.
    [[nodiscard]] T* there() { return there_.data(); }
    /// For MPI, which may write there from the beginning, and read there after bring_here.
    [[nodiscard]] T* here() { return direct_ ? there_.data() : here_.data(); }
    void bring_here(const Policy& on, std::size_t n) {
        direct_ ? synchronize(on) : download(on, there_.data(), n, here_.data());
    }
    void bring_there(const Policy& on, std::size_t n) {
        if (!direct_) upload(on, here_.data(), n, there_.data());
    }
    /// What came, as the host reads it.
    [[nodiscard]] const T* on_host(const Policy& on, std::size_t n) {
        if constexpr (host_policy<Policy>) return there_.data();
        if (direct_) download(on, there_.data(), n, here_.data());
        return here_.data();
    }
    /// Where nothing could be written: values of any kind are sent, from memory of the host.
    ///@{
    void give_up() { direct_ = host_policy<Policy>; }
    void give_up(std::size_t n) {
        give_up();
        std::fill_n(here(), n, T{});
    }
    ///@}
    /// What is in the policy's memory, for good.
    [[nodiscard]] execution::buffer_of<Policy, T> take() { return std::move(there_); }

private:
    bool direct_;  ///< MPI is given addresses in the policy's memory
    execution::buffer_of<Policy, T> there_;
    execution::buffer<T, host_space> here_;
};

/// Room for shapes, in the policy's memory and for MPI.
template <class Policy, class Shape>
class packed_shapes {
public:
    /// The number of shapes, and what else a message has to say of its length.
    using sizes = std::array<std::uint64_t, 1>;
    using set = shapes<Shape, space_of<Policy>>;
    using element = Shape;

    packed_shapes(const Policy& policy, const sizes& most, in_message is) : shapes_(policy, length(most), is) {}

    /// Of shapes that are chosen for a part.
    template <class Chosen, scalar T>
    static sizes measure(const Policy& on, Chosen& chosen, const part_bounds<T>& there) {
        return of_length(chosen.count(on, there));
    }
    /// Of shapes with n ids.
    template <shape_view Shapes>
    static sizes measure(const Policy&, const Shapes&, const std::uint32_t*, std::size_t n) {
        return of_length(n);
    }
    /// Writes the shapes with n ids.
    template <shape_view Shapes>
    void pack(const Policy& on, const Shapes& all, const std::uint32_t* ids, std::size_t n) {
        for_each_index(on, n, pack_shape<Shapes>{all, ids, shapes_.there()});
    }
    /// Writes what another room has, from `at` on, which is advanced.
    void put(const Policy& on, packed_shapes& from, const sizes& size, sizes& at) {
        copy(on, from.shapes_.there(), length(size), shapes_.there() + at[0]);
        at[0] += size[0];
    }

    void give_up() { shapes_.give_up(); }
    void bring_here(const Policy& on, const sizes& size) { shapes_.bring_here(on, length(size)); }
    void bring_there(const Policy& on, const sizes& size) { shapes_.bring_there(on, length(size)); }
    /// f(address for MPI, number, MPI type) for each array; `type` is that of an element.
    template <class F>
    void hand_over(const sizes& size, const message_type<element>& type, const F& f) {
        f(shapes_.here(), size[0], type.get());
    }
    [[nodiscard]] auto view(const sizes& size) { return typename set::view_type(shapes_.there(), length(size)); }
    /// All that there was room for.
    [[nodiscard]] set take() { return set_parts::shapes_of(shapes_.take()); }

private:
    static std::size_t length(const sizes& size) { return static_cast<std::size_t>(size[0]); }
    static sizes of_length(std::uint64_t n) {
        sizes size;  // not {n}: nvcc 13.0 hands that to the host's compiler without braces
        size[0] = n;
        return size;
    }
    message_room<Policy, Shape> shapes_;
};

// --- hulls -------------------------------------------------------------------------------------------------------------

template <shape_view Hulls>
struct count_points {
    Hulls hulls;
    const std::uint32_t* ids;
    ABUT_HD std::uint64_t operator()(std::size_t i) const { return hulls[ids[i]].count; }
};
template <shape_view Hulls>
struct write_counts {
    count_points<Hulls> count;
    std::uint32_t* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = static_cast<std::uint32_t>(count(i)); }
};
/// Points where they are in the world.
template <shape_view Hulls>
struct pack_points {
    using T = typename Hulls::scalar_type;
    Hulls hulls;
    const std::uint32_t* ids;
    const std::uint32_t* offsets;
    vec3<T>* out;
    ABUT_HD void operator()(std::size_t i) const {
        const hull<T> h = hulls[ids[i]];
        for (std::size_t k = 0; k < h.count; ++k) out[offsets[i] + k] = h[k];
    }
};
struct move_offset {
    const std::uint32_t* from;
    std::uint32_t first;
    std::uint32_t* to;
    ABUT_HD void operator()(std::size_t i) const { to[i] = first + from[i]; }
};

/// Of hulls their points. What is asked of a hull is asked of its points in the world, so those of a posed set are sent as
/// they are there.
template <class Policy, scalar T>
class packed_shapes<Policy, hull<T>> {
public:
    /// The number of hulls, and of their points.
    using sizes = std::array<std::uint64_t, 2>;
    using set = hulls<T, space_of<Policy>>;
    using element = vec3<T>;

    packed_shapes(const Policy& policy, const sizes& most, in_message is)
        : offsets_(policy, length(most) + 1, is), points_(policy, static_cast<std::size_t>(most[1]), is) {}

    template <class Chosen>
    static sizes measure(const Policy& on, Chosen& chosen, const part_bounds<T>& there) {
        return as_set({chosen.count(on, there), chosen.count_points(on, there)});
    }
    template <shape_view Hulls>
    static sizes measure(const Policy& on, const Hulls& all, const std::uint32_t* ids, std::size_t n) {
        return as_set({n, reduce(on, n, std::uint64_t{0}, add_up_tallies{}, count_points<Hulls>{all, ids})});
    }
    template <shape_view Hulls>
    void pack(const Policy& on, const Hulls& all, const std::uint32_t* ids, std::size_t n) {
        for_each_index(on, n, write_counts<Hulls>{{all, ids}, offsets_.there()});
        exclusive_scan(on, offsets_.there(), n);
        for_each_index(on, n, pack_points<Hulls>{all, ids, offsets_.there(), points_.there()});
    }
    void put(const Policy& on, packed_shapes& from, const sizes& size, sizes& at) {
        const auto first = static_cast<std::uint32_t>(at[1]);
        for_each_index(on, length(size) + 1, move_offset{from.offsets_.there(), first, offsets_.there() + at[0]});
        copy(on, from.points_.there(), static_cast<std::size_t>(size[1]), points_.there() + at[1]);
        for (const std::size_t k : {0u, 1u}) at[k] += size[k];
    }

    void give_up() {
        offsets_.give_up();
        points_.give_up();
    }
    void bring_here(const Policy& on, const sizes& size) {
        offsets_.bring_here(on, length(size) + 1);
        points_.bring_here(on, static_cast<std::size_t>(size[1]));
    }
    void bring_there(const Policy& on, const sizes& size) {
        offsets_.bring_there(on, length(size) + 1);
        points_.bring_there(on, static_cast<std::size_t>(size[1]));
    }
    template <class F>
    void hand_over(const sizes& size, const message_type<element>& type, const F& f) {
        f(offsets_.here(), size[0] + 1, MPI_UINT32_T);
        f(points_.here(), size[1], type.get());
    }
    [[nodiscard]] auto view(const sizes& size) {
        return typename set::view_type(points_.there(), static_cast<std::size_t>(size[1]), offsets_.there(), length(size));
    }
    [[nodiscard]] set take() { return set_parts::hulls_of(points_.take(), offsets_.take()); }

private:
    static std::size_t length(const sizes& size) { return static_cast<std::size_t>(size[0]); }
    /// Hulls of a view may share points, of which a set then has too many.
    static sizes as_set(const sizes& size) {
        check_count(static_cast<std::size_t>(size[1]), "abut::distributed: points of hulls for another rank");
        return size;
    }
    message_room<Policy, std::uint32_t> offsets_;
    message_room<Policy, vec3<T>> points_;
};

/// What a message of such shapes says of its length.
template <class Shape>
using sizes_of_shapes = typename packed_shapes<serial, Shape>::sizes;

}  // namespace abut::detail
