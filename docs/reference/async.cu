// SPDX-License-Identifier: MIT

#include <abut/cuda.hpp>

#include "expect.hpp"
#include "run_on_device.hpp"

namespace {

void run() {
    cudaStream_t stream = nullptr;
    cudaStreamCreate(&stream);
    {
        const abut::cuda on{.stream = stream};
        const auto balls = abut::copy_to(on, abut::spheres<float>({{{1, 1, 2}, 2}, {{2, 2, 3}, 3}, {{4, 4, 9}, 1}}));
        const abut::triangle<float> floor{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
        //! [async]
        abut::async_result<abut::index_pair> hits(on, 100);  // room for 100 pairs
        abut::pairs_async(on, balls, floor, hits);           // returns at once
        // ... kernels that read hits.data() and hits.state() may follow in the stream
        const auto found = abut::wait(on, hits);  // what abut::pairs gives
        expect(found.size() == 2);

        abut::async_result<abut::index_pair> few(on, 1);
        abut::pairs_async(on, balls, floor, few);
        const abut::async_state state = abut::read_state(on, few);
        expect(state.size == 1 && state.needed == 2);  // here wait would throw capacity_error
        //! [async]
    }
    cudaStreamDestroy(stream);
}

}  // namespace

int main() { return run_on_device(run); }
