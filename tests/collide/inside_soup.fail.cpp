// SPDX-License-Identifier: MIT
// expect: abut: inside looks into a closed mesh: a mesh, a mesh_view, or a tree of one
#include <abut/abut.hpp>

int main() {
    for (const auto where : abut::inside(abut::serial{}, abut::triangle_soup<float>(), abut::points<float>())) (void)where;
}
