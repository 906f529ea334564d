// SPDX-License-Identifier: MIT
#include <abut/predicate/face_face.hpp>

#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/modes.hpp"
#include "support/samples.hpp"
#include "support/shared_faces.hpp"

namespace {

using namespace abut;
using test::places;

template <class T>
using face_of = detail::mesh_face<T>;

// Neighbours in a plane, folded onto each other, and on two sides of a fold.
constexpr triangle<float> corner_triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
constexpr face_of<float> first_face{corner_triangle, {0, 1, 2}};
static_assert(!intersects(first_face, face_of<float>{{{1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {1, 2, 3}}));
static_assert(intersects(first_face, face_of<float>{{{1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}, {1, 2, 3}}));
static_assert(!intersects(first_face, face_of<float>{{{1, 0, 0}, {0, 1, 0}, {0, 0, 0x1p-149f}}, {1, 2, 3}}));
// Through a shared vertex, beside it, and along a side from it.
static_assert(intersects(first_face, face_of<float>{{{0, 0, 0}, {1, 1, 1}, {1, 1, -1}}, {0, 3, 4}}));
static_assert(!intersects(first_face, face_of<float>{{{0, 0, 0}, {-1, 1, 1}, {-1, 1, -1}}, {0, 3, 4}}));
static_assert(intersects(first_face, face_of<float>{{{0, 0, 0}, {2, 0, 0}, {1, -1, 0}}, {0, 3, 4}}));
// Vertices in one place that are not one: the side is more than the vertex.
static_assert(intersects(first_face, face_of<float>{{{0, 0, 0}, {1, 0, 0}, {1, -1, 0}}, {0, 3, 4}}));
static_assert(!intersects(face_of<float>{corner_triangle, {~0u, ~0u, ~0u}},
                          face_of<float>{{{-0.0f, 0, 0}, {1, 0, 0}, {1, -1, 0}}, {~0u, ~0u, ~0u}}));
// The same three vertices, with an area and without.
static_assert(intersects(first_face, face_of<float>{{{0, 1, 0}, {1, 0, 0}, {0, 0, 0}}, {2, 1, 0}}));
static_assert(!intersects(face_of<double>{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {0, 1, 2}},
                          face_of<double>{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {0, 1, 2}}));

struct face_tally {
    std::uint64_t pairs = 0, filter = 0, late = 0, limbs = 0, any_span = 0, wrong = 0, fast_wrong = 0;
    std::array<std::uint64_t, 4> shared{}, hits{};

    face_tally& operator+=(const face_tally& o) {
        pairs += o.pairs, filter += o.filter, late += o.late, limbs += o.limbs, any_span += o.any_span, wrong += o.wrong;
        fast_wrong += o.fast_wrong;
        for (std::size_t k = 0; k < 4; ++k) shared[k] += o.shared[k], hits[k] += o.hits[k];
        return *this;
    }
};

template <class T>
void examine(const face_of<T>& f, const face_of<T>& g, face_tally& sum) {
    const bool truth = test::oracle::meet_beyond_shared(f, g);
    const verdict by_filter = decide<filtered>(f, g), late = decide_late<filtered>(f, g), by_limbs = decide<exact>(f, g);
    const auto k = static_cast<std::size_t>(detail::faces_in_order<T>(f, g).shared);
    ++sum.pairs;
    ++sum.shared[k];
    sum.hits[k] += truth;
    (by_filter != verdict::unknown  ? sum.filter
     : late != verdict::unknown     ? sum.late
     : by_limbs != verdict::unknown ? sum.limbs
                                    : sum.any_span) += 1;
    const auto contradicts = [truth](verdict v) { return v == to_verdict(!truth); };
    bool wrong = contradicts(by_filter) || contradicts(late) || contradicts(by_limbs);
    wrong = wrong || intersects(f, g) != truth || intersects(g, f) != truth || intersects<exact>(g, f) != truth;
    if (by_limbs == verdict::unknown || sum.pairs % 16 == 0) wrong = wrong || resolve(f, g) != truth;
    sum.wrong += wrong;
    sum.fast_wrong += intersects<fast>(f, g) != truth;
}

template <class T>
face_tally examine_family(places kind, std::uint64_t count) {
    return test::in_threads<face_tally>(count, [kind](std::uint64_t begin, std::uint64_t end, face_tally& sum) {
        for (std::uint64_t i = begin; i < end; ++i) {
            const auto [f, g] = test::make_face_pair<T>(kind, i);
            examine(f, g, sum);
        }
    });
}

/// Every order of corners, of faces, and of numbers, of all pairs of faces over some vertices.
template <class T>
face_tally examine_all(const std::vector<vec3<T>>& at) {
    face_tally sum;
    const auto count = static_cast<std::uint32_t>(at.size());
    const auto face_number = [&](std::uint32_t k) {
        const std::uint32_t v[3] = {k % count, k / count % count, k / count / count};
        return face_of<T>{{at[v[0]], at[v[1]], at[v[2]]}, {v[0], v[1], v[2]}};
    };
    const std::uint32_t faces = count * count * count;
    for (std::uint32_t i = 0; i < faces; ++i) {
        for (std::uint32_t j = 0; j < faces; ++j) examine(face_number(i), face_number(j), sum);
    }
    return sum;
}

void print(const char* family, const char* type, const face_tally& t) {
    const auto n = [](std::uint64_t x) { return static_cast<unsigned long long>(x); };
    std::printf("| %-15s | %-6s | %llu |", family, type, n(t.pairs));
    for (std::size_t k = 0; k < 4; ++k) std::printf(" %llu of %llu |", n(t.hits[k]), n(t.shared[k]));
    std::printf(" %llu | %llu | %llu | %llu | %llu | %llu |\n", n(t.filter), n(t.late), n(t.limbs), n(t.any_span),
                n(t.fast_wrong), n(t.wrong));
}

/// Pairs whose stages are asked in a mode of the processor, and the truth, which is found outside of it.
template <class T>
std::uint64_t wrong_in_modes(places kind) {
    std::uint64_t wrong = 0;
    const std::uint64_t count = test::sample_count() / 10;
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto [f, g] = test::make_face_pair<T>(kind, i);
        const bool truth = test::oracle::meet_beyond_shared(f, g);
        const auto contradicts = [truth](verdict v) { return v == to_verdict(!truth); };
        for (const test::floating_mode& mode : test::floating_modes()) {
            test::in_mode(mode, [&, &f = f, &g = g] {
                bool bad = contradicts(decide<filtered>(f, g)) || contradicts(decide_late<filtered>(f, g)) ||
                           contradicts(decide<exact>(f, g)) || intersects(f, g) != truth;
                if (i % 16 == 0) bad = bad || resolve(f, g) != truth;
                wrong += bad;
            });
        }
    }
    return wrong;
}

}  // namespace

TEST_CASE("faces of a mesh: in every mode of the processor") {
    for (int i = 0; i < test::places_count; ++i) {
        const auto kind = static_cast<places>(i);
        CAPTURE(name_of(kind));
        CHECK(wrong_in_modes<float>(kind) == 0);
        CHECK(wrong_in_modes<double>(kind) == 0);
    }
}

TEST_CASE("faces of a mesh: every stage against vertices of polytopes in integers") {
    std::printf(
        "| family | scalar | pairs | hits, 0 shared | 1 | 2 | 3 | filter | late | limbs | any span | fast wrong | wrong "
        "|\n");
    face_tally all;
    for (int i = 0; i < test::places_count; ++i) {
        const auto kind = static_cast<places>(i);
        for (const bool single : {true, false}) {
            const std::uint64_t count = test::sample_count() / 4;
            const face_tally t = single ? examine_family<float>(kind, count) : examine_family<double>(kind, count);
            print(name_of(kind), single ? "float" : "double", t);
            CAPTURE(name_of(kind), single);
            CHECK(t.wrong == 0);
            all += t;
        }
    }
    print("all", "both", all);
    for (std::size_t k = 0; k < 4; ++k) {
        CHECK(all.shared[k] * 20 > all.pairs);
        CHECK(all.hits[k] * 20 > all.shared[k]);
        CHECK(all.hits[k] < all.shared[k]);
    }
    for (const std::uint64_t stage : {all.filter, all.late, all.limbs, all.any_span}) CHECK(stage * 100 > all.pairs);
}

TEST_CASE("faces of a mesh: all faces over four vertices, in every order") {
    // In general position, in a plane, on a line, and with two in one place.
    const std::vector<vec3<double>> sets[] = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                              {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}},
                                              {{0, 0, 0}, {4, 1, 0}, {0, 4, 3}, {2, 2.5, 1.5}},
                                              {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {3, 6, 9}},
                                              {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -0.0, 0}}};
    for (const auto& at : sets) {
        const face_tally t = examine_all(at);
        print("four vertices", "double", t);
        CHECK(t.wrong == 0);
    }
}
