// SPDX-License-Identifier: MIT
//
// Sets of convex hulls whose parts lie on many ranks: what one machine says of the whole set, bit for bit. They are sent as
// points, those of posed sets where they are in the world, and no others than may be asked about.

#include <abut/mpi.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "distributed/world.hpp"
#include "support/poses.hpp"
#include "support/surfaces.hpp"

namespace abut::test {

namespace {

template <scalar T>
using hull_lists = std::vector<std::vector<vec3<T>>>;

/// Hulls of one to forty points on a lattice, along one axis, so that parts lie side by side; then all of them again.
template <scalar T>
hull_lists<T> hulls_on_lattice(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> cell(0, 40), off(-7, 7), count(1, 40);
    hull_lists<T> all;
    for (std::size_t i = 0; i < n; ++i) {
        const int x = cell(random), y = cell(random), z = cell(random), points = count(random);
        std::vector<vec3<T>> some;
        for (int k = 0; k < points; ++k) {
            const int dx = off(random), dy = off(random), dz = off(random);
            some.push_back({T(x + dx) / 8, T(y + dy) / 8, T(z + dz) / 8});
        }
        all.push_back(some);
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& s, const auto& t) { return s[0].x < t[0].x; });
    const auto first = all;
    all.insert(all.end(), first.begin(), first.end());
    return all;
}

template <scalar T>
struct divided_hulls {
    hulls<T> whole, part;
    divided_hulls(const hull_lists<T>& all, division how, const detail::own_communicator& ranks)
        : whole(all), part(part_of(all, how, ranks.rank(), ranks.size())) {}
};

/// Places in and around the hulls.
template <scalar T>
std::vector<vec3<T>> places_at_hulls(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> cell(-6, 46);
    std::vector<vec3<T>> all;
    for (std::size_t i = 0; i < n; ++i) {
        const int x = cell(random), y = cell(random), z = cell(random);
        all.push_back({T(x) / 8, T(y) / 8, T(z) / 8});
    }
    return all;
}

template <scalar T>
struct mesh_at_hulls {
    std::vector<vec3<T>> vertices;
    std::vector<face> faces;

    mesh_at_hulls(std::size_t n, unsigned seed) {
        for (const vec3<T>& p : places_at_hulls<T>(n, seed)) {
            const auto first = static_cast<std::uint32_t>(vertices.size());
            vertices.insert(vertices.end(), {p, {p.x + T(0.5), p.y, p.z}, {p.x, p.y + T(0.5), p.z + T(0.25)}});
            faces.push_back({first, first + 1, first + 2});
        }
    }
    [[nodiscard]] mesh<T> whole() const { return mesh<T>(vertices, faces); }
    [[nodiscard]] mesh<T> part(division how, const detail::own_communicator& ranks) const {
        return mesh<T>(vertices, part_of(faces, how, ranks.rank(), ranks.size()));
    }
};

template <scalar T>
rigid<T> pose_at_hulls() {
    rigid<T> pose{};
    construction::set_rotation(pose, 0.8L, 0.1L, -0.5L, 0.2L);
    pose.translation = {T(1.5), T(-0.25), T(2.5)};
    return pose;
}

struct keep_some_with_hulls {
    bool operator()(std::uint64_t a, std::uint64_t b) const { return (a + 3 * b) % 5 != 0; }
};

/// The pairs of parts, against those of one machine. Returns how many they are.
template <class Local, class X, class Y, class WholeX, class WholeY>
std::size_t check_pairs_with_hulls(const distributed<Local>& on, const X& a, const Y& b, const WholeX& whole_a,
                                   const WholeY& whole_b) {
    const auto expected = in_all_parts(to_host(pairs(serial{}, whole_a, whole_b)));
    CHECK(lists_of_all(on.ranks(), to_host(pairs(on, a, b))) == expected);
    return expected.size();
}

template <class Local, class X, class Y, class WholeX, class WholeY>
void check_visits_with_hulls(const distributed<Local>& on, const X& a, const Y& b, const WholeX& whole_a,
                             const WholeY& whole_b) {
    const auto& ranks = on.ranks();
    const auto expected = in_all_parts(to_host(pairs(serial{}, whole_a, whole_b)));
    CHECK(count(on, a, b) == expected.size());
    CHECK(on_all(ranks, any(on, a, b)));
    std::vector<global_pair> visited, some;
    for_each_pair(on, a, b, [&](const global_pair& pair) { return visited.push_back(pair), visit::proceed; });
    std::sort(visited.begin(), visited.end());
    CHECK(lists_of_all(ranks, visited) == expected);
    std::copy_if(expected.begin(), expected.end(), std::back_inserter(some),
                 [](const global_pair& pair) { return keep_some_with_hulls{}(pair.a, pair.b); });
    const query_options<keep_some_with_hulls> options{.filter = {}};
    CHECK(lists_of_all(ranks, to_host(pairs(on, a, b, options))) == some);
}

template <class Local, class X, class Y, class WholeX, class WholeY>
void check_contacts_with_hulls(const distributed<Local>& on, const X& a, const Y& b, const WholeX& whole_a,
                               const WholeY& whole_b) {
    CHECK((lists_of_all(on.ranks(), to_host(contacts(on, a, b))) ==
           in_all_parts(to_host(contacts(serial{}, whole_a, whole_b)))));
}

template <class Local, class X, class Y, class WholeX, class WholeY>
void check_within_of_hulls(const distributed<Local>& on, const X& a, const Y& b, const WholeX& whole_a,
                           const WholeY& whole_b) {
    for (const double distance : {0.0, 0.1875}) {
        CAPTURE(distance);
        const auto expected = in_all_parts(to_host(within(serial{}, whole_a, whole_b, distance)));
        CHECK(expected.size() > 50);
        CHECK(lists_of_all(on.ranks(), to_host(within(on, a, b, distance))) == expected);
        CHECK(count_within(on, a, b, distance) == expected.size());
        CHECK(on_all(on.ranks(), any_within(on, a, b, distance)));
        std::vector<global_pair> visited;
        const auto visitor = [&](const global_pair& pair) { return visited.push_back(pair), visit::proceed; };
        for_each_within(on, a, b, distance, visitor);
        std::sort(visited.begin(), visited.end());
        CHECK(lists_of_all(on.ranks(), visited) == expected);
    }
}

/// Returns whether they touch.
template <class Local, class X, class Y, class WholeX, class WholeY>
bool check_distance_of_hulls(const distributed<Local>& on, const X& a, const Y& b, const WholeX& whole_a,
                             const WholeY& whole_b) {
    const auto expected = distance(serial{}, whole_a, whole_b);
    const auto found = distance(on, a, b);
    CHECK(on_all(on.ranks(), found && found->a == expected->a && found->b == expected->b &&
                                 found->point_a == expected->point_a && found->point_b == expected->point_b &&
                                 found->distance == expected->distance));
    return expected->distance == 0;
}

}  // namespace

TEST_CASE("distributed: convex hulls and a mesh whose parts lie on many ranks") {
    const distributed on(world(), serial{});
    const auto& ranks = on.ranks();
    const auto lists = hulls_on_lattice<float>(90, 101);
    const mesh_at_hulls<float> surface(300, 102);
    const rigid<float> pose = pose_at_hulls<float>();
    const auto whole_m = surface.whole();
    for (const division how : divisions) {
        const division how_m = how == division::even ? division::uneven : division::even;
        CAPTURE(static_cast<int>(how), on.size());
        const divided_hulls h(lists, how, ranks);
        const auto m = surface.part(how_m, ranks);
        const auto tree_h = make_bvh(on.local(), h.part);
        const auto tree_m = make_bvh(on.local(), m);
        CHECK(check_pairs_with_hulls(on, tree_m, h.part, whole_m, h.whole) > 300);
        CHECK(check_pairs_with_hulls(on, tree_h, m, h.whole, whole_m) > 300);
        CHECK(check_pairs_with_hulls(on, tree_m, posed(tree_h, pose), whole_m, posed(h.whole, pose)) > 100);
        CHECK(check_pairs_with_hulls(on, posed(h.part, pose), tree_m, posed(h.whole, pose), whole_m) > 100);
        check_visits_with_hulls(on, tree_m, h.part, whole_m, h.whole);
        check_contacts_with_hulls(on, tree_m, posed(tree_h, pose), whole_m, posed(h.whole, pose));
        check_within_of_hulls(on, tree_m, tree_h, whole_m, h.whole);
    }
    const divided_hulls h(hulls_on_lattice<double>(60, 103), division::uneven, ranks);
    const mesh_at_hulls<double> other(200, 104);
    const auto m = other.part(division::even, ranks);
    const rigid<double> pose_d = pose_at_hulls<double>();
    const auto tree = make_bvh(on.local(), m);
    CHECK(check_pairs_with_hulls(on, tree, posed(h.part, pose_d), other.whole(), posed(h.whole, pose_d)) > 50);
    check_contacts_with_hulls(on, tree, posed(h.part, pose_d), other.whole(), posed(h.whole, pose_d));
}

TEST_CASE("distributed: convex hulls among themselves, on threads") {
    const distributed on(world(), openmp{2});
    const auto& ranks = on.ranks();
    const auto lists = hulls_on_lattice<double>(70, 105);
    const rigid<double> pose = pose_at_hulls<double>();
    rigid<double> far = pose;
    far.translation.x = 20;
    int touching = 0, apart = 0;
    for (const division how : divisions) {
        CAPTURE(static_cast<int>(how), on.size());
        const divided_hulls a(lists, how, ranks), b(lists, division::uneven, ranks);
        const auto tree_a = make_bvh(on.local(), a.part);
        const auto tree_b = make_bvh(on.local(), b.part);
        const auto whole = make_bvh(serial{}, a.whole);
        CHECK(check_pairs_with_hulls(on, tree_a, posed(tree_b, pose), a.whole, posed(a.whole, pose)) > 100);
        check_contacts_with_hulls(on, tree_a, posed(tree_b, pose), a.whole, posed(a.whole, pose));
        const auto themselves = in_all_parts(to_host(self_pairs(serial{}, a.whole)));
        CHECK(themselves.size() > 100);
        CHECK(lists_of_all(ranks, to_host(self_pairs(on, tree_a))) == themselves);
        CHECK(count_self_pairs(on, tree_a) == themselves.size());
        const auto near = in_all_parts(to_host(self_within(serial{}, a.whole, 0.25)));
        CHECK(near.size() > themselves.size());
        CHECK(lists_of_all(ranks, to_host(self_within(on, tree_a, 0.25))) == near);
        for (const auto& where : {pose, far}) {
            const bool touch = check_distance_of_hulls(on, tree_a, posed(tree_b, where), whole, posed(whole, where));
            (touch ? touching : apart) += 1;
        }
    }
    CHECK((touching == 4 && apart == 4));
}

namespace {

/// A set of other shapes looks for hulls, and hulls for it.
template <shape S>
void check_hulls_and_others(const distributed<serial>& on, const divided_hulls<float>& h, const std::vector<S>& all) {
    const shapes<S> whole(all), part(part_of(all, division::even, on.rank(), on.size()));
    const auto tree = make_bvh(on.local(), part);
    const std::size_t found = check_pairs_with_hulls(on, tree, h.part, whole, h.whole);
    CHECK(found > 50);
    CHECK(check_pairs_with_hulls(on, h.part, tree, h.whole, whole) == found);
}

}  // namespace

TEST_CASE("distributed: convex hulls and all they touch") {
    const distributed on(world(), serial{});
    const divided_hulls h(hulls_on_lattice<float>(60, 106), division::uneven, on.ranks());
    std::vector<sphere<float>> balls;
    std::vector<aabb<float>> boxes;
    std::vector<capsule<float>> capsules;
    std::vector<segment<float>> segments;
    const auto places = places_at_hulls<float>(250, 107);
    for (const vec3<float>& p : places) {
        const vec3<float> q{p.x + 0.25f, p.y + 0.5f, p.z};
        balls.push_back({p, 0.25f});
        boxes.push_back({p, {q.x, q.y, q.z + 0.125f}});
        capsules.push_back({{p, q}, 0.125f});
        segments.push_back({p, q});
    }
    check_hulls_and_others(on, h, balls);
    check_hulls_and_others(on, h, boxes);
    check_hulls_and_others(on, h, capsules);
    check_hulls_and_others(on, h, segments);
    check_hulls_and_others(on, h, places);
    const shapes<sphere<float>> whole(balls), part(part_of(balls, division::even, on.rank(), on.size()));
    rigid<float> far = pose_at_hulls<float>();
    far.translation.y = -30;
    CHECK(!check_distance_of_hulls(on, make_bvh(on.local(), part), posed(make_bvh(on.local(), h.part), far),
                                   make_bvh(serial{}, whole), posed(make_bvh(serial{}, h.whole), far)));

    // One of each rank; and those of a plain set, each of which refers to the caller's points, and may be placed.
    const vec3<float> corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const auto ranks = static_cast<std::uint64_t>(on.size());
    CHECK(count(on, hull<float>(corners, 4), hull<float>(corners, 2)) == ranks * ranks);
    std::vector<hull<float>> placed;
    for (int k = 0; k < 30; ++k) {
        rigid<float> pose = pose_at_hulls<float>();
        pose.translation = {0.125f * static_cast<float>(k), 0.5f, 0.25f};
        placed.push_back(place(pose, hull<float>(corners, static_cast<std::size_t>(k % 4 + 1))));
    }
    const shapes<hull<float>> whole_set(placed), part_set(part_of(placed, division::even, on.rank(), on.size()));
    CHECK(check_pairs_with_hulls(on, make_bvh(on.local(), part), part_set, whole, whole_set) > 10);
    // Nothing at all.
    const hulls<float> none;
    CHECK(count(on, none, h.part) == 0);
    CHECK(count(on, h.part, none) == 0);
    CHECK(on_all(on.ranks(), to_host(pairs(on, none, none)).empty()));
}

TEST_CASE("distributed: points and rays ask for convex hulls of all parts") {
    const distributed on(world(), serial{});
    const auto& ranks = on.ranks();
    const auto lists = hulls_on_lattice<float>(80, 108);
    const auto places = places_at_hulls<float>(120, 109), to = places_at_hulls<float>(120, 110);
    std::vector<ray<float>> lines;
    for (std::size_t i = 0; i < places.size(); ++i) lines.push_back({places[i], to[i] - places[i]});
    const rays<float> all_lines(lines), my_lines(part_of(lines, division::uneven, on.rank(), on.size()));
    const auto my_places = part_of(places, division::even, on.rank(), on.size());
    const rigid<float> pose = pose_at_hulls<float>();
    for (const division how : divisions) {
        CAPTURE(static_cast<int>(how), on.size());
        const divided_hulls h(lists, how, ranks);
        const auto tree = posed(make_bvh(on.local(), h.part), pose);
        const auto whole = posed(make_bvh(serial{}, h.whole), pose);
        for (const std::size_t k : {std::size_t{1}, std::size_t{7}}) {
            CHECK((lists_of_all(ranks, to_host(nearest(on, tree, my_places, k))) ==
                   in_all_parts(to_host(nearest(serial{}, whole, places, k)))));
        }
        const auto hits = in_all_parts(to_host(raycast_all(serial{}, whole, all_lines)));
        CHECK(hits.size() > 100);
        CHECK(lists_of_all(ranks, to_host(raycast_all(on, tree, my_lines))) == hits);
        CHECK((lists_of_all(ranks, to_host(raycast(on, tree, my_lines))) ==
               in_all_parts(to_host(raycast(serial{}, whole, all_lines)))));
        CHECK((lists_of_all(ranks, to_host(raycast_any(on, tree, my_lines))) ==
               to_host(raycast_any(serial{}, whole, all_lines))));
    }
}

TEST_CASE("distributed: lists of posed pairs with convex hulls") {
    const distributed on(world(), serial{});
    const auto tree = make_bvh(serial{}, hulls<float>(hulls_on_lattice<float>(12, 111)));
    std::vector<posed_pair<std::remove_const_t<decltype(tree)>>> list;
    for (int k = 0; k < 9; ++k) {
        rigid<float> pose = pose_at_hulls<float>();
        pose.translation.x = 0.25f * static_cast<float>(k);
        list.push_back({posed(tree, rigid<float>{}), posed(tree, pose)});
    }
    const auto mine = part_of(list, division::uneven, on.rank(), on.size());
    const auto expected = in_all_parts(to_host(pairs(serial{}, list)));
    CHECK(expected.size() > 50);
    CHECK(lists_of_all(on.ranks(), to_host(pairs(on, mine))) == expected);
}

namespace {

/// Numbers of hulls and points that a part sends to another, by the packing, and by looking at each.
template <class View, scalar T>
std::pair<std::array<std::uint64_t, 2>, std::array<std::uint64_t, 2>> sent_of_hulls(const View& part,
                                                                                    const detail::part_bounds<T>& there) {
    detail::near_shapes<serial, View> near(part);
    std::array<std::uint64_t, 2> expected{};
    for (std::size_t i = 0; i < part.size(); ++i) {
        if (!there.reaches(bounds(part[i]))) continue;
        expected[0] += 1;
        expected[1] += part[i].count;
    }
    return {detail::packed_shapes<serial, hull<T>>::measure(serial{}, near, there), expected};
}

/// Too many points for a set, of few hulls.
struct hulls_of_many_points {
    std::uint64_t points;
    [[nodiscard]] std::uint64_t count(const serial&, const detail::part_bounds<float>&) const { return 3; }
    [[nodiscard]] std::uint64_t count_points(const serial&, const detail::part_bounds<float>&) const { return points; }
};

}  // namespace

TEST_CASE("distributed: no hulls are sent but those that another part may need") {
    const hulls<float> part(hulls_on_lattice<float>(200, 112));
    std::vector<sphere<float>> balls;
    for (const vec3<float>& p : places_at_hulls<float>(60, 113)) {
        if (p.x < 2) balls.push_back({p, 0.25f});
    }
    const auto there = detail::bounds_of_part(serial{}, spheres<float>(balls).view());
    const auto [sent, expected] = sent_of_hulls(part.view(), there);
    CHECK((expected[0] > 50 && expected[0] < 350 && expected[1] > 500));
    CHECK(sent == expected);
    const auto [sent_posed, expected_posed] =
        sent_of_hulls(posed_view<hulls<float>::view_type>{part.view(), pose_at_hulls<float>()}, there);
    CHECK(sent_posed == expected_posed);
    CHECK(sent_posed != sent);

    using packed = detail::packed_shapes<serial, hull<float>>;
    hulls_of_many_points many{(std::uint64_t{1} << 31) - 1};
    CHECK(packed::measure(serial{}, many, there)[1] == many.points);
    many.points += 1;
    CHECK_THROWS_AS((void)packed::measure(serial{}, many, there), capacity_error);
}

TEST_CASE("distributed: convex hulls divided anew") {
    const distributed on(world(), serial{});
    const auto& ranks = on.ranks();
    const auto lists = hulls_on_lattice<double>(101, 114);
    const auto points_of = [](const hulls<double>& set, std::size_t i) {
        const auto h = set.view()[i];
        std::vector<vec3<double>> points;
        for (std::size_t k = 0; k < h.count; ++k) points.push_back(h[k]);
        return points;
    };
    aabb<double> around = empty_box<double>();
    for (const auto& points : lists) around = merge(around, bounds(hull<double>(points.data(), points.size())));
    for (const division how : divisions) {
        CAPTURE(static_cast<int>(how), on.size());
        const divided_hulls h(lists, how, ranks);
        const auto part = redistribute(on, h.part);
        const auto ids = part.ids.to_host();
        std::vector<std::size_t> size(static_cast<std::size_t>(on.size()));
        detail::gather(ranks, part.set.size(), size);
        CHECK(*std::max_element(size.begin(), size.end()) - *std::min_element(size.begin(), size.end()) <= 1);
        bool same = ids.size() == part.set.size();
        for (std::size_t i = 0; same && i < ids.size(); ++i) {
            same = ids[i] < lists.size() && points_of(part.set, i) == lists[ids[i]];
        }
        CHECK(on_all(ranks, same));
        const auto all_ids = lists_of_all(ranks, ids);
        std::vector<std::pair<std::uint64_t, std::uint64_t>> codes;
        for (std::size_t i = 0; i < lists.size(); ++i) {
            codes.emplace_back(detail::morton_code<std::uint64_t>(bounds(h.whole.view()[i]), around), i);
        }
        std::sort(codes.begin(), codes.end());
        CHECK(std::equal(all_ids.begin(), all_ids.end(), codes.begin(), codes.end(),
                         [](std::uint64_t id, const auto& code) { return id == code.second; }));
        CHECK(count(on, part.set, part.set) == count(serial{}, h.whole, h.whole));
    }
    CHECK(redistribute(on, hulls<double>()).set.size() == 0);
}

TEST_CASE("distributed: bad hulls of one rank, and a filter that throws there") {
    const distributed on(world(), serial{});
    const auto lists = hulls_on_lattice<float>(60, 115);
    const divided_hulls h(lists, division::even, on.ranks());
    const mesh_at_hulls<float> surface(150, 116);
    const auto m = surface.part(division::even, on.ranks());
    const auto outcome_of = [&](const auto& call, int bad) {
        try {
            call();
        } catch (const distributed_error& e) {
            return e.rank() == bad ? 2 : 3;
        } catch (const std::exception&) {
            return 1;
        }
        return 0;
    };
    for (int bad = 0; bad < on.size(); ++bad) {
        const bool mine = on.rank() == bad;
        const int expected = mine ? 1 : 2;
        std::vector<vec3<float>> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        std::vector<std::uint32_t> offsets{0, 1, 4};
        const auto ask = [&] {
            const hulls_view<float> view(points.data(), points.size(), offsets.data(), offsets.size() - 1);
            return outcome_of([&] { (void)pairs(on, m, view); }, bad);
        };
        CHECK(on_all(on.ranks(), ask() == 0));
        if (mine) points[2].y = std::numeric_limits<float>::quiet_NaN();
        CHECK(on_all(on.ranks(), ask() == expected));
        points[2].y = 1;
        if (mine) offsets[1] = 0;  // the first hull has no point
        CHECK(on_all(on.ranks(), ask() == expected));
        offsets[1] = 5;  // and here all ranks have one that ends beyond the points
        CHECK(on_all(on.ranks(), ask() != 0));

        // At a pair with a hull from elsewhere, so after messages have begun.
        const std::uint64_t first = cut(division::even, lists.size(), on.rank(), on.size());
        const std::uint64_t last = cut(division::even, lists.size(), on.rank() + 1, on.size());
        const auto fails = [&](std::uint64_t, std::uint64_t id) -> bool {
            if (mine && (on.size() == 1 || id < first || id >= last)) throw std::range_error("a pair too many");
            return true;
        };
        const query_options<decltype(fails)> options{.filter = fails};
        CHECK(on_all(on.ranks(), outcome_of([&] { (void)pairs(on, m, h.part, options); }, bad) == expected));
        CHECK(check_pairs_with_hulls(on, m, h.part, surface.whole(), h.whole) > 100);  // the next call works
    }
}

}  // namespace abut::test
