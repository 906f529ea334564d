// SPDX-License-Identifier: MIT
//
// A program whose global policy has the name that the pages give it: g++ looks at the library's constructors again where
// they are instantiated, so none of them has a parameter of that name. Compiled with -Wshadow -Werror, and not run.
#include <abut/abut.hpp>

const abut::serial on;

namespace {

template <class T>
int all() {
    const abut::mesh<T> faces(on, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    const std::vector<abut::vec3<T>> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const abut::spheres<T> balls({{{0, 0, 0}, 1}});
    const abut::equal_spheres<T> grains(corners, 1);
    const abut::hulls<T> hulls(corners, {0, 3});
    const abut::rays<T> rays({{{0, 0, 1}, {0, 0, -1}}});
    const auto tree = abut::make_bvh(on, faces);
    const auto other = abut::make_bvh(on, balls, {.builder = abut::bvh_builder::ploc});
    const auto step = abut::moving(faces, faces.with_vertices(on, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}));
    const auto touching = abut::contacts(on, tree, other);
    std::size_t sum = abut::count(on, tree, other) + abut::count(on, hulls, grains);
    sum += abut::reduce_contacts(on, touching).size() +
           abut::reduce_contacts(on, touching, {.method = abut::contact_reduction::binning}).size();
    sum += abut::raycast(on, tree, rays).size() + abut::raycast_all(on, tree, rays).size();
    sum += abut::nearest(on, tree, corners).size() + abut::nearest(on, tree, corners, 2).size();
    sum += abut::self_impacts(on, step).size() + abut::first_self_impact(on, step).has_value();
    sum += abut::distance(on, tree, other).has_value() + abut::within(on, tree, other, 1).size();
    return static_cast<int>(sum) + abut::validate(on, faces).closed();
}

}  // namespace

int main() { return all<float>() + all<double>(); }
