# SPDX-License-Identifier: MIT
"""Conan 2 recipe. From a checkout: conan create packaging/conan --build=missing"""

from pathlib import Path

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy

CHECKOUT = Path(__file__).resolve().parents[2]
SOURCES = ("CMakeLists.txt", "LICENSE", "cmake/*", "include/*", "kernels/*", "packaging/*", "src/*")


class Cellist(ConanFile):
    name = "cellist"
    version = "0.1.0"
    license = "MIT"
    description = "Concurrent per-cell lists for OpenCL devices"
    topics = ("opencl", "gpu", "data-structures")
    package_type = "library"
    settings = "os", "compiler", "build_type", "arch"
    options = {"shared": [True, False], "fPIC": [True, False]}
    default_options = {"shared": False, "fPIC": True}
    implements = ["auto_shared_fpic"]

    def export_sources(self):
        for pattern in SOURCES:
            copy(self, pattern, CHECKOUT, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("opencl-icd-loader/2023.12.14", transitive_headers=True, transitive_libs=True)
        self.requires("opencl-clhpp-headers/2023.12.14", transitive_headers=True)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("COMMAND", "EXAMPLES", "TESTS", "BENCHMARKS"):
            toolchain.cache_variables[f"CELLIST_BUILD_{part}"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, Path(self.package_folder) / "licenses")
        CMake(self).install()

    def package_info(self):
        self.cpp_info.libs = ["cellist"]
        self.cpp_info.set_property("cmake_target_name", "cellist::cellist")
        self.cpp_info.set_property("pkg_config_name", "cellist")
        if self.options.shared:
            self.cpp_info.defines = ["CELLIST_SHARED"]
