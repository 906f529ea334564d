// SPDX-License-Identifier: MIT

#include <abut/shape/rows.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "support/catch.hpp"

#include <abut/abut.hpp>

namespace {

/// As Eigen's fixed-size vectors: not trivially copyable, elements by operator(), operator[] and a member type.
template <class T, int N>
class column {
public:
    using Scalar = T;
    column() = default;
    column(T x, T y, T z) : data_{x, y, z} {}
    column(const column& other) : data_(other.data_) {}
    column& operator=(const column& other) {
        data_ = other.data_;
        return *this;
    }
    T& operator[](std::ptrdiff_t i) { return data_[static_cast<std::size_t>(i)]; }
    const T& operator[](std::ptrdiff_t i) const { return data_[static_cast<std::size_t>(i)]; }

private:
    std::array<T, N> data_{};
};

struct xyz {
    float x, y, z;
};
struct zyx {
    float z, y, x;
};
struct padded {
    float x, y, z, unused;
};
struct xyzw {
    float x, y, z, w;
};
struct with_normal {
    std::array<float, 3> position, normal;
};
struct handle {
    float* at;
    std::uint64_t more;
    float& operator[](int i) const { return at[i]; }
};
/// Holds a pointer in as many bytes as a sphere has.
struct far_away {
    const float* at;
    std::uint64_t more;
    const float& operator[](int i) const { return at[i]; }
};

#pragma pack(push, 1)
struct packed {
    float x, y, z;
};
#pragma pack(pop)

using abut::detail::index_row;
using abut::detail::readable_as;

static_assert(readable_as<column<float, 3>, abut::vec3<float>> && readable_as<std::array<float, 3>, abut::vec3<float>>);
static_assert(readable_as<float[3], abut::vec3<float>> && readable_as<xyz, abut::vec3<float>> &&
              readable_as<float, abut::vec3<float>>);
static_assert(!readable_as<column<double, 3>, abut::vec3<float>> && !readable_as<column<float, 2>, abut::vec3<float>>);
static_assert(!readable_as<zyx, abut::vec3<float>> && !readable_as<padded, abut::vec3<float>> &&
              !readable_as<float*, abut::vec3<double>>);
static_assert(readable_as<xyzw, abut::sphere<float>> && readable_as<std::array<column<float, 3>, 3>, abut::triangle<float>>);
static_assert(!readable_as<std::vector<float>, abut::segment<float>> && !readable_as<std::span<float>, abut::sphere<float>>);
static_assert(!readable_as<handle, abut::sphere<float>>);
static_assert(!readable_as<packed, abut::vec3<float>>);  // may lie where no float may
static_assert(index_row<column<int, 3>, 3> && index_row<std::array<unsigned, 3>, 3> && index_row<int, 3>);
static_assert(!index_row<std::array<int, 4>, 3> && !index_row<std::array<long, 3>, 3> && !index_row<xyz, 3>);

const std::vector<abut::vec3<float>> corners{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
const std::vector<abut::face> faces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
const abut::spheres<float> balls{{{{1, 1, -2}, 2}, {{9, 9, 9}, 1}, {{4, 0, 0}, 0}}};

template <class P, class V>
std::vector<P> as(const std::vector<V>& values) {
    std::vector<P> made;
    for (const auto& v : values) {
        if constexpr (requires { v.x; }) {
            made.push_back(P{v.x, v.y, v.z});
        } else {
            using number = abut::detail::number_in<P>;
            made.push_back(P{static_cast<number>(v[0]), static_cast<number>(v[1]), static_cast<number>(v[2])});
        }
    }
    return made;
}

template <class Set>
auto touching(const Set& set) {
    return abut::to_host(abut::pairs(abut::serial{}, set, balls));
}

template <class Work>
std::string error_of(const Work& work) {
    try {
        work();
    } catch (const abut::error& e) {
        return e.what();
    }
    return "no error";
}

template <class V, class F>
void check_mesh() {
    const auto expected = touching(abut::mesh<float>(corners, faces));
    REQUIRE(expected.size() == 4);
    const auto v = as<V>(corners);
    const auto f = as<F>(faces);
    const abut::mesh<float> made(v, f);
    CHECK(made.size() == 4);
    CHECK(touching(made) == expected);
    CHECK(touching(abut::mesh<float>(abut::openmp{}, v, std::span<const F>(f))) == expected);
    CHECK(touching(abut::mesh<float>(corners, faces).with_vertices(abut::serial{}, v)) == expected);
    if constexpr (index_row<F, 3>) {
        CHECK(touching(abut::mesh_view<float>(v.data(), v.size(), f.data(), f.size())) == expected);
    }
}

/// The numbers of a point that is written twice, each time read through a view that is made then. `q` is `p`, which
/// compilers are not told.
[[gnu::noinline]] std::array<float, 2> read_through_views(std::array<float, 3>* p, const std::array<float, 3>* q) {
    p[0] = {1, 1, 1};
    const float first = abut::points_view<float>(q, 1)[0].x;
    p[0] = {2, 2, 2};
    return {first, abut::points_view<float>(q, 1)[0].x};
}

}  // namespace

TEST_CASE("Meshes and views of meshes are made of other libraries' arrays") {
    check_mesh<column<float, 3>, column<int, 3>>();
    check_mesh<std::array<float, 3>, std::array<int, 3>>();
    check_mesh<xyz, std::array<std::uint32_t, 3>>();
    check_mesh<abut::vec3<float>, std::array<std::int64_t, 3>>();
    check_mesh<column<float, 3>, std::array<std::uint16_t, 3>>();
    check_mesh<std::array<float, 3>, abut::face>();
    check_mesh<std::array<float, 3>, std::array<char, 3>>();
}

TEST_CASE("Flat arrays of numbers are vertices and faces, three by three") {
    std::vector<float> v;
    for (const auto& p : corners) v.insert(v.end(), {p.x, p.y, p.z});
    std::vector<int> f;
    for (const auto& t : faces) {
        for (const auto k : t) f.push_back(static_cast<int>(k));
    }
    const auto expected = touching(abut::mesh<float>(corners, faces));
    CHECK(touching(abut::mesh<float>(v, f)) == expected);
    CHECK(touching(abut::mesh_view<float>(v.data(), v.size() / 3, f.data(), f.size() / 3)) == expected);
    v.push_back(0);
    CHECK(error_of([&] { abut::mesh<float>(v, f); }) == "abut::mesh: an array of 13 numbers; expected a multiple of 3");
}

TEST_CASE("A view takes positions out of larger elements") {
    std::vector<with_normal> v;
    for (const auto& p : corners) v.push_back({{p.x, p.y, p.z}, {0, 0, 1}});
    const auto f = as<std::array<int, 3>>(faces);
    const abut::mesh_view<float> view(&v[0].position, v.size(), f.data(), f.size(), sizeof(with_normal));
    CHECK(touching(view) == touching(abut::mesh<float>(corners, faces)));
}

TEST_CASE("What is written between two queries is seen by the second") {
    auto v = as<std::array<float, 3>>(corners);
    const auto f = as<std::array<int, 3>>(faces);
    const abut::mesh_view<float> view(v.data(), v.size(), f.data(), f.size());
    CHECK(abut::count(abut::serial{}, view, balls) == 4);
    for (auto& p : v) p = {p[0] + 100, p[1], p[2]};
    CHECK(abut::count(abut::serial{}, view, balls) == 0);
}

TEST_CASE("A view reads what was written before it was made") {
    std::vector<std::array<float, 3>> v(1);
    CHECK(read_through_views(v.data(), v.data()) == std::array<float, 2>{1, 2});
}

TEST_CASE("Other sets are made of other libraries' arrays") {
    const abut::serial on;
    const abut::mesh<float> mesh(corners, faces);
    const auto p = as<column<float, 3>>(corners);
    CHECK(abut::count(on, abut::points<float>(p), mesh) == abut::count(on, abut::points<float>(corners), mesh));
    CHECK(abut::count(on, abut::points_view<float>(p.data(), p.size()), mesh) ==
          abut::count(on, abut::points<float>(corners), mesh));
    const std::vector<xyzw> four{{1, 1, -2, 2}, {9, 9, 9, 1}, {4, 0, 0, 0}};
    CHECK(abut::count(on, mesh, abut::spheres<float>(four)) == 4);
    CHECK(abut::count(on, mesh, abut::spheres_view<float>(four.data(), four.size())) == 4);
    const abut::equal_spheres<float> equal(p, 1.0f);
    CHECK(abut::count(on, mesh, equal) == abut::count(on, mesh, abut::equal_spheres<float>(corners, 1.0f)));
    CHECK(abut::count(on, mesh, abut::equal_spheres_view<float>(p.data(), p.size(), 1.0f)) == abut::count(on, mesh, equal));
    const std::vector<std::array<column<float, 3>, 3>> soup{{p[0], p[1], p[2]}};
    CHECK(abut::count(on, abut::triangle_soup<float>(soup), balls) == 2);
    const std::vector<std::array<float, 6>> two{{-1, 1, 1, 9, 1, 1}};
    CHECK(abut::count(on, mesh, abut::segments<float>(two)) == 2);
    const std::vector<std::array<int, 2>> edges{{0, 1}, {1, 2}};
    CHECK(abut::edge_mesh<float>(p, edges).size() == 2);
    CHECK(abut::edge_mesh_view<float>(p.data(), p.size(), edges.data(), edges.size()).size() == 2);
}

TEST_CASE("Points to look from are taken from other libraries' arrays") {
    const abut::mesh<float> mesh(corners, faces);
    const std::vector<column<float, 3>> from{{-1, 1, 1}, {1, 1, -3}};
    const auto near = abut::to_host(abut::nearest(abut::serial{}, mesh, from));
    REQUIRE(near.size() == 2);
    CHECK(near[0].distance == 1);
    CHECK(near[1].distance == 3);
}

TEST_CASE("Indices that are negative or too large are refused with the number that was written") {
    const auto v = as<std::array<float, 3>>(corners);
    std::vector<std::array<int, 3>> f{{0, 1, 2}, {0, -1, 2}};
    const auto make = [&] { abut::mesh<float>(v, f); };
    const auto view = [&] { (void)touching(abut::mesh_view<float>(v.data(), v.size(), f.data(), f.size())); };
    CHECK(error_of(make) == "abut::mesh: face 1: vertex index out of range, there are 4 vertices (-1)");
    CHECK(error_of(view) ==
          "abut::pairs: face 1: vertex index out of range, there are 4 vertices; as a signed number it is -1 "
          "(4.2949673e+09)");
    f[1][1] = 4;
    CHECK(error_of(make) == "abut::mesh: face 1: vertex index out of range, there are 4 vertices (4)");
    CHECK(error_of(view) == "abut::pairs: face 1: vertex index out of range, there are 4 vertices (4)");
    const std::vector<std::array<std::int64_t, 3>> wide{{0, 1, std::int64_t{1} << 32}};
    CHECK(error_of([&] { abut::mesh<float>(v, wide); }) ==
          "abut::mesh: face 0: vertex index out of range, there are 4 vertices (4.2949673e+09)");
    try {
        f[1][1] = -7;
        make();
        FAIL("expected an error");
    } catch (const abut::invalid_geometry& e) {
        CHECK((e.function() == "abut::mesh" && e.index() == 1 && e.value() == -7));
    }
    const std::vector<column<float, 3>> bad{{0, 0, 0}, {0, std::numeric_limits<float>::infinity(), 0}};
    CHECK(error_of([&] { abut::points<float>{bad}; }) == "abut::points: point 1: y is not finite (inf)");
}

TEST_CASE("Elements that point to their numbers are refused") {
    const float numbers[4] = {0, 0, 0, 1};
    const std::vector<far_away> pointers{{numbers, 0}};
    CHECK(error_of([&] { abut::spheres<float>{pointers}; }) ==
          "abut::spheres: the elements of the array point to their numbers, and do not hold them");
}
