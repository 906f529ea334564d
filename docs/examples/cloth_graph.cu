// SPDX-License-Identifier: MIT
//
// A cloth falls on a ball, and a step of it is one CUDA graph: kernels propose where vertices go, what would meet is found
// exactly, and kernels hold back what meets. The host launches graphs and waits once, at the end. The same is then done by
// calls that wait, and has to end with the same bits. The calls that matter are in `without_wait`.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <abut/cuda.hpp>

#include "falling_cloth.hpp"
#include "program_cuda.hpp"

namespace {

using vertex = abut::vec3<float>;
using impacts_found = abut::async_result<abut::impact<float>>;

struct settings : example::common_settings {
    unsigned length = 401, width = 115;  ///< squares of the cloth, 92,230 triangles
    int steps = 100;
};

struct program : example::cuda_program {
    static constexpr const char* name = "cloth_graph_cuda";
};

void check(cudaError_t code, const char* call) {
    if (code != cudaSuccess) throw abut::cuda_error(call, code);
}

// --- the cloth: masses and springs, which know nothing of collisions ------------------------------------------------------

struct grid {
    unsigned length, width;  ///< squares
    float side;              ///< of a square
};

std::vector<vertex> flat_cloth(const grid& g) {
    std::vector<vertex> made;
    for (unsigned i = 0; i <= g.length; ++i) {
        for (unsigned j = 0; j <= g.width; ++j) {
            const float x = (static_cast<float>(i) - 0.5f * static_cast<float>(g.length)) * g.side;
            const float y = (static_cast<float>(j) - 0.5f * static_cast<float>(g.width)) * g.side;
            made.push_back({0.96f * x - 0.28f * y + 0.013f, 0.28f * x + 0.96f * y - 0.017f, 0.51f});
        }
    }
    return made;
}
std::vector<abut::face> faces_of(const grid& g) {
    std::vector<abut::face> made;
    for (unsigned i = 0; i < g.length; ++i) {
        for (unsigned j = 0; j < g.width; ++j) {
            const unsigned at = i * (g.width + 1) + j, next = at + g.width + 1;
            made.push_back({at, next, next + 1});
            made.push_back({at, next + 1, at + 1});
        }
    }
    return made;
}

__global__ void fall(const vertex* at, const vertex* way, vertex* to, std::size_t n) {
    constexpr float gravity = 9.8f / (240 * 240);
    const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i < n) to[i] = {at[i].x + 0.99f * way[i].x, at[i].y + 0.99f * way[i].y, at[i].z + 0.99f * way[i].z - gravity};
}
/// Each vertex goes a part of the way that its twelve springs ask for (T. Jakobsen, Advanced character physics, 2001).
__global__ void relax(const vertex* from, vertex* to, grid g) {
    const unsigned k = blockIdx.x * blockDim.x + threadIdx.x, columns = g.width + 1, rows = g.length + 1;
    if (k >= columns * rows) return;
    const int i = static_cast<int>(k / columns), j = static_cast<int>(k % columns);
    const vertex p = from[k];
    vertex sum{0, 0, 0};
    for (int di = -2; di <= 2; ++di) {
        for (int dj = -2; dj <= 2; ++dj) {
            const int squares = di * di + dj * dj;
            const bool is_spring = squares == 1 || squares == 2 || squares == 4;
            const int row = i + di, column = j + dj;
            if (!is_spring || row < 0 || column < 0 || row >= static_cast<int>(rows) || column >= static_cast<int>(columns)) continue;
            const vertex q = from[static_cast<unsigned>(row) * columns + static_cast<unsigned>(column)];
            const float x = q.x - p.x, y = q.y - p.y, z = q.z - p.z, length = sqrtf(x * x + y * y + z * z);
            if (length == 0) continue;
            const float part = 0.5f * (1 - g.side * sqrtf(static_cast<float>(squares)) / length);
            sum = {sum.x + part * x, sum.y + part * y, sum.z + part * z};
        }
    }
    to[k] = {p.x + 0.25f * sum.x, p.y + 0.25f * sum.y, p.z + 0.25f * sum.z};
}

// --- the response -----------------------------------------------------------------------------------------------------------

/// Added up over all steps.
struct totals {
    std::uint64_t impacts, missing, undecided, steps, refused;
};

/// Vertices of the cloth that meet something go `share` of their way up to there. `part` has bits of floats from 0 to 1.
__global__ void hold_back(const abut::impact<float>* all, const abut::async_state* state, bool with_itself, float share,
                          unsigned* part, totals* sum) {
    const std::uint64_t size = state->size, step = std::uint64_t{gridDim.x} * blockDim.x;
    const std::uint64_t first = std::uint64_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (first == 0) {
        sum->impacts += state->needed;
        sum->missing += state->needed - size;
        sum->undecided += state->undecided;
    }
    for (std::uint64_t i = first; i < size; i += step) {
        const auto* const v = reinterpret_cast<const std::uint32_t*>(&all[i].vertices);  // whose [] is a host's
        const abut::feature_pair kind = all[i].kind;
        const int begin = !with_itself && kind == abut::feature_pair::face_vertex ? 1 : 0;
        const int end = with_itself || kind == abut::feature_pair::face_vertex ? 4 : kind == abut::feature_pair::edge_edge ? 2 : 1;
        const unsigned bits = __float_as_uint(share * static_cast<float>(all[i].time));
        for (int k = begin; k < end; ++k) atomicMin(part + v[k], bits);
    }
}
__global__ void shorten(const vertex* from, vertex* to, unsigned* part, std::size_t n) {
    const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const float p = __uint_as_float(part[i]);
    const vertex a = from[i], b = to[i];
    if (p < 1) to[i] = {a.x + p * (b.x - a.x), a.y + p * (b.y - a.y), a.z + p * (b.z - a.z)};
    part[i] = __float_as_uint(1);
}
/// All go where they want to if nothing is met on the way, for certain. Otherwise all stay.
__global__ void go(vertex* at, const vertex* to, vertex* way, const abut::async_value_state<double>* itself,
                   const abut::async_value_state<double>* ball, std::size_t n, totals* sum) {
    const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
    const bool is_free = itself->value == 1 && ball->value == 1;
    if (i == 0) {
        sum->steps += 1;
        sum->refused += is_free ? 0 : 1;
    }
    if (i >= n) return;
    const vertex a = at[i], b = is_free ? to[i] : a;
    way[i] = {b.x - a.x, b.y - a.y, b.z - a.z};
    at[i] = b;
}

// --- the queries --------------------------------------------------------------------------------------------------------------

using index_type = abut::impact_index<float, abut::device_space>;

/// What would meet, by calls that only put work into the stream: they may be captured into a graph.
class without_wait {
public:
    without_wait(const abut::cuda& on, const index_type& cloth, const index_type& ball)
        : on_(on), cloth_(on, cloth), ball_(ball), itself_(on, room, candidates), with_ball_(on, room), safe_itself_(on, candidates),
          safe_ball_(on) {}

    void refit(const vertex* from, const vertex* to, std::size_t n) {
        using view = abut::points_view<float, abut::device_space>;
        abut::refit(abut::async(on_, cloth_), abut::moving(view(from, n), view(to, n)));
    }
    template <class See>
    void impacts(const See& see) {
        abut::self_impacts(abut::async(on_, itself_), cloth_.index(), {.sorted = false});
        abut::impacts(abut::async(on_, with_ball_), cloth_.index(), ball_, {.sorted = false});
        see(itself_.data(), itself_.state(), true);
        see(with_ball_.data(), with_ball_.state(), false);
    }
    template <class See>
    void safe_steps(const See& see) {
        abut::safe_self_step(abut::async(on_, safe_itself_), cloth_.index());
        abut::safe_step(abut::async(on_, safe_ball_), cloth_.index(), ball_);
        see(safe_itself_.state(), safe_ball_.state());
    }

private:
    static constexpr std::size_t room = std::size_t{1} << 18, candidates = std::size_t{1} << 24;
    const abut::cuda& on_;
    abut::async_index<index_type> cloth_;
    const index_type& ball_;
    impacts_found itself_, with_ball_;
    abut::async_value<double> safe_itself_, safe_ball_;
};

/// The same by calls that wait, for which positions go to the host and back.
class with_wait {
public:
    with_wait(const abut::cuda& on, const abut::mesh<float, abut::device_space>& mesh, const index_type& cloth,
              const index_type& ball)
        : on_(on), mesh_(mesh), cloth_(cloth), ball_(ball), states_(on, 2), safe_(on, 2) {}

    void refit(const vertex* from, const vertex* to, std::size_t n) {
        std::vector<vertex> at_t0(n), at_t1(n);
        check(cudaMemcpyAsync(at_t0.data(), from, n * sizeof(vertex), cudaMemcpyDeviceToHost, on_.stream), "cudaMemcpyAsync");
        check(cudaMemcpyAsync(at_t1.data(), to, n * sizeof(vertex), cudaMemcpyDeviceToHost, on_.stream), "cudaMemcpyAsync");
        abut::synchronize(on_);
        cloth_ = abut::refit(on_, cloth_, abut::moving(mesh_.with_vertices(on_, at_t0), mesh_.with_vertices(on_, at_t1)));
    }
    template <class See>
    void impacts(const See& see) {
        found_[0].emplace(abut::self_impacts(on_, cloth_));
        found_[1].emplace(abut::impacts(on_, cloth_, ball_));
        for (int k = 0; k < 2; ++k) {
            const std::uint64_t n = found_[k]->size();
            const abut::async_state state{n, n, 0};
            check(cudaMemcpy(states_.data() + k, &state, sizeof state, cudaMemcpyHostToDevice), "cudaMemcpy");
            see(found_[k]->data(), states_.data() + k, k == 0);
        }
    }
    template <class See>
    void safe_steps(const See& see) {
        const abut::async_value_state<double> parts[2] = {{abut::safe_self_step(on_, cloth_), 0},
                                                          {abut::safe_step(on_, cloth_, ball_), 0}};
        check(cudaMemcpy(safe_.data(), parts, sizeof parts, cudaMemcpyHostToDevice), "cudaMemcpy");
        see(safe_.data(), safe_.data() + 1);
    }

private:
    const abut::cuda& on_;
    abut::mesh<float, abut::device_space> mesh_;
    index_type cloth_;
    const index_type& ball_;
    std::optional<abut::result<abut::impact<float>, abut::device_space>> found_[2];
    abut::execution::buffer<abut::async_state, abut::device_space> states_;
    abut::execution::buffer<abut::async_value_state<double>, abut::device_space> safe_;
};

// --- a simulation ----------------------------------------------------------------------------------------------------------------

class simulation {
public:
    simulation(const abut::cuda& on, const grid& g, const std::vector<vertex>& start)
        : on_(on), grid_(g), n_(start.size()), at_(on, n_), to_(on, n_), other_(on, n_), way_(on, n_), part_(on, n_), sum_(on, 1) {
        abut::execution::upload(on, start.data(), n_, at_.data());
        abut::execution::fill(on, way_.data(), n_, vertex{0, 0, 0});
        abut::execution::fill(on, part_.data(), n_, 0x3f800000u);  // the bits of 1
        abut::execution::fill(on, sum_.data(), 1, totals{});
        abut::synchronize(on);
    }
    /// Where vertices want to go.
    void propose() {
        constexpr int rounds = 8;
        fall<<<blocks(), threads, 0, on_.stream>>>(at_.data(), way_.data(), to_.data(), n_);
        for (int round = 0; round < rounds / 2; ++round) {
            relax<<<blocks(), threads, 0, on_.stream>>>(to_.data(), other_.data(), grid_);
            relax<<<blocks(), threads, 0, on_.stream>>>(other_.data(), to_.data(), grid_);
        }
    }
    /// What meets is held back at half of its way to there, then stays where it is, and asked again each time.
    template <class Queries>
    void step(Queries& queries) {
        constexpr int passes = 3;
        propose();
        for (int pass = 0; pass < passes; ++pass) {
            ask_impacts(queries, pass == 0 ? 0.5f : 0.0f);
            shorten<<<blocks(), threads, 0, on_.stream>>>(at_.data(), to_.data(), part_.data(), n_);
        }
        queries.refit(at_.data(), to_.data(), n_);
        queries.safe_steps([&](const auto* itself, const auto* ball) {
            go<<<blocks(), threads, 0, on_.stream>>>(at_.data(), to_.data(), way_.data(), itself, ball, n_, sum_.data());
        });
        check(cudaGetLastError(), "a step");
    }
    /// What meets on the way to where vertices want to go.
    template <class Queries>
    void ask_impacts(Queries& queries, float share) {
        queries.refit(at_.data(), to_.data(), n_);
        queries.impacts([&](const auto* found, const auto* state, bool with_itself) {
            hold_back<<<64, threads, 0, on_.stream>>>(found, state, with_itself, share, part_.data(), sum_.data());
        });
    }
    [[nodiscard]] std::vector<vertex> positions() const {
        std::vector<vertex> made(n_);
        abut::synchronize(on_);
        at_.read(made.data());
        return made;
    }
    [[nodiscard]] totals sums() const {
        totals made{};
        sum_.read(&made);
        return made;
    }

private:
    static constexpr unsigned threads = 256;
    [[nodiscard]] unsigned blocks() const { return static_cast<unsigned>(n_ / threads + 1); }

    const abut::cuda& on_;
    grid grid_;
    std::size_t n_;
    abut::execution::buffer<vertex, abut::device_space> at_, to_, other_, way_;
    abut::execution::buffer<unsigned, abut::device_space> part_;
    abut::execution::buffer<totals, abut::device_space> sum_;
};

/// What a function puts into the stream, as a graph.
class graph {
public:
    template <class Work>
    graph(const abut::cuda& on, const Work& work) : stream_(on.stream) {
        check(cudaStreamBeginCapture(stream_, cudaStreamCaptureModeThreadLocal), "cudaStreamBeginCapture");
        work();
        check(cudaStreamEndCapture(stream_, &graph_), "cudaStreamEndCapture");
        check(cudaGraphInstantiate(&executable_, graph_, 0), "cudaGraphInstantiate");
    }
    graph(const graph&) = delete;
    graph& operator=(const graph&) = delete;
    ~graph() {
        cudaStreamSynchronize(stream_);
        cudaGraphExecDestroy(executable_);
        cudaGraphDestroy(graph_);
    }
    void launch() const { check(cudaGraphLaunch(executable_, stream_), "cudaGraphLaunch"); }

private:
    cudaStream_t stream_;
    cudaGraph_t graph_ = nullptr;
    cudaGraphExec_t executable_ = nullptr;
};

/// Milliseconds for each of `times` calls, by the clock of the stream.
template <class Work>
double milliseconds(const abut::cuda& on, int times, const Work& work) {
    cudaEvent_t begin = nullptr, end = nullptr;
    check(cudaEventCreate(&begin), "cudaEventCreate");
    check(cudaEventCreate(&end), "cudaEventCreate");
    check(cudaEventRecord(begin, on.stream), "cudaEventRecord");
    for (int k = 0; k < times; ++k) work();
    check(cudaEventRecord(end, on.stream), "cudaEventRecord");
    abut::synchronize(on);
    float took = 0;
    check(cudaEventElapsedTime(&took, begin, end), "cudaEventElapsedTime");
    cudaEventDestroy(begin);
    cudaEventDestroy(end);
    return static_cast<double>(took) / times;
}

void run(const settings& s, cudaStream_t stream) {
    const abut::cuda on{.stream = stream};
    const grid g{s.length, s.width, 2.0f / static_cast<float>(s.length)};
    const std::vector<vertex> start = flat_cloth(g);
    const auto ball_surface = cloth_ccd::ball<float>();
    const auto cloth = abut::copy_to(on, abut::mesh<float>(start, faces_of(g)));
    const auto ball_there = abut::copy_to(on, abut::mesh<float>(ball_surface.vertices, ball_surface.faces));
    const auto ball = abut::make_impact_index(on, ball_there);
    const auto index = abut::make_impact_index(on, abut::moving(cloth, cloth));
    std::printf("cloth: vertices %zu, faces %zu; ball: faces %zu; float, filtered\n", start.size(), cloth.size(), ball_there.size());

    without_wait queries(on, index, ball);
    {
        simulation once(on, g, start);  // which loads all kernels
        once.step(queries);
        abut::synchronize(on);
    }
    simulation moving(on, g, start);
    const graph step(on, [&] { moving.step(queries); });
    const double in_graph = milliseconds(on, s.steps, [&] { step.launch(); });
    const std::vector<vertex> end = moving.positions();
    const totals sum = moving.sums();
    std::printf("in graphs: steps %llu, of which %llu were refused; impacts %llu, without room %llu, not decided %llu\n",
                static_cast<unsigned long long>(sum.steps), static_cast<unsigned long long>(sum.refused),
                static_cast<unsigned long long>(sum.impacts), static_cast<unsigned long long>(sum.missing),
                static_cast<unsigned long long>(sum.undecided));

    // Of the step that would come next.
    const graph impacts(on, [&] {
        moving.propose();
        moving.ask_impacts(queries, 1);
    });
    const double refit_and_impacts = milliseconds(on, s.steps, [&] { impacts.launch(); });
    const graph safe(on, [&] { queries.safe_steps([](const auto*, const auto*) {}); });
    const double safe_steps = milliseconds(on, s.steps, [&] { safe.launch(); });

    simulation waiting(on, g, start);
    with_wait asked(on, cloth, index, ball);
    const double with_waits = milliseconds(on, s.steps, [&] { waiting.step(asked); });
    const std::vector<vertex> other_end = waiting.positions();
    const bool is_same = std::memcmp(end.data(), other_end.data(), end.size() * sizeof(vertex)) == 0;
    std::printf("ms: a step in a graph %.3f, by calls that wait %.3f; proposal, refit and both impacts %.3f, both safe steps %.3f\n", in_graph,
                with_waits, refit_and_impacts, safe_steps);
    std::printf("positions at the end: %s\n", is_same ? "the same bits by calls that wait" : "others by calls that wait");

    const auto tree = abut::make_bvh(on, cloth.with_vertices(on, end));
    std::printf("pairs of faces that touch at the end: %llu of the cloth, %llu of cloth and ball\n",
                static_cast<unsigned long long>(abut::count_self_pairs(on, tree)),
                static_cast<unsigned long long>(abut::count(on, tree, abut::make_bvh(on, ball_there))));
}

}  // namespace

int main(int argc, char** argv) {
    settings s;
    s.policies = {"cuda"};
    const auto describe = [&](CLI::App& app) {
        app.description("A cloth falls on a ball. A step is one CUDA graph, with exact continuous collision in it.");
        app.add_option("--length", s.length, "Squares along the cloth")->type_name("N")->check(CLI::Range(1, 4000))->capture_default_str();
        app.add_option("--width", s.width, "Squares across it")->type_name("N")->check(CLI::Range(1, 4000))->capture_default_str();
        app.add_option("--steps", s.steps, "Steps that it falls, 240 a second")->type_name("N")->check(CLI::Range(1, 100000))->capture_default_str();
    };
    const auto work = [&]<class T>() {
        cudaStream_t stream = nullptr;
        check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "cudaStreamCreateWithFlags");
        run(s, stream);
        cudaStreamDestroy(stream);
        return 0;
    };
    return example::run<program>(argc, argv, s, describe, [] {}, work);
}
