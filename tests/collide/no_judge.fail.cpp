// SPDX-License-Identifier: MIT
// expect: the judge is no pair_judge
// errors: 3
#include <abut/abut.hpp>

struct half_a_judge {
    template <class S, class U>
    abut::verdict decide(const S&, const U&) const {
        return abut::verdict::unknown;
    }
};
void pass(const abut::spheres<float>& balls, const abut::mesh<float>& mesh) {
    const abut::serial on;
    const auto pairing = abut::detail::pair_up(on, balls, mesh, abut::query_options<>{}, "pass");
    abut::execution::work_count<abut::host_space> hits(on);
    abut::detail::search(on, pairing, half_a_judge{}, hits);
}
