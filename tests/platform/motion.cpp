// SPDX-License-Identifier: MIT

// When moving features and moving meshes meet.

#include <abut/collide/first_impact.hpp>
#include <abut/collide/impacts.hpp>
#include <abut/narrow/time_of_impact.hpp>
#include <abut/shape/motion.hpp>

#include "questions.hpp"
#include "scenes.hpp"

namespace platform {

namespace {

/// Two features, at both times.
template <class S, class U>
void ask_features(table& to, const char* kind) {
    using T = abut::scalar_type_of<S>;
    if (!to.asks(kind)) return;
    answers times = to.of(kind, name_of<T>, "time_of_impact"), exact = to.of(kind, name_of<T>, "time_of_impact_exact");
    for (std::uint64_t i = 0; i < 20'000; ++i) {
        inputs<T> in(11, i);
        const S s0 = in.template shape<S>();
        const U u0 = in.template shape<U>();
        const S s1 = in.template shape<S>();
        const U u1 = in.template shape<U>();
        const auto s = abut::moving(s0, s1);
        const auto u = abut::moving(u0, u1);
        const double t = abut::time_of_impact(s, u);
        times.next(), times.add(t >= 0), times.add(t);
        if (i / 16 % 64 != 0) continue;
        const double same = abut::time_of_impact<abut::exact>(s, u);
        exact.next(), exact.add(same >= 0), exact.add(same);
    }
}

template <abut::scalar T>
void ask(table& to) {
    ask_features<abut::vec3<T>, abut::triangle<T>>(to, "moving-vertex-face");
    ask_features<abut::segment<T>, abut::segment<T>>(to, "moving-edge-edge");
    if (!to.asks("moving-meshes")) return;
    const abut::serial on;
    const auto of = [&](const char* question) { return to.of("moving-meshes", name_of<T>, question); };
    answers all = of("impacts"), self = of("self_impacts"), first = of("first_impact");
    for (const bool on_lattice : {false, true}) {
        const auto cloth = abut::moving(sheet<T>(12, 1, 8, on_lattice), sheet<T>(12, 2, 8, on_lattice));
        const auto ground = sheet<T>(13, 3, 8, on_lattice);
        all.add_list(abut::impacts(on, cloth, ground));
        self.add_list(abut::self_impacts(on, cloth));
        const auto met = abut::first_impact(on, cloth, ground);
        first.next(), first.add(met.has_value());
        if (met) first.add_members(*met);
    }
}

}  // namespace

void ask_motion(table& to) {
    ask<float>(to);
    ask<double>(to);
}

}  // namespace platform
