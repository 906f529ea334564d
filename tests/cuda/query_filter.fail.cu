// SPDX-License-Identifier: MIT
// expect: calling a __host__ function.*less_than::operator.*functors_for_the_policy_cuda_have_to_be_marked_ABUT_HD
#include <cstdint>

#include <abut/cuda.hpp>

struct less_than {
    bool operator()(std::uint32_t a, std::uint32_t b) const { return a < b; }
};
std::uint64_t pass(const abut::cuda& on, const abut::spheres<float, abut::device_space>& balls,
                   const abut::mesh<float, abut::device_space>& mesh) {
    return abut::count(on, balls, mesh, abut::query_options<less_than>{.filter = {}});
}
