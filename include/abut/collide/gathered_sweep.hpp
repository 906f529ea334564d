// SPDX-License-Identifier: MIT
#pragma once

// sweep on a device, in stages, each with full warps. A walk that searches would keep the search's memory beside its own,
// and its lanes would come to shapes one at a time.
//
//   1. Each row walks. A few directions (narrow/plain_sweep.hpp) pass most shapes, and tell a time by which one is touched.
//      What is left is gathered: the shapes that may be touched by that time.
//   2. Each of these is searched in doubles (narrow/sweep_search.hpp).
//   3. Each row takes the first of its own. Where several may be that, their times are rounded, and it takes the first then.
//
// Rows that gather more than a few walk again, some at a time, with more room. What has no room then is walked once more,
// by rows that search as they go.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/limits.hpp>
#include <abut/collide/search.hpp>
#include <abut/collide/shares.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/ordered.hpp>
#include <abut/narrow/hit_time.hpp>
#include <abut/narrow/plain_sweep.hpp>
#include <abut/traverse/from_each.hpp>

namespace abut::detail {

/// A shape that a row may touch, and not before a time, which is rounded down.
struct gathered_shape {
    std::uint32_t row, id;
    float first;
};
/// What a row has gathered: `count` shapes from `first` on, which may be touched by `until`.
struct gathered_row {
    static constexpr std::uint32_t no_room = ~0u;
    std::uint64_t first;
    double until;
    std::uint32_t count;  ///< or no_room
};
struct gathered_shapes {
    gathered_shape* shapes;
    gathered_row* rows;
};

/// A row while it walks. `All` is that of from_each.
template <class All>
struct gathering_look {
    typename All::line_type line;
    typename All::row_type row;
    gathered_shape* shapes;
    std::uint32_t room, count = 0;
    bool has_room = true;

    ABUT_CALLS_ANY
    template <class Best>
    ABUT_HD void operator()(const All& all, typename All::id_type id, Best& best) {
        const time_bounds time = plain_sweep_bounds(line, all.shapes[id], best.bound());
        if (time.first < 0 || time.first > best.bound()) return;
        best.offer(time.last);
        if (count == room) forget_later_than(best.bound());
        if (count == room) {
            has_room = false;
            return best.offer(0);  // which ends the walk soon
        }
        // Small floats are rounded by more than a share of themselves.
        const float first = time.first > 0x1p-100 ? static_cast<float>(time.first * (1 - 0x1p-22)) : 0.0f;
        shapes[count++] = {static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(id), first};
    }
    ABUT_HD void forget_later_than(double bound) {
        std::uint32_t kept = 0;
        for (std::uint32_t k = 0; k < count; ++k) {
            if (static_cast<double>(shapes[k].first) <= bound) shapes[kept++] = shapes[k];
        }
        count = kept;
    }
    /// Walks. What is left of it lies in `shapes`.
    ABUT_CALLS_ANY
    template <class Sink>
    ABUT_HD gathered_row walk(const All& all, Sink& sink) {
        reach_of_look<All> reach(all.seen(row));
        all.walk(reach, sink, [&](typename All::id_type id) { (*this)(all, id, sink); });
        forget_later_than(sink.bound());
        return {0, sink.bound(), has_room ? count : gathered_row::no_room};
    }
};
/// All rows, each of which keeps a few shapes while it walks, and then puts them beside those of others.
template <class All>
struct gather_few {
    static constexpr std::uint32_t few = 16;
    All all;
    gathered_shapes to;
    std::uint64_t* taken;  ///< of the room for shapes
    std::uint64_t room;
    ABUT_CALLS_ANY
    template <class Sink>
    ABUT_HD void operator()(std::size_t i, Sink& sink) const {
        gathered_shape mine[few];  // not initialised
        gathering_look<All> look{all.rows[i], i, mine, few};
        gathered_row row = look.walk(all, sink);
        if (row.count != gathered_row::no_room && row.count > 0) {
            const std::uint32_t count = row.count;
            row.first = execution::atomic_add(taken, std::uint64_t{count});
            if (row.first + count > room) row.count = gathered_row::no_room;
            for (std::uint32_t k = 0; k < count && row.first + k < room; ++k) to.shapes[row.first + k] = mine[k];
        }
        to.rows[i] = row;
    }
};
/// Some rows, each of which has its own part of the room. One lane in `spread` walks.
template <class All>
struct gather_many {
    All all;
    gathered_shapes to;
    const std::uint64_t* some;
    std::uint32_t room_of_each;
    std::size_t spread;
    ABUT_CALLS_ANY
    template <class Sink>
    ABUT_HD void operator()(std::size_t i, Sink& sink) const {
        if (i % spread != 0) return;
        const std::uint64_t row = some[i / spread], first = std::uint64_t{room_of_each} * (i / spread);
        gathering_look<All> look{all.rows[row], static_cast<std::size_t>(row), to.shapes + first, room_of_each};
        to.rows[row] = look.walk(all, sink);
        to.rows[row].first = first;
    }
};

/// Between which times each shape that was gathered is touched. Of rows that have parts of the room, `some` says which.
template <class All>
struct search_gathered {
    All all;
    gathered_shapes from;
    time_bounds* times;
    const std::uint64_t* some;
    std::uint32_t room_of_each;
    ABUT_HD void operator()(std::size_t k) const {
        if (some != nullptr) {
            const gathered_row& mine = from.rows[some[k / room_of_each]];
            if (mine.count == gathered_row::no_room || k % room_of_each >= mine.count) return;
        }
        const gathered_shape of = from.shapes[k];
        times[k] = all.bounds_in_doubles(all.rows[of.row], of.id, from.rows[of.row].until);
    }
};

/// The time of a shape that was gathered, rounded.
template <class All>
struct round_gathered {
    All all;
    gathered_shapes from;
    time_bounds* times;
    const std::uint64_t* some;
    ABUT_HD void operator()(std::size_t i) const {
        const std::uint64_t k = some[i];
        const double time = all.time(all.rows[from.shapes[k].row], from.shapes[k].id);
        times[k] = {time, time};
    }
};
/// Each row takes the first of what it has gathered. Where that needs times to be rounded, they are handed on and so is the
/// row, and so are rows that found no room.
template <class All, class Sink>
struct choose_gathered {
    using T = scalar_type_of<typename All::line_type>;
    gathered_shapes from;
    const time_bounds* times;
    const std::uint64_t* some;  ///< or null for all rows
    bool in_scalars;
    Sink sink;

    template <class Open, class Ties, class Late>
    ABUT_HD void operator()(std::size_t i, Open& open, Ties& ties, Late& late) const {
        const std::uint64_t row = some != nullptr ? some[i] : i;
        const gathered_row mine = from.rows[row];
        if (mine.count == gathered_row::no_room) return late.push(row);
        const std::uint64_t end = mine.first + mine.count;
        double last = infinity<double>;
        for (std::uint64_t k = mine.first; k < end; ++k)
            last = times[k].first >= 0 && times[k].last < last ? times[k].last : last;
        const auto counts = [&](std::uint64_t k) { return times[k].first >= 0 && times[k].first <= last; };
        execution::least_value first{};
        std::uint32_t count = 0;
        bool are_known = true, is_known_in_scalars = true;
        for (std::uint64_t k = mine.first; k < end; ++k) {
            if (!counts(k)) continue;
            ++count;
            are_known = are_known && times[k].is_one();
            is_known_in_scalars = times[k].last <= 1 && time_as<T>(times[k].first) == time_as<T>(times[k].last);
            first.offer(times[k].last, from.shapes[k].id);
        }
        if (!are_known && !(in_scalars && count == 1 && is_known_in_scalars)) {
            for (std::uint64_t k = mine.first; k < end; ++k) {
                if (counts(k) && !times[k].is_one()) open.push(k);
            }
            return ties.push(row);
        }
        Sink best = sink;
        best.begin(row);
        if (count > 0) best.offer(first.value, first.key);
        best.end(row);
    }
};
/// Rows that walk and search at once.
template <class Each, class Sink>
struct search_while_walking {
    Each each;
    const std::uint64_t* rows;
    Sink sink;
    ABUT_CALLS_ANY
    ABUT_HD void operator()(std::size_t k) const {
        Sink best = sink;
        best.begin(rows[k]);
        each(rows[k], best);
        best.end(rows[k]);
    }
};

/// Whether a policy looks in stages.
template <class Policy, class All>
inline constexpr bool gathers_first = !host_policy<Policy> && All::can_gather;

/// What for_each_ordered(on, n, each, best) does, in stages. There is room for four shapes of each row, and for 2^16 at
/// least.
template <class Policy, class All, class Best>
class staged_sweep {
    using sink_type = typename Best::sink;
    using queue = key_queue<Policy>;

public:
    staged_sweep(const Policy& policy, std::size_t n, const from_each<All>& of_each, Best& into)
        : on_(policy),
          each_(of_each),
          sink_(into.make_sink(0)),
          room_(std::max(4 * n, std::size_t{1} << 16)),
          rows_(policy, n),
          shapes_(policy, room_),
          times_(policy, room_) {
        execution::buffer_of<Policy, std::uint64_t> taken(on_, 1);
        fill(on_, taken.data(), 1, std::uint64_t{0});
        execution::least_kept_by_walk until{1.0};
        for_each_ordered(on_, n, gather_few<All>{each_.all, gathered(), taken.data(), room_}, until);
        std::uint64_t count = 0;
        download(on_, taken.data(), 1, &count);
        queue late(on_, 1024);
        take(n, nullptr, static_cast<std::size_t>(std::min(count, std::uint64_t{room_})), 0, late);
        const std::size_t together = std::max(room_ / many, std::size_t{1});
        queue later(on_, 64);
        for (std::size_t begin = 0; begin < late.size(); begin += together) {
            walk_again(late.data() + begin, std::min(together, late.size() - begin), later);
        }
        for_each_index(on_, later.size(), search_while_walking<from_each<All>, sink_type>{each_, later.data(), sink_});
    }

private:
    static constexpr std::size_t many = 1024;

    [[nodiscard]] gathered_shapes gathered() { return {shapes_.data(), rows_.data()}; }
    /// The second and the third stage of some rows, or of all.
    void take(std::size_t n, const std::uint64_t* some, std::size_t count, std::uint32_t room_of_each, queue& late) {
        for_each_index(on_, count, search_gathered<All>{each_.all, gathered(), times_.data(), some, room_of_each});
        queue open(on_, n / 4 + 1024), ties(on_, n / 8 + 1024);
        using choose = choose_gathered<All, sink_type>;
        for_each_index(on_, n, choose{gathered(), times_.data(), some, each_.all.in_scalars, sink_}, open, ties, late);
        if (ties.size() == 0) return;
        for_each_index(on_, open.size(), round_gathered<All>{each_.all, gathered(), times_.data(), open.data()});
        queue none(on_, 0);
        for_each_index(on_, ties.size(), choose{gathered(), times_.data(), ties.data(), each_.all.in_scalars, sink_}, none,
                       none, none);
    }
    void walk_again(const std::uint64_t* some, std::size_t n, queue& late) {
        execution::least_kept_by_walk until{1.0};
        const auto room_of_each = static_cast<std::uint32_t>(std::min(room_ / n, many));
        const std::size_t spread = spread_of(n);
        for_each_ordered(on_, n * spread, gather_many<All>{each_.all, gathered(), some, room_of_each, spread}, until);
        take(n, some, n * room_of_each, room_of_each, late);
    }

    const Policy& on_;
    const from_each<All>& each_;
    sink_type sink_;
    std::size_t room_;
    execution::buffer_of<Policy, gathered_row> rows_;
    execution::buffer_of<Policy, gathered_shape> shapes_;
    execution::buffer_of<Policy, time_bounds> times_;
};

}  // namespace abut::detail
