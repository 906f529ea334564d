// SPDX-License-Identifier: MIT
#pragma once

// abut's answers for bench_peers: shapes are placed anew for each question, as a peer's are. Of a pose a sphere takes the translation
// alone, and a box is an oriented one.

#include <stdexcept>

#include <abut/narrow/contact.hpp>
#include <abut/narrow/distance.hpp>
#include <abut/predicate/intersects.hpp>
#include <abut/shape/oriented_box.hpp>

#include "peer.hpp"

namespace peers {

/// Calls f with the shape as abut has it.
template <kind K>
auto made(const shape& s) {
    if constexpr (K == kind::sphere) {
        return abut::sphere<double>{{0, 0, 0}, s.radius};
    } else if constexpr (K == kind::capsule) {
        return abut::capsule<double>{{{0, 0, -s.half}, {0, 0, s.half}}, s.radius};
    } else if constexpr (K == kind::box) {
        return abut::aabb<double>{-1.0 * s.halves, s.halves};
    } else if constexpr (K == kind::cylinder) {
        return abut::cylinder<double>{{{0, 0, -s.half}, {0, 0, s.half}}, s.radius};
    } else if constexpr (K == kind::cone) {
        return abut::cone<double>{{0, 0, s.half}, {0, 0, -s.half}, s.radius};
    } else {
        return s.with_edges ? s.with_edges->view()[0] : abut::hull<double>(s.points.data(), s.points.size());
    }
}

template <kind K, class S>
ABUT_INLINE auto placed(const abut::rigid<double>& pose, const S& s) {
    if constexpr (K == kind::sphere) {
        return S{pose.translation, s.radius};
    } else if constexpr (K == kind::box) {
        const double* const r = pose.rotation;
        return abut::oriented_box<double>{pose.translation, s.upper, {r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]}};
    } else {
        return place(pose, s);
    }
}

template <abut::arithmetic A, kind KA, kind KB>
ask answers_of(const shape& first, const shape& second, question asked) {
    const auto loop = [&](const auto& one) -> ask {
        return [a = made<KA>(first), b = made<KB>(second), one](const std::vector<pose_pair>& poses, std::vector<answer>& out) {
            for (std::size_t i = 0; i < poses.size(); ++i) one(placed<KA>(poses[i].a, a), placed<KB>(poses[i].b, b), out[i]);
        };
    };
    if (asked == question::boolean) {
        return loop([](const auto& s, const auto& t, answer& out) { out.touch = abut::intersects<A>(s, t); });
    } else if (asked == question::distance) {
        return loop([](const auto& s, const auto& t, answer& out) {
            const auto d = abut::distance(s, t);
            out = {d.distance == 0, d.distance, d.point_a, d.point_b, {0, 0, 0}};
        });
    }
    return loop([](const auto& s, const auto& t, answer& out) {
        const auto c = abut::contact_of<A>(s, t);
        out.touch = c.has_value();
        if (c) out = {true, c->depth, c->point, c->point, -1.0 * c->normal};
    });
}

/// The pairs of kinds that are measured, the first shape first.
template <class F>
auto for_kinds(kind a, kind b, const F& f) {
    using enum kind;
    using result = decltype(f.template operator()<sphere, sphere>());
    result out{};
    const auto one = [&]<kind KA, kind KB>() {
        if (a == KA && b == KB) out = f.template operator()<KA, KB>();
    };
    const auto first = [&]<kind KA, kind... KB>() { (one.template operator()<KA, KB>(), ...); };
    first.template operator()<sphere, sphere>();
    first.template operator()<capsule, sphere, capsule>();
    first.template operator()<box, sphere, capsule, box, cylinder, cone>();
    first.template operator()<cylinder, sphere, capsule, cylinder>();
    first.template operator()<cone, sphere, capsule, cylinder, cone>();
    first.template operator()<hull, sphere, capsule, box, cylinder, hull>();
    if (!out) throw std::logic_error("no such pair of kinds");
    return out;
}

template <abut::arithmetic A>
ask abut_answers(const shape& a, const shape& b, question asked) {
    return for_kinds(a.of, b.of, [&]<kind KA, kind KB>() { return answers_of<A, KA, KB>(a, b, asked); });
}

}  // namespace peers
