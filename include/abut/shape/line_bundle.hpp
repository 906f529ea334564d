// SPDX-License-Identifier: MIT
#pragma once

// Rays or segments that are asked together: what of a tree any of them may reach.
//
// Their origins lie in a box, and so do their directions. Where directions have one sign in a coordinate, the inverses of
// those lie between two numbers as well, and a plane is passed between two times, which are computed as those of a single
// ray (ray_reach.hpp), with one power of two for all. Rounded differences, products and inverses grow where exact ones do:
// so a box is entered no later, and left no earlier, than by any of the rays. That the largest coordinate of some of them
// may then be below 1 changes nothing: inverses are above 1/2 still, and below 2^-60 the planes say nothing.

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/lanes.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/arithmetic/strict.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/ray_reach.hpp>

namespace abut::detail {

/// Between what some lines lie; denormal numbers may be taken for 0.
template <scalar T, class Register = typename register_of<T>::type>
class line_bounds {
    using many = lanes<T, Register>;

public:
    double last;  ///< the latest time at which one ends
    T slack;

    ABUT_INLINE explicit line_bounds(const line_in_frame<T>& one)
        : last(one.last), slack(one.slack), origins_{in_lanes(one.origin), in_lanes(one.origin)},
          directions_{in_lanes(one.direction), in_lanes(one.direction)} {
        note_moves(one.direction);
    }
    ABUT_INLINE void add(const line_in_frame<T>& one) {
        const many origin = in_lanes(one.origin), direction = in_lanes(one.direction);
        origins_[0] = least(origin, origins_[0]);
        origins_[1] = greatest(origin, origins_[1]);
        directions_[0] = least(direction, directions_[0]);
        directions_[1] = greatest(direction, directions_[1]);
        note_moves(one.direction);
        last = greatest(last, one.last);
        slack = greatest(slack, one.slack);
    }
    [[nodiscard]] aabb<T> origins() const { return box_of(origins_); }
    [[nodiscard]] aabb<T> directions() const { return box_of(directions_); }

    /// Whether any direction is not 0 there, denormal ones neither.
    [[nodiscard]] bool moves(int axis) const { return static_cast<word>(bits_[axis] << 1) != 0; }

private:
    using word = typename float_format<T>::word;

    ABUT_INLINE void note_moves(const vec3<T>& direction) {
        bits_[0] |= ABUT_BIT_CAST(word, direction.x);
        bits_[1] |= ABUT_BIT_CAST(word, direction.y);
        bits_[2] |= ABUT_BIT_CAST(word, direction.z);
    }
    ABUT_INLINE static many in_lanes(const vec3<T>& v) { return many::of(v.x, v.y, v.z, 0); }
    static aabb<T> box_of(const many (&bounds)[2]) {
        T lower[4], upper[4];
        bounds[0].store(lower);
        bounds[1].store(upper);
        return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}};
    }

    many origins_[2], directions_[2];  ///< the least and the greatest
    word bits_[3] = {};                ///< of all directions
};

/// What lines between such bounds reach.
template <scalar T, class Register = typename register_of<T>::type>
class bundle_reach {
    using many = lanes<T, Register>;

public:
    explicit bundle_reach(const line_bounds<T>& lines) {
        constexpr T none = infinity<T>;
        const aabb<T> origins = lines.origins(), directions = lines.directions();
        const vec3<T>&down = directions.lower, &up = directions.upper;
        const vec3<T> size = greatest(absolute(down), absolute(up));
        const T largest = greatest(size.x, size.y, size.z);
        const bool is_safe = largest >= smallest_normal<T> && largest <= largest_finite<T>;
        const direction_scale<T> scale(is_safe ? largest : T(1));
        const T reach = lines.slack + 8 * smallest_normal<T>;  // of two origins that are flushed either may be the lesser
        const auto prepare = [&](int axis, T vec3<T>::*x, bool moves) {
            const T below = origins.upper.*x + reach, above = origins.lower.*x - reach;
            lower_[axis] = moves ? -none : above - reach;
            upper_[axis] = moves ? none : below + reach;
            is_narrow_ = is_narrow_ || !moves;

            const T lowest = scale.divide(down.*x), highest = scale.divide(up.*x);
            const bool back = highest < 0, forth = lowest > 0;
            const bool tells = is_safe && (back || forth) && least(absolute(lowest), absolute(highest)) >= T(0x1p-60);
            enters_[axis] = back ? axis + 3 : axis;
            leaves_[axis] = back ? axis : axis + 3;
            in_[axis] = !tells ? 0 : back ? above : below;
            out_[axis] = !tells ? none : back ? below : above;
            least_inverse_[axis] = tells ? 1 / highest : 0;
            greatest_inverse_[axis] = tells ? 1 / lowest : 0;
            told_ += tells || !moves;
        };
        prepare(0, &vec3<T>::x, lines.moves(0));
        prepare(1, &vec3<T>::y, lines.moves(1));
        prepare(2, &vec3<T>::z, lines.moves(2));
        limit_ = ray_reach<T>::limit_of(lines.last, scale.exponent);
    }

    /// In how many coordinates the planes of boxes say anything. In one alone, next to all boxes are reached.
    [[nodiscard]] int coordinates_told() const { return told_; }

    /// Of four boxes, by their planes (ray_reach_of_four), a bit for each that is reached, and when at the soonest, in times of
    /// these lines' own.
    [[nodiscard]] ABUT_INLINE unsigned reached(const T (&planes)[6][4], T (&to)[4]) const {
        constexpr T grown = 1 + 32 * unit_roundoff<T>, tiny = 4 * smallest_normal<T>;
        many entry = many::all(T(0)), exit = many::all(limit_);
        for (int k = 0; k < 3; ++k) {
            const many low = many::all(least_inverse_[k]), high = many::all(greatest_inverse_[k]),
                       in = many::load(planes[enters_[k]]) - many::all(in_[k]),
                       out = many::load(planes[leaves_[k]]) - many::all(out_[k]);
            entry = greatest(least(in * low, in * high), entry);
            exit = least(greatest(out * low, out * high), exit);  // none where the planes say nothing: no number is less
        }
        entry.store(to);
        auto apart = least(entry, many::all(ray_reach<T>::most)) > exit * many::all(grown) + many::all(tiny);
        if (is_narrow_) {
            for (int k = 0; k < 3; ++k) {
                apart = apart | (many::load(planes[k]) > many::all(upper_[k])) |
                        (many::all(lower_[k]) > many::load(planes[k + 3]));
            }
        }
        const decltype(apart) row[1] = {apart};
        return ~bits_of(row) & 0xfu;
    }

private:
    T in_[3], out_[3], least_inverse_[3], greatest_inverse_[3];
    T lower_[3], upper_[3];  ///< around the origins where all directions are 0, and infinite in other coordinates
    T limit_;
    int enters_[3], leaves_[3];  ///< which planes of a box are passed first and last
    int told_ = 0;
    bool is_narrow_ = false;
};

}  // namespace abut::detail
