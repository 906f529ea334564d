// SPDX-License-Identifier: MIT
#include <abut/collide/impacts.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "collide/impact_scenes.hpp"
#include "support/catch.hpp"

namespace abut::test {

TEMPLATE_TEST_CASE("impacts: serial", "", float, double) {
    check_all_impacts<TestType>(serial{});
    check_small_impacts<TestType>(serial{});
    check_first_of_many<TestType>(serial{});
}

TEMPLATE_TEST_CASE("impacts: openmp", "", float, double) {
    check_all_impacts<TestType>(openmp{.threads = 3}, 1, 3);
    check_small_impacts<TestType>(openmp{.threads = 3});
    check_first_of_many<TestType>(openmp{.threads = 3});
}

TEMPLATE_TEST_CASE("impacts: of bodies of thousands of faces", "", float, double) {
    const large_scene<TestType> s(4, 0.15);
    const auto between = in_order(impacts_by_loops(s.a, s.b)), self = in_order(self_impacts_by_loops(s.a));
    CHECK(between.size() > 500);
    CHECK(self.size() > 500);
    check_same("serial", to_host(impacts(serial{}, s.a.as_set(), s.b.as_set())), between);
    check_same("serial, self", to_host(self_impacts(serial{}, s.a.as_set())), self);
    const openmp on{.threads = 4};
    for (int k = 0; k < 3; ++k) {
        check_same("openmp", to_host(impacts(on, s.a.as_set(), s.b.as_set())), between);
        check_same("openmp, self", to_host(self_impacts(on, s.a.as_set())), self);
    }
}

// --- real scenes
// -------------------------------------------------------------------------------------------------------------

TEST_CASE("impacts: the truth of the scenes, cloth-funnel") {
    if (!ccd_folder("cloth-funnel")) ABUT_SKIP("data", "the folder of real scenes is not there (ABUT_DATA)");
    check_scene<float>(serial{}, "cloth-funnel");
    check_scene<double>(openmp{.threads = 3}, "cloth-funnel");
}

TEST_CASE("impacts: the truth of the scenes, cloth-ball") {
    if (!ccd_folder("cloth-ball")) ABUT_SKIP("data", "the folder of real scenes is not there (ABUT_DATA)");
    check_scene<float>(openmp{.threads = 3}, "cloth-ball");
    if (sample_count() > 5000) check_scene<double>(serial{}, "cloth-ball");
}

TEST_CASE("impacts: the truth of the scenes, armadillo-rollers") {
    if (!ccd_folder("armadillo-rollers")) ABUT_SKIP("data", "the folder of real scenes is not there (ABUT_DATA)");
    check_scene<double>(serial{}, "armadillo-rollers");
}

TEST_CASE("impacts: scenes without truth, the same on every policy") {
    if (!ccd_folder("rod-twist")) ABUT_SKIP("data", "the folder of real scenes is not there (ABUT_DATA)");
    if (sample_count() <= 5000) ABUT_SKIP("time", "takes long (ABUT_SAMPLES above 5000)");
    for (const char* name : {"n-body-simulation", "rod-twist"}) {
        CAPTURE(name);
        const auto folder = ccd_folder(name);
        REQUIRE(folder);
        const auto set = set_of<double>(read_ccd_scene(*folder));
        const auto found = to_host(self_impacts(serial{}, set));
        CHECK(found.size() > 1000);
        CHECK(to_host(self_impacts(openmp{.threads = 4}, set)) == found);
        CHECK(to_host(self_impacts<exact>(openmp{.threads = 4}, set)) == found);
    }
}

// --- what is refused
// ---------------------------------------------------------------------------------------------------------

namespace {

/// What an error says; nothing if there is none.
template <class Error, class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}
bool says(const std::string& message, std::initializer_list<const char*> parts) {
    return std::all_of(parts.begin(), parts.end(), [&](const char* p) { return message.find(p) != std::string::npos; });
}

}  // namespace

TEMPLATE_TEST_CASE("sets in motion: what is refused", "", float, double) {
    using T = TestType;
    const std::vector<vec3<T>> four{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, three(four.begin(), four.begin() + 3);
    const std::vector<face> faces{{0, 1, 2}, {0, 2, 3}}, others{{0, 1, 2}, {0, 1, 3}}, one{{0, 1, 2}};
    const mesh<T> m(four, faces);
    const serial on;
    const openmp threads{.threads = 2};

    const auto refused = [](const auto& call, std::initializer_list<const char*> parts) {
        const std::string message = refusal<error>(call);
        CAPTURE(message);
        CHECK(says(message, parts));
    };
    refused([&] { (void)moving(m, mesh<T>(four, one)); }, {"abut::moving", "2 shapes", "1 at t = 1"});
    refused([&] { (void)moving(mesh<T>(four, one), mesh<T>(three, one)); }, {"abut::moving", "4 vertices", "3 at t = 1"});
    refused([&] { (void)moving(m, mesh<T>(four, others)); }, {"abut::moving", "face 1"});
    refused([&] { (void)moving(edges(on, m), edges(on, mesh<T>(four, others))); }, {"abut::moving", "edge"});
    refused([&] { (void)moving(points<T>(four), points<T>(three)); }, {"abut::moving", "4", "3"});
    refused([&] { (void)m.with_vertices(on, three); }, {"with_vertices", "3", "4"});
    CHECK(to_host(self_impacts(on, moving(m, mesh<T>(four, faces)))) == to_host(self_impacts(on, moving(m, m))));

    // NaN and infinity at t = 1, by their place.
    for (const T bad : {std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity()}) {
        std::vector<vec3<T>> spoiled = four;
        spoiled[2].y = bad;
        const std::string copied = refusal<invalid_geometry>([&] { (void)m.with_vertices(on, spoiled); });
        CAPTURE(copied);
        CHECK(says(copied, {"vertex 2"}));
        const mesh_view<T> at_0(four.data(), 4, faces.data(), 2), at_1(spoiled.data(), 4, faces.data(), 2);
        const auto refused_at = [&](const char* when, const auto& call) {
            const std::string message = refusal<invalid_geometry>(call);
            CAPTURE(message);
            CHECK(says(message, {"abut::make_bvh", when, "2", "y is not finite"}));
        };
        for (const bool at_the_end : {false, true}) {
            const char* const when = at_the_end ? "at t = 1" : "at t = 0";
            const auto view = at_the_end ? moving(at_0, at_1) : moving(at_1, at_0);
            refused_at(when, [&] { (void)make_bvh(on, view); });
            refused_at(when, [&] { (void)make_bvh(threads, view); });
            CHECK_THROWS_AS(pairs(on, view, moving(points<T>(four), points<T>(four))), invalid_geometry);
            const points_view<T> points_0(four.data(), 4), points_1(spoiled.data(), 4);
            const auto of_points = at_the_end ? moving(points_0, points_1) : moving(points_1, points_0);
            refused_at(when, [&] { (void)make_bvh(on, of_points); });
            // One shape, and a set of such.
            const triangle<T> good{four[0], four[1], four[3]}, poor{spoiled[0], spoiled[2], spoiled[3]};
            const auto one_of_all = at_the_end ? moving(good, poor) : moving(poor, good);
            const std::string message =
                refusal<invalid_geometry>([&] { (void)pairs(on, one_of_all, moving(points<T>(four), points<T>(four))); });
            CAPTURE(message);
            CHECK(says(message, {"abut::pairs", when, "y is not finite"}));
        }
    }
    // Views are checked by what takes them.
    const mesh_view<T> view(four.data(), 4, faces.data(), 2), of_others(four.data(), 4, others.data(), 2),
        of_one(four.data(), 4, one.data(), 1);
    refused([&] { (void)make_bvh(on, moving(view, of_others)); }, {"abut::make_bvh", "face 1"});
    refused([&] { (void)make_bvh(threads, moving(view, of_one)); }, {"abut::make_bvh", "2 shapes", "1 at t = 1"});
    refused([&] { (void)make_bvh(on, moving(view, mesh_view<T>(four.data(), 3, one.data(), 1))); }, {"abut::make_bvh"});
    refused([&] { (void)make_bvh(on, moving(points_view<T>(four.data(), 4), points_view<T>(four.data(), 2))); },
            {"abut::make_bvh", "4 shapes", "2 at t = 1"});

    const auto index = make_impact_index(on, moving(m, m));
    refused([&] { (void)refit(on, index, moving(mesh<T>(four, others), mesh<T>(four, others))); },
            {"abut::refit", "face 1"});
    refused([&] { (void)refit(on, index, moving(mesh<T>(four, one), mesh<T>(four, one))); }, {"abut::refit", "shapes"});
    refused([&] { (void)refit(on, index, moving(mesh<T>(three, one), mesh<T>(three, one))); }, {"abut::refit"});
    CHECK(to_host(self_impacts(on, refit(on, index, moving(mesh<T>(four, faces), mesh<T>(four, faces))))) ==
          to_host(self_impacts(on, index)));

    // Bounds that are none.
    const auto with = [&](const conservative_bounds& bounds) {
        return [&, bounds] { (void)impacts<conservative>(on, m, m, {.bounds = bounds}); };
    };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), far = std::numeric_limits<double>::infinity();
    refused(with({.separation = -1}), {"abut::impacts", "separation"});
    refused(with({.separation = nan}), {"abut::impacts", "separation"});
    refused(with({.separation = far}), {"abut::impacts", "separation"});
    refused(with({.tolerance = -1}), {"abut::impacts", "tolerance"});
    refused(with({.tolerance = nan}), {"abut::impacts", "tolerance"});
    // A separation that would not be kept.
    const impact_options apart{.bounds = {.separation = 0.125}};
    refused([&] { (void)impacts(on, m, m, apart); }, {"abut::impacts", "separation is 0.125", "conservative"});
    refused([&] { (void)self_impacts<exact>(on, index, apart); }, {"abut::self_impacts", "conservative"});
    refused([&] { (void)first_impact<fast>(on, m, m, apart); }, {"abut::first_impact", "conservative"});
}

}  // namespace abut::test
