// SPDX-License-Identifier: MIT
// expect: calling a __host__ function.*disc.*functions_of_shapes_have_to_be_marked_ABUT_HD
#include <cstdint>

#include <abut/cuda.hpp>

namespace own {

struct disc {
    using scalar_type = float;
    abut::vec3<float> center;
    float radius;
};
ABUT_HD abut::aabb<float> bounds(const disc& d) { return bounds(abut::sphere<float>{d.center, d.radius}); }
template <abut::arithmetic A>
abut::verdict decide(const disc& d, const abut::triangle<float>& t) {
    return abut::intersects<A>(abut::sphere<float>{d.center, d.radius}, t) ? abut::verdict::yes : abut::verdict::no;
}
inline bool resolve(const disc&, const abut::triangle<float>&) { return false; }

}  // namespace own

std::uint64_t pass(const abut::cuda& on, const abut::shapes<own::disc, abut::device_space>& discs,
                   const abut::mesh<float, abut::device_space>& mesh) {
    return abut::count(on, discs, mesh);
}
