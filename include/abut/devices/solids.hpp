// SPDX-License-Identifier: MIT
#pragma once

// Several devices as those who are asked about solids (collide/solid_regions.hpp): relation, overlaps and contact_patches of
// two, of lists and of bodies. All devices look for faces that pass through each other, and for those that touch. What is the
// host's is done once; faces of divided solids come together there. Of lists and bodies each device decides its share.

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <abut/collide/contact_patches.hpp>
#include <abut/collide/relation.hpp>
#include <abut/collide/self_pairs.hpp>
#include <abut/collide/solid_entries.hpp>
#include <abut/devices/bodies.hpp>
#include <abut/devices/divide.hpp>
#include <abut/devices/query.hpp>
#include <abut/execution/team.hpp>

namespace abut::detail {

struct write_part_ids {
    part_ids ids;
    std::uint32_t* out;
    ABUT_HD void operator()(std::size_t i) const { out[i] = ids(static_cast<std::uint32_t>(i)); }
};
/// A set of triangles that devices have, as one vector of the host.
template <class Team, class X>
auto triangles_of_parts(const Team& team, const X& x, const char* function) {
    using T = scalar_of_argument<type_on_device<X>>;
    std::vector<triangle<T>> all;
    for (int k = 0; k < (is_divided<X> ? team.size() : 1); ++k) {
        const auto faces = faces_on_host(team[k], make_operand(team[k], on_device(x, k), function));
        if constexpr (is_divided<X>) {
            execution::buffer_of<typename Team::local_policy, std::uint32_t> numbers(team[k], faces.size());
            for_each_index(team[k], faces.size(), write_part_ids{x.ids(k), numbers.data()});
            std::vector<std::uint32_t> here(faces.size());
            download(team[k], numbers.data(), here.size(), here.data());
            all.resize(x.size());
            for (std::size_t i = 0; i < here.size(); ++i) all[here[i]] = faces[i].corners;
        } else {
            for (const auto& f : faces) all.push_back(f.corners);
        }
    }
    return all;
}

/// Two solids: each device has all, or its part, or they lie in host memory.
template <class Team, class X, class Y>
class solids_by_team {
    static constexpr bool in_parts = is_divided<X> || is_divided<Y>;
    static constexpr coincident_vertices by = in_parts ? coincident_vertices::merged : coincident_vertices::distinct;

public:
    using T = scalar_of_argument<type_on_device<X>>;
    solids_by_team(const Team& team, const X& x, const Y& y, const char* function)
        : team_(team), x_(x), y_(y), function_(function) {
        require_as_many(team, x, function);
        require_as_many(team, y, function);
        if constexpr (is_divided<X>) {
            has_a_ = x.size() > 0;
        } else {
            first_of(x_, [&](const auto& a) { has_a_ = a.shapes().size() > 0; });
        }
        if constexpr (is_divided<Y>) {
            has_b_ = y.size() > 0;
        } else {
            first_of(y_, [&](const auto& b) { has_b_ = b.shapes().size() > 0; });
        }
    }

    void require_simple() const {
        detail::require_simple(team_, x_, function_, "face", by);
        detail::require_simple(team_, y_, function_, "face", by);
    }
    [[nodiscard]] bool has_a() const { return has_a_; }
    [[nodiscard]] bool has_b() const { return has_b_; }
    [[nodiscard]] bool are_beside() const {
        if constexpr (in_parts) return false;
        return detail::are_beside(known_box(on_device(x_, 0)), known_box(on_device(y_, 0)));
    }
    template <arithmetic A>
    [[nodiscard]] bool passes() const {
        return ask_pairs(team_, ask_for<A>(passing_through{}, whether{}), two{x_, y_}, query_options<>{}, function_);
    }
    template <arithmetic A>
    [[nodiscard]] bool touches() const {
        return ask_pairs(team_, ask_for<A>(touching{}, whether{}), two{x_, y_}, query_options<>{}, function_);
    }
    template <arithmetic A, class Answer, class F>
    [[nodiscard]] Answer decide(const Answer&, const F& f, bool touch = true) const {
        if constexpr (in_parts) {
            std::vector<index_pair> touching_faces;
            if (touch) touching_faces = to_host(ask_pairs(team_, ask_for<A>(touching{}, all_pairs{}), two{x_, y_}, query_options<>{}, function_));
            gathered_solids<A, T> all(triangles_of_parts(team_, x_, function_), triangles_of_parts(team_, y_, function_), touching_faces);
            return f(all);
        } else {
            here<A> all{*this};
            return f(all);
        }
    }

private:
    template <arithmetic A>
    struct here {
        const solids_by_team& all;
        [[nodiscard]] auto faces_a() const { return all.faces_of(all.x_); }
        [[nodiscard]] auto faces_b() const { return all.faces_of(all.y_); }
        [[nodiscard]] bool touches() const { return all.template touches<A>(); }
        [[nodiscard]] std::vector<crossing<T>> contacts() const {
            return to_host(ask_pairs(all.team_, ask_for<A>(touching{}, all_crossings{}), two{all.x_, all.y_}, query_options<>{},
                                     all.function_));
        }
    };
    /// f(operand) on the first device.
    template <class Z, class F>
    void first_of(const Z& z, const F& f) const {
        f(make_operand(team_[0], on_device(z, 0), function_));
    }
    template <class Z>
    [[nodiscard]] std::vector<mesh_face<T>> faces_of(const Z& z) const {
        std::vector<mesh_face<T>> faces;
        first_of(z, [&](const auto& there) { faces = faces_on_host(team_[0], there); });
        return faces;
    }

    const Team& team_;
    const X& x_;
    const Y& y_;
    const char* function_;
    bool has_a_ = false, has_b_ = false;
};

/// A polytope by its boundary, in host memory.
template <class X>
decltype(auto) as_solid_on_host(const X& x, const char* function) {
    if constexpr (is_polytope<X>) {
        return boundary_of(x, function);
    } else {
        return (x);
    }
}

/// Whether devices take it as a solid: of what is divided they know triangles, and no vertices.
template <class X>
consteval bool is_solid_of_devices() {
    if constexpr (is_divided<X>) {
        return is_solid_in_parts<typename X::shape_type>();
    } else {
        static_assert(!is_divided_mesh<X>, "abut: what divide_mesh made is asked about motion; as a solid, divide or replicate the mesh");
        return are_solids<type_on_device<X>, type_on_device<X>>();
    }
}

template <execution::policy_team Team, class Question, class X, class Y>
auto ask_solids(const Team& team, const Question& question, const X& x, const Y& y) {
    if constexpr (is_polytope<X> || is_polytope<Y>) {
        return ask_solids(team, question, as_solid_on_host(x, question.function), as_solid_on_host(y, question.function));
    } else if constexpr (is_solid_of_devices<X>() && is_solid_of_devices<Y>()) {
        return question.find(solids_by_team<Team, X, Y>(team, x, y, question.function));
    } else {
        return question.template nothing<float>();
    }
}

template <class Index>
inline constexpr bool has_faces<replicated<Index>> = has_faces<Index>;

/// Each device decides its entries.
template <execution::policy_team Team, class Question, class IndexA, class IndexB>
auto ask_solid_list(const Team& team, const Question& question, const std::vector<posed_pair<replicated<IndexA>, replicated<IndexB>>>& list) {
    std::vector<typename Question::template answer<typename IndexA::scalar_type>> found(list.size());
    share_entries(team, list, question.function, [&](int k, const auto& mine, const entries_of_part& position) {
        auto some = ask_solid_list(team[k], question, mine.list, position);
        for (std::size_t i = 0; i < some.size(); ++i) found[position(i)] = std::move(some[i]);
    });
    return found;
}
/// Each device has all bodies, and decides those near each other that its share of the tree over them finds.
template <class Team, class Question, class Scene, class Which, class There>
auto told_by_shares(const Team& team, const Question& question, const Scene&, const Which& which, const There& there) {
    std::vector<typename Question::template told<typename solids_in_scene<Scene>::T>> found;
    for (auto& some : each_of(team, [&](int k) { return ask_solid_scene(team[k], question, there(k), which, share_of(team, k)); })) {
        std::move(some.begin(), some.end(), std::back_inserter(found));
    }
    sort_told(found);
    return found;
}
template <execution::policy_team Team, class Question, class Index, class Which>
auto ask_solid_scene(const Team& team, const Question& question, const replicated<bodies<Index>>& all, const Which& which) {
    require_as_many(team, all, question.function);
    return told_by_shares(team, question, all, which, [&](int k) { return all[k]; });
}
template <execution::policy_team Team, class Question, class A, class B, class Which>
auto ask_solid_scene(const Team& team, const Question& question, const bodies_between<A, B>& both, const Which& which) {
    require_as_many(team, both.a, question.function);
    require_as_many(team, both.b, question.function);
    return told_by_shares(team, question, both, which, [&](int k) { return between(both.a[k], both.b[k]); });
}
template <execution::policy_team Team, class Question, class... Indices, class Which>
auto ask_solid_scene(const Team&, const Question&, const mixed_bodies<Indices...>&, const Which&) {
    refuse_mixed<Team>();
    return std::vector<typename Question::template told<typename mixed_bodies<Indices...>::scalar_type>>();
}
template <execution::policy_team Team, class Question, class... A, class... B>
auto ask_solid_list(const Team&, const Question&, const std::vector<std::variant<posed_pair<A, B>...>>&) {
    refuse_mixed_list<Team>();
    return std::vector<typename Question::template answer<float>>();
}

}  // namespace abut::detail
