// SPDX-License-Identifier: MIT
#include <abut/abut.hpp>

#include "collide/box_cases.hpp"

static_assert(abut::shape_set<abut::oriented_boxes<float>> && abut::shape_view<abut::oriented_boxes_view<double>>);
static_assert(abut::placeable<abut::aabb<float>> && abut::placeable<abut::oriented_box<double>>);

TEST_CASE("oriented boxes: pairs, serial") { abut::test::check_sets_of_boxes<float>(abut::serial{}); }
TEST_CASE("oriented boxes: pairs, openmp") { abut::test::check_sets_of_boxes<double>(abut::openmp{3}); }
TEST_CASE("oriented boxes: more queries, serial") { abut::test::check_more_of_boxes<double>(abut::serial{}); }
TEST_CASE("oriented boxes: more queries, openmp") { abut::test::check_more_of_boxes<float>(abut::openmp{3}); }
TEST_CASE("oriented boxes: scenes, serial") { abut::test::check_scenes_of_boxes<float>(abut::serial{}); }
TEST_CASE("oriented boxes: scenes, openmp") { abut::test::check_scenes_of_boxes<double>(abut::openmp{3}); }
