// SPDX-License-Identifier: MIT
// expect: a shape of your own needs contact_between\(s, t\) beside it
#include <abut/narrow/contact.hpp>

namespace my {
template <abut::scalar T>
struct knob {
    abut::vec3<T> at;
};
template <abut::scalar T>
ABUT_HD constexpr abut::aabb<T> bounds(const knob<T>& k) {
    return {k.at, k.at};
}
template <abut::scalar T>
ABUT_HD constexpr bool resolve(const knob<T>&, const abut::sphere<T>&) {
    return true;
}
template <abut::arithmetic A, abut::scalar T>
ABUT_HD constexpr abut::verdict decide(const knob<T>&, const abut::sphere<T>&) {
    return abut::verdict::yes;
}
}  // namespace my

int main() { return abut::contact_of(my::knob<float>{}, abut::sphere<float>{}) ? 1 : 0; }
