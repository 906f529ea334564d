// SPDX-License-Identifier: MIT
#include <abut/shape/relative_pose.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "support/catch.hpp"
#include "support/hulls.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"
#include "support/touching.hpp"

using namespace abut;
using rational = boost::multiprecision::cpp_rational;

namespace {

constexpr aabb<double> unit_box{{-1, -1, -1}, {1, 1, 1}};
constexpr rigid<double> turned(double x) { return {{0, -1, 0, 1, 0, 0, 0, 0, 1}, {x, 0, 0}}; }
static_assert(overlaps(unit_box, make_relative_pose(rigid<double>{}, unit_box, turned(2), unit_box), unit_box));
static_assert(!overlaps(unit_box, make_relative_pose(rigid<double>{}, unit_box, turned(2 + 1e-13), unit_box), unit_box));

struct tally {
    std::uint64_t touching = 0, lost[3] = {}, kept_apart = 0;

    tally& operator+=(const tally& o) {
        touching += o.touching;
        kept_apart += o.kept_apart;
        for (int i = 0; i < 3; ++i) lost[i] += o.lost[i];
        return *this;
    }
};

/// Shapes that meet in the world by an exact oracle, in boxes that end where they meet: no test may tell the boxes apart.
template <class T>
void check_touching(bool extreme) {
    const auto body = [extreme](std::uint64_t first, std::uint64_t last, tally& sum) {
        for (std::uint64_t i = first; i < last; ++i) {
            test::draws d(test::sample_seed, extreme ? 11 : 10, i);
            const test::posed_contact<T> c = test::make_posed_contact<T>(d, extreme);
            const relative_pose<T> pose = make_relative_pose(c.pose_a, c.box_a, c.pose_b, c.box_b);
            const bool kept[3] = {overlaps<box_axes::of_a>(c.box_a, pose, c.box_b),
                                  overlaps<box_axes::faces>(c.box_a, pose, c.box_b),
                                  overlaps<box_axes::all>(c.box_a, pose, c.box_b)};
            if (!c.meet()) {
                sum.kept_apart += kept[2];
                continue;
            }
            ++sum.touching;
            for (int k = 0; k < 3; ++k) sum.lost[k] += !kept[k];
        }
    };
    const std::uint64_t n = 4 * test::sample_count();
    const tally sum = test::in_threads<tally>(n, body);
    std::printf("boxes under poses, %s%s: n %llu, touching %llu, lost %llu %llu %llu\n", sizeof(T) == 4 ? "float" : "double",
                extreme ? ", extreme" : "", static_cast<unsigned long long>(n),
                static_cast<unsigned long long>(sum.touching), static_cast<unsigned long long>(sum.lost[0]),
                static_cast<unsigned long long>(sum.lost[1]), static_cast<unsigned long long>(sum.lost[2]));
    CHECK(sum.lost[0] == 0);
    CHECK(sum.lost[1] == 0);
    CHECK(sum.lost[2] == 0);
    CHECK(sum.touching > n / 4);
}

template <class T>
bool meet(const sphere<T>& a, const sphere<T>& b) {
    const rational x = rational(a.center.x) - rational(b.center.x), y = rational(a.center.y) - rational(b.center.y),
                   z = rational(a.center.z) - rational(b.center.z), reach = rational(a.radius) + rational(b.radius);
    return x * x + y * y + z * z <= reach * reach;
}

/// Balls that touch in the world, or nearly do, in their boxes. Their radii stay where poses stretch or shrink all else;
/// where one pose shrinks what the other stretches, their relative pose is a rotation that knows nothing of it.
template <class T>
void check_balls() {
    const auto body = [](std::uint64_t first, std::uint64_t last, tally& sum) {
        using namespace test::construction;
        for (std::uint64_t i = first; i < last; ++i) {
            test::draws d(test::sample_seed, 12, i);
            const double from_origin = d.power_of_ten(-4, 1);
            rigid<T> pose_a = test::make_loose_pose<T>(d, 0), pose_b = test::make_loose_pose<T>(d, 0);
            if (d.below(2) == 0) {
                const double by = d.power_of_ten(-6, 0) * 0.49 * rotation_tolerance;
                const double stretch[3][3] = {{by, 0, 0}, {0, by, 0}, {0, 0, by}},
                             shrink[3][3] = {{-by, 0, 0}, {0, -by, 0}, {0, 0, -by}};
                pose_a = strained(test::make_rotation<T>(d), stretch);
                pose_b = strained(test::make_rotation<T>(d), shrink);
            }
            const sphere<T> a{round_to<T>(cube(d, from_origin)), rounded_to<T>(d.power_of_ten(-5, 1))};
            sphere<T> b{{}, rounded_to<T>(d.power_of_ten(-3, 1))};
            // Along an axis of a's, or of b's, in the world, or along any; apart by the radii but for some roundings.
            const int axis = d.below(9);
            const point n = unit(axis < 3   ? widened(detail::column(pose_a.rotation, axis))
                                 : axis < 6 ? widened(detail::column(pose_b.rotation, axis - 3))
                                            : cube(d, 1));
            const sphere<T> there = place(pose_a, a);
            const double apart = (static_cast<double>(a.radius) + static_cast<double>(b.radius)) *
                                 (1 - d.uniform(-1, 3) * static_cast<double>(unit_roundoff<T>));
            const point center = along(widened(there.center), apart, n);
            pose_b.translation = round_to<T>(along(center, d.power_of_ten(-4, 0), cube(d, 1)));
            b.center = placed_at(d, pose_b, round_to<T>(center));
            if (!meet(there, place(pose_b, b))) continue;
            ++sum.touching;
            const aabb<T> box_a = bounds(a), box_b = bounds(b);
            const relative_pose<T> b_to_a = make_relative_pose(pose_a, box_a, pose_b, box_b),
                                   a_to_b = make_relative_pose(pose_b, box_b, pose_a, box_a);
            sum.lost[0] += !overlaps<box_axes::of_a>(box_a, b_to_a, box_b) + !overlaps<box_axes::of_a>(box_b, a_to_b, box_a);
            sum.lost[1] +=
                !overlaps<box_axes::faces>(box_a, b_to_a, box_b) + !overlaps<box_axes::faces>(box_b, a_to_b, box_a);
            sum.lost[2] += !overlaps<box_axes::all>(box_a, b_to_a, box_b) + !overlaps<box_axes::all>(box_b, a_to_b, box_a);
        }
    };
    const std::uint64_t n = 4 * test::sample_count();
    const tally sum = test::in_threads<tally>(n, body);
    CHECK(sum.touching > n / 4);
    for (const std::uint64_t lost : sum.lost) CHECK(lost == 0);
}

}  // namespace

TEMPLATE_TEST_CASE("relative_pose: no boxes of balls are told apart that meet in the world", "", float, double) {
    check_balls<TestType>();
}

TEMPLATE_TEST_CASE("relative_pose: no two boxes are told apart whose shapes meet in the world", "", float, double) {
    check_touching<TestType>(false);
    check_touching<TestType>(true);
}
