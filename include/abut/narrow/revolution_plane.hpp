// SPDX-License-Identifier: MIT
#pragma once

// A cylinder or a cone and a plane: how far apart they are, and where, or a point of both. Heights over the plane are
// linear, so that the least and the greatest are on a rim, at an apex or at an end. Heights of the ends are sums of two
// doubles, and a rim reaches r |n x a| beyond its centre, where n and a are the plane's normal and the axis, of length 1.

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/flat_contact.hpp>
#include <abut/narrow/length_unit.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/revolution_foot.hpp>
#include <abut/shape/primitive.hpp>

namespace abut::detail {

/// What is seen of a solid over a plane, in the common scale of both.
template <scalar T>
class revolution_over_plane {
public:
    /// The plane's normal is not 0. `unit` is any that the solid is measured in.
    template <solid_of_revolution S>
    ABUT_HD constexpr revolution_over_plane(const S& s, const plane<T>& p, const length_unit<T>& unit)
        : scale_(s, p),
          end_{{scale_(axis_of(s).a), scale_(axis_of(s).b)}},
          over_(p, end_.at, scale_),
          radius_(scale_(s.radius)) {
        using namespace contact_math;
        const revolution_profile solid(s, unit);
        normal_ = unit_vector(over_.normal);
        const point across = part_across(normal_, solid.axis);
        aside_ = unit_vector(as<one_double>(across));
        tilt_ = root(one_double{plain_dot(across, across)}).high;
        rim_[0] = solid.is_cone ? 0 : radius_;
        rim_[1] = radius_;
        exponent_ = over_.exponent < -2040 ? -2040 : over_.exponent > 2040 ? 2040 : over_.exponent;
        const int down = scale_.exponent - exponent_;
        down_ = down < -2040 ? -2040 : down;
        for (int i = 0; i < 2; ++i) {
            nearest_ = beyond(i) < beyond(nearest_) ? i : nearest_;
        }
    }

    /// If they do not touch; infinite where double has no number.
    [[nodiscard]] ABUT_HD constexpr double distance() const { return contact_math::scaled(beyond(nearest_), exponent_); }
    [[nodiscard]] ABUT_HD constexpr vec3<T> point_on_solid() const {
        return scale_.template back<T>(plain_step(end_.at[nearest_], toward(nearest_), aside_));
    }
    [[nodiscard]] ABUT_HD constexpr vec3<T> point_on_plane() const {
        using namespace contact_math;
        const two_doubles size = root(dot(over_.normal, over_.normal)), height = over_.height[nearest_];
        const double along = scaled(toward(nearest_), down_), sunk = plain_product(along, plain_dot(normal_, aside_));
        const auto foot = [&](double x, const two_doubles& n, double away, double unit_normal) {
            const two_doubles of_end = two_doubles::of(scaled(x, down_)) - height * (n / size);
            const double flat = plain_sum(plain_product(along, away), -plain_product(sunk, unit_normal));
            return rounded_within<T>(scaled((of_end + two_doubles::of(flat)).high, exponent_));
        };
        const point& from = end_.at[nearest_];
        return {foot(from.x, over_.normal.x, aside_.x, normal_.x), foot(from.y, over_.normal.y, aside_.y, normal_.y),
                foot(from.z, over_.normal.z, aside_.z, normal_.z)};
    }
    /// Of the lowest and the highest point, at the common scale unless they are far from touching.
    [[nodiscard]] ABUT_HD constexpr contact_math::extent heights() const {
        contact_math::extent e{infinity<double>, -infinity<double>};
        for (int i = 0; i < 2; ++i) {
            const double height = over_.height[i].high;
            e = {least(e.lower, plain_sum(height, -reach(i))), greatest(e.upper, plain_sum(height, reach(i)))};
        }
        return e;
    }
    [[nodiscard]] ABUT_HD constexpr const vec3<double>& normal() const { return normal_; }
    /// The lowest point, or the middle of two ends' lowest ones that are as low; and how far below the plane, a length.
    ///@{
    [[nodiscard]] ABUT_HD constexpr vec3<T> lowest_point() const {
        using namespace contact_math;
        const point low[2] = {plain_step(end_.at[0], -rim_[0], aside_), plain_step(end_.at[1], -rim_[1], aside_)};
        const double first = lowest(0), second = lowest(1);
        return scale_.template back<T>(first < second ? low[0] : second < first ? low[1] : middle_of({low[0], low[1]}));
    }
    [[nodiscard]] ABUT_HD constexpr double depth() const {
        return contact_math::scaled(-least(lowest(0), lowest(1)), exponent_);
    }
    ///@}
    /// If they touch: where the plane passes between the lowest and the highest point.
    [[nodiscard]] ABUT_HD constexpr vec3<T> shared_point() const {
        using namespace contact_math;
        point low{}, high{};
        double lowest = infinity<double>, highest = -infinity<double>;
        for (int i = 0; i < 2; ++i) {
            for (int side = -1; side < 2; side += 2) {
                const double height = plain_sum(over_.height[i].high, side * reach(i));
                const point z = plain_step(end_.at[i], side * rim_[i], aside_);
                if (height < lowest) lowest = height, low = z;
                if (height > highest) highest = height, high = z;
            }
        }
        const double t = lowest < 0 ? highest > 0 ? -lowest / plain_sum(highest, -lowest) : 1 : 0;
        return scale_.template back<T>(plain_step(low, t, plain_difference(high, low)));
    }

private:
    struct two_ends {
        contact_math::point at[2];
    };
    contact_math::common_scale scale_;
    two_ends end_;
    contact_math::plane_heights<2> over_;
    double radius_, tilt_ = 0, rim_[2]{};
    vec3<double> normal_{}, aside_{};
    int exponent_ = 0, down_ = 0, nearest_ = 0;

    /// How much higher and lower than an end's centre its rim is, in the unit of heights.
    [[nodiscard]] ABUT_HD constexpr double reach(int i) const {
        return plain_product(contact_math::scaled(rim_[i], down_), tilt_);
    }
    [[nodiscard]] ABUT_HD constexpr double lowest(int i) const { return plain_sum(over_.height[i].high, -reach(i)); }
    [[nodiscard]] ABUT_HD constexpr double beyond(int i) const {
        return plain_sum(absolute(over_.height[i].high), -reach(i));
    }
    /// How far along `aside_` the point of a rim is that is nearest to the plane.
    [[nodiscard]] ABUT_HD constexpr double toward(int i) const { return over_.height[i].high > 0 ? -rim_[i] : rim_[i]; }
};

}  // namespace abut::detail
