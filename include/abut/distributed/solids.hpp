// SPDX-License-Identifier: MIT
#pragma once

// Ranks as those who are asked about solids (collide/solid_regions.hpp): relation, overlaps and contact_patches of two whose
// parts lie on many ranks, and of lists. Ranks look for faces that pass through each other, and for those that touch, as for any
// pairs. If none pass, triangles and pairs come to the first rank, which decides.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/collide/contact_patches.hpp>
#include <abut/collide/relation.hpp>
#include <abut/distributed/communicator.hpp>
#include <abut/distributed/query.hpp>

#include <mpi.h>

namespace abut::detail {

/// What all ranks have, one after another, on the first of them; on the others none. All ranks call it, each with what
/// make() makes; it throws on all of them or on none.
template <class Value, class Make>
std::vector<Value> brought_to_first_rank(const own_communicator& ranks, const char* function, const Make& make) {
    attempts attempt;
    std::vector<Value> mine, all;
    std::vector<std::uint64_t> sizes;
    std::vector<int> counts, begins;
    attempt([&] {
        sizes.resize(static_cast<std::size_t>(ranks.size()));
        counts.resize(sizes.size());
        begins.resize(sizes.size());
        mine = make();
    });
    attempt.settle(ranks);
    gather(ranks, std::uint64_t{mine.size()}, sizes);
    attempt([&] {
        std::uint64_t total = 0;
        for (const std::uint64_t n : sizes) total += n;
        if (total > static_cast<std::uint64_t>(std::numeric_limits<int>::max()) / 3) {
            throw capacity_error(std::string(function) + ": " + std::to_string(total) +
                                 " faces or pairs come to the first rank; expected no more than 715,827,882");
        }
        for (std::size_t k = 0, first = 0; k < sizes.size(); first += static_cast<std::size_t>(counts[k++])) {
            counts[k] = static_cast<int>(sizes[k]);
            begins[k] = static_cast<int>(first);
        }
        if (ranks.rank() == 0) all.resize(static_cast<std::size_t>(total));
    });
    attempt.settle(ranks);
    const message_type<Value> type;
    check_mpi(MPI_Gatherv(mine.data(), static_cast<int>(mine.size()), type.get(), all.data(), counts.data(), begins.data(),
                          type.get(), 0, ranks.get()),
              "MPI_Gatherv");
    return all;
}

/// Two solids whose parts lie on many ranks. All ranks make each call.
template <class Local, class X, class Y>
class solids_by_ranks {
public:
    using T = scalar_of_argument<X>;
    solids_by_ranks(const distributed<Local>& on, const X& x, const Y& y, const char* function)
        : on_(on), x_(x), y_(y), function_(function) {
        attempts attempt;
        std::uint64_t mine[2] = {}, sum[2] = {};
        attempt([&] {
            mine[0] = make_operand(on.local(), x, function).shapes().size();
            mine[1] = make_operand(on.local(), y, function).shapes().size();
        });
        attempt.settle(on.ranks());
        check_mpi(MPI_Allreduce(mine, sum, 2, MPI_UINT64_T, MPI_SUM, on.ranks().get()), "MPI_Allreduce");
        has_a_ = sum[0] > 0;
        has_b_ = sum[1] > 0;
    }

    void require_simple() const {
        require_simple_parts(x_);
        require_simple_parts(y_);
    }
    [[nodiscard]] bool has_a() const { return has_a_; }
    [[nodiscard]] bool has_b() const { return has_b_; }
    [[nodiscard]] static bool are_beside() { return false; }
    template <arithmetic A>
    [[nodiscard]] bool passes() const {
        return ask_pairs(on_, ask_for<A>(passing_through{}, whether{}), two{x_, y_}, query_options<>{}, function_);
    }
    template <arithmetic A>
    [[nodiscard]] bool touches() const {
        return ask_pairs(on_, ask_for<A>(touching{}, whether{}), two{x_, y_}, query_options<>{}, function_);
    }
    template <arithmetic A, class Answer, class F>
    [[nodiscard]] Answer decide(const Answer& otherwise, const F& f, bool touch = true) const {
        const own_communicator& ranks = on_.ranks();
        result<global_pair, space_of<Local>> found;
        if (touch) found = ask_pairs(on_, ask_for<A>(touching{}, all_pairs{}), two{x_, y_}, query_options<>{}, function_);
        const auto pairs = brought_to_first_rank<global_pair>(ranks, function_, [&] { return to_host(found); });
        const auto a = triangles_of(x_), b = triangles_of(y_);
        Answer answer = otherwise;
        attempts attempt;
        attempt([&] {
            if (ranks.rank() != 0) return;
            gathered_solids<A, T> all(a, b, pairs);
            answer = f(all);
        });
        attempt.settle(ranks);
        if constexpr (std::is_trivially_copyable_v<Answer>) {
            check_mpi(MPI_Bcast(&answer, int{sizeof answer}, MPI_BYTE, 0, ranks.get()), "MPI_Bcast");
        }
        return answer;
    }

private:
    template <class Z>
    void require_simple_parts(const Z& z) const {
        const auto pairs = self_pairs(on_, z, {.coincident = coincident_vertices::merged});
        attempts attempt;
        attempt([&] {
            if (pairs.empty()) return;
            const global_pair first = to_host(pairs).front();
            throw invalid_geometry(function_, "face", static_cast<std::size_t>(first.a),
                                   "the surface passes through itself or touches itself at this face; the other face is",
                                   static_cast<double>(first.b));
        });
        attempt.settle(on_.ranks());
    }
    template <class Z>
    [[nodiscard]] std::vector<triangle<T>> triangles_of(const Z& z) const {
        return brought_to_first_rank<triangle<T>>(on_.ranks(), function_, [&] {
            std::vector<triangle<T>> mine;
            for (const mesh_face<T>& f : faces_on_host(on_.local(), make_operand(on_.local(), z, function_))) mine.push_back(f.corners);
            return mine;
        });
    }

    const distributed<Local>& on_;
    const X& x_;
    const Y& y_;
    const char* function_;
    bool has_a_ = false, has_b_ = false;
};

template <class X>
consteval bool is_solid_of_ranks() {
    static_assert(!is_polytope<X>, "abut: ranks take a box or a hull as a solid by its boundary, which one of them gives");
    return is_solid_in_parts<typename shape_of_argument<X>::type>();
}

template <class Local, class Question, class X, class Y>
auto ask_solids(const distributed<Local>& on, const Question& question, const X& x, const Y& y) {
    if constexpr (is_solid_of_ranks<X>() && is_solid_of_ranks<Y>()) {
        return question.find(solids_by_ranks<Local, X, Y>(on, x, y, question.function));
    } else {
        return question.template nothing<float>();
    }
}

/// Of this rank's own entries.
template <class Local, class Question, class IndexA, class IndexB>
auto ask_solid_list(const distributed<Local>& on, const Question& question, const std::vector<posed_pair<IndexA, IndexB>>& list) {
    std::vector<typename Question::template answer<typename IndexA::scalar_type>> found;
    ask_own_entries(on, list, [&](const entries_of_rank& position) { found = ask_solid_list(on.local(), question, list, position); });
    return found;
}
template <class Local, class Question, class... A, class... B>
auto ask_solid_list(const distributed<Local>&, const Question&, const std::vector<std::variant<posed_pair<A, B>...>>&) {
    refuse_mixed_list<Local>();
    return std::vector<typename Question::template answer<float>>();
}
template <class Local, class Question, class Scene, class Which>
auto ask_solid_scene(const distributed<Local>&, const Question&, const Scene&, const Which&) {
    refuse_bodies<(sizeof(Scene) > 0)>();
    return std::vector<typename Question::template told<float>>();
}

}  // namespace abut::detail
