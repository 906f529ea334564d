// SPDX-License-Identifier: MIT
//
// Compiled with many more warnings than our own: a program that asks all there is to ask takes templates of most headers.

#include <abut/abut.hpp>

#include <cstdio>
#include <vector>

namespace {

template <abut::scalar T, class Policy>
std::size_t ask(const Policy& on) {
    using namespace abut;
    const mesh<T> here({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
    const mesh<T> later({{0, 0, 5}, {1, 0, 5}, {0, 1, 5}, {0, 0, 6}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
    const spheres<T> balls({{{0, 0, 1}, 1}, {{5, 5, 5}, 1}});
    const auto tree = make_bvh(on, here);
    const auto other = make_bvh(on, balls);
    const rigid<T> pose;
    std::size_t n = to_host(pairs(on, tree, balls)).size() + count<exact>(on, tree, other) + count<fast>(on, here, balls);
    n += static_cast<std::size_t>(any(on, make_grid(on, balls), tree));
    n += pairs(on, posed(tree, pose), tree).size() + self_pairs(on, tree).size();
    n += contacts(on, tree, balls).size() + contacts(on, tree, posed(tree, pose)).size();
    n += within(on, tree, other, T(1)).size() + nearest(on, tree, vec3<T>{1, 2, 3}).size();
    n += raycast(on, tree, ray<T>{{0, 0, 5}, {0, 0, -1}}).size();
    n += static_cast<std::size_t>(distance(on, tree, other)->distance > T(0));
    n += impacts(on, moving(here, later), moving(later, here)).size();
    for_each_pair(on, tree, balls, [](index_pair) { return visit::stop; });
    return n;
}

}  // namespace

int main() {
    const std::size_t n = ask<float>(abut::serial{}) + ask<double>(abut::openmp{});
    std::printf("%d\n", static_cast<int>(n));
}
