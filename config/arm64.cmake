# Cross build for arm64 on an amd64 Debian: cmake --preset arm64.  It needs the packages of arm64-packages.txt.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
# Debian installs the libraries of both architectures side by side.  By default pkg-config finds those of the host.
set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig)
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
# Runs the build tool manual_page and the unit and golden tests, with the installed libraries for arm64.
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static)
