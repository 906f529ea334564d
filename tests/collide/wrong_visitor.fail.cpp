// SPDX-License-Identifier: MIT
// expect: abut: a visitor is called as visitor.pair. const, and returns abut::visit::proceed or abut::visit::stop
#include <abut/abut.hpp>

int main() {
    const abut::mesh<float> m;
    abut::for_each_pair(abut::serial{}, m, m, [](abut::index_pair) {});
}
