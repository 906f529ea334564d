// SPDX-License-Identifier: MIT
#pragma once

// nearest of sets whose parts lie on many ranks. A rank looks in its own part first. Then its points go to each other rank
// whose part may hold something nearer, and answers come back. The least is by the measure of narrow/nearest_point.hpp and
// then by the id, as on one machine.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/nearest.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/parts.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/shape/point_reach.hpp>

#include <mpi.h>

namespace abut {

/// @addtogroup distributed
///@{

/// The id of no shape in a set of many parts.
inline constexpr std::uint64_t no_global_id = static_cast<std::uint64_t>(-1);

/// A `neighbor` with an id in a set of many parts. Where there are no shapes at all: `no_global_id`, the point asked about
/// and infinity.
template <scalar T>
struct global_neighbor {
    std::uint64_t id;  ///< of the shape
    vec3<T> point;     ///< on the shape, in the world
    T distance;        ///< from the point asked about, rounded to T

    friend constexpr bool operator==(const global_neighbor&, const global_neighbor&) = default;
};

///@}

namespace detail {

/// A neighbor, and what it was found by.
template <scalar T>
struct measured_neighbor {
    double measure;  ///< the squared distance in the unit of all ranks; infinite where there is none
    std::uint64_t id;
    vec3<T> point;
    T distance;

    /// Takes `other` if it is nearer, or as near with a smaller id.
    ABUT_HD void offer(const measured_neighbor& other) {
        if (other.measure < measure || (other.measure == measure && other.id < id)) *this = other;
    }
};

/// What one part says, with ids of the whole set.
template <shape_view Shapes, shape_view Points>
struct write_measured {
    using T = typename Points::scalar_type;
    Shapes shapes;
    Points points;
    length_unit<T> unit;
    std::uint64_t first_id;
    const std::uint32_t* order;
    const execution::least_value* found;  ///< null for none
    measured_neighbor<T>* out;

    ABUT_HD void operator()(std::size_t i) const {
        const std::size_t k = order == nullptr ? i : order[i];
        const vec3<T> p = points[k];
        out[k] = {infinity<double>, no_global_id, p, infinity<T>};
        if (found == nullptr || found[i].key >= no_id) return;
        const auto id = static_cast<std::uint32_t>(found[i].key);
        const neighbor<T> near = neighbor_of(p, shapes[id], id, unit);
        out[k] = {found[i].value, first_id + id, near.point, near.distance};
    }
};

/// Whether a part may hold something as near as a ball reaches: least(box) is how near what lies in a box comes at least.
template <scalar T, class Least>
ABUT_HD bool may_reach(const part_bounds<T>& part, const shrinking_ball<T>& ball, const Least& least) {
    if (!ball.keeps(least(part.around))) return false;
    bool may = false;
    for (std::size_t k = 0; k < part_boxes; ++k) {
        const aabb<T>& box = part.groups[k];
        may |= box.lower.x <= box.upper.x && ball.keeps(least(box));
    }
    return may;
}

/// Points for which a part may hold something as near as what they have.
template <shape_view Points>
struct may_be_nearer {
    using T = typename Points::scalar_type;
    Points points;
    const measured_neighbor<T>* best;
    length_unit<T> unit;
    part_bounds<T> part;

    ABUT_HD bool operator()(std::size_t i) const {
        auto ball = world_frame<T>{unit.length(1)}.ball_around(points[i]);
        if (best[i].id != no_global_id) ball.shrink_to(best[i].measure);
        return may_reach(part, ball, [&](const aabb<T>& box) { return ball.least_in(box); });
    }
};

/// Some neighbouring points, and the largest measure that one of them has.
template <scalar T>
struct point_block {
    aabb<T> box;
    double worst;
};
template <shape_view Points>
struct write_point_blocks {
    using T = typename Points::scalar_type;
    Points points;
    const measured_neighbor<T>* best;
    point_block<T>* blocks;
    ABUT_HD void operator()(std::size_t k) const {
        const std::size_t first = k * block_size, left = points.size() - first;
        point_block<T> block{empty_box<T>(), 0};
        for (std::size_t i = first; i < first + (left < block_size ? left : block_size); ++i) {
            block.box = merge(block.box, bounds(points[i]));
            block.worst = greatest(block.worst, best[i].measure);
        }
        blocks[k] = block;
    }
};
/// The same of blocks. The distance of two boxes is computed as that of a point from a box, and is no larger.
template <scalar T>
struct may_block_be_nearer {
    const point_block<T>* blocks;
    length_unit<T> unit;
    part_bounds<T> part;

    ABUT_HD bool operator()(std::size_t k) const {
        const aabb<T> around = blocks[k].box;
        auto ball = world_frame<T>{unit.length(1)}.ball_around(around.lower);
        if (blocks[k].worst < infinity<double>) ball.shrink_to(blocks[k].worst);
        return may_reach(part, ball, [&](const aabb<T>& box) {
            const vec3<T> away = greatest(vec3<T>{}, greatest(around.lower - box.upper, box.lower - around.upper));
            return dot(away, away);
        });
    }
};

template <scalar T>
struct take_nearer {
    const std::uint32_t* points;
    const measured_neighbor<T>* answers;
    measured_neighbor<T>* best;
    ABUT_HD void operator()(std::size_t i) const { best[points[i]].offer(answers[i]); }
};

template <scalar T>
struct write_global_neighbor {
    const measured_neighbor<T>* best;
    global_neighbor<T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = {best[i].id, best[i].point, best[i].distance}; }
};

/// The ranks' points and shapes, ready to be asked about.
template <class Local, class Operand, class Queries, scalar T>
class nearest_of_ranks {
public:
    nearest_of_ranks(const distributed<Local>& on, const Operand& x, const Queries& queries, const parts_of_set<T>& parts,
                     const std::vector<std::uint64_t>& points_of_rank, const length_unit<T>& unit)
        : on_(on),
          local_(on.local()),
          x_(x),
          queries_(queries),
          parts_(parts),
          points_of_rank_(points_of_rank),
          unit_(unit) {}

    result<global_neighbor<T>, space_of<Local>> find() {
        const own_communicator& ranks = on_.ranks();
        const int me = ranks.rank(), all = ranks.size();
        const std::size_t n = queries_.shapes().size();
        attempts attempt;
        attempt([&] {
            best_ = execution::buffer_of<Local, measured_neighbor<T>>(local_, n);
            ids_ = execution::buffer_of<Local, std::uint32_t>(local_, n);
            blocks_ = execution::buffer_of<Local, point_block<T>>(local_, blocks_of(n));
            near_ = execution::buffer_of<Local, std::uint32_t>(local_, blocks_of(n));
            rooms_.emplace(local_, std::min(n, most_points), most_of_others());
            answer(queries_, best_.data());
            look_at_blocks();
        });
        attempt.settle(ranks);
        for (int round = 1; round < all; ++round) exchange((me + round) % all, (me - round + all) % all, attempt);
        result<global_neighbor<T>, space_of<Local>> found;
        attempt([&] {
            execution::buffer_of<Local, global_neighbor<T>> out(local_, n);
            for_each_index(local_, n, write_global_neighbor<T>{best_.data(), out.data()});
            synchronize(local_);
            found = result<global_neighbor<T>, space_of<Local>>(std::move(out));
        });
        attempt.settle(ranks);
        return found;
    }

private:
    using point_room = message_room<Local, vec3<T>>;
    using answer_room = message_room<Local, measured_neighbor<T>>;
    /// Of a message.
    static constexpr std::size_t most_points = std::size_t{1} << 16;

    struct rooms {
        point_room asked, asking;
        answer_room answered, answering;
        rooms(const Local& on, std::size_t mine, std::size_t others)
            : asked(on, mine), asking(on, others), answered(on, mine), answering(on, others) {}
    };

    [[nodiscard]] std::size_t most_of_others() const {
        const std::uint64_t most = *std::max_element(points_of_rank_.begin(), points_of_rank_.end());
        return static_cast<std::size_t>(std::min<std::uint64_t>(most, most_points));
    }

    /// What this rank's part says of some points.
    template <class Points>
    void answer(const Points& points, measured_neighbor<T>* out) {
        const auto there = x_.shapes();
        const auto from = points.shapes();
        using shapes_type = std::remove_const_t<decltype(there)>;
        using points_type = std::remove_const_t<decltype(from)>;
        const std::uint64_t first = parts_.first_of(on_.rank());
        look_for_nearest(local_, x_, points, unit_, [&](const std::uint32_t* order, const execution::least_value* found) {
            for_each_index(local_, from.size(),
                           write_measured<shapes_type, points_type>{there, from, unit_, first, order, found, out});
            synchronize(local_);
        });
    }

    /// What blocks of points still look for.
    void look_at_blocks() {
        const auto points = queries_.shapes();
        using points_type = std::remove_const_t<decltype(points)>;
        for_each_index(local_, blocks_.size(), write_point_blocks<points_type>{points, best_.data(), blocks_.data()});
    }

    /// The points that `target` is asked about, to ids_. Returns how many these are.
    std::size_t choose_points(int target) {
        const auto points = queries_.shapes();
        using points_type = std::remove_const_t<decltype(points)>;
        const may_block_be_nearer<T> may_block{blocks_.data(), unit_, parts_[target]};
        const std::size_t blocks = compact(local_, blocks_.size(), may_block, near_.data());
        const in_blocks<may_be_nearer<points_type>> may{
            {points, best_.data(), unit_, parts_[target]}, near_.data(), points.size()};
        const std::size_t chosen = compact(local_, blocks * block_size, may, ids_.data());
        for_each_index(local_, chosen, write_ids_in_blocks<may_be_nearer<points_type>>{may, ids_.data()});
        return chosen;
    }

    /// Asks `target`, and answers `source`, some points at a time. Each knows how many there are before.
    void exchange(int target, int source, attempts& attempt) {
        enum tag { tag_count, tag_points, tag_answers };
        const MPI_Comm comm = on_.ranks().get();
        const auto points = queries_.shapes();
        using points_type = std::remove_const_t<decltype(points)>;
        const std::size_t n = points.size();
        const bool asks = n > 0 && parts_[target].size > 0;
        const bool is_asked = points_of_rank_[static_cast<std::size_t>(source)] > 0 && parts_[on_.rank()].size > 0;
        std::uint64_t out = 0, in = 0;
        MPI_Request requests[2];
        int open = 0;
        const auto wait = [&] {
            check_mpi(MPI_Waitall(open, requests, MPI_STATUSES_IGNORE), "MPI_Waitall");
            open = 0;
        };
        const auto send = [&](const void* data, std::uint64_t count, MPI_Datatype type, int to, tag which) {
            check_mpi(MPI_Isend(data, static_cast<int>(count), type, to, which, comm, &requests[open++]), "MPI_Isend");
        };
        const auto receive = [&](void* data, std::uint64_t count, MPI_Datatype type, int from, tag which) {
            check_mpi(MPI_Irecv(data, static_cast<int>(count), type, from, which, comm, &requests[open++]), "MPI_Irecv");
        };
        if (is_asked) receive(&in, 1, MPI_UINT64_T, source, tag_count);
        if (asks) {
            attempt([&] { out = choose_points(target); });
            send(&out, 1, MPI_UINT64_T, target, tag_count);
        }
        wait();
        for (std::uint64_t first = 0; first < std::max(out, in); first += most_points) {
            const auto part = [&](std::uint64_t total) {
                return static_cast<std::size_t>(first < total ? std::min<std::uint64_t>(total - first, most_points) : 0);
            };
            const std::size_t asked = part(out), asking = part(in);
            if (asking > 0) receive(rooms_->asking.here(), asking, point_type_.get(), source, tag_points);
            if (asked > 0) {
                attempt([&] {
                    const pack_shape<points_type> pack{points, ids_.data() + first, rooms_->asked.there()};
                    for_each_index(local_, asked, pack);
                    rooms_->asked.bring_here(local_, asked);
                });
                if (attempt.failed()) std::fill_n(rooms_->asked.here(), asked, vec3<T>{});  // points of any kind
                send(rooms_->asked.here(), asked, point_type_.get(), target, tag_points);
            }
            wait();
            if (asked > 0) receive(rooms_->answered.here(), asked, answer_type_.get(), target, tag_answers);
            if (asking > 0) {
                attempt([&] {
                    rooms_->asking.bring_there(local_, asking);
                    using view = shapes_view<vec3<T>, space_of<Local>>;
                    answer(plain_operand<view>{view(rooms_->asking.there(), asking)}, rooms_->answering.there());
                    rooms_->answering.bring_here(local_, asking);
                });
                send(rooms_->answering.here(), asking, answer_type_.get(), source, tag_answers);
            }
            wait();
            if (asked == 0) continue;
            attempt([&] {
                rooms_->answered.bring_there(local_, asked);
                for_each_index(local_, asked, take_nearer<T>{ids_.data() + first, rooms_->answered.there(), best_.data()});
                synchronize(local_);
            });
        }
        if (out > 0) attempt([&] { look_at_blocks(); });
    }

    const distributed<Local>& on_;
    const Local& local_;
    const Operand& x_;
    const Queries& queries_;
    const parts_of_set<T>& parts_;
    const std::vector<std::uint64_t>& points_of_rank_;
    length_unit<T> unit_;
    message_type<vec3<T>> point_type_;
    message_type<measured_neighbor<T>> answer_type_;
    execution::buffer_of<Local, measured_neighbor<T>> best_;
    execution::buffer_of<Local, point_block<T>> blocks_;
    execution::buffer_of<Local, std::uint32_t> ids_, near_;
    std::optional<rooms> rooms_;
};

/// What is largest of all ranks.
inline double largest_of_ranks(const own_communicator& ranks, double mine) {
    double largest = 0;
    check_mpi(MPI_Allreduce(&mine, &largest, 1, MPI_DOUBLE, MPI_MAX, ranks.get()), "MPI_Allreduce");
    return largest;
}

template <class Local, class X, class Points>
auto nearest_of_parts(const distributed<Local>& on, const X& index, const Points& points, const char* function) {
    using T = scalar_type_of<typename shape_of_argument<X>::type>;
    const Local& local = on.local();
    attempts attempt;
    const auto bring = [&] {
        return std::pair(make_operand(local, index, function), make_points<T>(local, points, function));
    };
    std::optional<decltype(bring())> here;
    part_bounds<T> mine;
    double largest = 0;
    parts_of_set<T> parts;
    std::vector<std::uint64_t> points_of_rank;
    attempt([&] {
        parts.make_room(on.size());
        points_of_rank.resize(static_cast<std::size_t>(on.size()));
        here.emplace(bring());
        mine = bounds_of_part(local, here->first.shapes());
        largest = largest_coordinate(local, here->first, here->second.shapes());
    });
    attempt.settle(on.ranks());
    parts.gather(on.ranks(), mine);
    gather(on.ranks(), std::uint64_t{here->second.shapes().size()}, points_of_rank);
    const auto unit = unit_of_magnitude<T>(largest_of_ranks(on.ranks(), largest));
    return nearest_of_ranks(on, here->first, here->second, parts, points_of_rank, unit).find();
}

}  // namespace detail

/// For each of this rank's `points` the nearest shape of all parts: a `result` of `global_neighbor`, in the order of the
/// points, 24 bytes each in float and 40 in double, in the local policy's memory. `index` is this rank's part, and `points`
/// this rank's points; both as of `nearest` under the local policy. Points go to ranks whose parts may hold something
/// nearer, at most 65,536 in a message.
///
/// The answers are those of one machine. In double, scenes whose coordinates differ by factors beyond 2^250 may differ in
/// the last bits under a pose.
/// @ingroup distributed
template <execution_policy Local, class X, class Points>
[[nodiscard]] auto nearest(const distributed<Local>& on, const X& index, const Points& points) {
    if constexpr (detail::can_be_near<Local, X, Points>()) {
        return detail::nearest_of_parts(on, index, points, "abut::nearest");
    } else {
        return result<global_neighbor<float>, space_of<Local>>();
    }
}

}  // namespace abut
