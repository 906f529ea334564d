// SPDX-License-Identifier: MIT
#pragma once

// `nearest` for many points and a tree: points that lie near each other look together.

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <abut/arithmetic/lanes.hpp>
#include <abut/collide/judge.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/group.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/narrow/nearest_point.hpp>
#include <abut/shape/point_reach.hpp>
#include <abut/traverse/group_walk.hpp>

namespace abut::detail {

/// Of a shape's corners, seen from where p is seen too, the one that is nearest to p.
template <scalar T>
struct corner_near {
    vec3<T> at;
    T square = infinity<T>, size = 0, longest = 0;  ///< squares: from p, of the farthest corner, of the longest edge

    template <int N>
    ABUT_HD corner_near(const corners_from<T, N>& seen, const vec3<T>& p) : at(seen.at[0]) {
        for (int k = 0; k < N; ++k) {
            const vec3<T> way = seen.at[k] - p, edge = seen.at[k] - seen.at[k + 1 < N ? k + 1 : 0];
            size = greatest(size, dot(seen.at[k], seen.at[k]));
            longest = greatest(longest, dot(edge, edge));
            if (dot(way, way) < square) square = dot(way, way), at = seen.at[k];
        }
    }
};

/// Groups that are left for walks of single points.
struct single_groups {
    std::uint8_t* is;               ///< whether a group is, of each
    std::uint32_t *end, *how_many;  ///< their numbers, before an end, and how many these are

    /// Of a group of `count` points. All are where nearly all are.
    [[nodiscard]] ABUT_HD bool has(std::size_t number, std::size_t count) const {
        const std::size_t groups = (count + execution::subgroup_size - 1) / execution::subgroup_size;
        return is[number] != 0 || std::size_t{execution::atomic_load(how_many)} * 16 > groups * 15;
    }
    /// Once.
    ABUT_HD void add(std::size_t number) const {
        if (is[number] == 2) return;
        is[number] = 2;
        *(end - 1 - execution::atomic_add(how_many, 1u)) = static_cast<std::uint32_t>(number);
    }
};

/// As many points as a subgroup has members look for their nearest shapes. What their box and a corner near its middle leave
/// over, a node or a shape for each member, comes to a list, which the members share. Each member tests its point with each
/// shape of the list, by bounds that take little (shape/corners.hpp), and so its limit shrinks. The pairs that are left are
/// shared out, and tested once more by what the limits are by then. What is left is measured, a pair for each member.
///
/// Some groups lie around what is as near to them on all sides, such as the middle of a tube, and find long lists. Their
/// points are left for a second run, in which each looks by itself, with all members of a group. Groups that are left for walks
/// of single points are passed over: those of shape_near_each, and the others where few are left, which nobody else would wait for.
template <bvh_layout Tree, class Frame, shape_view Shapes, shape_view Points, class Judge>
struct nearest_to_group {
    using T = typename Points::scalar_type;
    using shape_type = typename Shapes::shape_type;
    static_assert(measuring_judge<Judge, shape_type, typename Points::shape_type>);
    using walk_type = group_tree_walk<Tree>;
    using seen_shape = seen_shape_of<shape_type>;
    /// most_lists: full ones, after which a group is left for the second run.
    static constexpr unsigned members = execution::subgroup_size, room = 2 * members, most_lists = 24;
    struct waiting_pair {
        T at_least;
        std::uint32_t id, point;
    };
    struct measured {
        double value;
        std::uint32_t id;
    };
    struct shared {
        typename walk_type::shared walk;
        group_reach<T> reach;
        seen_corner<T> corner;           ///< the witness of the reach
        T corner_square;                 ///< of its way from the middle
        std::uint32_t next_witness;      ///< a shape that has a better one
        vec3<T> world[members];          ///< the points
        seen_corner<T> points[members];  ///< -2 p, where p is the point as seen from the middle, and its limit
        seen_shape shapes[room];         ///< the list
        std::uint16_t pairs[members * (members + 1)];
        waiting_pair waiting[2 * members];
        measured values[members];
        std::uint32_t mine[members];  ///< of each point, bits of values
    };
    using group = execution::group<shared, members>;
    walk_type walk;
    Frame frame;
    Shapes shapes;
    Points points;
    Judge judge;
    const std::uint32_t* order;
    std::size_t count;
    execution::least_value* out;
    const std::uint32_t* near;   ///< a shape near each point
    single_groups single;        ///< groups that are left for walks of single points
    std::uint32_t* left;         ///< numbers of groups that are left for the second run; null in that
    std::uint32_t* count_left;   ///< how many these are
    const std::uint32_t* alone;  ///< the groups of the second run, and null in the first

    ABUT_HD void operator()(const group& all) const {
        shared& memory = all.shared;
        const std::size_t number = all.first / members;
        if (alone == nullptr && all.first < count && single.has(number, count)) {
            all.each([&](unsigned k) {
                if (k == 0) single.add(number);
            });
            return;
        }
        const std::size_t first = alone == nullptr ? all.first : std::size_t{members} * alone[number / members] + number % members;
        if (first >= count) return;
        const unsigned there = alone != nullptr ? 1 : static_cast<unsigned>(count - first < members ? count - first : members);

        all.each([&](unsigned k) {
            const std::size_t i = first + (k < there ? k : 0);
            memory.world[k] = points[order == nullptr ? i : order[i]];
        });
        const aabb<T> around = box_around(all, [&](unsigned k) { return memory.world[k]; });
        const vec3<T> middle = T(0.5) * around.lower + T(0.5) * around.upper;
        const vec3<T> half = (1 + 8 * unit_roundoff<T>) * greatest(around.upper - middle, middle - around.lower);
        // What squares of distances lose to underflow, where lengths have a large unit.
        const T underflow = 4 * square_from(judge.unit, 0);
        const T far_squared = (1 + 16 * unit_roundoff<T>) * dot(half, half) + underflow / slack_of_squares<T>;
        aabb<T> in_frame = around;
        T lost_in_frame = 0;
        if constexpr (!std::is_same_v<Frame, world_frame<T>>) {
            in_frame = box_around(all, [&](unsigned k) { return frame.ball_around(memory.world[k]).center; });
            lost_in_frame = -all.least([&](unsigned k) { return -T(frame.ball_around(memory.world[k]).map.slack); });
            lost_in_frame += 4 * unit_roundoff<T> * lost_in_frame;
        }
        const auto look_past = [&](std::uint32_t id) {
            const auto shape = shapes[id];
            const seen_corners_of<shape_type> corners(shape, {0, 0, 0}), seen(shape, middle);
            T size = 0, nearest = infinity<T>;
            vec3<T> witness = corners.at[0], seen_witness = seen.at[0];
            for (int k = 0; k < corners_of_shape<shape_type>; ++k) {
                const T square = dot(seen.at[k], seen.at[k]);
                size = greatest(size, square);
                if (square < nearest) nearest = square, witness = corners.at[k], seen_witness = seen.at[k];
            }
            shrinking_ball<T> to = frame.ball_around(witness);
            to.map.slack = greatest(to.map.slack, static_cast<double>(lost_in_frame));
            const seen_corner<T> corner(seen_witness, size, far_squared);
            const group_reach<T> reach(in_frame, to.center, to.map, T(0x1p-44) * size + underflow);
            all.each([&](unsigned k) {
                if (k == 0) memory.reach = reach, memory.corner = corner, memory.corner_square = nearest;
            });
        };
        look_past(walk.shape_near(frame.ball_around(middle).center));
        all.each([&](unsigned k) {
            const vec3<T> minus_twice = T(-2) * (memory.world[k] - middle);
            T limit = memory.corner.at_most + dot(minus_twice, memory.corner.at);
            if (left != nullptr) {
                const auto shape = shapes[near[first + (k < there ? k : 0)]];
                const corner_near<T> own(seen_corners_of<shape_type>(shape, middle), memory.world[k] - middle);
                const seen_corner<T> corner(own.at, own.size, far_squared);
                limit = least(corner.at_most + dot(minus_twice, corner.at), limit);
            }
            memory.points[k] = {minus_twice, least(limit, infinity<T>)};  // not NaN
            memory.mine[k] = 0;
            if (k < there) out[first + k] = {};
        });

        unsigned listed = 0, waiting = 0, lists = 0;
        const auto measure = [&](unsigned begin, unsigned n) {
            all.each([&](unsigned k) {
                if (k >= n) return;
                const waiting_pair pair = memory.waiting[begin + k];
                if (pair.at_least > memory.points[pair.point].at_most) return;
                memory.values[k] = {judge.measure(shapes[pair.id], memory.world[pair.point]), pair.id};
                execution::set_bits_in_group(&memory.mine[pair.point], 1u << k);
            });
            all.each([&](unsigned k) {
                std::uint32_t bits = memory.mine[k];
                if (bits == 0) return;
                memory.mine[k] = 0;
                execution::least_value best = out[first + k];
                for (; bits != 0; bits &= bits - 1) {
                    const measured& one = memory.values[lowest_bit(bits)];
                    best.offer(one.value, one.id);
                }
                out[first + k] = best;
                seen_corner<T>& p = memory.points[k];
                const T square = square_from(judge.unit, best.value);
                const T most = square + slack_of_squares<T> * (square + far_squared) + 16 * smallest_normal<T>;
                p.at_most = least(most - T(0.25) * dot(p.at, p.at), p.at_most);
            });
        };
        const auto test_pairs = [&](unsigned begin, unsigned n) {
            all.each([&](unsigned k) {
                waiting_pair pair{};
                bool may_be = k < n;
                if (may_be) {
                    const seen_shape& shape = memory.shapes[memory.pairs[begin + k] / members];
                    const unsigned point = memory.pairs[begin + k] % members;
                    pair = {shape.least_from(memory.points[point].at), shape.id, point};
                    may_be = !(pair.at_least > memory.points[point].at_most);
                }
                all.append(waiting, may_be, [&](unsigned to) { memory.waiting[to] = pair; });
            });
        };
        const auto test_list = [&](bool is_last) {
            unsigned pairs = 0;
            for (unsigned begin = 0; begin == 0 || begin < listed; begin += members) {
                const unsigned end = begin + members < listed ? begin + members : listed;
                if (there > 1) {
                    all.each([&](unsigned k) {
                        seen_corner<T> p = memory.points[k];
                        std::uint32_t passing = 0;
                        for (unsigned i = begin; i < end; ++i) {
                            const T most = memory.shapes[i].most_from(p.at);
                            if (!(most - memory.shapes[i].spread > p.at_most)) passing |= 1u << (i - begin);
                            p.at_most = least(most, p.at_most);
                        }
                        memory.points[k].at_most = p.at_most;
                        all.append_bits(pairs, k < there ? passing : 0, [&](unsigned to, unsigned bit) {
                            memory.pairs[to] = static_cast<std::uint16_t>((begin + bit) * members + k);
                        });
                    });
                } else {
                    // A shape for each member, since there is one point.
                    const seen_corner<T> p = memory.points[0];
                    const T most = all.least([&](unsigned k) {
                        return begin + k < end ? least(memory.shapes[begin + k].most_from(p.at), infinity<T>) : infinity<T>;
                    });
                    const T limit = least(most, p.at_most);
                    all.each([&](unsigned k) {
                        if (k == 0) memory.points[0].at_most = limit;
                        const bool may_be = begin + k < end && !(memory.shapes[begin + k].least_from(p.at) > limit);
                        all.append(pairs, may_be, [&](unsigned to) {
                            memory.pairs[to] = static_cast<std::uint16_t>((begin + k) * members);
                        });
                    });
                }
                const bool is_end = begin + members >= listed;
                while (pairs >= members || (is_end && pairs > 0) || (is_end && is_last && waiting > 0)) {
                    const unsigned some = pairs < members ? pairs : members;
                    pairs -= some;
                    test_pairs(pairs, some);
                    if (waiting < members && !(is_end && is_last && pairs == 0)) continue;
                    const unsigned n = waiting < members ? waiting : members;
                    waiting -= n;
                    measure(waiting, n);
                }
            }
            ++lists;
        };
        // A corner that is nearer to the middle leaves less over.
        const auto look_past_nearest_of_list = [&] {
            typename group::template value<T> nearest;
            all.each([&](unsigned k) {
                nearest[k] = infinity<T>;
                for (unsigned i = k; i < listed; i += members) {
                    const vec3<T> corner = memory.shapes[i].corners[0].at;
                    const T square = dot(corner, corner);
                    if (square < nearest[k]) nearest[k] = square, memory.shapes[k].id = memory.shapes[i].id;
                }
            });
            const T least_of_all = all.least([&](unsigned k) { return nearest[k]; });
            if (!(least_of_all < memory.corner_square)) return;
            unsigned n = 0;
            all.each([&](unsigned k) {
                all.append(n, nearest[k] == least_of_all, [&](unsigned to) {
                    if (to == 0) memory.next_witness = memory.shapes[k].id;
                });
            });
            look_past(memory.next_witness);
        };
        walk(all, memory.walk, memory.reach, [&](const std::uint32_t* leaves, unsigned n, bool is_last) {
            all.each([&](unsigned k) {
                const std::uint32_t id = leaves[k < n ? k : 0];
                const seen_shape shape(seen_corners_of<shape_type>(shapes[id], middle), far_squared, id);
                all.append(listed, k < n && shape.may_be_nearer(half, memory.corner),
                           [&](unsigned to) { memory.shapes[to] = shape; });
            });
            if (listed <= room - members && !is_last) return true;
            test_list(is_last);
            const bool goes_on = left == nullptr || lists < most_lists || is_last;
            if (goes_on) {
                look_past_nearest_of_list();
            } else {
                all.each([&](unsigned k) {
                    if (k == 0) left[execution::atomic_add(count_left, 1u)] = static_cast<std::uint32_t>(number);
                });
            }
            listed = 0;
            return goes_on;
        });
    }

private:
    template <class F>
    ABUT_HD static aabb<T> box_around(const group& all, const F& f) {
        const auto least_of = [&](T vec3<T>::*x, T sign) {
            return sign * all.least([&](unsigned k) { return sign * (f(k).*x); });
        };
        return {{least_of(&vec3<T>::x, 1), least_of(&vec3<T>::y, 1), least_of(&vec3<T>::z, 1)},
                {least_of(&vec3<T>::x, -1), least_of(&vec3<T>::y, -1), least_of(&vec3<T>::z, -1)}};
    }
};

/// A shape near each point. Where all points of a group are close to theirs, next to its size, they have hardly more to look at
/// than that, and the group is left for walks of single points. (Where three of four are close was tried too: points far away took a
/// seventh longer.) A kernel of its own, so that all know how many groups are left.
template <bvh_layout Tree, class Frame, shape_view Shapes, shape_view Points>
struct shape_near_each {
    using T = typename Points::scalar_type;
    using shape_type = typename Shapes::shape_type;
    static constexpr unsigned members = execution::subgroup_size;
    /// A point is close to a shape whose longest edge has at least this part of the square of the way to a corner of it.
    static constexpr T close = T(0x1p-4);
    struct shared {};
    group_tree_walk<Tree> walk;
    Frame frame;
    Shapes shapes;
    Points points;
    const std::uint32_t* order;
    std::size_t count;
    std::uint32_t* near;
    single_groups single;

    ABUT_HD void operator()(const execution::group<shared, members>& all) const {
        const std::size_t first = all.first, number = first / members;
        if (first >= count) return;
        unsigned are_close = 0;
        all.each([&](unsigned k) {
            const std::size_t i = first + k < count ? first + k : first;
            const vec3<T> p = points[order == nullptr ? i : order[i]];
            const std::uint32_t id = walk.shape_near(frame.ball_around(p).center);
            if (first + k < count) near[i] = id;
            const corner_near<T> own(seen_corners_of<shape_type>(shapes[id], p), {0, 0, 0});
            all.append(are_close, own.square * close <= own.longest, [](unsigned) {});
        });
        all.each([&](unsigned k) {
            if (k != 0) return;
            single.is[number] = 0;
            if (are_close == members) single.add(number);
        });
    }
};

/// Whether a policy looks so. On a host each point finds its way sooner by itself: there none waits for another.
template <class Policy>
inline constexpr bool looks_in_groups = !host_policy<Policy>;
/// Whether it does so by a walk's tree. In trees of other volumes than boxes (bounded.hpp) each point looks alone.
template <class Policy, class Walk, class Shape>
concept look_in_groups = looks_in_groups<Policy> && has_corners<Shape> && requires(const Walk& walk) { walk.tree; } &&
    !requires(const Walk& walk) { walk.tree.volume(walk.tree.fetch(0), 0); };

/// The points of some groups, of n points in all. The last group may have fewer.
struct points_of_groups {
    const std::uint32_t* groups;  ///< their numbers
    std::size_t n;
    ABUT_HD std::size_t operator()(std::size_t i) const {
        constexpr unsigned members = execution::subgroup_size;
        return std::size_t{members} * groups[i / members] + i % members;
    }
};
/// The walks of these points.
template <class Walk>
struct walk_in_groups {
    Walk walk;
    points_of_groups point;
    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD void operator()(std::size_t i, Best& best) const {
        if (point(i) < point.n) walk(point(i), best);
    }
};
/// What they find, each where its point is.
template <memory_space Space>
struct best_in_groups {
    struct sink : execution::best_of_each<Space>::sink {
        points_of_groups point;
        ABUT_HD void end(std::size_t i) {
            if (point(i) < point.n) this->out[point(i)] = this->mine;
        }
    };
    execution::least_value* out;
    points_of_groups point;

    [[nodiscard]] sink make_sink(std::size_t /*thread*/) const { return {{out, execution::least_value{}.value}, point}; }
    template <class Policy>
    void begin(const Policy&, std::size_t /*threads*/) {}
    template <class Policy>
    void end(const Policy&) {}
};

/// For each point in the order of `order`, or in their own if that is null, the nearest shape. There are some points.
/// `by_itself` is the walk of a single point.
template <class Policy, bvh_layout Tree, class Frame, shape_view Shapes, shape_view Points, class Judge, class Alone>
auto nearest_in_groups(const Policy& on, const Tree& tree, const Frame& frame, const Shapes& shapes, const Points& points,
                       const Judge& judge, const std::uint32_t* order, const Alone& by_itself) {
    using group_type = nearest_to_group<Tree, Frame, Shapes, Points, Judge>;
    constexpr std::size_t members = group_type::members;
    const std::size_t n = points.size(), groups = n / members + 1;
    execution::buffer_of<Policy, execution::least_value> found(on, n);
    execution::buffer_of<Policy, std::uint32_t> numbers(on, groups + 2 + n);
    execution::buffer_of<Policy, std::uint8_t> is_single(on, groups);
    std::uint32_t *const left = numbers.data() + 2, *const end = left + groups, *const near = end;
    fill(on, numbers.data(), 2, 0u);
    const single_groups singles{is_single.data(), end, numbers.data() + 1};
    for_each_group(on, n, shape_near_each<Tree, Frame, Shapes, Points>{{tree}, frame, shapes, points, order, n, near, singles});
    group_type look{{tree}, frame, shapes, points, judge, order, n, found.data(), near, singles, left, numbers.data(), nullptr};
    for_each_group(on, n, look);
    std::uint32_t counts[2] = {};
    download(on, numbers.data(), 2, counts);
    look.alone = std::exchange(look.left, nullptr);
    for_each_group(on, members * members * counts[0], look);
    const points_of_groups single{end - counts[1], n};
    best_in_groups<space_of<Policy>> best{found.data(), single};
    for_each_ordered(on, members * counts[1], walk_in_groups<Alone>{by_itself, single}, best);
    return found;
}

}  // namespace abut::detail
