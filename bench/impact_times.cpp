// SPDX-License-Identifier: MIT
//
// usage: bench_impact_times DATA [--json=OUT.json] [--runs=N]
//
// Times of impact of single pairs on one core in double, by abut and by peers out of ABUT_PEERS (bench/impact_times/): of the
// pairs of DATA/SCENE/truth_vf.bin and truth_ee.bin, whose earliest times are known (README.md there). A row, SCENE/KIND/LIBRARY:
//
//   ns       of a pair that touches, the median of N runs (15) in which the libraries take turns; over is ACCD's, if it is there
//   apart    the same of one that does not, where there are more than a hundred
//   missed   of those that touch, they are said not to
//   late     times later than the true one, by more than 2^-50
//   phantom  those that do not touch, but are said to
//   early    how much earlier than the true one a time is: half of them are by less
//   worst    and all are
//
// abut is `filtered`; abut_conservative has its default bounds, abut_coarse a tolerance of 2^-3, about how early ACCD's times are;
// abut_fast promises nothing.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <abut/io/read.hpp>
#include <abut/narrow/time_of_impact.hpp>
#include <abut/shape/motion.hpp>

#include "impact_times/peer.hpp"
#include "results.hpp"

namespace {

using namespace impact_peer;

template <abut::motion_arithmetic A, int Exponent = 0>
void times_of(kind k, const std::vector<features>& all, std::vector<double>& out) {
    using abut::moving;
    abut::conservative_bounds bounds;
    if (Exponent != 0) bounds.tolerance = std::ldexp(1.0, Exponent);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const auto& p = all[i].t0;
        const auto& q = all[i].t1;
        if (k == kind::vertex_face) {
            out[i] = abut::time_of_impact<A>(moving(p[0], q[0]), moving(abut::triangle<double>{p[1], p[2], p[3]},
                                                                        abut::triangle<double>{q[1], q[2], q[3]}), bounds);
        } else {
            out[i] = abut::time_of_impact<A>(moving(abut::segment<double>{p[0], p[1]}, abut::segment<double>{q[0], q[1]}),
                                             moving(abut::segment<double>{p[2], p[3]}, abut::segment<double>{q[2], q[3]}), bounds);
        }
    }
}

struct pairs {
    std::vector<features> hits, misses;
    std::vector<double> truth;
};
pairs read_pairs(const std::filesystem::path& folder, kind k) {
    const auto first = abut::io::read_mesh_data<double>(folder / "frame0.ply"), last = abut::io::read_mesh_data<double>(folder / "frame1.ply");
    const auto file = folder / (k == kind::vertex_face ? "truth_vf.bin" : "truth_ee.bin");
    std::FILE* const in = std::fopen(file.c_str(), "rb");
    std::int32_t head[4]{};
    if (in == nullptr || std::fread(head, 4, 4, in) != 4 || head[0] != 0x54444343) throw std::runtime_error(file.string());
    std::vector<std::array<std::int32_t, 5>> rows(static_cast<std::size_t>(head[2]));
    std::vector<double> times(rows.size());
    const auto got = std::fread(rows.data(), 20, rows.size(), in) + std::fread(times.data(), 8, rows.size(), in);
    std::fclose(in);
    if (got != 2 * rows.size()) throw std::runtime_error(file.string());
    pairs out;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        features f{};
        for (int j = 0; j < 4; ++j) {
            const auto v = static_cast<std::size_t>(rows[i][j]);
            f.t0[j] = first.vertices.at(v), f.t1[j] = last.vertices.at(v);
        }
        (rows[i][4] != 0 ? out.hits : out.misses).push_back(f);
        if (rows[i][4] != 0) out.truth.push_back(times[i]);
    }
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::string path = bench::take_argument(argc, argv, "--json");
        const int runs = std::stoi(bench::take_argument(argc, argv, "--runs", "15"));
        if (argc != 2) throw std::runtime_error("usage: bench_impact_times DATA [--json=OUT.json] [--runs=N]");
        std::vector<library> all{{"abut", "", times_of<abut::filtered>},
                                 {"abut_conservative", "", times_of<abut::conservative>},
                                 {"abut_coarse", "", times_of<abut::conservative, -3>},
                                 {"abut_fast", "", times_of<abut::fast>}};
        all.insert(all.end(), libraries().begin(), libraries().end());
        bench::results out("bench_impact_times");
        for (std::size_t i = 4; i < all.size(); ++i) out.describe(all[i].name, all[i].version);
        for (const char* scene : {"cloth-ball", "cloth-funnel", "armadillo-rollers"}) {
            for (const kind k : {kind::vertex_face, kind::edge_edge}) {
                const pairs p = read_pairs(std::filesystem::path(argv[1]) / scene, k);
                const auto timed = [&](const std::vector<features>& some, std::vector<std::vector<double>>& found) {
                    std::vector<std::vector<double>> times(all.size());
                    for (int run = 0; run < runs; ++run) {
                        for (std::size_t i = 0; i < all.size(); ++i) {
                            found[i].assign(some.size(), 0);
                            const double start = bench::processor_time();
                            all[i].times(k, some, found[i]);
                            times[i].push_back((bench::processor_time() - start) / static_cast<double>(some.size()));
                        }
                    }
                    std::vector<double> ns;
                    for (auto& t : times) std::sort(t.begin(), t.end()), ns.push_back(t[t.size() / 2]);
                    return ns;
                };
                std::vector<std::vector<double>> found(all.size()), none(all.size());
                const std::vector<double> ns = timed(p.hits, found), apart = timed(p.misses, none);
                const auto peer = std::find_if(all.begin(), all.end(), [](const library& l) { return l.name == "ACCD"; });
                for (std::size_t i = 0; i < all.size(); ++i) {
                    double missed = 0, late = 0, phantom = 0;
                    std::vector<double> early;
                    for (std::size_t j = 0; j < p.truth.size(); ++j) {
                        missed += found[i][j] < 0;
                        late += found[i][j] > p.truth[j] + 0x1p-50;
                        if (found[i][j] >= 0) early.push_back(p.truth[j] - found[i][j]);
                    }
                    for (const double t : none[i]) phantom += t >= 0;
                    std::sort(early.begin(), early.end());
                    bench::counters row{{"ns", ns[i]}, {"missed", missed}, {"late", late}, {"phantom", phantom},
                                        {"of", static_cast<double>(p.hits.size())}, {"and", static_cast<double>(p.misses.size())},
                                        {"early", early.empty() ? 0 : early[early.size() / 2]},
                                        {"worst", early.empty() ? 0 : early.back()}};
                    if (peer != all.end()) row.push_back({"over", ns[i] / ns[static_cast<std::size_t>(peer - all.begin())]});
                    if (p.misses.size() > 100) row.push_back({"apart", apart[i]});
                    out.add(bench::joined({scene, k == kind::vertex_face ? "vertex_face" : "edge_edge", all[i].name}), row);
                }
            }
        }
        if (!path.empty()) out.write(path);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench_impact_times: %s\n", e.what());
        return 1;
    }
}
