#!/usr/bin/env bash
# compare_aarch64.sh [STEPS] [PROGRAM]: builds the program for 64-bit ARM, runs every scene with it in the emulator
# and compares traces and state hashes with those of PROGRAM (build/release/carom). Needs, on Debian:
#   dpkg --add-architecture arm64 && apt-get update && apt-get install g++-aarch64-linux-gnu qemu-user
# The libraries for ARM are unpacked into the build folder; nothing of the system is changed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
steps=${1:-240}
program=${2:-build/release/carom}
build=build/aarch64
libraries=$PWD/$build/libraries
packages=(libfmt-dev:arm64 libfmt9:arm64 zlib1g-dev:arm64 zlib1g:arm64)

for tool in aarch64-linux-gnu-g++ qemu-aarch64 cmake ninja; do
    if ! command -v "$tool" >/dev/null; then
        echo "compare_aarch64.sh: $tool is missing; on Debian: apt-get install g++-aarch64-linux-gnu qemu-user" >&2
        exit 2
    fi
done
if [ ! -x "$program" ]; then
    echo "compare_aarch64.sh: $program is not there; build it first" >&2
    exit 2
fi
if [ ! -e "$libraries/usr/include/zlib.h" ]; then
    mkdir -p "$libraries/packages"
    if ! (cd "$libraries/packages" && apt-get download "${packages[@]}"); then
        echo "compare_aarch64.sh: no packages for ARM; run: dpkg --add-architecture arm64 && apt-get update" >&2
        exit 2
    fi
    for package in "$libraries"/packages/*.deb; do dpkg-deb -x "$package" "$libraries"; done
fi

cmake -S . -B "$build" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/aarch64.cmake" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$libraries/usr" -DCMAKE_LIBRARY_PATH="$libraries/usr/lib/aarch64-linux-gnu" \
    -DCAROM_BUILD_TESTS=OFF -DCAROM_BUILD_BENCH=OFF -DCAROM_BUILD_REPLAY=OFF -DCAROM_WERROR=ON >/dev/null
cmake --build "$build" --target carom_cli

emulated=$build/carom-in-emulator
printf '#!/bin/sh\nexec qemu-aarch64 -L /usr/aarch64-linux-gnu "%s" "$@"\n' "$PWD/$build/carom" >"$emulated"
chmod +x "$emulated"
tests/determinism/compare_builds.sh "$steps" "$program" "$PWD/$emulated"
