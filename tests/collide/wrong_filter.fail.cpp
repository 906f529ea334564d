// SPDX-License-Identifier: MIT
// expect: abut: a filter is called as filter.id in a, id in b. const
#include <abut/abut.hpp>

struct not_itself {
    bool operator()(abut::index_pair pair) const { return pair.a != pair.b; }
};
int main() {
    const abut::mesh<float> m;
    return abut::any(abut::serial{}, m, m, abut::query_options<not_itself>{.filter = {}}) ? 1 : 0;
}
