// SPDX-License-Identifier: MIT
#include <abut/collide/distance.hpp>
#include <abut/collide/nearest.hpp>

#include "collide/revolution_distance_cases.hpp"
#include "support/catch.hpp"

using namespace abut;

namespace {

/// Planes that pass beside all of them.
template <class Solid>
void check_planes_beside(std::uint64_t seed) {
    using T = scalar_type_of<Solid>;
    test::uniform random(seed);
    test::distance_counts counts;
    const shapes<Solid> set(test::shape_maker<Solid>(random, false)(40));
    auto beside = test::shape_maker<plane<T>>(random, false)(40);
    for (plane<T>& p : beside) p = {p.normal, 8 + p.offset};
    test::check_distance(serial{}, shapes<plane<T>>(beside), set, counts);
    test::check_distance(openmp{3}, set, shapes<plane<T>>(beside), counts);
    CHECK(counts.touching == 0);
}

}  // namespace

TEST_CASE("distance: sets of cylinders") {
    test::check_distance_of<cylinder<float>, triangle<float>>(serial{}, 251);
    test::check_distance_of<segment<double>, cylinder<double>>(openmp{3}, 252);
    test::check_distance_of<cylinder<double>, vec3<double>>(serial{}, 253);
    test::check_distance_of<sphere<float>, cylinder<float>>(openmp{3}, 254);
    test::check_distance_of<cylinder<float>, aabb<float>>(serial{}, 255);
    test::check_distance_of<plane<double>, cylinder<double>>(serial{}, 256);
    check_planes_beside<cylinder<float>>(257);
}

TEST_CASE("distance: sets of cylinders, with each other and with capsules") {
    test::check_distance_of<cylinder<float>, cylinder<float>>(openmp{3}, 231);
    test::check_distance_of<cylinder<double>, cylinder<double>>(serial{}, 232);
    test::check_distance_of<cylinder<double>, capsule<double>>(openmp{3}, 233);
    test::check_distance_of<capsule<float>, cylinder<float>>(serial{}, 234);
}

TEST_CASE("distance: sets of cones") {
    test::check_distance_of<triangle<double>, cone<double>>(serial{}, 261);
    test::check_distance_of<cone<float>, segment<float>>(openmp{3}, 262);
    test::check_distance_of<vec3<float>, cone<float>>(serial{}, 263);
    test::check_distance_of<cone<double>, sphere<double>>(serial{}, 264);
    test::check_distance_of<cone<double>, aabb<double>>(openmp{3}, 265);
    test::check_distance_of<plane<float>, cone<float>>(serial{}, 266);
    check_planes_beside<cone<double>>(267);
}

TEST_CASE("distance: sets of cones, with each other, with cylinders and with capsules") {
    test::check_distance_of<cone<float>, cone<float>>(openmp{3}, 235);
    test::check_distance_of<cone<double>, cone<double>>(serial{}, 236);
    test::check_distance_of<cylinder<double>, cone<double>>(openmp{3}, 237);
    test::check_distance_of<cone<float>, cylinder<float>>(serial{}, 238);
    test::check_distance_of<cone<double>, capsule<double>>(openmp{3}, 239);
    test::check_distance_of<capsule<float>, cone<float>>(serial{}, 240);
}

TEST_CASE("distance: posed cylinders and cones, and lists of them") {
    test::check_distance_of_posed_solids<cylinder<float>>(serial{}, 271);
    test::check_distance_of_posed_solids<cylinder<double>>(openmp{3}, 272);
    test::check_distance_of_posed_solids<cone<float>>(openmp{3}, 273);
    test::check_distance_of_posed_solids<cone<double>>(serial{}, 274);
}

TEST_CASE("nearest: cylinders and cones") {
    test::check_nearest_of<cylinder<float>>(serial{}, 281);
    test::check_nearest_of<cylinder<double>>(openmp{3}, 282);
    test::check_nearest_of<cone<float>>(openmp{3}, 283);
    test::check_nearest_of<cone<double>>(serial{}, 284);
    test::uniform random(285);
    const shapes<cone<float>> set(test::shape_maker<cone<float>>(random, true)(60));
    const auto points = test::points_around<float>(80, random, {});
    const auto few = test::nearest_few_by_definition(set.view(), points, detail::length_unit<float>{}, 7);
    CHECK(to_host(nearest(openmp{3}, make_bvh(serial{}, set), points, 7)) == few);
    CHECK(to_host(nearest(serial{}, set, points, 7)) == few);
}
