// SPDX-License-Identifier: MIT
//
// usage: bench_motion --scene=FOLDER... --benchmark_out=motion.json
//
// Continuous collision of a step of a real scene with itself, on one thread: FOLDER has frame0.ply and frame1.ply. Names:
//
//   time/SCENE/SCALAR/KIND/ARITHMETIC   time_of_impact of pairs one by one; KIND is vertex_face or edge_edge. Counters
//                                       missed_per_million and phantom_per_million: answers other than those of `filtered`
//   look/SCENE/SCALAR/KIND              the first look of `filtered` at the same pairs, and who decides them
//   stage/SCENE/SCALAR/STAGE            of a whole query: build and refit of the index; walk, which finds pairs whose boxes
//                                       meet; search, which walks, decides and times; self_impacts, which sorts and writes
//                                       as well; first_self_impact
//
// The pairs are those whose boxes meet, as the library's own walk finds them: every so many, a million at most (`exact`: two
// thousand). Counters of `look` are shares of all of these pairs:
//
//   no_by_volume      they are never in one plane: coefficients of f have one sign
//   no_by_direction   of the others, those that a direction separates for the whole step
//   no_by_areas       those that neither rejects, but areas do
//   yes, open         what else the first look says
//   open_late         what is open after halves of the step: the last stage decides it
//   no_time           hits whose time registers do not find, open_late included

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>
#include <abut/io/read.hpp>

#include "google.hpp"

namespace {

using abut::detail::motion_filter;

template <class T>
constexpr const char* scalar_name = sizeof(T) == 4 ? "float" : "double";
template <bool Edges>
constexpr const char* kind_name = Edges ? "edge_edge" : "vertex_face";

/// A judge that has one opinion.
struct says {
    abut::verdict opinion;

    template <class S, class U>
    abut::verdict decide(const S&, const U&) const {
        return opinion;
    }
    template <class S, class U>
    double time(const S&, const U&) const {
        return 0;
    }
    template <class S, class U>
    double time_on_host(const S&, const U&) const {
        return 0;
    }
};

/// The pairs of features of a query of self_impacts.
template <abut::scalar T>
auto features_of(const abut::impact_index<T, abut::host_space>& index) {
    using namespace abut::detail;
    return feature_pairing<true, abut::impact_index<T, abut::host_space>, near_enough_to_touch, no_fronts>(
        index, index, {}, {}, "bench_motion");
}
/// Those that touch, by a judge.
template <class Pairing, class Judge>
auto find_hits(const Pairing& pairing, const Judge& judge) {
    abut::detail::timed_queue<abut::serial> hits(abut::serial{});
    abut::detail::search_times(abut::serial{}, pairing, judge, hits);
    return hits.take();
}

template <abut::scalar T>
class scene {
public:
    explicit scene(const std::filesystem::path& folder)
        : name_((folder / "").parent_path().filename().string()),
          step_(abut::moving(abut::io::read_mesh<T>(folder / "frame0.ply"), abut::io::read_mesh<T>(folder / "frame1.ply"))) {
    }

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const auto& step() const { return step_; }
    [[nodiscard]] const auto& index() const {
        if (!index_) index_ = abut::make_impact_index(abut::serial{}, step_);
        return *index_;
    }
    /// How many pairs of boxes meet.
    template <bool Edges>
    [[nodiscard]] std::size_t candidates() const {
        (void)pairs<Edges>();
        return candidates_[Edges ? 1 : 0];
    }
    template <bool Edges>
    [[nodiscard]] const std::vector<abut::detail::moving_points<T>>& pairs() const {
        auto& made = pairs_[Edges ? 1 : 0];
        if (!made.empty()) return made;
        const auto pairing = features_of(index());
        const auto& both = pairing.view();
        std::vector<std::uint64_t> keys;
        const auto hits = find_hits(pairing, says{abut::verdict::unknown});
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const std::uint64_t key = hits.data()[i].key;
            if ((both.key.kind(key) == abut::feature_pair::edge_edge) == Edges) keys.push_back(key);
        }
        std::sort(keys.begin(), keys.end());
        candidates_[Edges ? 1 : 0] = keys.size();
        for (std::size_t i = 0; i < keys.size(); i += keys.size() / most_pairs + 1) {
            made.push_back(both.with_shapes(keys[i], abut::detail::take_points<T>{}));
        }
        return made;
    }

private:
    static constexpr std::size_t most_pairs = 1'000'000;

    std::string name_;
    abut::moving_set<abut::mesh<T>> step_;
    mutable std::optional<abut::impact_index<T, abut::host_space>> index_;
    mutable std::vector<abut::detail::moving_points<T>> pairs_[2];
    mutable std::size_t candidates_[2]{};
};

/// The features of four points.
template <bool Edges, abut::scalar T, class Ask>
auto with_features(const abut::detail::moving_points<T>& p, const Ask& ask) {
    using abut::moving, abut::segment, abut::triangle;
    if constexpr (Edges) {
        return ask(moving(segment<T>{p.t0[0], p.t0[1]}, segment<T>{p.t1[0], p.t1[1]}),
                   moving(segment<T>{p.t0[2], p.t0[3]}, segment<T>{p.t1[2], p.t1[3]}));
    } else {
        return ask(moving(p.t0[0], p.t1[0]),
                   moving(triangle<T>{p.t0[1], p.t0[2], p.t0[3]}, triangle<T>{p.t1[1], p.t1[2], p.t1[3]}));
    }
}

template <class A, bool Edges, abut::scalar T>
void times(benchmark::State& state, const scene<T>& of) {
    constexpr std::size_t most = std::same_as<A, abut::exact> ? 2000 : std::size_t(-1);
    const auto& all = of.template pairs<Edges>();
    const std::size_t stride = all.size() / most + 1;
    std::size_t asked = 0, hits = 0;
    for (auto _ : state) {
        asked = hits = 0;
        for (std::size_t i = 0; i < all.size(); i += stride, ++asked) {
            hits += with_features<Edges>(all[i],
                                         [](const auto& s, const auto& t) { return abut::time_of_impact<A>(s, t); }) >= 0;
        }
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(asked));
    state.counters["pairs"] = static_cast<double>(asked);
    state.counters["hits"] = static_cast<double>(hits);
    if constexpr (!std::same_as<A, abut::exact>) {
        std::size_t missed = 0, phantom = 0;
        for (const auto& p : all) {
            const auto touches = [&]<class B>(B) {
                return with_features<Edges>(p, [](const auto& s, const auto& t) { return abut::time_of_impact<B>(s, t); }) >=
                       0;
            };
            const bool found = touches(A{}), truth = touches(abut::filtered{});
            missed += truth && !found;
            phantom += found && !truth;
        }
        state.counters["missed_per_million"] = 1e6 * static_cast<double>(missed) / static_cast<double>(all.size());
        state.counters["phantom_per_million"] = 1e6 * static_cast<double>(phantom) / static_cast<double>(all.size());
    }
}

template <bool Edges, abut::scalar T>
void look(benchmark::State& state, const scene<T>& of) {
    const auto& all = of.template pairs<Edges>();
    for (auto _ : state) {
        std::size_t open = 0;
        for (const auto& p : all) open += motion_filter<Edges>(p).look_once() == abut::verdict::unknown;
        benchmark::DoNotOptimize(open);
    }
    double by_volume = 0, by_direction = 0, by_areas = 0, yes = 0, open = 0, open_late = 0, no_time = 0;
    for (const auto& p : all) {
        const motion_filter<Edges> filter(p);
        const abut::verdict first = filter.look_once();
        yes += first == abut::verdict::yes;
        if (first == abut::verdict::no) {
            // A separation of next to nothing, and the whole step at once: a direction alone is asked.
            const bool in_no_plane = filter.volume({first, 0, 0}).has_no_root(filter.volume_error(0x1p-42));
            const bool separated = !in_no_plane && filter.conservative_time(1e-300, 1) < 0;
            (in_no_plane ? by_volume : separated ? by_direction : by_areas) += 1;
            continue;
        }
        open += first == abut::verdict::unknown;
        if (first == abut::verdict::unknown) {
            open_late += with_features<Edges>(p, [](const auto& s, const auto& t) {
                return abut::decide_late<abut::filtered>(s, t) == abut::verdict::unknown;
            });
        }
        no_time += abut::detail::filtered_time<Edges>(p).count == abut::detail::time_in_bits::unknown;
    }
    const auto n = static_cast<double>(all.size());
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
    state.counters["pairs"] = n;
    state.counters["candidates"] = static_cast<double>(of.template candidates<Edges>());
    state.counters["no_by_volume"] = by_volume / n;
    state.counters["no_by_direction"] = by_direction / n;
    state.counters["no_by_areas"] = by_areas / n;
    state.counters["yes"] = yes / n;
    state.counters["open"] = open / n;
    state.counters["open_late"] = open_late / n;
    state.counters["no_time"] = no_time / n;
}

// --- whole queries -----------------------------------------------------------------------------------------------------

template <abut::scalar T>
void build(benchmark::State& state, const scene<T>& of) {
    for (auto _ : state) benchmark::DoNotOptimize(abut::make_impact_index(abut::serial{}, of.step()));
    const auto& index = of.index();
    state.counters["tree_bytes"] =
        static_cast<double>(index.faces().bytes() + index.edges().bytes() + index.vertices().bytes());
    state.counters["faces"] = static_cast<double>(index.size());
    state.counters["edges"] = static_cast<double>(index.edges().size());
    state.counters["vertices"] = static_cast<double>(index.vertices().size());
}
template <abut::scalar T>
void refit(benchmark::State& state, const scene<T>& of) {
    benchmark::DoNotOptimize(abut::refit(abut::serial{}, of.index(), of.step()));  // derives the order of boxes
    for (auto _ : state) benchmark::DoNotOptimize(abut::refit(abut::serial{}, of.index(), of.step()));
}
template <abut::scalar T>
void walk(benchmark::State& state, const scene<T>& of) {
    for (auto _ : state) benchmark::DoNotOptimize(find_hits(features_of(of.index()), says{abut::verdict::no}).size());
    state.counters["candidates"] = static_cast<double>(of.template candidates<false>() + of.template candidates<true>());
}
template <abut::scalar T>
void search(benchmark::State& state, const scene<T>& of) {
    std::size_t found = 0;
    for (auto _ : state) found = find_hits(features_of(of.index()), abut::detail::time_in_motion<abut::filtered>{}).size();
    state.counters["found"] = static_cast<double>(found);
    state.counters["hit_bytes"] = static_cast<double>(found * sizeof(abut::detail::timed_key));
}
template <class A, abut::scalar T>
void self_impacts(benchmark::State& state, const scene<T>& of) {
    std::size_t found = 0;
    for (auto _ : state) found = abut::self_impacts<A>(abut::serial{}, of.index()).size();
    state.counters["impacts"] = static_cast<double>(found);
    state.counters["impact_bytes"] = static_cast<double>(found * sizeof(abut::impact<T>));
}

template <abut::scalar T>
void first(benchmark::State& state, const scene<T>& of) {
    for (auto _ : state) benchmark::DoNotOptimize(abut::first_self_impact(abut::serial{}, of.index()));
}

template <abut::scalar T>
void add(const std::filesystem::path& folder) {
    const auto of = std::make_shared<const scene<T>>(folder);
    const auto row = [&](const std::string& what, const std::string& name, auto* run, int iterations) {
        benchmark::RegisterBenchmark((what + "/" + of->name() + "/" + scalar_name<T> + "/" + name).c_str(),
                                     [of, run](benchmark::State& state) { run(state, *of); })
            ->Repetitions(5)
            ->ReportAggregatesOnly(true)
            ->Unit(benchmark::kMillisecond)
            ->Iterations(iterations);
    };
    const auto of_kind = [&]<bool Edges>() {
        const std::string kind = kind_name<Edges>;
        row("time", kind + "/fast", times<abut::fast, Edges, T>, 1);
        row("time", kind + "/conservative", times<abut::conservative, Edges, T>, 1);
        row("time", kind + "/filtered", times<abut::filtered, Edges, T>, 1);
        row("time", kind + "/exact", times<abut::exact, Edges, T>, 1);
        row("look", kind, look<Edges, T>, 1);
    };
    of_kind.template operator()<false>();
    of_kind.template operator()<true>();
    row("stage", "build", build<T>, 1);
    row("stage", "refit", refit<T>, 1);
    row("stage", "walk", walk<T>, 1);
    row("stage", "search", search<T>, 1);
    row("stage", "self_impacts", self_impacts<abut::filtered, T>, 1);
    row("stage", "first_self_impact", first<T>, 1);
    row("stage", "self_impacts_fast", self_impacts<abut::fast, T>, 1);
    row("stage", "self_impacts_conservative", self_impacts<abut::conservative, T>, 1);
}

}  // namespace

int main(int argc, char** argv) {
    constexpr std::string_view flag = "--scene=";
    std::vector<std::filesystem::path> folders;
    argc = static_cast<int>(std::remove_if(argv + 1, argv + argc,
                                           [&](const char* argument) {
                                               if (!std::string_view(argument).starts_with(flag)) return false;
                                               folders.emplace_back(argument + flag.size());
                                               return true;
                                           }) -
                            argv);
    if (folders.empty()) {
        std::fprintf(stderr, "bench_motion: expected --scene=FOLDER, with frame0.ply and frame1.ply\n");
        return 1;
    }
    try {
        for (const auto& folder : folders) {
            add<float>(folder);
            add<double>(folder);
        }
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench_motion: %s\n", e.what());
        return 1;
    }
    return bench::run_registered("bench_motion", argc, argv);
}
