// SPDX-License-Identifier: MIT
#include <abut/collide/device_self_test.hpp>

#include <bit>
#include <cstdint>
#include <string>

#include <abut/narrow/time_of_impact.hpp>

#include "support/catch.hpp"

using namespace abut;

TEST_CASE("device self-test: its tables say what integers say, and each has pairs that touch and pairs that do not") {
    detail::for_each_known([]<class Question, class S, class U>(const detail::known_pairs<Question, S, U>& known) {
        CAPTURE(known.name);
        std::uint64_t touch = 0;
        int left = 0;
        for (std::size_t k = 0; k < detail::self_test_pairs; ++k) {
            detail::drawn_numbers<scalar_type_of<S>> numbers(k);
            const detail::drawn<S> s(numbers);
            const detail::drawn<U> t(numbers);
            bool right = false;
            if constexpr (std::same_as<Question, detail::meet_in_motion>) {
                right = time_of_impact<exact>(s.shape, t.shape) >= 0;
            } else if constexpr (std::same_as<Question, detail::near_in_kernels>) {
                right = within<exact>(s.shape, t.shape, Question::distance);
            } else {
                right = intersects<exact>(s.shape, t.shape);
            }
            touch |= std::uint64_t{right} << k;
            left += Question::by_query(s.shape, t.shape) == verdict::unknown;
        }
        CHECK(known.touch == touch);
        CHECK(std::popcount(touch) >= 5);
        CHECK(std::popcount(touch) <= 59);
        CHECK(left <= (std::same_as<Question, detail::meet_in_motion> ? 16 : 0));
    });
}

TEMPLATE_TEST_CASE("device self-test: hosts pass, and one wrong answer of a kind is seen", "", serial, openmp) {
    const TestType on{};
    detail::require_right_decisions(on, "test");
    execution::detail::require_right_decisions_once(on, -1);
    execution::detail::require_right_decisions_once(on, -1);
    detail::for_each_known([&](auto known) {
        CAPTURE(known.name);
        CHECK(detail::wrong_of(on, known) == 0);
        for (const int k : {0, 17, 63}) {
            auto broken = known;
            broken.touch ^= std::uint64_t{1} << k;
            const std::uint64_t wrong = detail::wrong_of(on, broken);
            CHECK((wrong == std::uint64_t{1} << k ||
                   (wrong == 0 && std::string(known.name).find("motion") != std::string::npos)));
        }
    });
}
