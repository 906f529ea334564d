// SPDX-License-Identifier: MIT

#include <abut/abut.hpp>
#include <abut/io/read.hpp>
#include <abut/io/write.hpp>
#include <abut/io/write_gltf.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "expect.hpp"

int main() {
    abut::io::write_mesh("reference_part.ply", abut::mesh<float>{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}});
    abut::io::write_mesh("reference_ground.ply", abut::mesh<float>{{{0, 0, 0}, {4, 0, 0}, {0, -4, 0}}, {{0, 1, 2}}});
    //! [files]
    try {
        const auto part = abut::io::read_mesh<float>("reference_part.ply");
        const auto ground = abut::io::read_mesh<float>("reference_ground.ply");
        const auto found = abut::to_host(abut::pairs(abut::serial{}, part, ground));

        std::vector<std::uint8_t> hit(part.size());
        for (const auto& pair : found) hit[pair.a] = 1;
        abut::io::write_mesh("reference_hits.vtp", part, {.hit = hit});
        abut::io::write_pairs("reference_pairs.csv", found, {"part", "ground"});
        expect(found.size() == 1);

        abut::io::read_mesh<float>("no_such_file.ply");
        expect(false);
    } catch (const abut::io_error& e) {
        std::puts(e.what());  // no_such_file.ply: cannot be opened: No such file or directory
        expect(e.file() == "no_such_file.ply" && !e.line());
    }
    //! [files]

    const auto part = abut::io::read_mesh<float>("reference_part.ply");
    const auto ground = abut::io::read_mesh<float>("reference_ground.ply");
    //! [scene]
    abut::io::gltf_scene scene;
    const auto a = scene.add("part", part), b = scene.add("ground", ground);
    scene.add_contacts(a, b, abut::contacts(abut::serial{}, part, ground));
    abut::io::write_gltf("reference_scene.glb", scene);
    //! [scene]
    expect(abut::io::read_mesh<float>("reference_scene.glb").size() == 2);
}
