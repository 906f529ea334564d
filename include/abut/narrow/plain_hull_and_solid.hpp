// SPDX-License-Identifier: MIT
#pragma once

// A convex hull and a cylinder or a cone, as the search of gjk.hpp reads two hulls, in doubles whose operations are rounded
// one by one: for distances and contacts, which are the same bits on every device. Decisions have revolution_hull.hpp.

#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/narrow/directions.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/revolution_contact.hpp>
#include <abut/predicate/gjk.hpp>
#include <abut/shape/hull.hpp>

namespace abut::detail {

/// At a common scale, as seen from where the solid is seen from. Of the solid the points are those that were asked for.
template <scalar T>
class plain_hull_and_solid {
public:
    using number = contact_math::one_double;
    using point = contact_math::point;
    static constexpr int most_steps = 48;

    struct places {
        point at[most_steps + 2]{};
        std::uint32_t count = 0;
    };

    ABUT_HD constexpr plain_hull_and_solid(const hull<T>& h, const contact_math::seen_round_solid& solid,
                                           const point& origin, const contact_math::common_scale& scale, places& asked)
        : hull_(h), solid_(solid), origin_(origin), scale_(scale), asked_(asked) {}

    /// Where the search ends: at the nearest feature, or at a simplex that holds the origin, but for rounding. Out of line:
    /// inlined by nvcc 13.0, its result is in memory that the caller's next call writes to.
    [[nodiscard]] ABUT_NOINLINE ABUT_HD constexpr difference_simplex search() const {
        difference_simplex at;
        vec3<number> w[4];
        (void)search_origin<sought::nearest>(*this, at, w);
        return at;
    }
    /// The point of the hull that is farthest back along a way.
    [[nodiscard]] ABUT_HD constexpr std::uint32_t farthest_back(const point& way) const {
        double height = 0;
        return farthest_back(unit_along(way), height);
    }
    /// Whether no point is nearer along a way than a distance, but for a few 2^-53 of the shapes' size.
    [[nodiscard]] ABUT_HD constexpr bool is_nearest_along(const point& way, double distance) const {
        const point along = unit_along(way);
        double height = 0;
        (void)farthest_back(along, height);
        return plain_sum(height, -solid_.reach(along)) > plain_sum(scale_(distance), -0x1p-51);
    }

    [[nodiscard]] ABUT_HD constexpr vec3<number> difference(std::uint32_t i, std::uint32_t j) const {
        return contact_math::between<number>(asked_.at[j], seen(i));
    }
    ABUT_HD constexpr void look_back(const vec3<number>& way, std::uint32_t& i, std::uint32_t& j) const {
        const point along = contact_math::unit_vector(way);
        double height = 0;
        i = farthest_back(along, height);
        j = asked_.count++;
        asked_.at[j] = solid_.farthest(along);
    }
    [[nodiscard]] ABUT_HD constexpr vec3<number> way_between_middles() const {
        return contact_math::between<number>(solid_.end[0], seen(0));
    }
    [[nodiscard]] ABUT_HD constexpr bool are_apart(const vec3<number>&, std::uint32_t, std::uint32_t) const { return false; }
    ABUT_HD constexpr verdict holds_origin(const vec3<number> (&)[4], const difference_simplex&) const {
        return verdict::yes;
    }
    [[nodiscard]] ABUT_HD constexpr verdict when_lost(const difference_simplex&) const { return verdict::unknown; }

private:
    [[nodiscard]] ABUT_HD constexpr point seen(std::size_t k) const {
        return contact_math::plain_difference(scale_(hull_[k]), origin_);
    }
    [[nodiscard]] ABUT_HD static constexpr point unit_along(const point& way) {
        return contact_math::unit_vector(contact_math::as<number>(way));
    }
    [[nodiscard]] ABUT_HD constexpr std::uint32_t farthest_back(const point& along, double& height) const {
        std::uint32_t first = 0;
        height = infinity<double>;
        ABUT_ROLLED
        for (std::size_t k = 0; k < hull_.count; ++k) {
            const double x = contact_math::plain_dot(along, seen(k));
            if (x < height) height = x, first = static_cast<std::uint32_t>(k);
        }
        return first;
    }

    const hull<T>& hull_;
    const contact_math::seen_round_solid& solid_;
    const point& origin_;
    const contact_math::common_scale& scale_;
    places& asked_;
};

}  // namespace abut::detail
