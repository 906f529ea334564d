# SPDX-License-Identifier: MIT
"""A recipe for Conan 2. It exports the sources that it lies in: `conan create cmake/packaging/conan` from their root."""

import os

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeToolchain
from conan.tools.files import copy, rmdir

required_conan_version = ">=2.0"


class AbutConan(ConanFile):
    name = "abut"
    version = "0.2.0"
    description = "Collision geometry for C++20: which of these touch, where, how deep, and when"
    license = "MIT"
    topics = ("collision-detection", "computational-geometry", "header-only", "cuda", "openmp")
    package_type = "header-library"
    settings = "os", "arch", "compiler", "build_type"
    no_copy_source = True

    def export_sources(self):
        root = os.path.join(self.recipe_folder, os.pardir, os.pardir, os.pardir)
        for pattern in ("CMakeLists.txt", "LICENSE", "include/*", "cmake/*"):
            copy(self, pattern, src=root, dst=self.export_sources_folder)

    def package_id(self):
        self.info.clear()

    def validate(self):
        if self.settings.get_safe("compiler.cppstd"):
            check_min_cppstd(self, 20)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for option in ("ABUT_TESTS", "ABUT_EXAMPLES", "ABUT_BENCH", "ABUT_MPI"):
            toolchain.cache_variables[option] = "OFF"
        toolchain.cache_variables["CMAKE_INSTALL_LIBDIR"] = "lib"
        toolchain.generate()

    def build(self):
        CMake(self).configure()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", src=self.source_folder, dst=os.path.join(self.package_folder, "licenses"))
        rmdir(self, os.path.join(self.package_folder, "share", "doc"))

    def package_info(self):
        # abut brings its own config file, which finds OpenMP where it is used; CMakeDeps is not to write another.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "abut")]
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
