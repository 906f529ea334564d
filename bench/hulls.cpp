// SPDX-License-Identifier: MIT
//
// usage: bench_hulls --benchmark_enable_random_interleaving=true --benchmark_out=hulls.json
//
// Two convex hulls at a time, in double on one core, each of 1,000 poses of the second one. Names:
//
//   intersects/HOW/BODY  HOW is an arithmetic; BODY a box, or an ellipsoid of so many points, turned at random, about half
//   of
//                        which touch; of box_touching all touch in a face, an edge or a corner and in no more, or are a step
//                        off
//   distance/abut/BODY   how far apart, and where
//
// The peer (bench/hulls/) is in the same run, where its package is there.

#include <string>

#include <benchmark/benchmark.h>

#include <abut/abut.hpp>

#include "google.hpp"
#include "hulls/peer.hpp"

namespace {

template <class A>
void add_intersects(const char* name) {
    hulls_peer::add(std::string("intersects/") + name, [](const hulls_peer::body& b) {
        return [&b](const abut::rigid<double>& pose) {
            const abut::hull<double> a(b.points.data(), b.points.size());
            return abut::intersects<A>(a, place(pose, a));
        };
    });
}

}  // namespace

int main(int argc, char** argv) {
    add_intersects<abut::fast>("fast");
    add_intersects<abut::filtered>("filtered");
    add_intersects<abut::exact>("exact");
    hulls_peer::add("distance/abut", [](const hulls_peer::body& b) {
        return [&b](const abut::rigid<double>& pose) {
            const abut::hull<double> a(b.points.data(), b.points.size());
            return abut::distance(a, place(pose, a)).distance <= 0;
        };
    });
    return bench::run_registered("bench_hulls", argc, argv);
}
