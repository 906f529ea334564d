// SPDX-License-Identifier: MIT
//
// usage: bench_validate_cuda [OUT.json]
//
// What a mesh takes to be validated on a device. Names are those of bench/validate.cpp, and:
//
//   uploaded/ORDER/cuda/N   the mesh in the host's memory, which is uploaded for the call

#include <cstdio>
#include <exception>
#include <string>

#include <abut/cuda.hpp>

#include "cuda_table.hpp"
#include "validate_meshes.hpp"

namespace {

using bench::check;
using bench::counters;
using bench::joined;
using bench::table;
using validate_meshes::order;

template <class T>
void add(const abut::cuda& on, table& out, validate_meshes::size n, order o) {
    const auto arrays = validate_meshes::make<T>(n, o);
    const abut::mesh<T> on_host(arrays.vertices, arrays.faces);
    const auto on_device = copy_to(on, on_host);
    const std::string in = validate_meshes::name_of(o), size = std::to_string(n.faces());
    const counters items{{"items", static_cast<double>(n.faces())}};
    const auto validate = [&](const auto& mesh) {
        const abut::mesh_report report = abut::validate(on, mesh);
        if (!report.closed() || report.euler_characteristic != 0) throw abut::error("this is no torus");
        return items;
    };
    // Vertices and faces are read, and 12 bytes a half-edge are written, sorted in as many passes of 8 bits as two vertices
    // take (each reads and writes them), and read.
    const int vertex_bits = abut::detail::id_bits(arrays.vertices.size());
    const double half_edges = 36.0 * static_cast<double>(n.faces()), passes = (2 * vertex_bits + 7) / 8;
    const double least = 12.0 * static_cast<double>(n.faces()) + half_edges * (2 * passes + 1);
    out.add(joined({"validate", in, sizeof(T) == 4 ? "float" : "double", "cuda", size}), least,
            [&] { return validate(on_device); });
    if constexpr (sizeof(T) == 4) {
        out.add(joined({"uploaded", in, "cuda", size}), 0, [&] { return validate(on_host); });
        out.add(joined({"half_edges", in, "cuda", size}), least, [&] {
            const abut::detail::half_edge_table<abut::cuda> sorted(on, on_device.view(), vertex_bits);
            return items;
        });
    }
}

}  // namespace

int main(int argc, char** argv) {
    return bench::run("bench_validate_cuda", argc, argv, [](const abut::cuda& on, table& out) {
        for (const auto& n : validate_meshes::sizes) {
            for (const order o : {order::of_the_torus, order::random}) {
                add<float>(on, out, n, o);
                add<double>(on, out, n, o);
            }
        }
    });
}
