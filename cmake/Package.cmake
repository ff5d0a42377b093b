# SPDX-License-Identifier: MIT
# The packages that `cpack -G DEB` makes: the library for developers, the command, and the example
# programs; a shared library has one of its own.

set(CPACK_PACKAGE_NAME cellist)
set(CPACK_PACKAGE_VENDOR "the cellist authors")
set(CPACK_PACKAGE_CONTACT "the cellist authors <cellist@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

string(CONCAT about
    "cellist puts records into per-cell lists concurrently: fragments into pixels,\n"
    "triangles into grid cells, particles into bins. One insert call inside an OpenCL\n"
    "kernel, with pools that grow, and sorting after the build.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libcellist-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${about}\nThis package has the headers and the library.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "ocl-icd-opencl-dev | opencl-dev, opencl-headers, opencl-clhpp-headers")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "cmake | pkgconf")
if(TARGET cellist_mpi)
    set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS libopenmpi-dev)
endif()

if(BUILD_SHARED_LIBS)
    list(APPEND CPACK_COMPONENTS_ALL library)
    set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME "libcellist${cellist_soversion}")
    set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "${about}\nThis package has the shared library.")
    set(CPACK_DEBIAN_LIBRARY_PACKAGE_GENERATE_SHLIBS ON)
    set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS library)
    set(CPACK_COMPONENT_COMMAND_DEPENDS library)
    set(CPACK_COMPONENT_EXAMPLES_DEPENDS library)
endif()

if(CELLIST_BUILD_COMMAND)
    list(APPEND CPACK_COMPONENTS_ALL command)
    set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME cellist)
    set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION utils)
    set(CPACK_COMPONENT_COMMAND_DESCRIPTION
        "${about}\nThis package has the command, which checks and measures OpenCL devices.")
    set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
endif()

if(TARGET cellist-oit)
    list(APPEND CPACK_COMPONENTS_ALL examples)
    set(CPACK_DEBIAN_EXAMPLES_PACKAGE_NAME cellist-examples)
    set(CPACK_DEBIAN_EXAMPLES_PACKAGE_SECTION graphics)
    set(CPACK_COMPONENT_EXAMPLES_DESCRIPTION
        "${about}\nThis package has the example programs: transparency, shadows, and others.")
    set(CPACK_DEBIAN_EXAMPLES_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
endif()

include(CPack)
