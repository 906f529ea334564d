// SPDX-License-Identifier: MIT
// expect: a shape of your own needs decide_within<A>\(s, t, distance\) and resolve_within\(s, t, distance\) beside it
#include <abut/abut.hpp>

namespace my {
template <abut::scalar T>
struct knob {
    abut::vec3<T> at;
};
template <abut::scalar T>
ABUT_HD constexpr abut::aabb<T> bounds(const knob<T>& k) {
    return {k.at, k.at};
}
}  // namespace my

int main() { return static_cast<int>(abut::within(abut::serial{}, abut::shapes<my::knob<float>>(), abut::mesh<float>(), 1).size()); }
