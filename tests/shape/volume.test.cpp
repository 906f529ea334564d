// SPDX-License-Identifier: MIT
#include <abut/shape/volume.hpp>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstdio>
#include <vector>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <boost/multiprecision/cpp_int.hpp>

#include <abut/shape/view.hpp>

#include "support/catch.hpp"
#include "support/encloses.hpp"
#include "support/poses.hpp"
#include "support/samples.hpp"
#include "support/touching.hpp"
#include "support/triangle_families.hpp"

using namespace abut;
/// Without expression templates, so that vec3's operations return it.
using eager_rational = boost::multiprecision::number<boost::multiprecision::cpp_rational_backend, boost::multiprecision::et_off>;
using test::draws;
using test::encloses;
using point = test::construction::point;

static_assert(bounding_volume<sphere<float>> && bounding_volume<sphere<double>>);
static_assert(bounding_volume<aabb<float>> && bounding_volume<aabb<double>>);
static_assert(bounding_volume<obb<float>> && bounding_volume<obb<double>>);
static_assert(bounding_volume<kdop<float, 14>> && bounding_volume<kdop<double, 18>> && bounding_volume<kdop<float, 26>>);
static_assert(!bounding_volume<vec3<float>> && !bounding_volume<triangle<float>> && !bounding_volume<capsule<double>>);
static_assert(triangle_range<std::vector<triangle<float>>, float> && triangle_range<mesh_view<double, host_space>, double>);
static_assert(!triangle_range<std::vector<triangle<float>>, double>);

namespace {

// --- in constant expressions -------------------------------------------------------------------------------------------

constexpr triangle<double> example{{0, 0, 0}, {1, 2, 3}, {-1, 0, 5}};

template <class V>
constexpr bool meets_itself_and_nothing_far() {
    const V v = around<V>(example);
    const rigid<double> here, far{{0, -1, 0, 1, 0, 0, 0, 0, 1}, {100, 2, 3}};
    return overlaps(v, v) && overlaps(v, merge(v, v)) &&
           !overlaps(v, make_relative_pose(here, bounds(v), far, bounds(v)), v);
}
static_assert(meets_itself_and_nothing_far<sphere<double>>());
static_assert(meets_itself_and_nothing_far<aabb<double>>());
static_assert(meets_itself_and_nothing_far<obb<double>>());
static_assert(meets_itself_and_nothing_far<kdop<double, 14>>());
static_assert(meets_itself_and_nothing_far<kdop<double, 18>>());
static_assert(meets_itself_and_nothing_far<kdop<double, 26>>());

template <class V>
using scalar_of = typename detail::volume_scalar<V>::type;

// --- volumes that end at a triangle ------------------------------------------------------------------------------------

// Each encloses `t`, which lies on its surface, and reaches `size` to where `away` points.

template <class T>
sphere<T> ending_at(sphere<T>*, draws& d, const triangle<T>& t, const point& away, double size) {
    const point side = test::construction::length(away) > 0 ? away : test::construction::cube(d, 1);
    sphere<T> v{test::construction::round_to<T>(test::construction::along(test::construction::widened(t.a), size, side)), 0};
    for (const vec3<T>& p : {t.a, t.b, t.c}) v.radius = std::max(v.radius, detail::distance_above(v.center, p));
    return v;
}
template <class T>
aabb<T> ending_at(aabb<T>*, draws& d, const triangle<T>& t, const point& away, double size) {
    return test::construction::extended(d, bounds(t), away, size);
}
template <class T>
obb<T> ending_at(obb<T>*, draws& d, const triangle<T>& t, const point& away, double size) {
    const rigid<T> turn = test::make_rotation<T>(d);
    obb<T> v{{}, {detail::row(turn.rotation, 0), detail::row(turn.rotation, 1), detail::row(turn.rotation, 2)}, {}};
    point center = test::construction::widened(t.a);
    const int flat = d.below(8);  // that axis has no extent but the triangle's
    for (int i = 0; i < 3; ++i) {
        const point axis = test::construction::widened(v.axes[i]);
        const double by = i == flat ? 0 : size * d.power_of_ten(-3, 0), along = test::construction::product(axis, away);
        const bool forward = std::fabs(along) < 1e-4 ? d.below(2) == 0 : along > 0;
        center = test::construction::along(center, forward ? by : -by, axis);
    }
    v.center = test::construction::round_to<T>(center);
    detail::obb_fit fit(v.center, v.axes);
    for (const vec3<T>& p : {t.a, t.b, t.c}) fit.see(detail::widened(p), {0, 0, 0});
    v.half_widths = fit.rounded_widths<T>();
    return v;
}
template <class T, int K>
kdop<T, K> ending_at(kdop<T, K>*, draws& d, const triangle<T>& t, const point& away, double size) {
    kdop<T, K> v = around<kdop<T, K>>(t);
    for (int i = 0; i < K / 2; ++i) {
        const detail::kdop_normal n = detail::normal_of<K>(i);
        const double by = size * d.power_of_ten(-3, 0), along = n.x * away.x + n.y * away.y + n.z * away.z;
        const bool neither = std::fabs(along) < 1e-4, some = neither && d.below(2) == 0;
        if (along < 0 || some) v.lower[i] = test::construction::rounded_to<T>(static_cast<double>(v.lower[i]) - by);
        if (along >= 0 && !some) v.upper[i] = test::construction::rounded_to<T>(static_cast<double>(v.upper[i]) + by);
    }
    return v;
}

// --- the properties ----------------------------------------------------------------------------------------------------

struct enclosing_tally {
    std::uint64_t corners = 0, lost = 0, lost_by_merge = 0, lost_by_bounds = 0, touching = 0, told_apart = 0, accepted = 0;
    enclosing_tally& operator+=(const enclosing_tally& o) {
        corners += o.corners, lost += o.lost, lost_by_merge += o.lost_by_merge, lost_by_bounds += o.lost_by_bounds;
        touching += o.touching, told_apart += o.told_apart, accepted += o.accepted;
        return *this;
    }
};

template <class T>
bool orthonormal(const obb<T>& v) {
    rigid<T> pose;
    for (int i = 0; i < 3; ++i) {
        pose.rotation[3 * i] = v.axes[i].x, pose.rotation[3 * i + 1] = v.axes[i].y, pose.rotation[3 * i + 2] = v.axes[i].z;
    }
    return test::is_orthonormal(pose);
}
template <class V>
bool orthonormal(const V&) {
    return true;
}

/// Sets of one to four triangles of every family: all corners are enclosed, also by the merged volume and its box; and the
/// volumes of triangles that meet overlap.
template <class V>
void check_enclosing() {
    using T = scalar_of<V>;
    const std::uint64_t n = test::sample_count() / 50 + 1;
    enclosing_tally total;
    for (int f = 0; f < test::triangle_family_count; ++f) {
        total += test::in_threads<enclosing_tally>(n, [f](std::uint64_t first, std::uint64_t last, enclosing_tally& sum) {
            for (std::uint64_t i = first; i < last; ++i) {
                std::vector<triangle<T>> a, b;
                for (std::uint64_t k = 0; k <= i % 4; ++k) {
                    const auto pair =
                        test::make_triangle_pair<T>(test::sample_seed, static_cast<test::triangle_family>(f), 4 * i + k);
                    a.push_back(pair.a);
                    b.push_back(pair.b);
                }
                const V va = around<V>(a), vb = around<V>(b), both = merge(va, vb), other = merge(vb, va);
                const aabb<T> box = bounds(va);
                sum.accepted += orthonormal(va) && orthonormal(both);
                for (const triangle<T>& t : a) {
                    sum.corners += 3;
                    sum.lost += !encloses(va, t);
                    sum.lost_by_merge += !encloses(both, t) + !encloses(other, t);
                    sum.lost_by_bounds += !encloses(box, t);
                }
                for (const triangle<T>& t : b) sum.lost_by_merge += !encloses(both, t) + !encloses(other, t);
                sum.lost_by_merge += !overlaps(both, va) + !overlaps(vb, both);
                if (i % 4 == 0 && test::oracle::intersects(a[0], b[0])) {
                    ++sum.touching;
                    const rigid<T> here;
                    const relative_pose<T> pose = make_relative_pose(here, bounds(a[0]), here, bounds(b[0]));
                    sum.told_apart += !overlaps(va, vb) + !overlaps(va, pose, vb);
                }
            }
        });
    }
    const std::uint64_t sets = n * static_cast<std::uint64_t>(test::triangle_family_count);
    CHECK(total.corners > sets);
    CHECK(total.accepted == sets);
    CHECK(total.lost == 0);
    CHECK(total.lost_by_merge == 0);
    CHECK(total.lost_by_bounds == 0);
    CHECK(total.touching > sets / 20);
    CHECK(total.told_apart == 0);
}

struct touching_tally {
    std::uint64_t touching = 0, lost = 0, lost_in_one_frame = 0, lost_in_a_mode = 0;
    touching_tally& operator+=(const touching_tally& o) {
        touching += o.touching, lost += o.lost, lost_in_one_frame += o.lost_in_one_frame, lost_in_a_mode += o.lost_in_a_mode;
        return *this;
    }
};

/// All that is asked of two volumes, in both orders. A function call, so that nothing moves out of or into the mode that is
/// set around it.
template <class V, class T>
ABUT_NOINLINE bool asked(const test::posed_contact<T>& c, const V& a, const aabb<T>& around_a, const V& b,
                         const aabb<T>& around_b) {
    return overlaps(a, make_relative_pose(c.pose_a, around_a, c.pose_b, around_b), b) &&
           overlaps(b, make_relative_pose(c.pose_b, around_b, c.pose_a, around_a), a);
}

/// What a relative pose is made for: the triangles alone, whose boxes are the smallest there can be; boxes have to be in it.
template <class V, class T>
aabb<T> extent(const V&, const triangle<T>& t) {
    return bounds(t);
}
template <class T>
aabb<T> extent(const aabb<T>& v, const triangle<T>&) {
    return v;
}

/// Volumes that end where they meet, in one frame and each in the frame of its object.
template <class V>
void check_touching(const char* name, bool extreme) {
    using T = scalar_of<V>;
    const std::uint64_t n = test::sample_count();
    const auto body = [extreme](std::uint64_t first, std::uint64_t last, touching_tally& sum) {
        for (std::uint64_t i = first; i < last; ++i) {
            draws d(test::sample_seed, extreme ? 21 : 20, i);
            const test::posed_contact<T> c = test::make_posed_contact<T>(d, extreme);
            const double from_origin = test::construction::largest_of(test::construction::widened(c.a.a));
            const double size = std::fmax(from_origin, 1e-300) * d.power_of_ten(-6, 3);
            V* const kind = nullptr;
            const V a = ending_at(kind, d, c.a, c.side_a, size), b = ending_at(kind, d, c.b, c.side_b, size);
            const point back{-c.side_a.x, -c.side_a.y, -c.side_a.z};
            const V beside = ending_at(kind, d, c.a, back, size * d.power_of_ten(-3, 3));
            sum.lost_in_one_frame += !overlaps(a, beside) + !overlaps(beside, a);
            if (!c.meet()) continue;
            ++sum.touching;
            const aabb<T> around_a = extent(a, c.a), around_b = extent(b, c.b);
            sum.lost += !asked(c, a, around_a, b, around_b);
            for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
                std::fesetround(mode);
                const bool kept = asked(c, a, around_a, b, around_b);
                std::fesetround(FE_TONEAREST);
                sum.lost_in_a_mode += !kept;
            }
#if defined(__SSE2__)
            const unsigned before = _mm_getcsr();
            _mm_setcsr(before | 0x8040);  // flush to zero, denormals are zero
            const bool kept = asked(c, a, around_a, b, around_b);
            _mm_setcsr(before);
            sum.lost_in_a_mode += !kept;
#endif
        }
    };
    const touching_tally sum = test::in_threads<touching_tally>(n, body);
    std::printf("%s, %s%s: n %llu, touching %llu, lost %llu, in one frame %llu\n", name, sizeof(T) == 4 ? "float" : "double",
                extreme ? ", extreme" : "", static_cast<unsigned long long>(n),
                static_cast<unsigned long long>(sum.touching), static_cast<unsigned long long>(sum.lost),
                static_cast<unsigned long long>(sum.lost_in_one_frame));
    CHECK(sum.touching > n / 4);
    CHECK(sum.lost == 0);
    CHECK(sum.lost_in_one_frame == 0);
    CHECK(sum.lost_in_a_mode == 0);
}

// --- that they do tell apart what is apart --------------------------------------------------------------------------------

using exact_point = vec3<eager_rational>;

template <class T>
exact_point to_exact(const vec3<T>& p) {
    return {eager_rational(p.x), eager_rational(p.y), eager_rational(p.z)};
}

/// A solid spanned by three vectors either way from its centre.
struct exact_box {
    exact_point center, edges[3];
};

/// By the separating axes of both, in rational arithmetic, as if they were `larger` times as large. No edge is 0.
bool overlap(const exact_box& a, const exact_box& b, const eager_rational& larger = 1) {
    const exact_point way = b.center - a.center;
    const auto separates = [&](const exact_point& n) {
        eager_rational reach = 0;
        for (const exact_box* const box : {&a, &b}) {
            for (const exact_point& edge : box->edges) reach += abs(dot(n, edge));
        }
        return abs(dot(n, way)) > larger * reach;
    };
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (separates(cross(a.edges[i], a.edges[j])) || separates(cross(b.edges[i], b.edges[j]))) return false;
        for (const exact_point& edge : b.edges) {
            if (separates(cross(a.edges[i], edge))) return false;
        }
    }
    return true;
}

template <class T>
exact_box in_world(const rigid<T>& pose, const obb<T>& v) {
    const exact_point rows[3] = {to_exact(detail::row(pose.rotation, 0)), to_exact(detail::row(pose.rotation, 1)),
                                 to_exact(detail::row(pose.rotation, 2))};
    const auto turned = [&rows](const exact_point& p) {
        return exact_point{dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)};
    };
    const T h[3] = {v.half_widths.x, v.half_widths.y, v.half_widths.z};
    exact_box r{turned(to_exact(v.center)) + to_exact(pose.translation), {}};
    for (int i = 0; i < 3; ++i) r.edges[i] = eager_rational(h[i]) * turned(to_exact(v.axes[i]));
    return r;
}

template <class T>
obb<T> as_obb(const aabb<T>& box) {
    return {T(0.5) * (box.lower + box.upper), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, T(0.5) * (box.upper - box.lower)};
}

struct truth_tally {
    std::uint64_t apart = 0, together = 0, lost = 0, kept[3] = {}, kept_clear = 0, clear = 0;
    truth_tally& operator+=(const truth_tally& o) {
        apart += o.apart, together += o.together, lost += o.lost, kept_clear += o.kept_clear, clear += o.clear;
        for (int i = 0; i < 3; ++i) kept[i] += o.kept[i];
        return *this;
    }
};

/// Random boxes against the truth, in the world and in one frame: what is apart by a thousandth, all axes tell apart.
template <class T>
void check_against_truth() {
    const std::uint64_t n = test::sample_count() / 10 + 1;
    const auto body = [](std::uint64_t first, std::uint64_t last, truth_tally& sum) {
        const auto see = [&sum](const exact_box& a, const exact_box& b, bool kept) {
            if (overlap(a, b)) {
                ++sum.together;
                sum.lost += !kept;
                return;
            }
            const bool is_clear = !overlap(a, b, eager_rational(1001) / 1000);
            ++sum.apart;
            sum.clear += is_clear;
            sum.kept_clear += is_clear && kept;
        };
        for (std::uint64_t i = first; i < last; ++i) {
            draws d(test::sample_seed, 30, i);
            const rigid<T> pose_a = test::make_pose<T>(d, 0.5), pose_b = test::make_pose<T>(d, 1), here;
            const auto box = [&d] {
                const point p = test::construction::cube(d, 0.3);
                const double x = d.uniform(0.01, 0.8), y = d.uniform(0.01, 0.8), z = d.uniform(0.01, 0.8);
                return aabb<T>{test::construction::round_to<T>({p.x - x, p.y - y, p.z - z}),
                               test::construction::round_to<T>({p.x + x, p.y + y, p.z + z})};
            };
            const aabb<T> a = box(), b = box();
            const relative_pose<T> pose = make_relative_pose(pose_a, a, pose_b, b);
            const bool kept[3] = {overlaps<box_axes::of_a>(a, pose, b), overlaps(a, pose, b),
                                  overlaps<box_axes::all>(a, pose, b)};
            const std::uint64_t apart = sum.apart;
            see(in_world(pose_a, as_obb(a)), in_world(pose_b, as_obb(b)), kept[2]);
            for (int k = 0; k < 3; ++k) {
                sum.kept[k] += sum.apart > apart && kept[k];
                sum.lost += sum.apart == apart && !kept[k];
            }
            obb<T> u = as_obb(a), v = as_obb(b);
            const rigid<T> turn_u = test::make_rotation<T>(d), turn_v = test::make_rotation<T>(d);
            for (int k = 0; k < 3; ++k) {
                u.axes[k] = detail::row(turn_u.rotation, k);
                v.axes[k] = detail::row(turn_v.rotation, k);
            }
            see(in_world(pose_a, u), in_world(pose_b, v), overlaps(u, pose, v));
            v.center.x += T(0.7);
            see(in_world(here, u), in_world(here, v), overlaps(u, v));
        }
    };
    const truth_tally sum = test::in_threads<truth_tally>(n, body);
    const auto permille = [&](std::uint64_t x) { return 3000.0 * static_cast<double>(x) / static_cast<double>(sum.apart); };
    std::printf("%s: %llu boxes overlap, %llu do not; of those kept, in 1000: 3 axes %.0f, 6 axes %.0f, 15 axes %.1f\n",
                sizeof(T) == 4 ? "float" : "double", static_cast<unsigned long long>(sum.together),
                static_cast<unsigned long long>(sum.apart), permille(sum.kept[0]), permille(sum.kept[1]),
                permille(sum.kept[2]));
    CHECK(sum.together > n / 2);
    CHECK(sum.clear > n / 2);
    CHECK(sum.lost == 0);
    CHECK(sum.kept_clear == 0);
    CHECK(permille(sum.kept[0]) < 250);
    CHECK(permille(sum.kept[1]) < 120);
    CHECK(permille(sum.kept[2]) < 10);
}

struct culling_tally {
    std::uint64_t apart = 0, far = 0, kept = 0, kept_far = 0, kept_in_one_frame = 0;
    culling_tally& operator+=(const culling_tally& o) {
        apart += o.apart, far += o.far, kept += o.kept, kept_far += o.kept_far, kept_in_one_frame += o.kept_in_one_frame;
        return *this;
    }
};

/// Sets of triangles in the unit ball whose hulls are apart: the share that the volumes do not tell apart, in percent. What
/// is far apart has to be, at any scale.
template <class V>
void check_culling(const char* name, double percent) {
    using T = scalar_of<V>;
    const std::uint64_t n = test::sample_count() / 5 + 1;
    const auto body = [](std::uint64_t first, std::uint64_t last, culling_tally& sum) {
        for (std::uint64_t i = first; i < last; ++i) {
            draws d(test::sample_seed, 40, i);
            const int range = sizeof(T) == 4 ? 30 : 280;
            const double scale = d.power_of_ten(-range, range);
            const auto triangles = [&] {
                std::vector<triangle<T>> r;
                const double flat = d.uniform(0, 0.55);  // coordinates to 0.55: in the unit ball
                for (int k = 0; k < 4; ++k) {
                    vec3<T> corner[3];
                    for (vec3<T>& p : corner) {
                        const point q = test::construction::cube(d, 0.55);
                        p = test::construction::round_to<T>({scale * q.x, scale * q.y, scale * q.z * flat});
                    }
                    r.push_back({corner[0], corner[1], corner[2]});
                }
                return r;
            };
            const std::vector<triangle<T>> a = triangles(), b = triangles();
            const point direction = test::construction::unit(test::construction::cube(d, 1));
            const double distance = scale * d.uniform(0.2, 6);
            rigid<T> pose_a = test::make_pose<T>(d, scale), pose_b = test::make_pose<T>(d, 0);
            pose_b.translation = test::construction::round_to<T>(
                test::construction::along(test::construction::widened(pose_a.translation), distance, direction));
            std::vector<vec3<T>> world_a, world_b;
            detail::for_each_corner<T>(a, [&](const vec3<T>& p) { world_a.push_back(place(pose_a, p)); });
            detail::for_each_corner<T>(b, [&](const vec3<T>& p) { world_b.push_back(place(pose_b, p)); });
            if (test::oracle::hulls_intersect(world_a, world_b)) continue;
            ++sum.apart;
            const V u = around<V>(a), v = around<V>(b);
            const relative_pose<T> pose = make_relative_pose(pose_a, bounds(u), pose_b, bounds(v));
            const bool kept = overlaps(u, pose, v), is_far = distance > 4.5 * scale;
            sum.kept += kept;
            sum.far += is_far;
            sum.kept_far += is_far && kept;
            std::vector<triangle<T>> moved = b;
            for (triangle<T>& t : moved) t.a.x += T(3 * scale), t.b.x += T(3 * scale), t.c.x += T(3 * scale);
            sum.kept_in_one_frame += overlaps(u, around<V>(moved));
        }
    };
    const culling_tally sum = test::in_threads<culling_tally>(n, body);
    const double kept = 100.0 * static_cast<double>(sum.kept) / static_cast<double>(sum.apart);
    std::printf("%s, %s: hulls apart %llu, kept in vain %.1f %%\n", name, sizeof(T) == 4 ? "float" : "double",
                static_cast<unsigned long long>(sum.apart), kept);
    CHECK(sum.apart > n / 2);
    CHECK(sum.far > n / 8);
    CHECK(sum.kept_far == 0);
    CHECK(sum.kept_in_one_frame == 0);
    CHECK(kept < percent);
}

}  // namespace

TEMPLATE_TEST_CASE("volume: every corner is enclosed, merged and boxed, exactly, in every family", "", sphere<float>,
                   sphere<double>, aabb<float>, aabb<double>, obb<float>, obb<double>, (kdop<float, 14>), (kdop<double, 14>),
                   (kdop<float, 18>), (kdop<double, 18>), (kdop<float, 26>), (kdop<double, 26>)) {
    check_enclosing<TestType>();
}

TEMPLATE_TEST_CASE("volume: no two volumes are told apart that hold what meets in the world", "", float, double) {
    for (const bool extreme : {false, true}) {
        check_touching<sphere<TestType>>("spheres", extreme);
        check_touching<aabb<TestType>>("boxes", extreme);
        check_touching<obb<TestType>>("oriented boxes", extreme);
        check_touching<kdop<TestType, 14>>("14-DOPs", extreme);
        check_touching<kdop<TestType, 18>>("18-DOPs", extreme);
        check_touching<kdop<TestType, 26>>("26-DOPs", extreme);
    }
}

TEMPLATE_TEST_CASE("volume: sums that overflow tell nothing apart", "", float, double) {
    using T = TestType;
    const T unit = sizeof(T) == 4 ? T(0x1p124) : T(0x1p1020);  // all sums below are exact, or overflow
    const auto check = [unit]<class V>(V*, const vec3<T>& p, const vec3<T>& q, const vec3<T>& t) {
        const vec3<T> a = unit * p, b = unit * q;
        rigid<T> pose_b;
        pose_b.translation = unit * t;
        REQUIRE(place(pose_b, b) == a);
        const V u = around<V>(triangle<T>{a, a, a}), v = around<V>(triangle<T>{b, b, b});
        const relative_pose<T> pose = make_relative_pose(rigid<T>{}, bounds(a), pose_b, bounds(b));
        const relative_pose<T> as_if_near{{pose.rotation[0], pose.rotation[1], pose.rotation[2]},
                                          {pose.magnitude[0], pose.magnitude[1], pose.magnitude[2]},
                                          pose_b.translation,
                                          pose.deviation,
                                          T(0)};
        CHECK(overlaps(u, pose, v));
        if (!std::same_as<V, aabb<T>>) CHECK(overlaps(u, as_if_near, v));  // boxes leave it to make_relative_pose
        CHECK(overlaps(v, u) == overlaps(u, v));
    };
    const auto check_all = [&](const vec3<T>& p, const vec3<T>& q, const vec3<T>& t) {
        check(static_cast<sphere<T>*>(nullptr), p, q, t);
        check(static_cast<aabb<T>*>(nullptr), p, q, t);
        check(static_cast<obb<T>*>(nullptr), p, q, t);
        check(static_cast<kdop<T, 14>*>(nullptr), p, q, t);
        check(static_cast<kdop<T, 18>*>(nullptr), p, q, t);
        check(static_cast<kdop<T, 26>*>(nullptr), p, q, t);
    };
    check_all({9, 0, 0}, {2, 0, 0}, {7, 0, 0});         // twice 9 overflows, twice 7 does not
    check_all({9, 9, -9}, {-3, -3, 3}, {12, 12, -12});  // along (1, 1, 1): 12 + 12 overflows
    check_all({15, -15, 15}, {15, -15, 15}, {0, 0, 0});
}

TEMPLATE_TEST_CASE("volume: boxes are kept in vain only within the slack", "", float, double) {
    check_against_truth<TestType>();
}

TEMPLATE_TEST_CASE("volume: what is apart is told apart", "", float, double) {
    check_culling<sphere<TestType>>("spheres", 20);
    check_culling<aabb<TestType>>("boxes", 8);
    check_culling<obb<TestType>>("oriented boxes", 8);
    check_culling<kdop<TestType, 14>>("14-DOPs", 4);
    check_culling<kdop<TestType, 18>>("18-DOPs", 4);
    check_culling<kdop<TestType, 26>>("26-DOPs", 4);
}
