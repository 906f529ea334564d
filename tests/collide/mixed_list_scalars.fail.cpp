// SPDX-License-Identifier: MIT
// expect: abut: the entries of a list have one scalar type, float or double
#include <variant>

#include <abut/abut.hpp>

int main() {
    const abut::serial on;
    auto balls = abut::make_bvh(on, abut::spheres<float>());
    auto boxes = abut::make_bvh(on, abut::boxes<double>());
    const std::vector<std::variant<abut::posed_pair<decltype(balls)>, abut::posed_pair<decltype(boxes)>>> list;
    return static_cast<int>(abut::any_each(on, list).size());
}
