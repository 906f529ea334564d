// SPDX-License-Identifier: MIT
#pragma once

// Parts of sets that lie on several ranks or devices: where each is, and which shapes of one come near another.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <abut/collide/nearness.hpp>
#include <abut/collide/operand.hpp>
#include <abut/collide/options.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/group.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/curve_order.hpp>
#include <abut/index/lbvh.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/equal_elements.hpp>
#include <abut/shape/posed.hpp>
#include <abut/shape/reach.hpp>
#include <abut/shape/view.hpp>
#include <abut/traverse/bvh_walk.hpp>
#include <abut/traverse/even_nodes.hpp>
#include <abut/traverse/traversal.hpp>

namespace abut::detail {

/// Boxes around groups of neighbours in a part. One box would do; where ids follow space, several leave out more.
inline constexpr std::size_t part_boxes = 16;

/// A part of a set, as the others know it.
template <scalar T>
struct part_bounds {
    std::uint64_t size = 0;
    aabb<T> around = empty_box<T>();
    aabb<T> groups[part_boxes];  ///< empty ones where there are fewer shapes

    /// Whether something in the box may touch a shape of the part.
    [[nodiscard]] ABUT_HD bool reaches(const aabb<T>& box) const {
        if (!overlaps(around, box)) return false;
        bool reached = false;
        for (std::size_t k = 0; k < part_boxes; ++k) reached |= overlaps(groups[k], box);
        return reached;
    }
    /// Whether shapes of two parts may touch.
    [[nodiscard]] bool is_near(const part_bounds& other) const {
        return std::any_of(other.groups, other.groups + part_boxes, [this](const aabb<T>& box) { return reaches(box); });
    }
};

/// All that comes so near to a part (nearness.hpp), or to a box: the boxes, grown.
template <scalar T, class Frame>
aabb<T> grown(const aabb<T>& box, const near_by<T, Frame>& near) {
    return box.lower.x <= box.upper.x ? near_reach<T, Frame>{box, near.frame}.bounds() : box;
}
template <scalar T, class Frame>
part_bounds<T> grown(part_bounds<T> part, const near_by<T, Frame>& near) {
    part.around = grown(part.around, near);
    for (aabb<T>& box : part.groups) box = grown(box, near);
    return part;
}
template <class Bounds>
const Bounds& grown(const Bounds& bounds, const near_enough_to_touch&) {
    return bounds;
}
/// Of pairs whose boxes touch: what comes near enough to a part, or to a box.
struct as_near_as_boxes {
    template <class Bounds>
    const Bounds& operator()(const Bounds& bounds) const {
        return bounds;
    }
};
/// What comes as near as a distance along a straight line.
template <class Bounds, scalar T>
Bounds grown_by(const Bounds& bounds, T distance) {
    return grown(bounds, near_in_distance<T>{distance_frame<T>(distance)});
}

/// A part as another one knows it that looks closely: by boxes around a thousand shapes or more each, too, where there are
/// some.
template <scalar T, memory_space Space>
struct close_bounds {
    part_bounds<T> part;
    bvh_view<T, Space> boxes;  ///< a tree over these boxes; of none where nothing but the part is known

    /// As part_bounds::reaches.
    [[nodiscard]] ABUT_HD bool reaches(const aabb<T>& box) const {
        if (!part.reaches(box)) return false;
        if (boxes.size() == 0) return true;
        const bvh_walk<bvh_view<T, Space>> walk{boxes};
        box_reach<T> reach(box);
        typename bvh_walk<bvh_view<T, Space>>::cursor at;
        bool reached = false;
        walk.for_each(reach, at, [] { return false; }, [&](std::uint32_t) {
            reached = true;
            return visit::stop;
        });
        return reached;
    }
};

/// The boxes of about so many nodes of a tree, on the host: between them they hold all shapes.
template <class Policy, bvh_layout Tree>
auto boxes_of_nodes(const Policy& on, const Tree& tree, std::size_t nodes) {
    using box = aabb<typename Tree::scalar_type>;
    const auto cut = cut_evenly(on, tree, nodes);
    execution::buffer_of<Policy, box> boxes(on, cut.size());
    for_each_index(on, cut.size(), write_node_boxes<Tree>{tree, cut.data(), boxes.data()});
    std::vector<box> here(cut.size());
    download(on, boxes.data(), boxes.size(), here.data());
    return here;
}

/// Neighbours in a set, as many as this, have a box of their own.
inline constexpr std::size_t block_size = 64;
inline std::size_t blocks_of(std::size_t n, std::size_t size = block_size) { return n / size + (n % size != 0); }

template <shape_view Shapes>
struct write_block_boxes {
    using T = typename Shapes::scalar_type;
    Shapes shapes;
    std::size_t size;  ///< of a block
    aabb<T>* boxes;
    ABUT_HD void operator()(std::size_t k) const {
        const std::size_t first = k * size, left = shapes.size() - first;
        aabb<T> box = empty_box<T>();
        for (std::size_t i = first; i < first + (left < size ? left : size); ++i) box = merge(box, bounds(shapes[i]));
        boxes[k] = box;
    }
};

/// The same for blocks of block_size, each read by a group of threads as it lies in memory, and not by one thread, whose
/// neighbours would read far from it.
template <shape_view Shapes>
struct write_boxes_by_groups {
    using T = typename Shapes::scalar_type;
    static constexpr unsigned members = execution::subgroup_size;
    struct shared {
        aabb<T> boxes[members];
    };
    Shapes shapes;
    aabb<T>* boxes;
    ABUT_HD void operator()(const execution::group<shared, members>& some) const {
        const std::size_t block = some.first / members, first = block * block_size, left = shapes.size() - first;
        const auto count = static_cast<unsigned>(left < block_size ? left : block_size);
        aabb<T>* const mine = some.shared.boxes;
        some.each([&](unsigned k) {
            mine[k] = empty_box<T>();
            for (unsigned i = k; i < count; i += members) mine[k] = merge(mine[k], bounds(shapes[first + i]));
        });
        for (unsigned half = members / 2; half > 0; half /= 2) {
            some.each(0, half, [&](unsigned k) { mine[k] = merge(mine[k], mine[k + half]); });
        }
        some.each(0, 1, [&](unsigned) { boxes[block] = mine[0]; });
    }
};

/// Divides a row of boxes into groups of neighbours: the row is cut where that leaves the least volume, and again, until
/// there are as many groups as a part has. Where shapes lie along a curve, these are the places where it jumps.
template <scalar T>
class box_groups {
public:
    explicit box_groups(const std::vector<aabb<T>>& boxes) : boxes_(boxes), left_(boxes.size()) {
        for (const aabb<T>& box : boxes) around_ = merge(around_, box);
        groups_.reserve(part_boxes);
        if (!boxes.empty()) groups_.push_back(best_cut(0, boxes.size()));
        while (groups_.size() < part_boxes) {
            const auto gain = [](const group& x, const group& y) { return x.gain < y.gain; };
            const auto most = std::max_element(groups_.begin(), groups_.end(), gain);
            if (most == groups_.end() || most->cut == most->first) break;  // boxes are alone, or there are none
            const group whole = *most;
            *most = best_cut(whole.first, whole.cut);
            groups_.push_back(best_cut(whole.cut, whole.last));
        }
    }

    void write(part_bounds<T>& part) const {
        part.around = around_;
        for (aabb<T>& box : part.groups) box = empty_box<T>();
        for (std::size_t k = 0; k < groups_.size(); ++k) {
            for (std::size_t i = groups_[k].first; i < groups_[k].last; ++i) {
                part.groups[k] = merge(part.groups[k], boxes_[i]);
            }
        }
    }

private:
    struct group {
        std::size_t first, last, cut;  ///< `cut` is `first` where there is none
        double gain;                   ///< volume that is left out if it is cut there
    };

    /// In parts of the extents of all. Flat boxes have some volume too.
    [[nodiscard]] double volume(const aabb<T>& box) const {
        const auto side = [](T lower, T upper, T first, T last) {
            const double extent = static_cast<double>(last) / 2 - static_cast<double>(first) / 2;
            const double mine = static_cast<double>(upper) / 2 - static_cast<double>(lower) / 2;
            return (extent > 0 ? mine / extent : 0) + 1.0 / 64;
        };
        return side(box.lower.x, box.upper.x, around_.lower.x, around_.upper.x) *
               side(box.lower.y, box.upper.y, around_.lower.y, around_.upper.y) *
               side(box.lower.z, box.upper.z, around_.lower.z, around_.upper.z);
    }
    [[nodiscard]] group best_cut(std::size_t first, std::size_t last) {
        aabb<T> box = empty_box<T>();
        for (std::size_t i = first; i + 1 < last; ++i) left_[i] = volume(box = merge(box, boxes_[i]));
        group best{first, last, first, -infinity<double>};
        const double whole = volume(merge(box, boxes_[last - 1]));
        box = empty_box<T>();
        for (std::size_t i = last - 1; i > first; --i) {
            const double gain = whole - left_[i - 1] - volume(box = merge(box, boxes_[i]));
            if (gain > best.gain) best.cut = i, best.gain = gain;
        }
        return best;
    }

    const std::vector<aabb<T>>& boxes_;
    aabb<T> around_ = empty_box<T>();
    std::vector<double> left_;  ///< the volume of a group's boxes up to each
    std::vector<group> groups_;
};

template <class Policy, shape_view Shapes>
auto bounds_of_part(const Policy& on, const Shapes& shapes) {
    using T = typename Shapes::scalar_type;
    part_bounds<T> part;
    part.size = shapes.size();
    // Fine enough to cut where the curve jumps: of 50,000 shapes 1,024 boxes left eight parts to send three times as much.
    const std::size_t size = std::clamp<std::size_t>(shapes.size() / 16384, 1, block_size);
    std::vector<aabb<T>> boxes(blocks_of(shapes.size(), size));
    execution::buffer_of<Policy, aabb<T>> there(on, boxes.size());
    for_each_index(on, boxes.size(), write_block_boxes<Shapes>{shapes, size, there.data()});
    download(on, there.data(), boxes.size(), boxes.data());
    box_groups<T>(boxes).write(part);
    return part;
}

/// Shapes that may touch one of another part's.
template <shape_view Shapes, class There>
struct comes_near {
    Shapes shapes;
    There there;
    ABUT_HD bool operator()(std::size_t i) const { return there.reaches(bounds(shapes[i])); }
};

template <scalar T, class There>
struct is_block_near {
    const aabb<T>* boxes;
    There there;
    ABUT_HD bool operator()(std::size_t k) const { return there.reaches(boxes[k]); }
};

/// A test of those that some blocks have, one after another.
template <class Test>
struct in_blocks {
    Test test;
    const std::uint32_t* blocks;
    std::size_t count;  ///< of all, in these blocks or not
    [[nodiscard]] ABUT_HD std::size_t id(std::size_t place) const {
        return std::size_t{blocks[place / block_size]} * block_size + place % block_size;
    }
    ABUT_HD bool operator()(std::size_t place) const { return id(place) < count && test(id(place)); }
};
/// Ids in place of places.
template <class Test>
struct write_ids_in_blocks {
    in_blocks<Test> in;
    std::uint32_t* ids;
    ABUT_HD void operator()(std::size_t i) const { ids[i] = static_cast<std::uint32_t>(in.id(ids[i])); }
};

/// Shapes as they are, those of some ids.
template <shape_view Shapes>
struct pack_shape {
    static_assert(!refers_to_memory<typename Shapes::shape_type>,
                  "abut: hulls refer to their points, and sets of them are not divided among devices: replicate(devices, set) "
                  "gives each the whole set");
    Shapes shapes;
    const std::uint32_t* ids;
    typename Shapes::shape_type* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = shapes[ids[i]]; }
};

/// How many points hulls have of which the test is true.
template <class Test, shape_view Hulls>
struct points_if {
    in_blocks<Test> in;
    Hulls hulls;
    ABUT_HD std::uint64_t operator()(std::size_t place) const { return in(place) ? hulls[in.id(place)].count : 0; }
};

/// Which shapes of a part come near another part, `there`: part_bounds or close_bounds.
template <class Policy, shape_view Shapes>
class near_shapes {
public:
    using view = Shapes;
    using T = typename Shapes::scalar_type;

    explicit near_shapes(const Shapes& shapes) : shapes_(shapes) {}

    /// All of the part.
    [[nodiscard]] const Shapes& shapes() const { return shapes_; }
    /// How many come near.
    template <class There>
    [[nodiscard]] std::uint64_t count(const Policy& on, const There& there) {
        const std::size_t blocks = near_blocks(on, there);
        return reduce(on, blocks * block_size, std::uint64_t{0}, add_up_tallies{}, one_if<near_in_blocks<There>>{near(there)});
    }
    /// How many points these have, of hulls.
    template <class There>
    [[nodiscard]] std::uint64_t count_points(const Policy& on, const There& there) {
        const std::size_t blocks = near_blocks(on, there);
        return reduce(on, blocks * block_size, std::uint64_t{0}, add_up_tallies{},
                      points_if<comes_near<Shapes, There>, Shapes>{near(there), shapes_});
    }
    /// Writes the ids of as many, ascending, in the policy's memory.
    template <class There>
    void write_ids(const Policy& on, const There& there, std::uint32_t* ids) {
        write_ids_of(on, there, near_blocks(on, there), ids);
    }
    /// The ids of all that come near, ascending, without a count before: with 4 bytes for each shape of a block that does.
    template <class There>
    [[nodiscard]] execution::buffer_of<Policy, std::uint32_t> ids(const Policy& on, const There& there) {
        const std::size_t blocks = near_blocks(on, there);
        execution::buffer_of<Policy, std::uint32_t> all(on, blocks * block_size);
        const std::size_t n = write_ids_of(on, there, blocks, all.data());
        execution::buffer_of<Policy, std::uint32_t> found(on, n);
        copy(on, all.data(), n, found.data());
        return found;
    }

private:
    template <class There>
    using near_in_blocks = in_blocks<comes_near<Shapes, There>>;

    /// Finds the blocks of which shapes may come near.
    template <class There>
    [[nodiscard]] std::size_t near_blocks(const Policy& on, const There& there) {
        const std::size_t blocks = blocks_of(shapes_.size());
        if (boxes_.size() == 0 && blocks > 0) {
            boxes_ = execution::buffer_of<Policy, aabb<T>>(on, blocks);
            near_ = execution::buffer_of<Policy, std::uint32_t>(on, blocks);
            using group_type = write_boxes_by_groups<Shapes>;
            for_each_group(on, blocks * group_type::members, group_type{shapes_, boxes_.data()});
        }
        return compact(on, blocks, is_block_near<T, There>{boxes_.data(), there}, near_.data());
    }
    template <class There>
    std::size_t write_ids_of(const Policy& on, const There& there, std::size_t blocks, std::uint32_t* ids) {
        const std::size_t n = compact(on, blocks * block_size, near(there), ids);
        for_each_index(on, n, write_ids_in_blocks<comes_near<Shapes, There>>{near(there), ids});
        return n;
    }
    template <class There>
    [[nodiscard]] near_in_blocks<There> near(const There& there) const {
        return {{shapes_, there}, near_.data(), shapes_.size()};
    }

    Shapes shapes_;
    execution::buffer_of<Policy, aabb<T>> boxes_;  ///< of blocks
    execution::buffer_of<Policy, std::uint32_t> near_;
};

/// What shapes from elsewhere look in: a, or where b has an index and a has none, an index of a. As on one machine, plain
/// sets are compared all with all.
template <class Policy, class X, class Y>
auto looked_in(const Policy& on, const X& a, std::type_identity<Y>) {
    constexpr bool makes_one = [] {
        if constexpr (is_posed<Y>) {
            return is_index<decltype(Y::object)>;
        } else {
            return is_index<Y>;
        }
    }();
    if constexpr (is_posed<X>) {
        return posed(looked_in(on, a.object, std::type_identity<Y>{}), a.pose);
    } else if constexpr (makes_one && shape_set<X> && !is_index<X>) {
        return make_bvh(on, a);
    } else {
        return a;
    }
}

// What a user gives, called with ids of the whole sets: ids(a, b) names the pair of two shapes that are here.

template <class Filter, class Ids>
struct filter_by_whole_ids {
    Filter filter;
    Ids ids;
    ABUT_CALLS_ANY
    ABUT_HD bool operator()(std::uint32_t a, std::uint32_t b) const {
        const auto pair = ids(a, b);
        return filter(pair.a, pair.b);
    }
};
/// The filter that keeps all stays as it is.
template <class Filter, class Ids>
auto filter_here(const Filter& filter, const Ids& ids) {
    if constexpr (std::same_as<Filter, keep_all>) {
        return filter;
    } else {
        return filter_by_whole_ids<Filter, Ids>{filter, ids};
    }
}

/// The visitor of pairs here, and of none after it has said to stop.
template <class Visitor, class Ids>
struct visitor_by_whole_ids {
    Visitor visitor;
    Ids ids;
    std::uint32_t* stopped;
    ABUT_CALLS_ANY
    ABUT_HD visit operator()(const index_pair& pair) const {
        if (execution::atomic_load(stopped) != 0) return visit::stop;
        const visit next = visitor(ids(pair.a, pair.b));
        if (next == visit::stop) execution::atomic_store(stopped, 1);
        return next;
    }
};

}  // namespace abut::detail
