// SPDX-License-Identifier: MIT
//
// Prints what docs/matrix.md says of shapes: which pairs have which query. It asks the concepts that the queries themselves ask.
#include <cstdio>
#include <string>
#include <tuple>
#include <utility>

#include <abut/abut.hpp>

namespace {

using namespace abut;

template <class S>
struct kind {
    using type = S;
    const char* name;
};
using T = double;
constexpr std::tuple kinds{kind<vec3<T>>{"point"},     kind<segment<T>>{"segment"},       kind<triangle<T>>{"triangle"},
                           kind<aabb<T>>{"box"},       kind<oriented_box<T>>{"oriented box"}, kind<hull<T>>{"hull"},
                           kind<sphere<T>>{"sphere"},  kind<capsule<T>>{"capsule"},       kind<cylinder<T>>{"cylinder"},
                           kind<cone<T>>{"cone"},      kind<plane<T>>{"plane"},           kind<half_space<T>>{"half space"},
                           kind<ray<T>>{"ray"}};

template <class F>
void for_each_kind(const F& f) {
    std::apply([&](const auto&... all) { (f(all), ...); }, kinds);
}

/// Solids with curved sides that are no balls: where two of them, or one and a ray, are compared with a distance, it is certified.
template <class S>
inline constexpr bool is_of_revolution = detail::solid_of_revolution<S>;

template <class S, class U>
std::string queries_of_pair() {
    std::string letters;
    const auto add = [&](bool is, char letter) {
        if (is) letters += letter;
    };
    using namespace detail;  // as `within` has it
    constexpr bool has_ray = std::same_as<S, ray<T>> || std::same_as<U, ray<T>>;
    constexpr bool is_certified = has_ray || (is_of_revolution<S> && is_of_revolution<U>);
    add(decidable_pair<S, U> || decidable_pair<U, S>, 'T');
    add(distance_decidable<S, U>, is_certified ? 'w' : 'W');
    add(measurable<S, U>, 'D');
    add(contact_pair<S, U> || contact_pair<U, S>, 'C');
    add(sweepable_pair<S, U>, sweepable_round<S, U> ? 's' : 'S');
    return letters.empty() ? "-" : letters;
}

void print_pairs() {
    std::string head = "| |", rule = "| --- |";
    for_each_kind([&](const auto& k) { head += std::string(" ") + k.name + " |", rule += " --- |"; });
    std::printf("%s\n%s\n", head.c_str(), rule.c_str());
    for_each_kind([](const auto& row) {
        std::printf("| **%s** |", row.name);
        for_each_kind([&](const auto& column) {
            using S = typename std::remove_cvref_t<decltype(row)>::type;
            using U = typename std::remove_cvref_t<decltype(column)>::type;
            std::printf(" %s |", queries_of_pair<S, U>().c_str());
        });
        std::printf("\n");
    });
}

/// What a set of such shapes is asked.
template <class S>
void print_set(const char* name) {
    const auto mark = [](bool is) { return is ? "yes" : "-"; };
    using namespace detail;
    std::printf("| **%s** | %s | %s | %s | %s | %s |\n", name, mark(decidable_pair<S, S>), mark(has_hit_time<S, ray<T>>),
                mark(approachable<S>), mark(sweepable_pair<S, sphere<T>>), mark(placeable<S>));
}

}  // namespace

int main(int argc, char**) {
    if (argc > 1) {
        std::printf("| | `self_pairs` | `raycast` | `nearest` | `sweep` | `posed` |\n");
        std::printf("| --- | --- | --- | --- | --- | --- |\n");
        for_each_kind([](const auto& k) { print_set<typename std::remove_cvref_t<decltype(k)>::type>(k.name); });
    } else {
        print_pairs();
    }
}
