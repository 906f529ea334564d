// SPDX-License-Identifier: MIT
#include <abut/narrow/time_of_impact.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <random>
#include <string>

#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/motion_families.hpp"
#include "support/motion_oracle.hpp"
#include "support/samples.hpp"

// The times of contact of moving features, and each stage that finds them, against the oracle in unbounded integers.

namespace abut::test {

namespace {

constexpr motion_kind both_kinds[] = {motion_kind::vertex_face, motion_kind::edge_edge};

template <scalar T>
detail::moving_points<T> points_of(const motion<T>& m) {
    detail::moving_points<T> p;
    for (int i = 0; i < 4; ++i) {
        p.t0[i] = m.t0[i];
        p.t1[i] = m.t1[i];
    }
    return p;
}

/// Calls `ask` with the two features.
template <scalar T, class Ask>
auto with_features(motion_kind kind, const motion<T>& m, const Ask& ask) {
    if (kind == motion_kind::vertex_face) {
        return ask(moving(m.t0[0], m.t1[0]),
                   moving(triangle<T>{m.t0[1], m.t0[2], m.t0[3]}, triangle<T>{m.t1[1], m.t1[2], m.t1[3]}));
    }
    return ask(moving(segment<T>{m.t0[0], m.t0[1]}, segment<T>{m.t1[0], m.t1[1]}),
               moving(segment<T>{m.t0[2], m.t0[3]}, segment<T>{m.t1[2], m.t1[3]}));
}

template <class A, scalar T>
double time_of(motion_kind kind, const motion<T>& m, const conservative_bounds& bounds = {}) {
    return with_features(kind, m, [&](const auto& s, const auto& t) { return time_of_impact<A>(s, t, bounds); });
}

/// What `filtered` and `exact` have to say.
double expected_time(const motion_answer& a) { return a.hit ? std::ldexp(static_cast<double>(a.cell), -40) : -1; }

/// One more family: points that share coordinates at both times, three of them or all, as those of grids and boxes do, which
/// some stages look for. In integers, or anywhere.
constexpr auto aligned = static_cast<motion_family>(motion_family_count);

const char* name_of_family(motion_family f) { return f == aligned ? "aligned" : name_of(f); }

template <scalar T>
motion<T> aligned_pair(std::uint64_t seed_value, motion_kind kind, std::uint64_t index) {
    draws d(seed_value, 1000 + static_cast<std::uint64_t>(kind), index);
    const int lattice = d.below(3) == 0 ? 0 : 2 + d.below(7);
    const auto number = [&] {
        const double x = lattice > 0 ? d.below(lattice) : d.uniform(-1, 1);
        return construction::rounded_to<T>(x);
    };
    motion<T> m;
    constexpr T vec3<T>::*axes[3] = {&vec3<T>::x, &vec3<T>::y, &vec3<T>::z};
    const bool three_of_each = d.below(3) == 0;        // of which no axis shows all areas
    const int plane = three_of_each ? 3 : d.below(4);  // all points are in one, across this axis
    for (int k = 0; k < 3; ++k) {
        const bool is_still = d.below(4) == 0;
        const T shared_t0 = number(), shared_t1 = is_still ? shared_t0 : number();
        const int style = three_of_each ? 1 : d.below(3), left_out = d.below(4);
        for (int i = 0; i < 4; ++i) {
            const T t0 = number(), t1 = number();
            const bool shares = k == plane || (style == 1 && i != left_out) || (style == 2 && i < 2);
            m.t0[i].*axes[k] = shares ? shared_t0 : t0;
            m.t1[i].*axes[k] = shares ? shared_t1 : is_still ? t0 : t1;
        }
    }
    return construction::motions::shuffled(d, kind, m);
}

template <scalar T>
motion<T> pair_of(std::uint64_t seed_value, motion_kind kind, motion_family f, std::uint64_t index) {
    return f == aligned ? aligned_pair<T>(seed_value, kind, index) : make_motion<T>(seed_value, kind, f, index);
}

/// Pairs of these families cost milliseconds each in double.
template <scalar T>
std::uint64_t count_of(motion_family f, std::uint64_t n) {
    const bool slow = f == motion_family::wide_lattice || f == motion_family::all_bit_patterns ||
                      f == motion_family::any_scale || f == motion_family::axis_scales;
    return f == aligned ? 10 * n : slow && sizeof(T) == 8 ? n / 20 + 1 : n;
}

/// How often something was wrong, and where last.
struct flaws {
    std::uint64_t count = 0;
    std::uint64_t last = 0;

    void add(bool wrong, std::uint64_t i) {
        if (!wrong) return;
        ++count;
        last = i;
    }
    flaws& operator+=(const flaws& other) {
        count += other.count;
        if (other.count > 0) last = other.last;
        return *this;
    }
};

#define ABUT_CHECK_NONE(flaws)         \
    do {                               \
        CAPTURE(#flaws, (flaws).last); \
        CHECK((flaws).count == 0);     \
    } while (false)

/// Calls body(kind, family, index, tally) for pairs of each family, and check(tally) for each family.
template <scalar T, class Tally, class Body, class Check>
void for_each_family(std::uint64_t n, const Body& body, const Check& check) {
    for (const motion_kind kind : both_kinds) {
        for (int k = 0; k <= motion_family_count; ++k) {
            const auto f = static_cast<motion_family>(k);
            const Tally tally =
                in_threads<Tally>(count_of<T>(f, n), [&](std::uint64_t first, std::uint64_t last, Tally& of_thread) {
                    for (std::uint64_t i = first; i < last; ++i) body(kind, f, i, of_thread);
                });
            CAPTURE(name_of(kind), name_of_family(f));
            check(kind, f, tally);
        }
    }
}

// --- filtered, exact, fast
// -------------------------------------------------------------------------------------------------

struct exact_tally {
    std::uint64_t pairs = 0, hits = 0, decided_once = 0, decided_late = 0, in_registers = 0, fast_misses = 0,
                  fast_alarms = 0;
    flaws filtered_time, exact_time, features, order, predicates, fast_answer;

    exact_tally& operator+=(const exact_tally& t) {
        pairs += t.pairs, hits += t.hits, decided_once += t.decided_once, decided_late += t.decided_late;
        in_registers += t.in_registers, fast_misses += t.fast_misses, fast_alarms += t.fast_alarms;
        filtered_time += t.filtered_time, exact_time += t.exact_time, features += t.features, order += t.order;
        predicates += t.predicates, fast_answer += t.fast_answer;
        return *this;
    }
};

template <scalar T>
void examine_exact(motion_kind kind, motion_family f, std::uint64_t i, exact_tally& tally) {
    const motion<T> m = pair_of<T>(sample_seed, kind, f, i);
    const motion_answer truth = oracle::first_contact(kind, m);
    const double time = expected_time(truth);
    ++tally.pairs;
    tally.hits += truth.hit;
    tally.filtered_time.add(time_of<filtered>(kind, m) != time, i);
    tally.exact_time.add(time_of<exact>(kind, m) != time, i);
    const bool edges = kind == motion_kind::edge_edge;
    const auto p = points_of(m);
    tally.features.add((edges ? detail::exact_time<true>(p) : detail::exact_time<false>(p)) != truth.cell, i);

    draws d(sample_seed, 78, i);
    const motion<T> other = construction::motions::shuffled(d, kind, m);
    tally.order.add(time_of<filtered>(kind, other) != time || time_of<exact>(kind, other) != time, i);

    const verdict right = to_verdict(truth.hit);
    with_features(kind, m, [&](const auto& s, const auto& t) {
        const verdict once = decide<filtered>(s, t), late = decide_late<filtered>(s, t);
        const bool wrong = (once != verdict::unknown && once != right) || (late != verdict::unknown && late != right) ||
                           decide<exact>(s, t) != verdict::unknown || resolve(s, t) != truth.hit;
        tally.predicates.add(wrong, i);
        tally.decided_once += once != verdict::unknown;
        tally.decided_late += late != verdict::unknown;
    });
    const std::int64_t count = (edges ? detail::filtered_time<true>(p) : detail::filtered_time<false>(p)).count;
    tally.in_registers += count != detail::time_in_bits::unknown;

    const double quick = time_of<fast>(kind, m);
    tally.fast_answer.add(!(quick == -1 || (quick >= 0 && quick <= 1)), i);
    tally.fast_misses += truth.hit && quick < 0;
    tally.fast_alarms += !truth.hit && quick >= 0;
}

}  // namespace

TEMPLATE_TEST_CASE("time of impact: filtered and exact are the oracle's, bit for bit", "", float, double) {
    const bool wordy = std::getenv("ABUT_PRINT") != nullptr;
    exact_tally all;
    for_each_family<TestType, exact_tally>(
        sample_count() / 40, examine_exact<TestType>, [&](motion_kind kind, motion_family f, const exact_tally& t) {
            CHECK(t.pairs > 0);
            ABUT_CHECK_NONE(t.filtered_time);
            ABUT_CHECK_NONE(t.exact_time);
            ABUT_CHECK_NONE(t.features);
            ABUT_CHECK_NONE(t.order);
            ABUT_CHECK_NONE(t.predicates);
            ABUT_CHECK_NONE(t.fast_answer);
            all += t;
            if (wordy) {
                std::printf(
                    "%-11s %-20s %6zu pairs %6zu hits; once %5.1f %%, late %5.1f %%, time %5.1f %%; "
                    "fast: %zu missed, %zu false alarms\n",
                    name_of(kind), name_of_family(f), std::size_t{t.pairs}, std::size_t{t.hits},
                    100.0 * static_cast<double>(t.decided_once) / static_cast<double>(t.pairs),
                    100.0 * static_cast<double>(t.decided_late) / static_cast<double>(t.pairs),
                    100.0 * static_cast<double>(t.in_registers) / static_cast<double>(t.pairs), std::size_t{t.fast_misses},
                    std::size_t{t.fast_alarms});
            }
        });
    CHECK(all.hits * 3 > all.pairs);
    CHECK((all.pairs - all.hits) * 10 > all.pairs);
    // That each stage is asked: some pairs end in each.
    CHECK(all.decided_once * 10 > all.pairs);
    CHECK(all.decided_late > all.decided_once);
    CHECK(all.in_registers < all.pairs);
    CHECK((all.pairs - all.decided_late) * 20 > all.pairs);
}

// --- the filter alone
// ------------------------------------------------------------------------------------------------------

namespace {

struct filter_tally {
    std::uint64_t pairs = 0, yes = 0, no = 0, deep = 0, more_with_shared = 0;
    flaws once, search, search_unshared, search_one_root, interval, before;

    filter_tally& operator+=(const filter_tally& t) {
        pairs += t.pairs, yes += t.yes, no += t.no, deep += t.deep, more_with_shared += t.more_with_shared;
        once += t.once, search += t.search, search_unshared += t.search_unshared, search_one_root += t.search_one_root;
        interval += t.interval, before += t.before;
        return *this;
    }
};

template <bool Edges, scalar T>
void examine_filter(const motion<T>& m, const motion_answer& truth, std::uint64_t i, filter_tally& tally) {
    const auto p = points_of(m);
    const detail::motion_filter<Edges> filter(p);
    const std::uint32_t shared = detail::shared_coordinates<Edges>(p);
    const auto contradicts = [&](verdict v) { return v == to_verdict(!truth.hit); };
    tally.once.add(contradicts(filter.look_once()), i);
    const auto found = filter.search(false, shared), unshared = filter.search(false, 0), one = filter.search(true, shared);
    tally.search.add(contradicts(found.touch), i);
    tally.search_unshared.add(contradicts(unshared.touch), i);
    tally.search_one_root.add(contradicts(one.touch), i);
    for (const auto& a : {found, unshared, one}) {
        if (!truth.hit || a.touch == verdict::no) continue;
        const std::int64_t cell = truth.cell >> (40 - a.depth);  // the last instant of the step is in no cell of it
        const bool inside = cell == a.j;
        if (a.touch == verdict::yes) tally.interval.add(!inside, i);
        if (a.touch == verdict::unknown) tally.before.add(cell < a.j, i);
    }
    tally.yes += found.touch == verdict::yes;
    tally.no += found.touch == verdict::no;
    tally.deep += found.depth > 0;
    tally.more_with_shared += found.touch != verdict::unknown && unshared.touch == verdict::unknown;
}

}  // namespace

TEMPLATE_TEST_CASE("time of impact: the filter never contradicts the oracle", "", float, double) {
    filter_tally all;
    for_each_family<TestType, filter_tally>(
        sample_count() / 20,
        [](motion_kind kind, motion_family f, std::uint64_t i, filter_tally& tally) {
            const motion<TestType> m = pair_of<TestType>(sample_seed + 3, kind, f, i);
            const motion_answer truth = oracle::first_contact(kind, m);
            ++tally.pairs;
            kind == motion_kind::edge_edge ? examine_filter<true>(m, truth, i, tally)
                                           : examine_filter<false>(m, truth, i, tally);
        },
        [&](motion_kind, motion_family, const filter_tally& t) {
            ABUT_CHECK_NONE(t.once);
            ABUT_CHECK_NONE(t.search);
            ABUT_CHECK_NONE(t.search_unshared);
            ABUT_CHECK_NONE(t.search_one_root);
            ABUT_CHECK_NONE(t.interval);
            ABUT_CHECK_NONE(t.before);
            all += t;
        });
    CHECK(all.yes * 10 > all.pairs);
    CHECK(all.no * 10 > all.pairs);
    CHECK(all.deep * 20 > all.pairs);
    CHECK(all.more_with_shared > 0);
}

namespace {

struct mode_tally {
    std::uint64_t pairs = 0;
    flaws decisions, times, filters, conservative_time;

    mode_tally& operator+=(const mode_tally& t) {
        pairs += t.pairs, decisions += t.decisions, times += t.times, filters += t.filters;
        conservative_time += t.conservative_time;
        return *this;
    }
};

}  // namespace

TEMPLATE_TEST_CASE("time of impact: in every mode of the processor", "", float, double) {
    for_each_family<TestType, mode_tally>(
        sample_count() / 100 + 1,
        [](motion_kind kind, motion_family f, std::uint64_t i, mode_tally& tally) {
            const motion<TestType> m = pair_of<TestType>(sample_seed + 4, kind, f, i);
            const motion_answer truth = oracle::first_contact(kind, m);
            const double time = expected_time(truth);
            ++tally.pairs;
            for (const floating_mode& mode : floating_modes()) {
                double found = 0, careful = 0;
                bool contradicts = false;
                in_mode(mode, [&] {
                    found = time_of<filtered>(kind, m);
                    careful = time_of<conservative>(kind, m, {.tolerance = 1e-3});
                    with_features(kind, m, [&](const auto& s, const auto& t) {
                        contradicts = decide<filtered>(s, t) == to_verdict(!truth.hit) ||
                                      decide_late<filtered>(s, t) == to_verdict(!truth.hit);
                    });
                });
                tally.decisions.add((found >= 0) != truth.hit, i);
                tally.times.add(found != time, i);
                tally.filters.add(contradicts, i);
                tally.conservative_time.add(truth.hit && !(careful >= 0 && careful <= time + 0x1p-40), i);
            }
        },
        [&](motion_kind, motion_family, const mode_tally& t) {
            ABUT_CHECK_NONE(t.decisions);
            ABUT_CHECK_NONE(t.times);
            ABUT_CHECK_NONE(t.filters);
            ABUT_CHECK_NONE(t.conservative_time);
        });
}

// --- conservative
TEST_CASE("time of impact: denormals that are read as zero are not equal") {
    // In one plane across y, for those that cannot tell denormal numbers: y has nothing else.
    const motion<float> m{
        {{0x1.8p-32f, 0x1p-132f, 0}, {0x1p-32f, 0x1.8p-132f, 0}, {0x1p-33f, 0x1.8p-132f, 0x1p-17f}, {0, 0, 0x1p-17f}},
        {{0x1p-32f, 0x1p-132f, 0x1p-17f},
         {0x1p-32f, 0x1p-133f, 0},
         {0x1p-33f, 0, 0x1p-17f},
         {0x1.8p-32f, 0x1p-133f, 0x1.8p-17f}}};
    REQUIRE_FALSE(oracle::first_contact(motion_kind::vertex_face, m).hit);
    for (const floating_mode& mode : floating_modes()) {
        double time = 0;
        in_mode(mode, [&] { time = time_of<filtered>(motion_kind::vertex_face, m); });
        CAPTURE(mode.name);
        CHECK(time == -1);
    }
}

// ----------------------------------------------------------------------------------------------------------

namespace {

using real = long double;
using real_vec = std::array<real, 3>;

real_vec minus(const real_vec& a, const real_vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
real inner(const real_vec& a, const real_vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
real length(const real_vec& a) { return std::sqrt(inner(a, a)); }
real_vec plus(const real_vec& a, real k, const real_vec& b) { return {a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]}; }

real to_segment(const real_vec& p, const real_vec& a, const real_vec& b) {
    const real_vec u = minus(b, a), w = minus(p, a);
    const real uu = inner(u, u), s = uu > 0 ? std::clamp<real>(inner(w, u) / uu, 0, 1) : 0;
    return length(plus(w, -s, u));
}

/// By the least over the borders and, where the feet of the perpendicular are inside, that.
real distance_of(motion_kind kind, const std::array<real_vec, 4>& p) {
    if (kind == motion_kind::vertex_face) {
        real least = std::min({to_segment(p[0], p[1], p[2]), to_segment(p[0], p[2], p[3]), to_segment(p[0], p[3], p[1])});
        const real_vec u = minus(p[2], p[1]), v = minus(p[3], p[1]), w = minus(p[0], p[1]);
        const real uu = inner(u, u), uv = inner(u, v), vv = inner(v, v), wu = inner(w, u), wv = inner(w, v),
                   area = uu * vv - uv * uv;
        if (area > 0) {
            const real s = (wu * vv - wv * uv) / area, r = (wv * uu - wu * uv) / area;
            if (s >= 0 && r >= 0 && s + r <= 1) least = std::min(least, length(plus(plus(w, -s, u), -r, v)));
        }
        return least;
    }
    real least = std::min({to_segment(p[0], p[2], p[3]), to_segment(p[1], p[2], p[3]), to_segment(p[2], p[0], p[1]),
                           to_segment(p[3], p[0], p[1])});
    const real_vec u = minus(p[1], p[0]), v = minus(p[3], p[2]), w = minus(p[2], p[0]);
    const real uu = inner(u, u), uv = inner(u, v), vv = inner(v, v), wu = inner(w, u), wv = inner(w, v),
               area = uu * vv - uv * uv;
    if (area > 0) {
        const real s = (wu * vv - wv * uv) / area, r = (wu * uv - wv * uu) / area;
        if (s >= 0 && s <= 1 && r >= 0 && r <= 1) least = std::min(least, length(plus(plus(w, -s, u), r, v)));
    }
    return least;
}

/// The features seen from point 1, at a time; how far the relative positions of points reach and move.
template <scalar T>
class seen_motion {
public:
    seen_motion(motion_kind kind, const motion<T>& m) : kind_(kind) {
        for (std::size_t i = 0; i < 4; ++i) {
            at_0_[i] = relative(m.t0[i], m.t0[1]);
            change_[i] = minus(relative(m.t1[i], m.t1[1]), at_0_[i]);
        }
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j) {
                speed_ = std::max(speed_, length(minus(change_[i], change_[j])));
                reach_ = std::max(reach_, length(minus(at_0_[i], at_0_[j])));
            }
        }
        reach_ += speed_;
    }
    [[nodiscard]] real distance(real t) const {
        std::array<real_vec, 4> p;
        for (std::size_t i = 0; i < 4; ++i) p[i] = plus(at_0_[i], t, change_[i]);
        return distance_of(kind_, p);
    }
    [[nodiscard]] real speed() const { return speed_; }
    [[nodiscard]] real reach() const { return reach_; }

private:
    static real_vec relative(const vec3<T>& p, const vec3<T>& q) {
        return {static_cast<real>(p.x) - static_cast<real>(q.x), static_cast<real>(p.y) - static_cast<real>(q.y),
                static_cast<real>(p.z) - static_cast<real>(q.z)};
    }

    motion_kind kind_;
    std::array<real_vec, 4> at_0_{}, change_{};
    real speed_ = 0, reach_ = 0;
};

/// Families whose numbers long double has a range for.
constexpr bool is_moderate(motion_family f) {
    return (f < motion_family::any_scale || f == aligned) && f != motion_family::needles && f != motion_family::flat;
}

struct conservative_tally {
    std::uint64_t pairs = 0, hits = 0, close = 0, far_before = 0, alarms = 0, near_in_time = 0;
    flaws missed, late, range, early, separation_later, separation_order, near_missed;

    conservative_tally& operator+=(const conservative_tally& t) {
        pairs += t.pairs, hits += t.hits, close += t.close, far_before += t.far_before, alarms += t.alarms;
        near_in_time += t.near_in_time;
        missed += t.missed, late += t.late, range += t.range, early += t.early;
        separation_later += t.separation_later, separation_order += t.separation_order, near_missed += t.near_missed;
        return *this;
    }
};

template <scalar T>
void examine_conservative(motion_kind kind, motion_family f, std::uint64_t i, conservative_tally& tally) {
    const motion<T> m = pair_of<T>(sample_seed + 5, kind, f, i);
    const motion_answer truth = oracle::first_contact(kind, m);
    const seen_motion<T> seen(kind, m);
    ++tally.pairs;
    tally.hits += truth.hit;
    constexpr double tolerances[] = {0.25, 0.1, 1e-3, 1e-6, 1e-9, 0};
    for (std::size_t k = 0; k < std::size(tolerances); ++k) {
        if (k >= 3 && i % 8 != k) continue;  // thousands of intervals each
        const double tolerance = tolerances[k];
        const double time = time_of<conservative>(kind, m, {.tolerance = tolerance});
        tally.range.add(!(time == -1 || (time >= 0 && time <= 1)), i);
        tally.missed.add(truth.hit && time < 0, i);
        tally.late.add(truth.hit && truth.exact->compared_to(time) < 0, i);
        tally.alarms += k == 2 && !truth.hit && time >= 0;
        if (k == 2 && truth.hit) tally.near_in_time += truth.time - time <= tolerance;
        // No more than 2^14 intervals can be asked of a tolerance as large as that. In the last one, which is reported, the
        // features are as near as their motion within it explains.
        if (k >= 3 || time < 0 || !is_moderate(f)) continue;
        const double width = std::bit_floor(static_cast<std::uint32_t>(1 / tolerance)) == 1 / tolerance
                                 ? tolerance
                                 : 0.5 / static_cast<double>(std::bit_floor(static_cast<std::uint32_t>(1 / tolerance)));
        const real nearest = seen.distance(static_cast<real>(time) + static_cast<real>(width) / 2);
        tally.early.add(nearest > seen.speed() * static_cast<real>(width) / 2 + seen.reach() * 1e-7L, i);
    }

    // Larger separations are reported no later, and no pair that comes so near is left out.
    if (i % 4 != 0) return;
    const double unit = static_cast<double>(seen.reach());
    double last = time_of<conservative>(kind, m, {.tolerance = 1e-2});
    for (const double part : {1e-12, 1e-6, 1e-3, 0.01, 0.1, 0.5, 2.0}) {
        const double separation = part * unit;
        if (!(separation > 0 && std::isfinite(separation))) continue;
        const double time = time_of<conservative>(kind, m, {.tolerance = 1e-2, .separation = separation});
        tally.separation_later.add(truth.hit && (time < 0 || truth.exact->compared_to(time) < 0), i);
        tally.separation_order.add(last >= 0 && (time < 0 || time > last), i);
        last = time;
        if (!is_moderate(f)) continue;
        for (int s = 0; s <= 32; ++s) {
            const real t = static_cast<real>(s) / 32;
            if (seen.distance(t) > static_cast<real>(separation) * (1 - 1e-12L)) continue;
            tally.near_missed.add(time < 0 || static_cast<real>(time) > t, i);
            ++tally.close;
            break;
        }
    }
}

}  // namespace

TEMPLATE_TEST_CASE("time of impact: conservative never misses and is never late", "", float, double) {
    conservative_tally all, in_general;
    for_each_family<TestType, conservative_tally>(sample_count() / 25 + 1, examine_conservative<TestType>,
                                                  [&](motion_kind, motion_family f, const conservative_tally& t) {
                                                      ABUT_CHECK_NONE(t.range);
                                                      ABUT_CHECK_NONE(t.missed);
                                                      ABUT_CHECK_NONE(t.late);
                                                      // Of triangles that are nearly segments the nearest point is not
                                                      // always found.
                                                      CHECK(t.early.count * 200 <= t.pairs);
                                                      ABUT_CHECK_NONE(t.separation_later);
                                                      ABUT_CHECK_NONE(t.separation_order);
                                                      ABUT_CHECK_NONE(t.near_missed);
                                                      all += t;
                                                      if (f == motion_family::random || f == motion_family::crossing)
                                                          in_general += t;
                                                  });
    CHECK(all.close > all.pairs / 2);
    CHECK(in_general.near_in_time * 100 >= in_general.hits * 97);
    CHECK(in_general.alarms * 20 <= in_general.pairs);
}

namespace {

struct rest_tally {
    std::uint64_t pairs = 0;
    flaws within, beyond, touching;

    rest_tally& operator+=(const rest_tally& t) {
        pairs += t.pairs, within += t.within, beyond += t.beyond, touching += t.touching;
        return *this;
    }
};

}  // namespace

TEMPLATE_TEST_CASE("time of impact: a pair at rest is reported within the separation, and only there", "", float, double) {
    rest_tally all;
    for (const motion_kind kind : both_kinds) {
        for (const motion_family f :
             {motion_family::random, motion_family::at_rest, motion_family::lattice_4, motion_family::lattice_16,
              motion_family::at_rest_coplanar, motion_family::offset_1e6}) {
            rest_tally t;
            for (std::uint64_t i = 0; i < sample_count() / 5; ++i) {
                motion<TestType> m = pair_of<TestType>(sample_seed + 6, kind, f, i);
                draws d(sample_seed + 6, 79, i);
                const vec3<TestType> by{static_cast<TestType>(d.below(9)), static_cast<TestType>(d.below(9)), 0};
                const bool moves = f != motion_family::random && f != motion_family::offset_1e6 && i % 2 == 0;
                for (int k = 0; k < 4; ++k) m.t1[k] = moves ? m.t0[k] + by : m.t0[k];  // together
                const bool touches = oracle::first_contact(kind, m).hit;
                const seen_motion<TestType> seen(kind, m);
                const real distance = seen.distance(0);
                const auto time = [&](real separation) {
                    return time_of<conservative>(kind, m, {.tolerance = 0.1, .separation = static_cast<double>(separation)});
                };
                t.touching.add(touches && time_of<conservative>(kind, m) != 0, i);
                if (touches || distance < 1e-4L * seen.reach()) continue;
                ++t.pairs;
                t.within.add(time(distance * (1 + 1e-12L)) != 0, i);
                t.beyond.add(time(distance * (1 - 1e-7L)) != -1, i);
            }
            CAPTURE(name_of(kind), name_of_family(f));
            ABUT_CHECK_NONE(t.within);
            ABUT_CHECK_NONE(t.beyond);
            ABUT_CHECK_NONE(t.touching);
            all += t;
        }
    }
    CHECK(all.pairs > sample_count() / 5 * 4);
}

TEST_CASE("time of impact: a vertex at rest by a narrow face is not nearer than it is") {
    // A million pairs had this one, whose nearest point by weights of corners is off by 1e-7 of the distance.
    const vec3<float> vertex{-175744.469f, 387400.25f, 437064.531f};
    const triangle<float> face{{-175632.188f, 387580.438f, 437223.125f},
                               {-175897.344f, 387154.844f, 436848.125f},
                               {-175936.422f, 387149.312f, 436888.875f}};
    constexpr double distance = 0.06346650420195728;  // of rationals, rounded
    const auto time = [&](double separation) {
        return time_of_impact<conservative>(moving(vertex, vertex), moving(face, face),
                                            {.tolerance = 0.1, .separation = separation});
    };
    CHECK(time(distance * (1 + 1e-12)) == 0);
    CHECK(time(distance * (1 - 1e-8)) == -1);
}

TEMPLATE_TEST_CASE("points that all come to one place meet there, unless they touch at the start", "", float, double) {
    using T = TestType;
    std::mt19937 random(20261128);
    const auto coordinate = [&] { return static_cast<T>(static_cast<int>(random() % 5) - 2); };  // many touch, many are flat
    const auto point = [&] { return vec3<T>{coordinate(), coordinate(), coordinate()}; };
    int at_start = 0, at_end = 0;
    for (int i = 0; i < 3000; ++i) {
        const vec3<T> end = i % 3 == 0 ? point() : vec3<T>{T(0.3), T(-0.7), T(0.1)};
        const vec3<T> a = point(), b = point(), c = point(), d = point();
        const auto check = [&](const auto& s, const auto& t, bool touch) {
            const double when = time_of_impact(s, t);
            CHECK(when == time_of_impact<exact>(s, t));
            CHECK(when == (touch ? 0 : 1));
            (touch ? at_start : at_end) += 1;
        };
        const triangle<T> face{a, b, c}, last_face{end, end, end};
        const segment<T> one{a, b}, other{c, d}, last_edge{end, end};
        check(moving(d, end), moving(face, last_face), intersects<exact>(segment<T>{d, d}, face));
        check(moving(one, last_edge), moving(other, last_edge),
              intersects<exact>(triangle<T>{a, b, b}, triangle<T>{c, d, d}));
    }
    CHECK(at_start > 100);
    CHECK(at_end > 1000);
}

}  // namespace abut::test
