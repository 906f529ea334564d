// SPDX-License-Identifier: MIT
#pragma once

// Arguments of each form for each executor, by their types alone: matrix.py compiles calls with them and runs none. What needs CUDA is
// stood for by a policy with memory of its own, so that any compiler of C++20 can be asked. Ranks need MPI.

#include <variant>
#include <vector>

#include <abut/abut.hpp>
#include <abut/collide/async.hpp>
#include <abut/devices/bodies.hpp>
#include <abut/devices/distance.hpp>
#include <abut/devices/impacts.hpp>
#include <abut/devices/query.hpp>
#include <abut/devices/rows.hpp>
#include <abut/devices/solids.hpp>
#include <abut/mpi.hpp>

#include "../devices/host_team.hpp"
#include "../support/fenced.hpp"

namespace ask {

using abut::device_space, abut::host_space, abut::replicated, abut::test::fenced;
using on_devices = abut::test::host_team<fenced>;

template <class X>
const X& some();
const auto use = [](auto) { return abut::visit::proceed; };
const auto use_there = [](int) { return use; };

template <class Policy, class Space>
using tree_of = decltype(abut::make_bvh(some<Policy>(), some<abut::mesh<float, Space>>()));
template <class Policy, class Space>
using small_of = decltype(abut::quantised(some<Policy>(), some<tree_of<Policy, Space>>()));

/// What all executors but several devices take alike.
template <class Policy, class Space, class Tree = tree_of<Policy, Space>, class Small = small_of<Policy, Space>>
struct arguments {
    static const Tree& tree;
    static const std::vector<abut::posed_pair<Tree, Tree>>& list;
    static const std::vector<std::variant<abut::posed_pair<Tree, Tree>, abut::posed_pair<Tree, Small>>>& mixed_list;
    static const abut::bodies<Tree>& scene;
    static const abut::mixed_bodies<Tree, Small>& mixed;
    static const abut::moving_set<abut::mesh<float, Space>>& step;
    static const abut::bodies_motion<Tree>& way;
    static const std::vector<abut::moving_pair<Tree, Tree>>& ways;
    static const abut::points<float, Space>& points;
    static const abut::rays<float, Space>& lines;
    static const abut::spheres<float, Space>& rows;
    static const abut::shapes<abut::swept<abut::sphere<float>>, Space>& balls;
    static constexpr auto visitor = use;
};

struct processor : arguments<abut::serial, host_space> {
    static const abut::serial& on;
    static const abut::mesh<float>& faces;
    static const abut::triangle<float>& face;
    static const decltype(abut::wide(on, tree))& broad;
    static const decltype(abut::quantised(on, tree))& small;
    static const decltype(abut::make_grid(on, some<abut::spheres<float>>()))& buckets;
    static const decltype(abut::posed(tree, abut::rigid<float>{}))& placed;
};

struct cuda : arguments<fenced, device_space> {
    static const fenced& on;
};

template <class Outcome>
struct stream : arguments<fenced, device_space> {
    static const abut::async<fenced, Outcome>& on;
};

struct devices {
    static const on_devices& on;
    using part = tree_of<fenced, device_space>;
    using small = small_of<fenced, device_space>;
    static const replicated<part>& tree;
    static const decltype(abut::make_bvh(on, abut::divide(on, some<abut::mesh<float>>())))& divided;
    static const std::vector<abut::posed_pair<replicated<part>, replicated<part>>>& list;
    static const std::vector<std::variant<abut::posed_pair<replicated<part>, replicated<part>>,
                                          abut::posed_pair<replicated<part>, replicated<small>>>>& mixed_list;
    static const replicated<abut::bodies<part>>& scene;
    static const abut::mixed_bodies<part, small>& mixed;
    static const decltype(abut::make_impact_index(on, some<abut::moving_set<abut::mesh<float>>>()))& step;
    static const replicated<abut::bodies_motion<part>>& way;
    static const std::vector<abut::moving_pair<replicated<part>, replicated<part>>>& ways;
    static const replicated<abut::points<float, device_space>>& points;
    static const replicated<abut::rays<float, device_space>>& lines;
    static const replicated<abut::spheres<float, device_space>>& rows;
    static const replicated<abut::shapes<abut::swept<abut::sphere<float>>, device_space>>& balls;
    static constexpr auto visitor = use_there;
};

struct ranks : arguments<abut::serial, host_space> {
    static const abut::distributed<abut::serial>& on;
};

}  // namespace ask
