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

constexpr aabb<double> cube{{-1, -1, -1}, {1, 1, 1}};
constexpr rigid<double> turned(double x) { return {{0, -1, 0, 1, 0, 0, 0, 0, 1}, {x, 0, 0}}; }
static_assert(overlaps(cube, make_relative_pose(rigid<double>{}, cube, turned(2), cube), cube));
static_assert(!overlaps(cube, make_relative_pose(rigid<double>{}, cube, turned(2 + 1e-13), cube), cube));

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
            test::draws d(test::seed, extreme ? 11 : 10, i);
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

}  // namespace

TEMPLATE_TEST_CASE("relative_pose: no two boxes are told apart whose shapes meet in the world", "", float, double) {
    check_touching<TestType>(false);
    check_touching<TestType>(true);
}
