// SPDX-License-Identifier: MIT

#include <abut/cuda.hpp>

#include "expect.hpp"
#include "run_on_device.hpp"

namespace {

void run() {
    const abut::spheres<float> balls{{{{1, 1, 2}, 2}, {{4, 4, 3}, 3}, {{4, 4, 9}, 1}}};
    //! [policies]
    cudaStream_t stream = nullptr;
    cudaStreamCreate(&stream);
    {
        const abut::cuda on{.stream = stream};
        const auto resident = abut::copy_to(on, balls);     // in device memory from here on
        const auto found = abut::self_pairs(on, resident);  // as well
        for (const auto [a, b] : abut::to_host(found)) {    // waits for the copy
            expect(a == 0 && b == 1);
        }
        expect(abut::memory_in_use(on).used > 0);
    }  // sets and results go before their stream does
    abut::release_memory(abut::cuda{});
    cudaStreamDestroy(stream);
    //! [policies]
}

}  // namespace

int main() { return run_on_device(run); }
