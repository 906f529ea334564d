# SPDX-License-Identifier: MIT
"""A package for Spack 1.0 or newer: `spack repo add cmake/packaging/spack/spack_repo/abut`, then `spack dev-build abut@0.2.0` in the
root of the sources. `git` has to name the repository before `spack install abut` can fetch it."""

from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Abut(CMakePackage):
    """Collision geometry for C++20: which of these touch, where, how deep, and when."""

    homepage = "https://example.org/abut"
    git = "https://example.org/abut.git"

    license("MIT")

    version("main", branch="main")
    version("0.2.0", tag="v0.2.0")

    variant("openmp", default=True, description="Link OpenMP to abut::abut")
    variant("mpi", default=False, description="Queries of sets whose parts lie on the ranks of an MPI program")
    variant("cuda", default=False, description="Bring the CUDA toolkit that .cu files are compiled with")

    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("mpi", when="+mpi")
    depends_on("cuda@13:", when="+cuda", type=("build", "link", "run"))

    conflicts("%gcc@:11", msg="abut needs C++20: g++ 12 or newer")
    conflicts("%clang@:13", msg="abut needs C++20: clang 14 or newer")

    def cmake_args(self):
        return [
            self.define("ABUT_TESTS", False),
            self.define("ABUT_EXAMPLES", False),
            self.define("ABUT_BENCH", False),
            self.define_from_variant("ABUT_OPENMP", "openmp"),
            self.define_from_variant("ABUT_MPI", "mpi"),
        ]
