// SPDX-License-Identifier: MIT
// expect: the judge is no timing_judge
// errors: 3
#include <abut/abut.hpp>

struct half_a_judge {
    template <class S, class U>
    abut::verdict decide(const S&, const U&) const {
        return abut::verdict::unknown;
    }
};
void pass(const abut::impact_index<float, abut::host_space>& index) {
    using namespace abut::detail;
    const abut::serial on;
    const feature_pairing<true, abut::impact_index<float, abut::host_space>, near_enough_to_touch, no_fronts> pairing(
        index, index, {}, {}, "pass");
    timed_queue<abut::serial> hits(on);
    search_times(on, pairing, half_a_judge{}, hits);
}
