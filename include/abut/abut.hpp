// SPDX-License-Identifier: MIT
#pragma once

// All of abut for the serial and OpenMP policies. Nothing is needed but a C++20 compiler. <abut/cuda.hpp> adds CUDA.

/// @namespace abut
/// Everything that a program names, but for files.

#include <abut/arithmetic/self_test.hpp>
#include <abut/collide/advise.hpp>
#include <abut/collide/bodies.hpp>
#include <abut/collide/boundary.hpp>
#include <abut/collide/body_distance.hpp>
#include <abut/collide/body_pairs.hpp>
#include <abut/collide/body_rows.hpp>
#include <abut/collide/contact_patches.hpp>
#include <abut/collide/contacts.hpp>
#include <abut/collide/crossings.hpp>
#include <abut/collide/curves.hpp>
#include <abut/collide/distance.hpp>
#include <abut/collide/first_impact.hpp>
#include <abut/collide/impact_details.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/collide/hausdorff.hpp>
#include <abut/collide/hull_edges.hpp>
#include <abut/collide/inside.hpp>
#include <abut/collide/list.hpp>
#include <abut/collide/list_distance.hpp>
#include <abut/collide/list_each.hpp>
#include <abut/collide/mixed_bodies.hpp>
#include <abut/collide/mixed_list.hpp>
#include <abut/collide/mixed_questions.hpp>
#include <abut/collide/nearest.hpp>
#include <abut/collide/penetration.hpp>
#include <abut/collide/query.hpp>
#include <abut/collide/raycast.hpp>
#include <abut/collide/raycast_all.hpp>
#include <abut/collide/raycast_detailed.hpp>
#include <abut/collide/reduce_contacts.hpp>
#include <abut/collide/relation.hpp>
#include <abut/collide/row_each.hpp>
#include <abut/collide/safe_step.hpp>
#include <abut/collide/self_pairs.hpp>
#include <abut/collide/spans.hpp>
#include <abut/collide/sweep.hpp>
#include <abut/collide/touching_bodies.hpp>
#include <abut/collide/validate.hpp>
#include <abut/collide/welded_near.hpp>
#include <abut/collide/winding_number.hpp>
#include <abut/collide/within.hpp>
#include <abut/config.hpp>
#include <abut/error.hpp>
#include <abut/index/bounded.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/grid.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/index/leaf_ids.hpp>
#include <abut/index/quality.hpp>
#include <abut/index/quantised.hpp>
#include <abut/index/refit.hpp>
#include <abut/index/wide.hpp>
#include <abut/narrow/contact.hpp>
#include <abut/narrow/distance.hpp>
#include <abut/narrow/feature_weights.hpp>
#include <abut/narrow/impact_detail.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/narrow/time_of_impact.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/predicate/within.hpp>
#include <abut/shape/copy_view.hpp>
#include <abut/shape/features.hpp>
#include <abut/shape/hulls.hpp>
#include <abut/shape/motion.hpp>
#include <abut/shape/posed.hpp>
#include <abut/shape/set.hpp>
#include <abut/shape/volume.hpp>
#include <abut/shape/welded.hpp>
#include <abut/shape/xyz_view.hpp>
