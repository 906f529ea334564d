// SPDX-License-Identifier: MIT
#pragma once

// The steps of simulations and the stages of a query that bench/pair_rules.cpp and .cu measure, for each rule of pairs.
//
// A scene is a folder with frame0.ply and frame1.ply, one mesh at two times. Stages add up: each does all that the one
// before does.
//
//   index    the index, with its orphans where the rule has them
//   refit    the index of the same step from another one
//   walk     pairs of faces, or of features, whose boxes overlap
//   boxes    pairs of features whose boxes overlap; of trees over features they are the same
//   tests    the elementary test of each, with the time of those that touch
//   impacts  all of self_impacts: they are sorted and written as well

#include <cstdint>
#include <string>
#include <vector>

#include <abut/abut.hpp>
#include <abut/io/read.hpp>

namespace pair_rules {

using abut::pair_rule;
using step = abut::moving_set<abut::mesh<double>>;

/// The two share their faces.
inline step read_step(const std::string& folder) {
    const auto t0 = abut::io::read_mesh<double>(folder + "/frame0.ply"),
               t1 = abut::io::read_mesh<double>(folder + "/frame1.ply");
    (void)abut::moving(t0, t1);  // throws where they do not go together
    const auto places = t1.view().vertices;
    return {t0, t0.with_vertices(abut::serial{},
                                 std::vector<abut::vec3<double>>(places.first(), places.first() + places.count))};
}

inline constexpr const char* scenes[] = {"cloth-ball", "cloth-funnel", "armadillo-rollers", "n-body-simulation",
                                         "rod-twist"};

/// A judge by which none touch: what is left of a search is to find what it would judge.
struct let_none_touch {
    template <class S, class U>
    ABUT_HD abut::verdict decide(const S&, const U&) const {
        return abut::verdict::no;
    }
    template <class S, class U>
    ABUT_HD double time(const S&, const U&) const {
        return -1;
    }
    template <class S, class U>
    double time_on_host(const S&, const U&) const {
        return -1;
    }
};

/// Counts candidates.
struct count_candidate {
    ABUT_CALLS_ANY
    template <class Count>
    ABUT_HD bool operator()(std::uint64_t, Count& count) const {
        count.add(1);
        return true;
    }
    ABUT_HD void finish(std::uint64_t, auto&...) const {}
};

/// Counts pairs of faces that a rule does not leave out.
template <class Expand>
struct count_looked_at {
    Expand expand;
    ABUT_CALLS_ANY
    template <class Count>
    ABUT_HD bool operator()(std::uint64_t key, Count& count) const {
        count.add(expand.leaves_out(key) ? 0 : 1);
        return true;
    }
    ABUT_HD void finish(std::uint64_t, auto&...) const {}
};

/// All boxes overlap.
struct no_boxes {
    template <class T>
    ABUT_HD bool operator()(const abut::aabb<T>&, const abut::aabb<T>&) const {
        return true;
    }
};

template <class Index>
inline constexpr bool by_faces = requires(const Index& index) {
    index.parts();
};

/// The pairs of faces of a query within an index, and what tells of their features.
template <class Index>
auto faces_of(const Index& index) {
    const auto both = abut::detail::features_of_two<true>(index, index, "bench");
    return abut::detail::faces_of_one(index, both.key, abut::detail::near_enough_to_touch{});
}
/// The pairs of features of such a query by trees over features.
template <class Index>
auto features_of(const Index& index) {
    using namespace abut::detail;
    return feature_pairing<true, Index, near_enough_to_touch, no_fronts>(index, index, {}, {}, "bench");
}

/// The walk alone. Returns how many pairs it finds.
template <class Policy, class Index>
std::uint64_t walk(const Policy& on, const Index& index) {
    abut::execution::work_count<abut::space_of<Policy>> count(on);
    const auto judge = [&](const auto& pairing) {
        pairing.judge_candidates(on, [&](const auto& loop) { loop(count_candidate{}, count); });
    };
    if constexpr (by_faces<Index>) {
        judge(faces_of(index).first);
    } else {
        judge(features_of(index));
    }
    return count.total();
}

/// Takes what is pushed, and counts it.
template <class Count>
struct push_to_count {
    Count& count;
    ABUT_HD void push(std::uint64_t) const { count.add(1); }
};
template <class Expand>
struct count_features_of {
    Expand expand;
    ABUT_CALLS_ANY
    template <class Count>
    ABUT_HD bool operator()(std::uint64_t key, Count& count) const {
        const push_to_count<Count> counted{count};
        expand(key, counted);
        return true;
    }
    ABUT_HD void finish(std::uint64_t, auto&...) const {}
    ABUT_INLINE void prefetch(std::uint64_t key, int ahead) const { expand.prefetch(key, ahead); }
};
/// The pairs of features that pairs of faces tell.
template <class Policy, class Pairing, class Expand>
std::uint64_t count_features(const Policy& on, const Pairing& pairing, const Expand& expand) {
    abut::execution::work_count<abut::space_of<Policy>> count(on);
    pairing.judge_candidates(on, [&](const auto& loop) { loop(count_features_of<Expand>{expand}, count); });
    return count.total();
}

/// How many pairs of features touch by a judge.
template <class Policy, class Index, class Judge>
std::uint64_t search(const Policy& on, const Index& index, const Judge& judge) {
    using namespace abut::detail;
    timed_queue<Policy> hits(on, std::size_t{1} << 20);
    if constexpr (by_faces<Index>) {
        const auto both = features_of_two<true>(index, index, "bench");
        time_by_faces<true>(on, index, index, both, judge, near_enough_to_touch{}, hits);
    } else {
        search_times(on, features_of(index), judge, hits);
    }
    return hits.size();
}
/// On a host pairs are counted where they are found; on a device they are gathered, as a query does.
template <class Policy, class Index>
std::uint64_t boxes(const Policy& on, const Index& index) {
    if constexpr (!abut::host_policy<Policy>) {
        return search(on, index, let_none_touch{});
    } else if constexpr (by_faces<Index>) {
        const auto [pairing, expand] = faces_of(index);
        return count_features(on, pairing, expand);
    } else {
        return walk(on, index);
    }
}
template <class Policy, class Index>
std::uint64_t tests(const Policy& on, const Index& index) {
    return search(on, index, abut::detail::time_in_motion<abut::filtered>{});
}

/// What pairs a rule meets on the way, on a host: pairs of faces, and of features before and after their boxes are compared;
/// the orphans among these.
struct pair_counts {
    std::uint64_t faces = 0, looked_at = 0, features = 0, overlapping = 0, orphans = 0, overlapping_orphans = 0;
};

template <class Index>
pair_counts count_pairs(const Index& index) {
    using namespace abut::detail;
    const abut::serial on;
    pair_counts counts;
    if constexpr (by_faces<Index>) {
        const auto [pairing, expand] = faces_of(index);
        const auto without_boxes = [](const auto& e) {
            return expand_faces<true, decltype(e.a.faces), std::remove_cvref_t<decltype(e.rule)>, no_boxes>{
                e.a, e.b, e.faces, e.keys, e.rule, {}};
        };
        counts.faces = walk(on, index);
        abut::execution::work_count<abut::host_space> looked_at(on);
        pairing.judge_candidates(on, [&, &expand = expand](const auto& loop) {
            loop(count_looked_at<std::remove_cvref_t<decltype(expand)>>{expand}, looked_at);
        });
        counts.looked_at = looked_at.total();
        counts.features = count_features(on, pairing, without_boxes(expand));
        counts.overlapping = count_features(on, pairing, expand);
        if constexpr (Index::keeps_orphans) {
            const auto both = features_of_two<true>(index, index, "bench");
            for (const std::uint64_t key : index.orphans().keys.to_host()) {
                counts.overlapping_orphans += both.with_shapes(key, boxes_are_near<same_frame>{});
            }
            counts.orphans = index.orphans().keys.size();
        }
    } else {
        counts.features = counts.overlapping = walk(on, index);
    }
    return counts;
}

inline const char* name_of(pair_rule rule) {
    return rule == pair_rule::feature_trees              ? "feature_trees"
           : rule == pair_rule::representative_triangles ? "representatives"
                                                         : "orphan_sets";
}

}  // namespace pair_rules
