// SPDX-License-Identifier: MIT
#pragma once

// The points of a hull as a search sees them, kept from one scan for the farthest of them to the next: placed, subtracted
// and in the search's numbers already, and coordinate by coordinate, so that a host takes four at a time (lanes.hpp). There
// is room for the first few hundred, on the stack; a search reads what is beyond from the hull each time. A device keeps
// none, since its stack is memory that is far away, and constant expressions neither. Nor is any kept of a hull of many
// points that has edges: it is climbed (hull_climb.hpp).
//
// All is computed as of one point after another, but for sums: products are rounded before they are added, so that nothing
// is contracted, and of equal heights the first one counts.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/lanes.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/vec.hpp>
#include <abut/config.hpp>
#include <abut/predicate/hull_climb.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/rigid.hpp>

namespace abut::detail {

template <scalar F, scalar T>
class kept_points {
public:
    static constexpr std::size_t room = ABUT_DEVICE_CODE ? 0 : 512;
    /// Of so many points, hulls with edges are climbed, in doubles, where yes or no is asked, or how far apart they are; and where
    /// numbers of shapes that touch, or of solids are, with which faces across the way are common. Fewer are read in less time.
    static constexpr std::size_t fewest_climbed = 128, fewest_climbed_for_numbers = 384;

    /// Those of a hull, its first ones, where they are in the world. What of the arrays they leave stays as it is: to clear
    /// it would take longer than a scan.
    ABUT_HD constexpr explicit kept_points(const hull<T>& h, std::size_t fewest_to_climb = fewest_climbed) {
        if constexpr (may_climb) {
            if (!ABUT_CONSTANT_EVALUATED() && h.edges != nullptr && h.count >= fewest_to_climb) {
                climb_.begin(h);
                is_climbed_ = true;
                size_ = h.count;
                return;
            }
        }
#if !ABUT_DEVICE_CODE
        if (!ABUT_CONSTANT_EVALUATED() && h.count >= fewest) take(h);
#endif
    }
    /// How many there are.
    [[nodiscard]] ABUT_HD constexpr std::size_t size() const { return size_; }
    [[nodiscard]] ABUT_HD constexpr vec3<F> operator[](std::size_t i) const {
        if constexpr (may_climb) {
            if (is_climbed_) return climb_[i];
        }
        return {x_[i], y_[i], z_[i]};
    }

    /// Calls change(p) of each, which says what becomes of it. Of those of a hull that is climbed none is left.
    template <class Change>
    ABUT_HD constexpr void replace(const Change& change) {
        if (is_climbed_) return leave();
        for (std::size_t i = 0; i < filled(); ++i) set(i, change((*this)[i]));
    }
    /// As they are seen from another point: their differences, rounded.
    ABUT_HD constexpr void see_from(const vec3<F>& origin) {
        if constexpr (may_climb) {
            if (is_climbed_) return climb_.see_from(origin);
        }
#if !ABUT_DEVICE_CODE
        if (size_ == 0) return;
        const vec3<four> from = in_registers(origin);
        for (std::size_t i = 0; i < filled(); i += 4) store(i, load(i) - from);
#endif
    }
    /// The smallest box around them.
    [[nodiscard]] ABUT_HD constexpr aabb<F> box() const {
        if constexpr (may_climb) {
            if (is_climbed_) return climb_.box();
        }
        aabb<F> around = empty_box<F>();
#if !ABUT_DEVICE_CODE
        if (size_ == 0) return around;
        vec3<four> lower = load(0), upper = lower;
        for (std::size_t i = 4; i < filled(); i += 4) {
            const vec3<four> p = load(i);
            lower = least(p, lower);
            upper = greatest(p, upper);
        }
        around = {{least_of(lower.x), least_of(lower.y), least_of(lower.z)},
                  {greatest_of(upper.x), greatest_of(upper.y), greatest_of(upper.z)}};
#endif
        return around;
    }
    /// Whether the points are not kept but climbed, so that their box takes time to find.
    [[nodiscard]] ABUT_HD constexpr bool are_climbed() const { return is_climbed_; }
    /// The smallest box around some of them where they are climbed, or around all.
    [[nodiscard]] ABUT_HD constexpr aabb<F> inner_box() const {
        if constexpr (may_climb) {
            if (is_climbed_) return climb_.inner_box();
        }
        return box();
    }
    /// The largest magnitude of a coordinate; 0 of no points.
    [[nodiscard]] ABUT_HD constexpr F largest() const {
        if constexpr (may_climb) {
            if (is_climbed_) return climb_.largest();
        }
        if (size_ == 0) return 0;
        const aabb<F> around = box();
        const vec3<F> far = greatest(absolute(around.lower), absolute(around.upper));
        return greatest(far.x, far.y, far.z);
    }
    /// No less than that, and where it takes time to find not much more.
    [[nodiscard]] ABUT_HD constexpr F size_of_all() const {
        if constexpr (may_climb) {
            if (is_climbed_) return climb_.size();
        }
        return largest();
    }
    /// As many times a point that is about in their middle. If the hull is not climbed, their sum, in some order.
    [[nodiscard]] ABUT_HD constexpr vec3<F> sum() const {
        vec3<F> total{0, 0, 0};
        if constexpr (may_climb) {
            if (is_climbed_) return static_cast<F>(size_) * climb_.middle();
        }
#if !ABUT_DEVICE_CODE
        if (size_ == 0) return total;
        vec3<four> sums = all(total);
        std::size_t i = 0;
        for (; i + 4 <= size_; i += 4) sums = sums + load(i);
        total = {sum_of(sums.x), sum_of(sums.y), sum_of(sums.z)};
        for (; i < size_; ++i) total = total + (*this)[i];
#endif
        return total;
    }
    /// Where a point has a lesser product with the way than `least` is: the least product, and the first that has it.
    ABUT_HD constexpr void look_back(const vec3<F>& way, F& least, std::uint32_t& first) const {
        if constexpr (may_climb) {
            if (is_climbed_) return climb_.look_back(way, least, first);
        }
#if !ABUT_DEVICE_CODE
        if (size_ > 0) scan(way, least, first);
#endif
    }

private:
    static constexpr std::size_t block = 8, fewest = 4;
    static constexpr bool may_climb = std::same_as<F, double>;

    ABUT_HD constexpr void leave() {
        is_climbed_ = false;
        size_ = 0;
    }
    ABUT_HD constexpr void set(std::size_t i, const vec3<F>& p) {
        x_[i] = p.x;
        y_[i] = p.y;
        z_[i] = p.z;
    }
    /// With repetitions of the first point, which fill up a block.
    [[nodiscard]] ABUT_HD constexpr std::size_t filled() const { return (size_ + block - 1) / block * block; }

#if !ABUT_DEVICE_CODE
    using four = lanes<F>;

    ABUT_HD void take(const hull<T>& h) {
        constexpr bool later = std::same_as<T, double> && std::same_as<F, double>;  // four at a time
        size_ = h.count < room ? h.count : room;
        const void* const first = h.points;
        const auto* at = static_cast<const unsigned char*>(first);
        for (std::size_t i = 0; i < size_; ++i, at += h.stride) {
            vec3<T> p = *static_cast<const vec3<T>*>(static_cast<const void*>(at));
            if (!later && h.is_placed) p = place(h.pose, p);
            set(i, {static_cast<F>(rounded(p.x)), static_cast<F>(rounded(p.y)), static_cast<F>(rounded(p.z))});
        }
        for (std::size_t i = size_; i < filled(); ++i) set(i, (*this)[0]);
        if constexpr (later) {
            if (h.is_placed) place_all(h.pose);
        }
    }
    /// As `place` does a point.
    ABUT_HD void place_all(const rigid<double>& pose) {
        const vec3<four> x = all(row(pose.rotation, 0)), y = all(row(pose.rotation, 1)), z = all(row(pose.rotation, 2)),
                         shift = in_registers(pose.translation);
        for (std::size_t i = 0; i < filled(); i += 4) {
            const vec3<four> p = load(i);
            store(i, vec3<four>{product(x, p), product(y, p), product(z, p)} + shift);
        }
    }
    ABUT_HD void scan(const vec3<F>& way, F& lowest, std::uint32_t& first) const {
        const vec3<four> along = all(way);
        four in_block[room / block], low = four::all(lowest);
        for (std::size_t i = 0; i < size_; i += block) {
            const four here = least(product(along, load(i)), least(product(along, load(i + 4)), four::all(lowest)));
            in_block[i / block] = here;
            low = least(here, low);
        }
        const F found = least_of(low);
        if (!(found < lowest)) return;
        lowest = found;
        const four bound = four::all(found);
        std::size_t i = 0;
        while (bits_of({in_block[i / block] <= bound}) == 0) i += block;
        const unsigned here = bits_of({product(along, load(i)) <= bound}) | bits_of({product(along, load(i + 4)) <= bound})
                                                                                << 4;
        first = static_cast<std::uint32_t>(i + lowest_bit(here));
    }

    ABUT_INLINE ABUT_HD static vec3<four> all(const vec3<F>& p) { return {four::all(p.x), four::all(p.y), four::all(p.z)}; }
    /// The same of what a caller may have computed, which is contracted into nothing.
    ABUT_INLINE ABUT_HD static vec3<four> in_registers(const vec3<F>& p) {
        return {rounded(four::all(p.x)), rounded(four::all(p.y)), rounded(four::all(p.z))};
    }
    [[nodiscard]] ABUT_INLINE ABUT_HD vec3<four> load(std::size_t i) const {
        return {four::load_aligned(x_ + i), four::load_aligned(y_ + i), four::load_aligned(z_ + i)};
    }
    ABUT_INLINE ABUT_HD void store(std::size_t i, const vec3<four>& p) {
        p.x.store(x_ + i);
        p.y.store(y_ + i);
        p.z.store(z_ + i);
    }
    ABUT_INLINE ABUT_HD static four product(const vec3<four>& way, const vec3<four>& p) {
        return (rounded(way.x * p.x) + rounded(way.y * p.y)) + rounded(way.z * p.z);
    }
    ABUT_INLINE ABUT_HD static F least_of(const four& numbers) {
        F x[4];
        numbers.store(x);
        return least(least(x[0], x[1]), least(x[2], x[3]));
    }
    ABUT_INLINE ABUT_HD static F greatest_of(const four& numbers) {
        F x[4];
        numbers.store(x);
        return greatest(greatest(x[0], x[1]), greatest(x[2], x[3]));
    }
    ABUT_INLINE ABUT_HD static F sum_of(const four& numbers) {
        F x[4];
        numbers.store(x);
        return (x[0] + x[1]) + (x[2] + x[3]);
    }
#endif

    static constexpr std::size_t held = room > 0 ? room + block : 1;

    std::size_t size_ = 0;
    bool is_climbed_ = false;
    hull_climb<T> climb_;
    alignas(16) F x_[held], y_[held], z_[held];
};

}  // namespace abut::detail
