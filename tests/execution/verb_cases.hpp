// SPDX-License-Identifier: MIT
#pragma once

// What every policy's verbs promise (execution/policy.hpp), checked against the standard library. One source for all
// policies: tests/execution runs it on the host's, tests/cuda on the device.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <type_traits>
#include <vector>

#include <abut/execution/host.hpp>
#include <abut/execution/ordered.hpp>

#include "support/catch.hpp"
#include "support/scenes.hpp"

namespace abut::test {

struct write_square {
    std::uint64_t* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = i * i; }
};
struct identity {
    ABUT_HD std::uint64_t operator()(std::size_t i) const { return i; }
};
struct element {
    const std::uint64_t* values;
    ABUT_HD std::uint64_t operator()(std::size_t i) const { return values[i]; }
};
struct sum {
    ABUT_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};
struct write_remainder {
    std::uint32_t* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = static_cast<std::uint32_t>(i * i % 11); }
};
struct is_multiple {
    std::size_t of;
    ABUT_HD bool operator()(std::size_t i) const { return i % of == 0; }
};
/// Pushes i % 4 copies of i, and counts them.
struct push_some {
    ABUT_CALLS_ANY
    template <class Queue, class Count>
    ABUT_HD void operator()(std::size_t i, Queue& queue, Count& count) const {
        for (std::size_t k = 0; k < i % 4; ++k) {
            queue.push(i);
            count.add(1);
        }
    }
};
/// Each multiple of `of` finds `copies` candidates; a walk that was stopped goes on where it was.
struct emit_copies {
    using candidate = std::uint64_t;
    struct cursor {
        std::size_t next = 0;
    };
    std::size_t of, copies;
    ABUT_HD bool may_find(std::size_t i) const { return is_multiple{of}(i); }
    ABUT_CALLS_ANY
    template <class Emitter, class Hits>
    ABUT_HD bool operator()(std::size_t i, cursor& at, const Emitter& emitter, Hits&) const {
        for (; at.next < copies; ++at.next) {
            if (emitter.is_full()) return true;
            emitter.push(i * copies + at.next);
        }
        return false;
    }
};
/// Keeps what is not a multiple of 3; multiples of 5 are left open, and kept when they are finished.
struct keep_some {
    ABUT_CALLS_ANY
    template <class Hits>
    ABUT_HD bool operator()(std::uint64_t candidate, Hits& hits) const {
        if (candidate % 5 == 0) return false;
        if (candidate % 3 != 0) hits.push(candidate);
        return true;
    }
    ABUT_CALLS_ANY
    template <class Hits>
    ABUT_HD void finish(std::uint64_t candidate, Hits& hits) const {
        hits.push(candidate);
    }
};
struct count_always {
    template <class Count>
    ABUT_HD bool operator()(std::uint64_t, Count& count) const {
        count.add(1);
        return true;
    }
    template <class Count>
    ABUT_HD void finish(std::uint64_t, Count&) const {}
};
struct raise_at {
    std::size_t where;
    ABUT_CALLS_ANY
    template <class Flag>
    ABUT_HD void operator()(std::size_t i, Flag& flag) const {
        if (!flag.raised() && i == where) flag.raise();
    }
};
/// Every second candidate is left open.
struct raise_always {
    template <class Flag>
    ABUT_HD bool operator()(std::uint64_t candidate, Flag& flag) const {
        if (candidate % 2 == 0) return false;
        flag.raise();
        return true;
    }
    template <class Flag>
    ABUT_HD void finish(std::uint64_t, Flag& flag) const {
        flag.raise();
    }
};

struct product_tile {
    struct row {
        std::uint64_t value;
    };
    struct reach {
        std::uint64_t value;
    };
    using column = std::uint64_t;
    using candidate = std::uint64_t;
    /// A share of all pairs, or all of them.
    std::uint64_t modulus;
    const row* stored = nullptr;
    static bool passes(std::uint64_t modulus, std::uint64_t i, std::uint64_t j) { return (i * 3 + j) % modulus == 0; }
    const row* rows_in_memory() const { return stored; }
    ABUT_HD row load_row(std::size_t i) const { return {i + 1}; }
    ABUT_HD reach reach_of(const row& r) const { return {(r.value - 1) * 3}; }
    ABUT_HD column load_column(std::size_t j) const { return j + 1; }
    ABUT_HD bool passes(const reach& r, const column& c) const { return (r.value + c - 1) % modulus == 0; }
    ABUT_HD candidate candidate_of(std::size_t i, std::size_t j) const { return i << 32 | j; }
    /// Every eleventh diagonal is left open.
    ABUT_CALLS_ANY
    template <class Queue, class Count>
    ABUT_HD bool operator()(const row& r, std::size_t i, const column& c, std::size_t j, Queue& queue, Count& count) const {
        count.add(1);
        if ((i + j) % 11 == 0) return false;
        if (r.value * c % 7 == 0 && r.value == i + 1 && c == j + 1) queue.push(i << 32 | j);
        return true;
    }
    ABUT_CALLS_ANY
    template <class Queue, class Count>
    ABUT_HD void finish(std::uint64_t key, Queue& queue, Count& count) const {
        count.add(1000);
        if (((key >> 32) + 1) * ((key & 0xffffffff) + 1) % 7 == 0) queue.push(key);
    }
};
struct store_row {
    product_tile::row* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = product_tile{1}.load_row(i); }
};
template <class Policy, class T>
std::vector<T> on_host(const Policy& on, const T* values, std::size_t n) {
    std::vector<T> copy(n);
    download(on, values, n, copy.data());
    return copy;
}

template <class Policy, class Queue>
std::vector<std::uint64_t> sorted_content(const Policy& on, Queue& queue) {
    auto values = on_host(on, queue.data(), queue.size());
    std::sort(values.begin(), values.end());
    return values;
}

inline const std::size_t verb_sizes[] = {0, 1, 2, 31, 255, 256, 257, 1023, 4096, 8192, 70'001};

template <class Policy>
void check_loops(const Policy& on) {
    for (const std::size_t n : verb_sizes) {
        CAPTURE(n);
        execution::buffer_of<Policy, std::uint64_t> out(on, n);
        fill(on, out.data(), n, std::uint64_t{7});
        CHECK(on_host(on, out.data(), n) == std::vector<std::uint64_t>(n, 7));
        for_each_index(on, n, write_square{out.data()});
        std::vector<std::uint64_t> squares(n);
        for (std::size_t i = 0; i < n; ++i) squares[i] = i * i;
        CHECK(on_host(on, out.data(), n) == squares);

        execution::work_queue<std::uint64_t, space_of<Policy>> queue(on);
        execution::work_count<space_of<Policy>> count(on);
        for_each_index(on, n, push_some{}, queue, count);
        std::vector<std::uint64_t> expected;
        for (std::size_t i = 0; i < n; ++i) expected.insert(expected.end(), i % 4, i);
        CHECK(sorted_content(on, queue) == expected);
        CHECK(count.total() == expected.size());
        // What a queue has stays before what comes.
        const std::vector<std::uint64_t> before = on_host(on, queue.data(), queue.size());
        for_each_index(on, n, push_some{}, queue, count);
        std::vector<std::uint64_t> both = on_host(on, queue.data(), queue.size());
        REQUIRE(both.size() == 2 * expected.size());
        const auto middle = both.begin() + static_cast<std::ptrdiff_t>(expected.size());
        CHECK(std::equal(before.begin(), before.end(), both.begin()));
        std::sort(middle, both.end());
        CHECK(std::equal(expected.begin(), expected.end(), middle));
        CHECK(count.total() == 2 * expected.size());

        execution::work_flag<space_of<Policy>> flag(on), calm(on);
        for_each_index(on, n, raise_at{n / 2}, flag);
        for_each_index(on, n, raise_at{n}, calm);
        CHECK(flag.raised() == (n > 0));
        CHECK_FALSE(calm.raised());
    }
}

/// Few selected indices with few candidates, all of them with some, and more candidates than any block has room for.
template <class Policy>
void check_candidates(const Policy& on) {
    struct {
        std::size_t n, of, copies;
    } const cases[] = {{0, 1, 1}, {1, 1, 1}, {100'000, 97, 3}, {5000, 1, 4}, {70'000, 1, 1}, {3000, 1, 40}, {2, 1, 100'000}};
    for (const auto& [n, of, copies] : cases) {
        CAPTURE(n, of, copies);
        execution::work_queue<std::uint64_t, space_of<Policy>> hits(on);
        for_each_candidate(on, n, emit_copies{of, copies}, keep_some{}, hits);
        const std::vector<std::uint64_t> all = sorted_content(on, hits);
        std::vector<std::uint64_t> expected;
        for (std::size_t i = 0; i < n; i += of) {
            for (std::uint64_t c = i * copies; c < (i + 1) * copies; ++c) {
                if (c % 5 == 0 || c % 3 != 0) expected.push_back(c);
            }
        }
        CHECK(all == expected);
    }
}

/// Adds up each group in a heap, level by level: place k gets the sums of places 2 k and 2 k + 1, and index k of the group
/// is place 256 + k. Of each index it writes the sum of the group, that of place k, itself, how many indices of the group
/// are 1 more than a multiple of 3, and how many sums of the heap's upper levels are odd.
struct add_in_groups {
    static constexpr unsigned parts = 5, size = execution::group_size;
    std::uint64_t* sums;
    std::size_t n;

    struct shared {
        std::uint64_t value[2 * size];
        unsigned odd;
    };
    ABUT_HD void operator()(const execution::group<shared>& members) const {
        const std::size_t first = members.first;
        shared& with = members.shared;
        const unsigned thirds = members.count(0, size, [&](unsigned k) {
            with.value[size + k] = first + k < n ? first + k : 0;
            return first + k < n && (first + k) % 3 == 1;
        });
        members.each([&](unsigned k) {
            if (k == 0) with.value[0] = 0;
        });
        const auto add = [&](unsigned k) {
            with.value[k] = with.value[2 * k] + with.value[2 * k + 1];
            return with.value[k] % 2 == 1;
        };
        unsigned width = size / 2;
        for (; width > execution::subgroup_size; width /= 2) members.each(width, 2 * width, add);
        members.in_subgroup([&](const execution::subgroup& some) {
            unsigned odd = 0;
            for (; width > 4; width /= 2) odd += some.count(width, 2 * width, add);
            for (; width > 0; width /= 2) some.each(width, 2 * width, add);
            some.each(0, 1, [&](unsigned) { with.odd = odd; });
        });
        members.each(0, parts * size, [&](unsigned t) {
            const unsigned k = t / parts;
            const std::uint64_t values[parts] = {with.value[1], with.value[k], with.value[size + k], thirds, with.odd};
            if (first + k < n) sums[parts * first + t] = values[t % parts];
        });
    }
};

/// Of each group of 32: numbers that are no multiples of 3, in their order; a number for each bit of a member's number; how
/// many these are, and the least of some values.
struct append_in_groups {
    static constexpr unsigned members = execution::subgroup_size;
    struct shared {
        std::uint32_t listed[members];
        std::uint32_t named[members];  ///< by which bits each member was
        std::uint32_t taken[80];       ///< how often each number was, of as many as there are bits
    };
    static constexpr std::size_t parts = 5;
    std::uint64_t* out;
    std::size_t n;

    ABUT_CALLS_ANY
    template <class Group>
    ABUT_HD void operator()(const Group& group) const {
        shared& with = group.shared;
        typename Group::template value<std::uint64_t> own;
        group.each([&](unsigned k) {
            own[k] = group.first + k;
            with.named[k] = with.listed[k] = 0;
        });
        group.each(0, 80, [&](unsigned k) { with.taken[k] = 0; });
        unsigned listed = 1, bits = 5;
        group.each([&](unsigned k) {
            group.append(listed, own[k] % 3 != 0, [&](unsigned to) { with.listed[to - 1] = static_cast<unsigned>(own[k]); });
        });
        group.each([&](unsigned k) {
            group.append_bits(bits, k, [&](unsigned to, unsigned bit) {
                if (to < 5 || to >= 85 || bit >= 5) return;
                with.named[k] += 1u << bit;
                execution::increment_in_group(&with.taken[to - 5]);
            });
        });
        const double least = group.least([&](unsigned k) { return static_cast<double>((own[k] * 7919) % 1009); });
        group.each([&](unsigned k) {
            if (own[k] >= n) return;
            std::uint64_t* const mine = out + parts * own[k];
            mine[0] = with.listed[k];
            mine[1] = with.named[k];
            for (const std::uint32_t times : with.taken) mine[1] += times == 1 ? 100 : 0;
            mine[2] = listed;
            mine[3] = bits;
            mine[4] = static_cast<std::uint64_t>(least);
        });
    }
};

template <class Policy>
void check_small_groups(const Policy& on) {
    constexpr std::size_t size = execution::subgroup_size, parts = append_in_groups::parts;
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{32}, std::size_t{100}, std::size_t{5000}}) {
        CAPTURE(n);
        execution::buffer_of<Policy, std::uint64_t> out(on, parts * n);
        for_each_group(on, n, append_in_groups{out.data(), n});
        const auto written = on_host(on, out.data(), out.size());
        std::uint64_t wrong = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t first = i / size * size;
            std::vector<std::uint64_t> listed;
            std::uint64_t least = 1009;
            for (std::size_t j = first; j < first + size; ++j) {
                if (j % 3 != 0) listed.push_back(j);
                least = std::min<std::uint64_t>(least, j * 7919 % 1009);
            }
            const std::uint64_t expected[parts] = {i - first < listed.size() ? listed[i - first] : 0, 8000 + i - first,
                                                   1 + listed.size(), 85, least};
            for (std::size_t k = 0; k < parts; ++k) wrong += written[parts * i + k] != expected[k];
        }
        CHECK(wrong == 0);
    }
}

/// No group, groups that are whole, and a last one with one index or a few.
inline constexpr std::size_t group_counts[] = {0, 1, 255, 256, 257, 768, 70'001};

template <class Policy>
void check_groups(const Policy& on) {
    constexpr std::size_t size = execution::group_size, parts = add_in_groups::parts;
    for (const std::size_t n : group_counts) {
        CAPTURE(n);
        execution::buffer_of<Policy, std::uint64_t> sums(on, parts * n);
        for_each_group(on, n, add_in_groups{sums.data(), n});
        const auto written = on_host(on, sums.data(), sums.size());
        std::uint64_t wrong = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t first = i / size * size, k = i % size;
            const auto below = [&](std::size_t place) {
                std::size_t from = place, count = 1;
                for (; from < size; from *= 2) count *= 2;
                std::uint64_t sum = 0;
                for (std::size_t j = first + from - size; j < first + from - size + count && j < n; ++j) sum += j;
                return sum;
            };
            std::uint64_t thirds = 0, odd = 0;
            if (k == 0) {
                for (std::size_t j = first; j < first + size && j < n; ++j) thirds += j % 3 == 1;
                for (std::size_t place = 8; place < 64; ++place) odd += below(place) % 2;
                wrong += written[parts * i + 3] != thirds || written[parts * i + 4] != odd;
            }
            wrong += written[parts * i] != below(1) || written[parts * i + 1] != (k == 0 ? 0 : below(k)) ||
                     written[parts * i + 2] != i;
        }
        CHECK(wrong == 0);
    }
}

/// The number of indices lies in the policy's memory.
template <class Policy>
void check_indirect(const Policy& on) {
    for (const std::size_t n : verb_sizes) {
        CAPTURE(n);
        execution::buffer_of<Policy, std::uint32_t> number(on, 1);
        execution::buffer_of<Policy, std::uint64_t> out(on, n + 1);
        fill(on, number.data(), 1, static_cast<std::uint32_t>(n));
        fill(on, out.data(), n + 1, std::uint64_t{7});
        for_each_indirect(on, number.data(), write_square{out.data()});
        std::vector<std::uint64_t> squares(n + 1, 7), expected;
        for (std::size_t i = 0; i < n; ++i) squares[i] = i * i;
        CHECK(on_host(on, out.data(), n + 1) == squares);

        execution::work_queue<std::uint64_t, space_of<Policy>> queue(on);
        execution::work_count<space_of<Policy>> count(on);
        for_each_indirect(on, number.data(), push_some{}, queue, count);
        for (std::size_t i = 0; i < n; ++i) expected.insert(expected.end(), i % 4, i);
        CHECK(sorted_content(on, queue) == expected);
        CHECK(count.total() == expected.size());
    }
}

/// Items that make items: a tree of which the shape depends on `shape` alone.
struct grow {
    enum class kind : unsigned { full, ragged, chain, comb };
    struct item {
        std::uint64_t path;
        std::uint32_t depth;
    };
    using candidate = std::uint64_t;
    static constexpr unsigned most_children = 4, most_depth = 96;
    kind shape;
    std::uint32_t depth;

    std::size_t roots = 1;
    [[nodiscard]] std::size_t seeds() const { return roots; }
    void prefetch(const item&) const {}
    [[nodiscard]] ABUT_HD item seed(std::size_t i) const { return {i + 1, 0}; }
    [[nodiscard]] ABUT_HD bool has(std::uint64_t path, unsigned k) const {
        switch (shape) {
            case kind::full:
                return true;
            case kind::ragged:
                return k == 0 || (path >> 40) % 100 < 27;
            case kind::chain:
                return k == 2;
            case kind::comb:
                return k > 0;
        }
        return false;
    }
    ABUT_CALLS_ANY
    template <unsigned K, class Emitter>
    ABUT_HD void child(const item& at, Emitter& emitter) const {
        const std::uint64_t path = at.path * 6364136223846793005u + K + 1;
        const bool is = has(path, K), ends = at.depth + 1 >= depth || (shape == kind::comb && K > 1);
        const std::integral_constant<unsigned, K> k;
        emitter.add(k, is && !ends, item{path, at.depth + 1});
        emitter.push(k, is && ends, path);
    }
    ABUT_CALLS_ANY
    template <class Emitter>
    ABUT_HD void operator()(const item& at, Emitter& emitter) const {
        child<0>(at, emitter);
        child<1>(at, emitter);
        child<2>(at, emitter);
        child<3>(at, emitter);
    }
};

/// The candidates, by recursion.
struct grown {
    std::vector<std::uint64_t> candidates;
    template <class Place>
    void add(Place, bool is, const grow::item& at) {
        if (is) next.push_back(at);
    }
    template <class Place>
    void push(Place, bool is, std::uint64_t candidate) {
        if (is) candidates.push_back(candidate);
    }
    std::vector<grow::item> next;
    explicit grown(const grow& tree) {
        for (std::size_t i = 0; i < tree.roots; ++i) next.push_back(tree.seed(i));
        while (!next.empty()) {
            const grow::item at = next.back();
            next.pop_back();
            tree(at, *this);
        }
    }
};

template <class Policy>
void check_descents(const Policy& on) {
    using kind = grow::kind;
    struct {
        grow tree;
        std::size_t least;  ///< candidates that there should be, or the test shows nothing
    } const cases[] = {{{kind::full, 1}, 4},         {{kind::full, 2}, 16},  {{kind::full, 10}, 1'000'000},
                       {{kind::ragged, 20}, 10'000}, {{kind::chain, 95}, 1}, {{kind::comb, 95}, 180}};
    for (const auto& [tree, least] : cases) {
        CAPTURE(static_cast<unsigned>(tree.shape), tree.depth);
        execution::work_queue<std::uint64_t, space_of<Policy>> hits(on);
        for_each_descendant(on, tree, keep_some{}, hits);
        const grown truth(tree);
        CHECK(truth.candidates.size() >= least);
        std::vector<std::uint64_t> expected;
        for (const std::uint64_t c : truth.candidates) {
            if (c % 5 == 0 || c % 3 != 0) expected.push_back(c);
        }
        std::sort(expected.begin(), expected.end());
        CHECK((sorted_content(on, hits) == expected));
        execution::work_flag<space_of<Policy>> found(on);
        for_each_descendant(on, tree, raise_always{}, found);
        CHECK(found.raised() == (least > 0));
    }
}

template <class Policy>
void check_tile(const Policy& on, std::size_t n, std::size_t m, const product_tile& tile) {
    execution::work_queue<std::uint64_t, space_of<Policy>> queue(on);
    execution::work_count<space_of<Policy>> count(on);
    for_each_tiled(on, n, m, tile, queue, count);
    std::vector<std::uint64_t> expected;
    std::uint64_t passed = 0, settled = 0;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < m; ++j) {
            if (!product_tile::passes(tile.modulus, i, j)) continue;
            ++passed;
            settled += (i + j) % 11 == 0;
            if ((i + 1) * (j + 1) % 7 == 0) expected.push_back(i << 32 | j);
        }
    }
    CHECK(sorted_content(on, queue) == expected);
    CHECK(count.total() == passed + 1000 * settled);
}

template <class Policy>
void check_tiles(const Policy& on) {
    const std::pair<std::size_t, std::size_t> sizes[] = {{0, 5},      {5, 0},    {1, 1},     {1, 3000},   {3000, 1},
                                                         {300, 257},  {96, 1},   {97, 2},    {257, 1000}, {300'000, 1},
                                                         {20'001, 3}, {767, 32}, {7680, 33}, {1537, 31}};
    enum : int { computed, stored, stored_askew };
    for (const auto& [n, m] : sizes) {
        // Rows one after another; "askew" is by 8 bytes.
        execution::buffer_of<Policy, product_tile::row> memory(on, n + 1);
        for (const int where : {computed, stored, stored_askew}) {
            product_tile::row* const rows = where == computed ? nullptr : memory.data() + (where == stored_askew ? 1 : 0);
            if (where != computed) for_each_index(on, n, store_row{rows});
            for (const std::uint64_t modulus : {1u, 2u, 67u}) {
                if (n * m / modulus > 200'000) continue;  // or the test takes long
                CAPTURE(n, m, modulus, where);
                check_tile(on, n, m, product_tile{modulus, rows});
            }
        }
    }
}

template <class Policy>
void check_reductions(const Policy& on) {
    for (const std::size_t n : verb_sizes) {
        CAPTURE(n);
        CHECK(reduce(on, n, std::uint64_t{0}, sum{}, identity{}) == n * (n + 1) / 2 - n);
        execution::buffer_of<Policy, std::uint32_t> values(on, n + 1);
        for_each_index(on, n, write_remainder{values.data()});
        exclusive_scan(on, values.data(), n);
        std::vector<std::uint32_t> expected(n + 1);
        for (std::size_t i = 0; i < n; ++i) expected[i + 1] = static_cast<std::uint32_t>(expected[i] + i * i % 11);
        CHECK(on_host(on, values.data(), n + 1) == expected);

        execution::buffer_of<Policy, std::uint32_t> kept(on, n + 1);
        const std::size_t count = compact(on, n, is_multiple{3}, kept.data());
        REQUIRE(count == (n + 2) / 3);
        execution::buffer_of<Policy, std::uint64_t> sum_there(on, 1), twin(on, n);
        reduce_into(on, n, sum_there.data(), std::uint64_t{0}, sum{}, identity{});
        CHECK(on_host(on, sum_there.data(), 1).front() == n * (n + 1) / 2 - n);
        for_each_task(on, n, write_square{twin.data()});
        execution::buffer_of<Policy, std::uint64_t> squares(on, n);
        copy(on, twin.data(), n, squares.data());
        CHECK(reduce(on, n, std::uint64_t{0}, sum{}, element{squares.data()}) ==
              (n == 0 ? 0 : (n - 1) * n * (2 * n - 1) / 6));
        std::vector<std::uint32_t> multiples(count);
        for (std::size_t i = 0; i < count; ++i) multiples[i] = static_cast<std::uint32_t>(3 * i);
        CHECK(on_host(on, kept.data(), count) == multiples);
    }
}

template <class Key, class Policy>
void check_sorts(const Policy& on) {
    uniform random(42);
    for (const std::size_t n : verb_sizes) {
        for (const int bits : {0, 1, 11, 12, 23, 30, static_cast<int>(8 * sizeof(Key))}) {
            CAPTURE(n, bits, sizeof(Key));
            Key mask = bits == 8 * sizeof(Key) ? static_cast<Key>(-1) : static_cast<Key>((Key{1} << bits) - 1);
            if (bits == 23) mask = static_cast<Key>(mask & ~Key{0xffff});  // keys that differ in their last digit alone
            std::vector<Key> keys(n);
            std::vector<std::uint32_t> order(n);
            for (Key& key : keys) key = static_cast<Key>(random() * 0x1p53) * Key{2654435761u} & mask;
            std::iota(order.begin(), order.end(), 0u);

            execution::buffer_of<Policy, Key> sorted(on, n), alone(on, n);
            execution::buffer_of<Policy, std::uint32_t> values(on, n);
            upload(on, keys.data(), n, sorted.data());
            upload(on, keys.data(), n, alone.data());
            upload(on, order.data(), n, values.data());
            sort_by_key(on, sorted, values, bits);
            sort_keys(on, alone, bits);
            std::stable_sort(order.begin(), order.end(),
                             [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
            std::sort(keys.begin(), keys.end());
            CHECK(on_host(on, sorted.data(), n) == keys);
            CHECK(on_host(on, alone.data(), n) == keys);
            CHECK(on_host(on, values.data(), n) == order);
        }
    }
}

/// Index i offers `width` values, of which many are equal, and passes over those above the bound. `visits` counts the
/// others.
struct offer_some {
    std::size_t width;
    std::uint64_t* visits;
    ABUT_HD static double value(std::size_t i, std::size_t k) {
        return static_cast<double>((i * 2654435761u + k * 40503u) % 1009) * 0.25;
    }
    /// Of equal values the last one to come has the least key.
    ABUT_HD std::uint64_t key(std::size_t i, std::size_t k) const { return (1'000'000 - i) * width + (width - k); }
    ABUT_CALLS_ANY
    template <class Sink>
    ABUT_HD void operator()(std::size_t i, Sink& best) const {
        for (std::size_t k = 0; k < width; ++k) {
            if (value(i, k) > best.bound()) continue;
            best.offer(value(i, k), key(i, k));
            execution::atomic_add(visits, std::uint64_t{1});
        }
    }
};

template <class Policy>
void check_ordered(const Policy& on) {
    for (const std::size_t n : {0u, 1u, 31u, 257u, 5000u}) {
        CAPTURE(n);
        execution::buffer_of<Policy, std::uint64_t> visits(on, 1);
        fill(on, visits.data(), 1, std::uint64_t{0});
        const offer_some walk{40, visits.data()};
        std::vector<execution::least_value> of_each(n);
        execution::least_value of_all;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t k = 0; k < walk.width; ++k) of_each[i].offer(walk.value(i, k), walk.key(i, k));
            of_all.offer(of_each[i].value, of_each[i].key);
        }
        execution::best_of_each<space_of<Policy>> each(on, n);
        for_each_ordered(on, n, walk, each);
        CHECK((on_host(on, each.data(), n) == of_each));
        const std::uint64_t alone = on_host(on, visits.data(), 1)[0];
        execution::best_of_all<space_of<Policy>> all(on);
        for_each_ordered(on, n, walk, all);
        CHECK((all.least() == of_all));
        // One bound for all passes over more.
        const std::uint64_t together = on_host(on, visits.data(), 1)[0] - alone;
        CHECK(alone <= n * walk.width);
        if (n == 5000) CHECK(together < alone / 2);
        // What comes in later loops is added.
        for_each_ordered(on, std::size_t{1}, walk, all);
        CHECK((all.least() == of_all || n == 0));
    }
}

template <class Policy>
void check_verbs(const Policy& on) {
    check_loops(on);
    check_candidates(on);
    check_groups(on);
    check_small_groups(on);
    check_indirect(on);
    check_descents(on);
    check_tiles(on);
    check_ordered(on);
    check_reductions(on);
    check_sorts<std::uint32_t>(on);
    check_sorts<std::uint64_t>(on);
}

}  // namespace abut::test
