// SPDX-License-Identifier: MIT
#pragma once

// What bench/extremes.cpp and bench/extremes.cu share: pairs and scenes at the extremes of tests/support/extremes.hpp,
// decided on a policy, timed and compared with what is right. Names of rows, where STEP is EXTREME/VALUE:
//
//   pair/KIND/SCALAR/STEP    KIND is the name of one there; hulls, whose points lie elsewhere, and what is long to compile
//                            are for hosts alone. fast_ns, filtered_ns and exact_ns are times of a pair among many;
//                            *_worst_ns of the slowest of a sample, on hosts. hits, fast_wrong, filtered_wrong, exact_wrong
//                            and last_stage_wrong count the sample, which unbounded integers decide as well. undecided and
//                            unresolved are the shares of all pairs that the filter leaves, and that integers in registers
//                            leave to the last stage.
//   scene/KIND/SCALAR/STEP   a query of two tori with trees (meshes), or of a torus with a tree and balls at its surface
//                            (balls). build_ms, and fast_ms, filtered_ms and exact_ms of all pairs. truth is how many pairs
//                            all against all finds by integers; *_lost and *_invented are what the query differs in.
//
// `exact` of features in motion is the last stage, which hosts have alone: there it is timed for the sample, and elsewhere
// not.

#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <abut/abut.hpp>

#include "../tests/support/extreme_truth.hpp"
#include "../tests/support/scenes.hpp"
#include "results.hpp"

namespace extremes_bench {

namespace test = abut::test;
using test::extreme, test::extreme_step;

inline constexpr std::uint64_t seed = 2026;

template <class T>
constexpr const char* scalar_name = sizeof(T) == 4 ? "float" : "double";

/// How much is measured: pairs for times, and those of them that are decided in unbounded integers as well. Features in
/// motion take so much longer that fewer have to do.
struct sizes {
    std::size_t pairs = 4096, moving_pairs = 256, sample = 1000, moving_sample = 64;
};

inline std::string name_of(const extreme_step& step) {
    char value[32];
    std::snprintf(value, sizeof(value), "%g", step.value);
    return bench::joined({test::name_of(step.what), value});
}

template <class Kind, class T>
using pair_type = decltype(test::make_extreme_pair<Kind, T>(0, {}, 0));

template <class P>
inline constexpr bool is_moving = false;
template <class S, class U>
inline constexpr bool is_moving<test::pair_of<abut::motion<S>, abut::motion<U>>> = true;

/// Of these two the exact stages are the longest by far, and nvcc takes the longest for them.
template <class Kind>
inline constexpr bool is_long_to_compile = std::same_as<Kind, test::extreme_contacts<abut::capsule, abut::triangle>> ||
                                           std::same_as<Kind, test::extreme_contacts<abut::ray, abut::triangle>>;

template <class Kind, abut::scalar T>
struct make_pair {
    extreme_step step;
    pair_type<Kind, T>* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = test::make_extreme_pair<Kind, T>(seed, step, i); }
};

/// All stages, but for the last one of features in motion, which devices do not have: these are left `unknown`.
template <abut::arithmetic A, class P>
ABUT_HD abut::verdict ask(const P& p) {
    if constexpr (!is_moving<P>) {
        return abut::to_verdict(abut::intersects<A>(test::shape_of(p.a), test::shape_of(p.b)));
    } else {
        const abut::verdict v = abut::decide<A>(p.a, p.b);
        if constexpr (std::same_as<A, abut::filtered>) {
            if (v == abut::verdict::unknown) return abut::decide_late<A>(p.a, p.b);
        }
        return v;
    }
}

template <abut::arithmetic A, class P>
struct ask_each {
    const P* pairs;
    abut::verdict* answers;
    ABUT_HD void operator()(std::size_t i) const { answers[i] = ask<A>(pairs[i]); }
};

/// Which pairs the filter leaves (1), and which the integers in registers leave (2).
template <class P>
struct find_left {
    const P* pairs;
    std::uint8_t* left;
    ABUT_HD void operator()(std::size_t i) const {
        const auto& a = test::shape_of(pairs[i].a);
        const auto& b = test::shape_of(pairs[i].b);
        const bool undecided = abut::decide<abut::filtered>(a, b) == abut::verdict::unknown;
        bool unresolved = undecided;
        if constexpr (is_moving<P>) {
            if (undecided) unresolved = ask<abut::filtered>(pairs[i]) == abut::verdict::unknown;
        } else {
            unresolved = abut::decide<abut::exact>(a, b) == abut::verdict::unknown;
        }
        left[i] = static_cast<std::uint8_t>((undecided ? 1 : 0) | (unresolved ? 2 : 0));
    }
};

/// The slowest of the pairs by one arithmetic, in ns: each the fastest of five tries (of three where it takes long), since
/// other jobs disturb.
template <abut::arithmetic A, class P>
double worst_ns(const std::vector<P>& pairs, std::size_t count) {
    using clock = std::chrono::steady_clock;
    double worst = 0;
    unsigned hits = 0;
    for (std::size_t i = 0; i < count; ++i) {
        double best = 1e30;
        for (int k = 0; k < 5 && (k < 3 || best < 1e6); ++k) {
            const auto start = clock::now();
            hits += abut::intersects<A>(test::shape_of(pairs[i].a), test::shape_of(pairs[i].b)) ? 1U : 0U;
            best = std::min(best, std::chrono::duration<double, std::nano>(clock::now() - start).count());
        }
        worst = std::max(worst, best);
    }
    const volatile unsigned used = hits;
    (void)used;
    return worst;
}

/// `time(on, work)` is what one run of `work` takes, in ms.
template <class Policy, class Time>
class bench_of {
    static constexpr bool on_host = std::same_as<abut::space_of<Policy>, abut::host_space>;

public:
    bench_of(const Policy& on, const Time& time, const sizes& of, bench::results& out)
        : on_(on), time_(time), of_(of), out_(out) {}

    /// Whether `filtered` and `exact` were right throughout.
    [[nodiscard]] bool all_right() const { return all_right_; }

    template <abut::scalar T>
    void run() {
        const auto of_kind = [this]<class Kind>(Kind) {
            if constexpr (on_host || !is_long_to_compile<Kind>) this->template pairs_of<Kind, T>();
        };
        test::for_each_kind(test::first_extreme_kinds{}, of_kind);
        test::for_each_kind(test::other_extreme_kinds{}, of_kind);
        if constexpr (on_host) test::for_each_kind(test::hull_extreme_kinds{}, of_kind);
        scenes<T>();
    }

private:
    template <class Work>
    double median(const Work& work) const {
        std::vector<double> times;
        times.push_back(time_(on_, work));
        for (int i = 1; i < 5 && times[0] < 50; ++i) times.push_back(time_(on_, work));
        std::sort(times.begin(), times.end());
        return times[times.size() / 2];
    }

    template <class P>
    struct on_policy {
        abut::execution::buffer_of<Policy, P> pairs;
        std::vector<P> on_host;
    };

    /// Time of a pair in ns, and the answers of the first `sample`.
    template <abut::arithmetic A, class P>
    double ask_all(const on_policy<P>& all, std::size_t n, std::vector<abut::verdict>& answers) const {
        abut::execution::buffer_of<Policy, abut::verdict> found(on_, n);
        answers.resize(n);
        const double ms = median([&] {
            for_each_index(on_, n, ask_each<A, P>{all.pairs.data(), found.data()});
            if constexpr (is_moving<P>) {  // as queries do
                found.read(answers.data());
                for (std::size_t i = 0; i < n; ++i) {
                    if (answers[i] == abut::verdict::unknown) {
                        answers[i] = abut::to_verdict(abut::resolve(all.on_host[i].a, all.on_host[i].b));
                    }
                }
            }
        });
        if constexpr (!is_moving<P>) found.read(answers.data());
        return 1e6 * ms / static_cast<double>(n);
    }

    template <class Kind, abut::scalar T>
    void pairs_of() {
        for (const extreme what : test::extremes) {
            for (const extreme_step& step : test::steps_of<T>(what)) pairs_of_step<Kind, T>(step);
        }
    }

    template <class Kind, abut::scalar T>
    void pairs_of_step(const extreme_step& step) {
        using P = pair_type<Kind, T>;
        constexpr bool moving = is_moving<P>;
        const std::size_t n = moving ? of_.moving_pairs : of_.pairs,
                          sample = std::min(n, moving ? of_.moving_sample : of_.sample);
        on_policy<P> all{{on_, n}, std::vector<P>(n)};
        for_each_index(on_, n, make_pair<Kind, T>{step, all.pairs.data()});
        all.pairs.read(all.on_host.data());
        bench::counters row;

        std::vector<bool> truth(sample);
        for (std::size_t i = 0; i < sample; ++i) truth[i] = test::touch_in_truth<T>(all.on_host[i]);
        std::vector<abut::verdict> answers;
        const auto wrong = [&] {
            double count = 0;
            for (std::size_t i = 0; i < sample; ++i) count += (answers[i] == abut::verdict::yes) != truth[i];
            return count;
        };
        row.emplace_back("fast_ns", ask_all<abut::fast>(all, n, answers));
        const double fast_wrong = wrong();
        row.emplace_back("filtered_ns", ask_all<abut::filtered>(all, n, answers));
        const double filtered_wrong = wrong();
        double exact_wrong = 0;
        if (!moving || on_host) {
            row.emplace_back("exact_ns", ask_all<abut::exact>(all, moving ? sample : n, answers));
            exact_wrong = wrong();
        }
        if constexpr (on_host) {
            row.emplace_back("filtered_worst_ns", worst_ns<abut::filtered>(all.on_host, sample));
            row.emplace_back("exact_worst_ns", worst_ns<abut::exact>(all.on_host, sample));
        }
        double last_stage_wrong = 0;
        for (std::size_t i = 0; i < sample; ++i) {
            const auto& [a, b] = all.on_host[i];
            last_stage_wrong += abut::resolve(test::shape_of(a), test::shape_of(b)) != truth[i];
        }

        abut::execution::buffer_of<Policy, std::uint8_t> left_by(on_, n);
        for_each_index(on_, n, find_left<P>{all.pairs.data(), left_by.data()});
        std::vector<std::uint8_t> left(n);
        left_by.read(left.data());
        const auto share = [&](int bit) {
            return static_cast<double>(std::count_if(left.begin(), left.end(), [bit](auto x) { return (x & bit) != 0; })) /
                   static_cast<double>(n);
        };
        row.emplace_back("sample", static_cast<double>(sample));
        row.emplace_back("hits", static_cast<double>(std::count(truth.begin(), truth.end(), true)));
        row.emplace_back("fast_wrong", fast_wrong);
        row.emplace_back("filtered_wrong", filtered_wrong);
        if (!moving || on_host) row.emplace_back("exact_wrong", exact_wrong);
        row.emplace_back("last_stage_wrong", last_stage_wrong);
        row.emplace_back("undecided", share(1));
        row.emplace_back("unresolved", share(2));
        all_right_ = all_right_ && filtered_wrong == 0 && exact_wrong == 0 && last_stage_wrong == 0;
        out_.add(bench::joined({"pair", Kind::name(), scalar_name<T>, name_of(step)}), row);
    }

    /// All pairs that touch, all against all in integers.
    template <class X, class Y>
    static std::vector<abut::index_pair> all_pairs(const X& a, const Y& b) {
        std::vector<abut::index_pair> pairs;
        for (std::uint32_t i = 0; i < a.size(); ++i) {
            const auto s = a[i];
            for (std::uint32_t j = 0; j < b.size(); ++j) {
                if (abut::intersects<abut::exact>(s, b[j])) pairs.push_back({i, j});
            }
        }
        return pairs;
    }

    template <abut::arithmetic A, class X, class Y>
    void query(const char* arithmetic, const X& a, const Y& b, const std::vector<abut::index_pair>& truth,
               bench::counters& row) {
        std::vector<abut::index_pair> found;
        const double ms = median([&] { found = to_host(abut::pairs<A>(on_, a, b)); });
        std::vector<abut::index_pair> lost, invented;
        std::set_difference(truth.begin(), truth.end(), found.begin(), found.end(), std::back_inserter(lost));
        std::set_difference(found.begin(), found.end(), truth.begin(), truth.end(), std::back_inserter(invented));
        const std::string of = arithmetic;
        row.emplace_back(of + "_ms", ms);
        row.emplace_back(of + "_lost", static_cast<double>(lost.size()));
        row.emplace_back(of + "_invented", static_cast<double>(invented.size()));
        all_right_ = all_right_ && (std::same_as<A, abut::fast> || (lost.empty() && invented.empty()));
    }

    /// `x` and `y` are what is asked, in the policy's memory; `a` and `b` what they were made of.
    template <abut::scalar T, class X, class Y, class B>
    void scene(const std::string& name, bench::counters row, const X& x, const Y& y, const abut::mesh<T>& a, const B& b) {
        const auto truth = all_pairs(a.view(), b.view());
        row.emplace_back("truth", static_cast<double>(truth.size()));
        query<abut::fast>("fast", x, y, truth, row);
        query<abut::filtered>("filtered", x, y, truth, row);
        query<abut::exact>("exact", x, y, truth, row);
        out_.add(name, row);
    }

    template <abut::scalar T>
    void scenes() {
        const test::torus<double> torus(32, 16, 0.6, 0.3);
        for (const extreme what : {extreme::scaled, extreme::moved, extreme::flattened, extreme::snapped}) {
            for (const extreme_step& step : test::steps_of<T>(what)) {
                test::draws d(seed, 0, 0);
                const test::construction::extreme_frame frame(d, step);
                const auto placed = [&](const abut::vec3<double>& p) {
                    return frame.template placed<T>(d, frame.formed(p));
                };
                std::vector<abut::vec3<T>> first, second;
                std::vector<abut::sphere<T>> balls;
                for (const auto& p : torus.vertices) {
                    first.push_back(placed(p));
                    second.push_back(placed({p.z + 0.05, p.x - 0.02, p.y + 0.03}));
                    balls.push_back({placed({1.5 * p.x, 1.5 * p.y, p.z}), frame.template placed<T>(d, frame.formed(0.25))});
                }
                const abut::mesh<T> a(first, torus.faces);
                const auto name = [&](const char* kind) {
                    return bench::joined({"scene", kind, scalar_name<T>, name_of(step)});
                };
                const abut::mesh<T> b(second, torus.faces);
                const abut::spheres<T> c(balls);
                const auto x = copy_to(on_, a);
                const bench::counters row{{"build_ms", median([&] { (void)abut::make_bvh(on_, x); })}};
                const auto tree = abut::make_bvh(on_, x);
                scene(name("meshes"), row, tree, abut::make_bvh(on_, copy_to(on_, b)), a, b);
                scene(name("balls"), row, tree, copy_to(on_, c), a, c);
            }
        }
    }

    Policy on_;
    Time time_;
    sizes of_;
    bench::results& out_;
    bool all_right_ = true;
};

/// The main of both programs. Returns the exit status: 1 where an answer that is to be right was wrong.
template <class Policy, class Time>
int run(const char* program, int argc, char** argv, const Policy& on, const Time& time, sizes of,
        const bench::description& machine = {}) {
    const std::string json = bench::take_argument(argc, argv, "--json"), pairs = bench::take_argument(argc, argv, "--pairs"),
                      sample = bench::take_argument(argc, argv, "--sample");
    if (argc > 1) throw std::runtime_error(std::string(argv[1]) + ": expected --json=FILE, --pairs=N or --sample=N");
    if (!pairs.empty()) of.pairs = std::stoul(pairs), of.moving_pairs = of.pairs / 16 + 1;
    if (!sample.empty()) of.sample = std::stoul(sample), of.moving_sample = of.sample / 16 + 1;
    bench::results out(program);
    for (const auto& [key, value] : machine) out.describe(key, value);
    bench_of<Policy, Time> all(on, time, of, out);
    all.template run<float>();
    all.template run<double>();
    if (!json.empty()) out.write(json);
    std::printf(all.all_right() ? "filtered and exact: 0 wrong\n" : "WRONG ANSWERS of filtered or exact\n");
    return all.all_right() ? 0 : 1;
}

}  // namespace extremes_bench
