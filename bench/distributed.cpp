// SPDX-License-Identifier: MIT
//
// usage: mpirun -np P bench_distributed [--json=FILE] [--shapes=N] [--runs=N] [--whole=N] [--cores=N]
//
// Queries of sets whose parts lie on ranks, each rank on one core. The scene is as many triangles as spheres, uniform in a
// cube of as many units of volume, so that a triangle touches about three spheres. It is the same whatever P is. One run
// measures 1, 2, 4 ... P ranks in turn, each on a communicator of its own, while the other ranks sleep. `ms` is by the
// clock, for no more ranks than --cores, which is those of this host. `work_ms` is processor time outside of calls of MPI
// that wait, which other jobs and a lack of cores disturb less. Both are of the slowest rank, and medians of --runs runs (7;
// 3 beyond the cores). Names:
//
//   STAGE/DEAL/SHAPES/RANKS    SHAPES is N / 2, N and 2 N (200,000). STAGE is redistribute, build, pairs, count or nearest.
//                              DEAL is how shapes are dealt to ranks: random, or curve, which is by redistribute. Counters
//                              are of all ranks, or `most_` of the rank that has most: messages and bytes that are sent,
//                              collective calls and what they bring to a rank, results, largest over mean of the ranks'
//                              results. For pairs: b-shapes that touch an a-shape of another rank, once for each such rank,
//                              which is the least that has to be sent
//   parts/SHAPES/PARTS         what pairs would send if --whole shapes (4,000,000), and a tenth, were on so many ranks along
//                              the curve, and how many blocks of shapes are near another part. One process counts it with
//                              the library's own rule
//   link/BYTES                 one way of a message between two ranks here, ms
//   local/WHAT                 what a rank does for each other rank, ns: a look at one block of shapes, at one shape of a
//                              near block, at one block of points (most are far), at one point of a near block, at one part,
//                              at one code; and the making of one block of points

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include <mpi.h>

#include <abut/mpi.hpp>

#include "../tests/support/draws.hpp"
#include "results.hpp"

namespace {

using part_bounds = abut::detail::part_bounds<float>;

double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// What this rank has said to others, and its processor time in calls that wait for them.
struct traffic {
    double messages = 0, bytes = 0, collectives = 0, gathered = 0, waited_ms = 0;
} said;

struct waiting {
    double since = processor_ms();
    waiting() = default;
    waiting(const waiting&) = delete;
    waiting& operator=(const waiting&) = delete;
    ~waiting() { said.waited_ms += processor_ms() - since; }
};

double bytes_of(int count, MPI_Datatype type) {
    int size = 0;
    PMPI_Type_size(type, &size);
    return static_cast<double>(count) * size;
}
void add_collective(double bytes) {
    ++said.collectives;
    said.gathered += bytes;
}

}  // namespace

// MPI lets a program put its own functions before those of MPI: these count.
extern "C" {
int MPI_Isend(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request) {
    ++said.messages;
    said.bytes += bytes_of(count, type);
    return PMPI_Isend(data, count, type, to, tag, comm, request);
}
int MPI_Waitall(int count, MPI_Request* requests, MPI_Status* statuses) {
    const waiting here;
    return PMPI_Waitall(count, requests, statuses);
}
int MPI_Allgather(const void* data, int count, MPI_Datatype type, void* all, int each, MPI_Datatype of, MPI_Comm comm) {
    int ranks = 0;
    PMPI_Comm_size(comm, &ranks);
    add_collective(bytes_of(each, of) * ranks);
    const waiting here;
    return PMPI_Allgather(data, count, type, all, each, of, comm);
}
int MPI_Allreduce(const void* data, void* all, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm) {
    add_collective(bytes_of(count, type));
    const waiting here;
    return PMPI_Allreduce(data, all, count, type, op, comm);
}
int MPI_Exscan(const void* data, void* before, int count, MPI_Datatype type, MPI_Op op, MPI_Comm comm) {
    add_collective(bytes_of(count, type));
    const waiting here;
    return PMPI_Exscan(data, before, count, type, op, comm);
}
}

namespace {

using abut::test::draws;
using abut::test::construction::cube;
using abut::test::construction::point;
using abut::test::construction::round_to;
using triangles = std::vector<abut::triangle<float>>;
using spheres = std::vector<abut::sphere<float>>;
using on_ranks = abut::distributed<abut::serial>;

// --- the scene: shapes first to last of `total` ---------------------------------------------------------------------------

triangles some_triangles(std::size_t first, std::size_t last, std::size_t total) {
    const double half = std::cbrt(static_cast<double>(total)) / 2;
    triangles made;
    for (std::size_t i = first; i < last; ++i) {
        draws d(2026, 1, i);
        const point p = cube(d, half), a = cube(d, 1), b = cube(d, 1), c = cube(d, 1);
        made.push_back({round_to<float>(p + a), round_to<float>(p + b), round_to<float>(p + c)});
    }
    return made;
}
spheres some_spheres(std::size_t first, std::size_t last, std::size_t total) {
    const double half = std::cbrt(static_cast<double>(total)) / 2;
    spheres made;
    for (std::size_t i = first; i < last; ++i) {
        draws d(2026, 2, i);
        made.push_back({round_to<float>(cube(d, half)), 0.5F});
    }
    return made;
}

// --- rows -----------------------------------------------------------------------------------------------------------------

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? std::numeric_limits<double>::quiet_NaN() : values[values.size() / 2];
}

double reduced(double mine, MPI_Op op, MPI_Comm comm) {
    double all = 0;
    PMPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, op, comm);
    return all;
}

struct row {
    std::vector<double> ms, work_ms;
    bench::counters values;
};

/// Rows by name, in the order in which they came first.
class rows {
public:
    row& operator[](const std::string& name) {
        if (of_.find(name) == of_.end()) names_.push_back(name);
        return of_[name];
    }
    void write(bench::results& to) {
        for (const auto& name : names_) {
            bench::counters values = of_[name].values;
            values.emplace(values.begin(), "work_ms", median(of_[name].work_ms));
            values.emplace(values.begin(), "ms", median(of_[name].ms));
            to.add(name, values);
        }
    }

private:
    std::vector<std::string> names_;
    std::map<std::string, row> of_;
};

/// Runs work() -> number of results on all ranks of `comm`, and keeps the time of the slowest and what was said.
template <class Work>
auto measure(rows& all, const std::string& name, MPI_Comm comm, bool timed, const Work& work) {
    PMPI_Barrier(comm);
    said = {};
    const double start = MPI_Wtime(), processor = processor_ms();
    auto found = work();
    const double work_ms = processor_ms() - processor - said.waited_ms;
    const double ms = 1e3 * reduced(MPI_Wtime() - start, MPI_MAX, comm);
    int ranks = 0;
    PMPI_Comm_size(comm, &ranks);
    const auto results = static_cast<double>(found.size());
    const double sum = reduced(results, MPI_SUM, comm), most = reduced(results, MPI_MAX, comm);
    row& kept = all[name];
    if (timed) kept.ms.push_back(ms);
    kept.work_ms.push_back(reduced(work_ms, MPI_MAX, comm));
    kept.values = {{"messages", reduced(said.messages, MPI_SUM, comm)},
                   {"most_messages", reduced(said.messages, MPI_MAX, comm)},
                   {"bytes", reduced(said.bytes, MPI_SUM, comm)},
                   {"most_bytes", reduced(said.bytes, MPI_MAX, comm)},
                   {"collectives", said.collectives},
                   {"gathered_bytes", said.gathered},
                   {"results", sum},
                   {"imbalance", sum > 0 ? most * ranks / sum : 1}};
    return found;
}

/// A count, as a list of so many would say it.
struct counted {
    std::uint64_t n;
    [[nodiscard]] std::uint64_t size() const { return n; }
};

/// b-shapes of other ranks among what this rank's a-shapes touch, each once.
double foreign(const on_ranks& on, const abut::result<abut::global_pair, abut::host_space>& pairs, std::uint64_t own_b) {
    std::vector<std::uint64_t> sizes(static_cast<std::size_t>(on.size())), met;
    abut::detail::gather(on.ranks(), own_b, sizes);
    const std::uint64_t first = std::accumulate(sizes.begin(), sizes.begin() + on.rank(), std::uint64_t{0});
    for (const auto& pair : pairs) {
        if (pair.b < first || pair.b >= first + own_b) met.push_back(pair.b);
    }
    std::sort(met.begin(), met.end());
    return static_cast<double>(std::unique(met.begin(), met.end()) - met.begin());
}

template <class Triangles, class Spheres>
void ask(rows& all, const on_ranks& on, MPI_Comm comm, const std::string& end, bool timed, const Triangles& a,
         const Spheres& b, const std::vector<abut::vec3<float>>& centers) {
    const abut::serial local;
    const auto index = measure(all, "build/" + end, comm, timed, [&] { return abut::make_bvh(local, a); });
    const auto pairs = measure(all, "pairs/" + end, comm, timed, [&] { return abut::pairs(on, index, b); });
    const double least = reduced(foreign(on, pairs, b.size()), MPI_SUM, comm);
    all["pairs/" + end].values.emplace_back("least_shapes", least);
    all["pairs/" + end].values.emplace_back("least_bytes", least * (sizeof(abut::sphere<float>) + 4));
    // All ranks are told the same number.
    measure(all, "count/" + end, comm, timed, [&] {
        const auto n = static_cast<std::uint64_t>(abut::count(on, index, b));
        return counted{n / static_cast<std::uint64_t>(on.size())};
    });
    measure(all, "nearest/" + end, comm, timed, [&] { return abut::nearest(on, index, centers); });
}

/// All stages of one scene on the ranks of `comm`.
void run(rows& all, MPI_Comm comm, std::size_t shapes, bool timed) {
    const on_ranks on(comm, abut::serial{});
    const auto me = static_cast<std::size_t>(on.rank()), ranks = static_cast<std::size_t>(on.size());
    const std::size_t first = shapes * me / ranks, last = shapes * (me + 1) / ranks;
    const auto centers_of = [](const auto& list) {
        std::vector<abut::vec3<float>> centers;
        for (const auto& sphere : list) centers.push_back(sphere.center);
        return centers;
    };
    const triangles a = some_triangles(first, last, shapes);
    const spheres b = some_spheres(first, last, shapes);
    const std::string end = std::to_string(shapes) + "/" + std::to_string(ranks);
    const abut::shapes<abut::triangle<float>> set_a(a);
    const abut::shapes<abut::sphere<float>> set_b(b);
    ask(all, on, comm, "random/" + end, timed, set_a, set_b, centers_of(b));
    struct part {
        abut::redistributed_part<abut::triangle_soup<float>> moved;
        [[nodiscard]] std::size_t size() const { return moved.set.size(); }
    };
    const auto part_a =
        measure(all, "redistribute/random/" + end, comm, timed, [&] { return part{abut::redistribute(on, set_a)}; });
    const auto part_b = abut::redistribute(on, set_b);
    const auto view = part_b.set.view();
    spheres mine;
    for (std::size_t i = 0; i < view.size(); ++i) mine.push_back(view[i]);
    ask(all, on, comm, "curve/" + end, timed, part_a.moved.set, part_b.set, centers_of(mine));
}

// --- many parts, counted by one process -----------------------------------------------------------------------------------

using bounds_of_some = std::vector<abut::detail::part_bounds<float>>;
using ids = std::vector<std::uint32_t>;

template <class Shapes>
auto part_of(const Shapes& view, std::size_t k, std::size_t parts) {
    const std::size_t first = view.size() * k / parts, last = view.size() * (k + 1) / parts;
    using shape = typename Shapes::shape_type;
    return abut::shapes_view<shape, abut::host_space>(view.shapes.first() + first, last - first);
}
template <class Shapes>
bounds_of_some bounds_of_parts(const Shapes& view, std::size_t parts) {
    bounds_of_some all;
    for (std::size_t k = 0; k < parts; ++k)
        all.push_back(abut::detail::bounds_of_part(abut::serial{}, part_of(view, k, parts)));
    return all;
}

template <class Shapes>
std::vector<abut::aabb<float>> boxes_of_blocks(const Shapes& view) {
    std::vector<abut::aabb<float>> boxes(abut::detail::blocks_of(view.size()));
    const abut::detail::write_block_boxes<Shapes> write{view, abut::detail::block_size, boxes.data()};
    for (std::size_t k = 0; k < boxes.size(); ++k) write(k);
    return boxes;
}
template <class Test>
ids which(std::size_t n, const Test& test) {
    ids some(n);
    some.resize(abut::execution::compact(abut::serial{}, n, test, some.data()));
    return some;
}

void count_parts(rows& all, std::size_t shapes, const std::vector<std::size_t>& divisions) {
    const on_ranks alone(MPI_COMM_SELF, abut::serial{});
    const auto a = abut::redistribute(alone, abut::shapes<abut::triangle<float>>(some_triangles(0, shapes, shapes)));
    const auto b = abut::redistribute(alone, abut::shapes<abut::sphere<float>>(some_spheres(0, shapes, shapes)));
    const auto view_a = a.set.view();
    const auto view_b = b.set.view();
    const auto pairs = abut::pairs(abut::serial{}, abut::make_bvh(abut::serial{}, a.set), b.set);
    for (const std::size_t parts : divisions) {
        if (shapes / parts < 100) continue;
        const auto parts_a = bounds_of_parts(view_a, parts), parts_b = bounds_of_parts(view_b, parts);
        double sent = 0, most_sent = 0, neighbours = 0, most_neighbours = 0, near_blocks = 0;
        for (std::size_t from = 0; from < parts; ++from) {
            const auto part = part_of(view_b, from, parts);
            const auto boxes = boxes_of_blocks(part);
            double here = 0, near = 0;
            for (std::size_t to = 0; to < parts; ++to) {
                if (to == from || !parts_a[to].is_near(parts_b[from])) continue;
                using comes_near = abut::detail::comes_near<std::remove_const_t<decltype(part)>, part_bounds>;
                const ids blocks = which(boxes.size(), abut::detail::is_block_near<float, part_bounds>{boxes.data(), parts_a[to]});
                const abut::detail::in_blocks<comes_near> comes{{part, parts_a[to]}, blocks.data(), part.size()};
                double some = 0;
                for (std::size_t i = 0; i < blocks.size() * abut::detail::block_size; ++i) some += comes(i) ? 1 : 0;
                near_blocks += static_cast<double>(blocks.size());
                here += some;
                near += some > 0 ? 1 : 0;
            }
            sent += here;
            neighbours += near;
            most_sent = std::max(most_sent, here);
            most_neighbours = std::max(most_neighbours, near);
        }
        std::vector<std::uint64_t> touches;
        std::vector<double> found(parts);
        const auto which_part = [&](std::uint32_t id) {  // the last part that begins at or before id
            return ((id + std::uint64_t{1}) * parts - 1) / shapes;
        };
        for (const auto& pair : pairs) {
            const std::uint64_t part = which_part(pair.a);
            found[part] += 1;
            if (part != which_part(pair.b)) touches.push_back(pair.b * std::uint64_t{parts} + part);
        }
        std::sort(touches.begin(), touches.end());
        const auto least = static_cast<double>(std::unique(touches.begin(), touches.end()) - touches.begin());
        const auto mean = static_cast<double>(pairs.size()) / static_cast<double>(parts);
        all["parts/" + std::to_string(shapes) + "/" + std::to_string(parts)].values = {
            {"sent_shapes", sent},
            {"most_sent_shapes", most_sent},
            {"least_shapes", least},
            {"near_blocks", near_blocks},
            {"neighbours", neighbours},
            {"most_neighbours", most_neighbours},
            {"imbalance", *std::max_element(found.begin(), found.end()) / mean}};
    }
}

// --- what one message, and one step for another rank, costs here
// ------------------------------------------------------------

void time_link(rows& all, int rank, int runs) {
    for (const int bytes : {8, 1 << 20}) {
        std::vector<char> data(static_cast<std::size_t>(bytes));
        for (int k = 0; k < runs; ++k) {
            const int times = bytes == 8 ? 2000 : 200;
            const double start = MPI_Wtime();
            for (int i = 0; i < times; ++i) {
                if (rank == 0) MPI_Send(data.data(), bytes, MPI_BYTE, 1, 0, MPI_COMM_WORLD);
                MPI_Recv(data.data(), bytes, MPI_BYTE, 1 - rank, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
                if (rank == 1) MPI_Send(data.data(), bytes, MPI_BYTE, 0, 0, MPI_COMM_WORLD);
            }
            if (rank == 0) all["link/" + std::to_string(bytes)].ms.push_back(1e3 * (MPI_Wtime() - start) / times / 2);
        }
    }
}

/// ns of processor time of each of n steps, a median.
template <class Step>
void time_steps(rows& all, const std::string& name, int runs, std::size_t n, const Step& step) {
    std::vector<double> ns;
    static volatile std::uint64_t keep = 0;
    for (int k = 0; k < runs; ++k) {
        const double start = processor_ms();
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += step(i);
        keep = keep + sum;
        ns.push_back(1e6 * (processor_ms() - start) / static_cast<double>(n));
    }
    all[name].values = {{"ns", median(ns)}};
}

/// A look of part `to` at one thing of another part.
struct look {
    std::uint32_t to, id;
};
/// Times tests[to](id) for all looks.
template <class Test>
void time_looks(rows& all, const std::string& name, int runs, const std::vector<Test>& tests,
                const std::vector<look>& looks) {
    time_steps(all, name, runs, looks.size(), [&](std::size_t i) { return tests[looks[i].to](looks[i].id) ? 1U : 0U; });
}

/// Times tests of blocks of other parts, for which may_ask(to, of), and tests of what is in the blocks that pass.
template <class Test, class Block, class Ask>
void time_blocks(rows& all, const std::string& name, int runs, std::size_t shapes, const std::vector<Block>& blocks,
                 const std::vector<Test>& tests, const Ask& may_ask) {
    constexpr std::size_t size = abut::detail::block_size;
    std::vector<look> at_blocks, at_shapes;
    for (std::uint32_t to = 0; to < blocks.size(); ++to) {
        for (std::uint32_t k = 0; k < abut::detail::blocks_of(shapes); ++k) {
            const std::size_t of = k * size * blocks.size() / shapes;
            if (of == to || !may_ask(to, of)) continue;
            at_blocks.push_back({to, k});
            if (!blocks[to](k)) continue;
            for (std::size_t i = k * size; i < std::min((k + 1) * size, shapes); ++i)
                at_shapes.push_back({to, static_cast<std::uint32_t>(i)});
        }
    }
    time_looks(all, "local/" + name + "_block", runs, blocks, at_blocks);
    time_looks(all, "local/" + name, runs, tests, at_shapes);
}

void time_local(rows& all, std::size_t shapes, int runs) {
    const on_ranks alone(MPI_COMM_SELF, abut::serial{});
    const auto set = abut::redistribute(alone, abut::shapes<abut::sphere<float>>(some_spheres(0, shapes, shapes))).set;
    const auto view = set.view();
    using view_type = std::remove_const_t<decltype(view)>;
    const auto parts = bounds_of_parts(view, 1000);  // few of them are near to one
    const auto boxes = boxes_of_blocks(view);
    std::vector<abut::detail::is_block_near<float, part_bounds>> near_blocks;
    std::vector<abut::detail::comes_near<view_type, part_bounds>> near_shapes;
    for (const auto& part : parts) {
        near_blocks.push_back({boxes.data(), part});
        near_shapes.push_back({view, part});
    }
    time_blocks(all, "shape", runs, shapes, near_blocks, near_shapes,
                [&](std::size_t to, std::size_t of) { return parts[to].is_near(parts[of]); });
    time_steps(all, "local/part", runs, 10000,
               [&](std::size_t i) { return parts[i / 100 * 10].is_near(parts[i % 100 * 10]) ? 1U : 0U; });

    std::vector<abut::vec3<float>> points;
    for (std::size_t i = 0; i < shapes; ++i) points.push_back(view[i].center);
    using points_view = abut::shapes_view<abut::vec3<float>, abut::host_space>;
    const points_view all_points(points.data(), shapes);
    const auto unit = abut::detail::unit_of_magnitude<float>(std::cbrt(static_cast<double>(shapes)) / 2);
    std::vector<abut::detail::measured_neighbor<float>> best(shapes);
    const double one = unit.of(1);
    for (auto& b : best) b = {one * one, 0, {}, 1};
    std::vector<abut::detail::block_looking<float>> blocks(boxes.size());
    const abut::detail::write_blocks_looking<points_view> write{all_points, best.data(), 1, blocks.data()};
    time_steps(all, "local/made_block", runs, blocks.size(), [&](std::size_t k) {
        write(k);
        return blocks[k].worst > 0 ? 1U : 0U;
    });
    const abut::detail::nearest_in_parts<float> question{unit};
    std::vector<abut::detail::may_block_be_near<float>> may_blocks;
    std::vector<abut::detail::may_be_changed<points_view, abut::detail::nearest_in_parts<float>>> may_points;
    for (const auto& part : parts) {
        may_blocks.push_back({blocks.data(), unit, part});
        may_points.push_back({all_points, question, best.data(), part});
    }
    time_blocks(all, "point", runs, shapes, may_blocks, may_points, [](std::size_t, std::size_t) { return true; });

    std::vector<std::uint64_t> codes(shapes);
    for (std::size_t i = 0; i < shapes; ++i) codes[i] = draws(2026, 3, i).bits() >> 1;
    std::sort(codes.begin(), codes.end());
    time_steps(all, "local/code", runs, 10000, [&](std::size_t i) {
        const std::uint64_t code = draws(2026, 4, i).bits() >> 1;
        return static_cast<std::uint64_t>(std::lower_bound(codes.begin(), codes.end(), code) - codes.begin());
    });
}

/// Comes back when all ranks are here, and takes no core until then.
void sleep_until_all_are_here() {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    for (int done = 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE), done == 0;) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

int number(int& argc, char** argv, const char* name, int otherwise) {
    return std::max(1, std::atoi(bench::take_argument(argc, argv, name, std::to_string(otherwise)).c_str()));
}

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    int rank = 0, ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    try {
        const std::string json = bench::take_argument(argc, argv, "--json");
        const auto shapes = static_cast<std::size_t>(number(argc, argv, "--shapes", 200000));
        const auto whole = static_cast<std::size_t>(number(argc, argv, "--whole", 4000000));
        const int runs = number(argc, argv, "--runs", 7);
        const int cores = number(argc, argv, "--cores", static_cast<int>(std::thread::hardware_concurrency()));
        rows all;
        for (int k = 0; k < runs; ++k) {
            for (const std::size_t n : {shapes / 2, shapes, 2 * shapes}) {
                for (int active = 1; active <= ranks; active *= 2) {
                    if (active > cores && k >= 3) continue;
                    MPI_Comm comm = MPI_COMM_NULL;
                    MPI_Comm_split(MPI_COMM_WORLD, rank < active ? 0 : MPI_UNDEFINED, rank, &comm);
                    if (comm != MPI_COMM_NULL) {
                        run(all, comm, n, active <= cores);
                        MPI_Comm_free(&comm);
                    }
                    sleep_until_all_are_here();
                }
            }
        }
        if (ranks > 1 && rank < 2) time_link(all, rank, runs);
        if (rank == 0) {
            time_local(all, shapes, runs);
            // Powers of 8 divide the cube into cubes, others do not.
            for (const std::size_t n : {whole / 10, whole})
                count_parts(all, n, {2, 3, 8, 10, 64, 100, 512, 1000, 4096, 10000});
            bench::results to("bench_distributed");
            to.describe("ranks", std::to_string(ranks));
            to.describe("runs", std::to_string(runs));
            all.write(to);
            if (!json.empty()) to.write(json);
        }
        sleep_until_all_are_here();
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "bench_distributed, rank %d: %s\n", rank, problem.what());
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Finalize();
    return 0;
}
