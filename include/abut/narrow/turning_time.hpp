// SPDX-License-Identifier: MIT
#pragma once

// When two shapes of bodies that turn come together: never too late, and early by no more than a length, the tolerance. By
// conservative advancement: at a time the shapes' distance is bracketed by the search of Gilbert, Johnson and Keerthi in
// doubles; if it is within the tolerance, that is the time; and else they are apart for some time along the direction that
// the search ended with (shape/turning_reach.hpp). So the answer is a function of the two shapes, the motions and the
// tolerance alone.
//
// For points, segments, triangles, spheres, capsules, boxes, oriented boxes and hulls, which have a core of points.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_search.hpp>
#include <abut/predicate/hull_within.hpp>
#include <abut/shape/core.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/oriented_box.hpp>
#include <abut/shape/primitive.hpp>
#include <abut/shape/turning_reach.hpp>

namespace abut::detail {

/// Shapes that can turn.
template <class S>
concept turnable = has_core_points<S, scalar_type_of<S>>;

/// The points of a core in the body's frame, as seen from the centre of its motion.
template <scalar T>
class turned_core {
public:
    ABUT_HD turned_core(const hull<T>& h, const vec3<double>& centre) : of_(h), centre_(centre) {
        const std::size_t n = least(h.count, room);
        for (std::size_t i = 0; i < n; ++i) kept_[i] = seen(i);
    }
    [[nodiscard]] ABUT_HD std::size_t size() const { return of_.count; }
    [[nodiscard]] ABUT_HD vec3<double> operator[](std::size_t i) const { return i < room ? kept_[i] : seen(i); }
    [[nodiscard]] ABUT_HD vec3<double> farthest(const vec3<double>& n) const {
        vec3<double> best = kept_[0];
        double most = plain_dot(n, best);
        for (std::size_t i = 1; i < size(); ++i) {
            const vec3<double> p = (*this)[i];
            const double x = plain_dot(n, p);
            if (x > most) most = x, best = p;
        }
        return best;
    }
    /// Brings them to the world.
    ABUT_HD void move_to(const turned_frame& frame) {
        frame_ = frame;
        const std::size_t n = least(size(), room);
        for (std::size_t i = 0; i < n; ++i) placed_[i] = frame.place(kept_[i]);
    }
    /// The farthest one there.
    [[nodiscard]] ABUT_HD vec3<double> farthest_placed(const vec3<double>& n) const {
        if (size() > room) return frame_.place(farthest(frame_.back(n)));
        vec3<double> best = placed_[0];
        double most = plain_dot(n, best);
        for (std::size_t i = 1; i < size(); ++i) {
            const double x = plain_dot(n, placed_[i]);
            if (x > most) most = x, best = placed_[i];
        }
        return best;
    }
    /// Some point amid them there.
    [[nodiscard]] ABUT_HD vec3<double> middle() const {
        const std::size_t n = least(size(), room);
        vec3<double> sum = placed_[0];
        for (std::size_t i = 1; i < n; ++i) sum = plain_step(sum, 1.0, placed_[i]);
        const double share = 1 / static_cast<double>(n);
        return {plain_product(share, sum.x), plain_product(share, sum.y), plain_product(share, sum.z)};
    }
    /// No point is farther from the centre of the motion, where it is placed.
    [[nodiscard]] ABUT_HD double radius() const {
        double far = 0;
        for (std::size_t i = 0; i < size(); ++i) far = greatest(far, plain_dot((*this)[i], (*this)[i]));
        return plain_product(turning_bounds::stretch, std::sqrt(far));
    }
    /// As of a box: half the greatest second derivative of a point. The distance to the axis is the greatest of a corner.
    [[nodiscard]] ABUT_HD double bend(const rigid_motion& m, const turned_frame& at) const {
        if (m.angle == 0) return 0;
        double far = 0;
        for (std::size_t i = 0; i < size(); ++i) {
            const vec3<double> across = plain_cross(m.axis, at.turned((*this)[i]));
            far = greatest(far, plain_dot(across, across));
        }
        return plain_product(plain_product(0.5 * (1 + 0x1p-40), plain_product(m.angle, m.angle)), std::sqrt(far));
    }

private:
    static constexpr std::size_t room = 8;
    [[nodiscard]] ABUT_HD vec3<double> seen(std::size_t i) const { return plain_step(widened(of_[i]), -1.0, centre_); }

    const hull<T>& of_;
    vec3<double> centre_, kept_[room]{}, placed_[room]{};
    turned_frame frame_{};
};

/// When two shapes meet, and how far apart they are then, no farther than that. Infinite where they do not meet.
struct turning_time {
    double time = infinity<double>;
    double distance = infinity<double>;
};

/// The search for it.
template <scalar T>
class turning_search {
    using point = vec3<double>;

public:
    ABUT_HD turning_search(const hull<T>& a, double radius_a, const hull<T>& b, double radius_b, const turning_pair& both,
                           double tolerance)
        : both_(both),
          a_(a, both.a.centre),
          b_(b, both.b.centre),
          bounds_(both, a_.radius(), b_.radius()),
          radius_(plain_sum(radius_a, radius_b)),
          tolerance_(tolerance) {}

    /// The time, where it is not after `until`; else one that may be infinite. They are known to be farther apart than the
    /// tolerance before `from`.
    ///
    /// The way is searched in parts of 2^-6, each by itself, and what is found in the first that has something is the time.
    /// So it is the same wherever a search begins: what is known to be far apart has nothing. A part takes at most
    /// most_steps steps: after so many shapes have come as near as the tolerance for long, or that is far below what doubles
    /// tell; what is said then is not late.
    [[nodiscard]] ABUT_HD turning_time find(double from, double until) {
        for (int part = part_of(from); part < parts;) {
            const turning_time found = look_in(part, until);
            if (part < 0 || found.time <= 1) return found;
        }
        return {};
    }

    /// Whether they touch at a time, but for so little that a search has to end there at the latest.
    [[nodiscard]] ABUT_HD bool touch_at(double time) {
        move_to(time);
        along_ = plain_step(b_.middle(), -1.0, a_.middle());
        return nearest() <= 0.5 * bounds_.margin;
    }

private:
    static constexpr int parts = 64, most_steps = 1 << 12;
    using ahead_type = gap_ahead<turned_core<T>, turned_core<T>>;

    ABUT_HD void move_to(double time) {
        frame_a_ = both_.a.frame(time);
        frame_b_ = both_.b.frame(time);
        a_.move_to(frame_a_);
        b_.move_to(frame_b_);
    }
    [[nodiscard]] ABUT_HD static int part_of(double time) {
        const int part = static_cast<int>(time * parts);
        return part < parts ? part : parts - 1;
    }
    /// What is in a part; and the part in which to go on, which is negative where nothing is by `until`.
    [[nodiscard]] ABUT_HD turning_time look_in(int& part, double until) {
        const double begin = static_cast<double>(part) / parts, end = static_cast<double>(part + 1) / parts;
        double time = begin;
        for (int step = 0;; ++step) {
            move_to(time);
            bend_ = plain_sum(a_.bend(both_.a, frame_a_), b_.bend(both_.b, frame_b_));
            if (step == 0) {
                along_ = plain_step(b_.middle(), -1.0, a_.middle());
                if (is_passed(time, until, part)) return {};
            }
            const double distance = nearest();
            if (distance <= plain_sum(tolerance_, -bounds_.margin)) return {time, greatest(distance, 0.0)};
            if (is_passed(time, until, part)) return {};
            const double left = plain_sum(end, -time), ahead = has_way() ? way_ahead(radius_).free_for(left) : 0;
            if (ahead >= left) {
                ++part;
                return {};
            }
            if (!(plain_sum(time, ahead) > time) || step >= most_steps) return {time, distance};
            time = plain_sum(time, ahead);
        }
    }
    /// Whether they are farther apart than the tolerance until `until`, or as far as into another part: then that is the
    /// part.
    [[nodiscard]] ABUT_HD bool is_passed(double time, double until, int& part) const {
        if (!(until >= time)) {
            part = -1;
            return true;
        }
        if (!has_way()) return false;
        const double left = plain_sum(until, -time);
        const ahead_type far = way_ahead(plain_sum(radius_, tolerance_));
        const double free = far.free_for(left);
        const bool is_past = left > 0 ? free >= left : far.after(0).gap > 0;
        const int next = part_of(plain_sum(time, free));
        if (!is_past && next <= part) return false;
        part = is_past ? -1 : next;
        return true;
    }
    [[nodiscard]] ABUT_HD bool has_way() const { return contact_math::largest_of(along_) > 0x1p-400; }
    [[nodiscard]] ABUT_HD ahead_type way_ahead(double radius) const {
        const double length = plain_length(along_);
        return {a_,     b_,   both_, bounds_, frame_a_, frame_b_, {along_.x / length, along_.y / length, along_.z / length},
                radius, bend_};
    }

    /// How far apart they are, at most, less the radii; it is at least a little less, along the direction that is left, if
    /// that is more than the tolerance.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD double nearest() {
        using namespace contact_math;
        plain_simplex at;
        point along = has_way() ? along_ : point{1, 0, 0};
        double most = infinity<double>, least = -infinity<double>;
        constexpr int most_searched = 48;
        for (int step = 0; step < most_searched; ++step) {
            const double of_along = plain_length(along);
            if (!(of_along > 0x1p-400)) break;
            const point p = a_.farthest_placed(along), q = b_.farthest_placed(negated(along)), w = plain_difference(q, p);
            const double gap = plain_dot(along, w) / of_along;
            if (gap > least) least = gap, along_ = along;
            // A share of what is left between the shapes is enough to go on.
            if (step > 0 && plain_sum(most, -least) <= plain_product(0x1p-5, plain_sum(most, -radius_))) break;
            const auto result = at.append(p, q, w);
            if (result == plain_simplex::result::holds_origin) return -radius_;
            if (result != plain_simplex::result::nearer) break;
            along = at.along;
            most = root(one_double{at.square}).high;
            if (plain_sum(most, -radius_) <= plain_product(0.5, tolerance_)) break;
        }
        return plain_sum(most, -radius_);
    }

    const turning_pair& both_;
    turned_core<T> a_, b_;
    turning_bounds bounds_;  ///< of these two, and not of all in a tree
    double radius_, tolerance_, bend_ = 0;
    turned_frame frame_a_{}, frame_b_{};
    point along_{0, 0, 0};
};

/// f(search) of two shapes of bodies in motion.
template <turnable S, turnable U, class F>
ABUT_HD auto with_turning_search(const S& s, const U& t, const turning_pair& both, double tolerance, const F& f) {
    const auto points_a = core_points_of(s);
    const auto points_b = core_points_of(t);
    const hull<scalar_type_of<S>>&a = points_a.as_hull(), &b = points_b.as_hull();  // perhaps of what is made here
    turning_search<scalar_type_of<S>> search(a, static_cast<double>(radius_around_core(s)), b,
                                             static_cast<double>(radius_around_core(t)), both, tolerance);
    return f(search);
}
/// When two shapes of bodies in motion meet, if not after `until`. They are farther apart than the tolerance before `from`.
template <turnable S, turnable U>
ABUT_NOINLINE ABUT_HD turning_time turning_time_of(const S& s, const U& t, const turning_pair& both, double tolerance,
                                                   double from = 0, double until = 1) {
    return with_turning_search(s, t, both, tolerance, [&](auto& search) { return search.find(from, until); });
}
/// Whether two shapes touch at a time, for certain but for rounding: then they meet.
template <turnable S, turnable U>
ABUT_NOINLINE ABUT_HD bool touch_at_time(const S& s, const U& t, const turning_pair& both, double tolerance, double time) {
    return with_turning_search(s, t, both, tolerance, [&](auto& search) { return search.touch_at(time); });
}

}  // namespace abut::detail
