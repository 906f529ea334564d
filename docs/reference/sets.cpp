// SPDX-License-Identifier: MIT

#include <abut/abut.hpp>
#include <string>
#include <vector>

#include "expect.hpp"

int main() {
    //! [sets]
    const std::vector<abut::vec3<float>> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    const std::vector<abut::face> faces{{0, 1, 2}, {1, 3, 2}};
    const abut::mesh<float> square{vertices, faces};           // copies and checks both
    const auto corners = abut::vertices(square);               // shares the mesh's storage
    const auto rim = abut::edges(abut::serial{}, square);      // five, each once
    const auto there = abut::copy_to(abut::openmp{}, square);  // in the policy's memory; here it is the same one

    // The caller's own array, without a copy: here every other of eight points.
    std::vector<abut::vec3<float>> own(8);
    const abut::points_view<float> half(own.data(), own.size() / 2, 2 * sizeof(abut::vec3<float>));

    try {
        const abut::spheres<float> bad{{{{0, 0, 0}, 1}, {{0, 0, 0}, -2}}};
    } catch (const abut::invalid_geometry& e) {
        // abut::spheres: sphere 1: radius is negative (-2)
        expect(e.index() == 1 && e.value() == -2);
    }
    //! [sets]
    expect(square.size() == 2 && corners.size() == 4 && rim.size() == 5 && half.size() == 4);
    expect(there.view().faces.data == square.view().faces.data);
    try {
        const abut::spheres<float> bad{{{{0, 0, 0}, 1}, {{0, 0, 0}, -2}}};
        expect(false);
    } catch (const abut::invalid_geometry& e) {
        expect(std::string(e.what()) == "abut::spheres: sphere 1: radius is negative (-2)");
    }
}
