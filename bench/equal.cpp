// SPDX-License-Identifier: MIT
//
// usage: bench_equal [--json=FILE] [--most=N] [--only=WORD]
//
// What equal values cost where the least ids win: scenes in which as many shapes as can be are as near, or are met as soon,
// beside the same scenes with numbers moved a little at random, in which hardly any are. One core. Names:
//
//   SCENE/FORM/N      N shapes, or N on either side: `ms` with ties, `ms_without`, and `over`, their quotient; of two trees also
//                     `ms_first`, of the first call with ties, of trees that nobody has asked, and `ms_made`, of making these
//
// Each pair of times is of calls in turn, and the quotient is one of medians. First calls are the median of five.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/abut.hpp>

#include "../tests/support/scenes.hpp"
#include "results.hpp"

namespace {

using abut::vec3;
using T = float;
const abut::serial on;

/// What a scene is made of: shapes of one side, of which `rough` moves each a little.
class moves {
public:
    explicit moves(double rough, std::uint64_t seed) : rough_(rough), random_(seed) {}
    vec3<T> operator()(double x, double y, double z) {
        const auto one = [&](double v) { return static_cast<T>(v + rough_ * (random_() - 0.5)); };
        return {one(x), one(y), one(z)};
    }
    T size(double r) { return static_cast<T>(r + rough_ * (random_() - 0.5)); }

private:
    double rough_;
    abut::test::uniform random_;
};
constexpr double roughness = 1e-3;

abut::shapes<vec3<T>> copied_points(std::size_t n, double z, moves move) {
    std::vector<vec3<T>> all;
    for (std::size_t i = 0; i < n; ++i) all.push_back(move(0, 0, z));
    return abut::shapes<vec3<T>>(all);
}
abut::shapes<abut::sphere<T>> copied_spheres(std::size_t n, double z, moves move) {
    std::vector<abut::sphere<T>> all;
    for (std::size_t i = 0; i < n; ++i) all.push_back({move(0, 0, z), move.size(0.25)});
    return abut::shapes<abut::sphere<T>>(all);
}
abut::shapes<abut::aabb<T>> copied_boxes(std::size_t n, double z, moves move) {
    std::vector<abut::aabb<T>> all;
    for (std::size_t i = 0; i < n; ++i) all.push_back({move(0, 0, z), move(0.5, 0.5, z + 0.5)});
    return abut::shapes<abut::aabb<T>>(all);
}
/// Triangles between corners that are a unit apart, as many as `n` or a few more; their ids are in no order.
abut::mesh<T> plate(std::size_t n, double z, moves move) {
    const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(n) / 2)));
    std::vector<vec3<T>> corners;
    std::vector<abut::face> faces;
    for (std::uint32_t y = 0; y <= side; ++y) {
        for (std::uint32_t x = 0; x <= side; ++x) corners.push_back(move(x, y, z));
    }
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t at = y * (side + 1) + x;
            faces.push_back({at, at + 1, at + side + 1});
            faces.push_back({at + 1, at + side + 2, at + side + 1});
        }
    }
    abut::test::uniform random(3);
    for (std::size_t i = faces.size(); i > 1; --i) std::swap(faces[i - 1], faces[random.below(i)]);
    return abut::mesh<T>(corners, faces);
}

// --- forms ----------------------------------------------------------------------------------------------------------------

abut::rigid<T> turned(double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {{T(c), T(-s), 0, T(s), T(c), 0, 0, 0, 1}, {0, 0, 0}};
}

template <class Set>
constexpr bool has_volumes = std::is_same_v<Set, abut::mesh<T>> || std::is_same_v<Set, abut::shapes<vec3<T>>>;

struct as_made {
    static auto of(auto tree) { return tree; }
};
struct as_oriented {
    static auto of(const auto& tree) { return abut::oriented(on, tree); }
};
struct as_wide {
    static auto of(const auto& tree) { return abut::wide(on, tree); }
};
struct as_quantised {
    static auto of(const auto& tree) { return abut::quantised(on, tree); }
};

/// Asks again and again of what was made once; ms of each call.
template <class Ask>
double once(const Ask& ask) {
    const auto start = std::chrono::steady_clock::now();
    ask();
    return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
double median(std::vector<double> times) {
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
    return times[times.size() / 2];
}
volatile std::uint64_t sink = 0;

struct program {
    bench::results results{"bench_equal"};
    std::string only;

    template <class With, class Without>
    void compare(const std::string& name, const With& with, const Without& without, bench::counters more = {}) {
        if (name.find(only) == std::string::npos) return;
        std::vector<double> of_with, of_without;
        double spent = 0;
        while (of_with.size() < 3 || (spent < 200 && of_with.size() < 501)) {
            of_with.push_back(once(with));
            of_without.push_back(once(without));
            spent += of_with.back() + of_without.back();
        }
        const double a = median(of_with), b = median(of_without);
        more.insert(more.begin(), {{"ms", a}, {"ms_without", b}, {"over", a / b}});
        results.add(name, more);
    }

    /// `make(k, rough)` is side k.
    template <class Make>
    void pairs(const std::string& scene, std::size_t n, const Make& make) {
        const auto name = [&](const char* form) { return scene + "/" + form + "/" + std::to_string(n); };
        const auto ask = [](const auto& a, const auto& b) {
            return [&] {
                const auto found = abut::distance(on, a, b);
                sink = sink + (found ? found->a : 0);
            };
        };
        const auto of_trees = [&]<class Layout>(const char* form, Layout, const abut::bvh_options& options) {
            if (name(form).find(only) == std::string::npos) return;
            const auto tree = [&](int k, double rough) { return Layout::of(abut::make_bvh(on, make(k, rough), options)); };
            const auto a = tree(0, 0), b = tree(1, 0), c = tree(0, roughness), d = tree(1, roughness);
            const auto set_a = make(0, 0), set_b = make(1, 0);
            std::vector<double> first, made;
            for (int i = 0; i < 5; ++i) {
                std::optional<std::remove_const_t<decltype(a)>> x, y;
                made.push_back(once([&] {
                    x = Layout::of(abut::make_bvh(on, set_a, options));
                    y = Layout::of(abut::make_bvh(on, set_b, options));
                }));
                first.push_back(once(ask(*x, *y)));
            }
            compare(name(form), ask(a, b), ask(c, d), {{"ms_first", median(first)}, {"ms_made", median(made)}});
        };
        of_trees("bvh", as_made{}, {});
        of_trees("sah", as_made{}, {.builder = abut::bvh_builder::sah});
        of_trees("least_ids", as_made{}, {.least_ids = true});
        of_trees("wide", as_wide{}, {});
        if constexpr (has_volumes<decltype(make(0, 0))>) of_trees("oriented", as_oriented{}, {});
        of_trees("quantised", as_quantised{}, {});
        const auto a = abut::make_bvh(on, make(0, 0)), b = abut::make_bvh(on, make(1, 0));
        const auto c = abut::make_bvh(on, make(0, roughness)), d = abut::make_bvh(on, make(1, roughness));
        const auto pose = turned(0.5), still = turned(0);
        compare(name("posed"), ask(abut::posed(a, pose), abut::posed(b, pose)), ask(abut::posed(c, pose), abut::posed(d, pose)));
        compare(name("one_posed"), ask(a, abut::posed(b, still)), ask(c, abut::posed(d, still)));
        const auto set_a = make(0, 0), set_c = make(0, roughness), set_b = make(1, 0), set_d = make(1, roughness);
        compare(name("rows"), ask(set_a, b), ask(set_c, d));
        compare(name("rows_of_b"), ask(a, set_b), ask(c, set_d));
        compare(name("rows_posed"), ask(set_a, abut::posed(b, still)), ask(set_c, abut::posed(d, still)));
        using index = std::remove_cvref_t<decltype(a)>;
        const auto list_of = [&](const index& x, const index& y) {
            return std::vector<abut::posed_pair<index>>(4, {abut::posed(x, pose), abut::posed(y, pose)});
        };
        const auto asks_list = [](const auto& list) {
            return [&] {
                const auto found = abut::distance(on, list);
                sink = sink + found[0].a;
            };
        };
        const auto l = list_of(a, b), m = list_of(c, d);
        compare(name("list"), asks_list(l), asks_list(m));
        const auto bodies_of = [&](const index& x, const index& y) {
            return abut::make_bodies(on, std::vector<abut::posed_object<index>>{abut::posed(x, pose), abut::posed(y, pose)});
        };
        const auto asks_bodies = [](const auto& all) {
            return [&] {
                const auto found = abut::distance(on, all);
                sink = sink + (found ? found->a : 0);
            };
        };
        const auto p = bodies_of(a, b), q = bodies_of(c, d);
        compare(name("bodies"), asks_bodies(p), asks_bodies(q));
    }

    template <class Make, class Rows, class Ask>
    void rows(const std::string& scene, const char* question, std::size_t n, const Make& make, const Rows& looking, const Ask& ask) {
        const auto of = [&](const std::string& form, const auto& x, const auto& y) {
            compare(scene + "/" + question + form + "/" + std::to_string(n), [&] { sink = sink + ask(x, looking); },
                    [&] { sink = sink + ask(y, looking); });
        };
        const auto a = abut::make_bvh(on, make(0, 0)), b = abut::make_bvh(on, make(0, roughness));
        of("", a, b);
        of("_wide", abut::wide(on, a), abut::wide(on, b));
        if constexpr (has_volumes<decltype(make(0, 0))>) of("_oriented", abut::oriented(on, a), abut::oriented(on, b));
        of("_quantised", abut::quantised(on, a), abut::quantised(on, b));
        of("_posed", abut::posed(a, turned(0.5)), abut::posed(b, turned(0.5)));
        using index = std::remove_cvref_t<decltype(a)>;
        const auto bodies_of = [&](const index& x) {
            return abut::make_bodies(on, std::vector<abut::posed_object<index>>{abut::posed(x, turned(0.5)), abut::posed(x, turned(0.1))});
        };
        of("_bodies", bodies_of(a), bodies_of(b));
    }
};

}  // namespace

int main(int argc, char** argv) {
    const std::string path = bench::take_argument(argc, argv, "--json");
    const std::size_t most = std::stoul(bench::take_argument(argc, argv, "--most", "20000"));
    program all;
    all.only = bench::take_argument(argc, argv, "--only");
    for (std::size_t n : {std::size_t{1000}, std::size_t{5000}, std::size_t{20000}}) {
        if (n > most) continue;
        const auto copies = [&](const auto& one, double apart) {
            return [&one, n, apart](int k, double rough) { return one(n, k * apart, moves(rough, static_cast<std::uint64_t>(k) + 1)); };
        };
        all.pairs("points", n, copies(copied_points, 1));
        all.pairs("points_touch", n, copies(copied_points, 0));
        all.pairs("spheres", n, copies(copied_spheres, 1));
        all.pairs("boxes", n, copies(copied_boxes, 1));
        all.pairs("plates", n, copies(plate, 1));
        all.pairs("plates_touch", n, copies(plate, 0));
        std::vector<vec3<T>> looking;
        std::vector<abut::ray<T>> lines;
        abut::test::uniform random(7);
        const auto around = [&] { return vec3<T>{T(random() * 4 - 2), T(random() * 4 - 2), T(random() * 4 - 2)}; };
        for (int i = 0; i < 1000; ++i) looking.push_back(around());
        const auto first = [](const auto& found) { return found[0].id; };
        const auto nearest = [&](const auto& x, const auto& from) { return first(abut::nearest(on, x, from)); };
        const auto nearest_few = [&](const auto& x, const auto& from) { return first(abut::nearest(on, x, from, 8)); };
        const auto cast = [&](const auto& x, const auto& from) { return first(abut::raycast(on, x, from)); };
        const auto detailed = [&](const auto& x, const auto& from) { return abut::raycast_detailed(on, x, from)[0].hit.id; };
        const auto aim = [&](double side) {
            lines.clear();
            for (int i = 0; i < 1000; ++i) lines.push_back({{T(side * random()), T(side * random()), -5}, {0, 0, 1}});
            return abut::rays<T>(lines);
        };
        all.rows("points", "nearest", n, copies(copied_points, 1), looking, nearest);
        all.rows("points", "nearest_few", n, copies(copied_points, 1), looking, nearest_few);
        all.rows("spheres", "nearest", n, copies(copied_spheres, 1), looking, nearest);
        all.rows("spheres", "raycast", n, copies(copied_spheres, 1), aim(0.2), cast);
        const auto triangles = [&](int, double rough) {
            moves move(rough, 1);
            std::vector<vec3<T>> corners;
            std::vector<abut::face> faces;
            for (std::uint32_t i = 0; i < n; ++i) {
                corners.push_back(move(0, 0, 0)), corners.push_back(move(1, 0, 0)), corners.push_back(move(0, 1, 0));
                faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
            }
            return abut::mesh<T>(corners, faces);
        };
        all.rows("triangles", "nearest", n, triangles, looking, nearest);
        all.rows("triangles", "raycast", n, triangles, aim(0.5), cast);
        all.rows("triangles", "raycast_detailed", n, triangles, aim(0.5), detailed);
    }
    if (!path.empty()) all.results.write(path);
    return 0;
}
