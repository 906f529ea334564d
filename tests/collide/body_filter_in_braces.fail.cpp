// SPDX-License-Identifier: MIT
// expect: abut: this option is true or false: name the one that is meant, as in abut::query_options{.filter = f}
#include <abut/abut.hpp>

int main() {
    const auto never = [](const abut::body_pair&) { return false; };
    const abut::body_options<> options{never};
    return options.sorted ? 1 : 0;
}
