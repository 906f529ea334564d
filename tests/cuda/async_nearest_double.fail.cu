// SPDX-License-Identifier: MIT
// expect: abut: this question needs the host between its kernels, in this scalar type: it is for calls that wait
// errors: 1
#include <abut/cuda.hpp>

void pass(const abut::points<double, abut::device_space>& there, abut::async_result<abut::neighbor<double>>& into) {
    const abut::cuda on;
    abut::nearest(abut::async(on, into), there, there);
}
