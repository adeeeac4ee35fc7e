#!/usr/bin/env bash
# tools/setup.sh run|test: installs what ./run or ./test needs and this system lacks, as Debian packages.
set -euo pipefail

missing=()

package() { # NAME: wanted as a package (libraries)
    local status
    status=$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$1")
}

program() { # PROGRAM PACKAGE: wanted on the PATH, wherever it comes from
    command -v "$1" >/dev/null || missing+=("$2")
}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "setup: this is not a Debian system; see docs/building.md for what has to be there" >&2
    exit 0
fi

for_run() {
    program g++ g++
    program cmake cmake
    program ninja ninja-build
    program node nodejs
    program npm npm
    [ -e /etc/ssl/certs/ca-certificates.crt ] || missing+=(ca-certificates) # for npm
    package libhwy-dev
    package libfmt-dev
    package nlohmann-json3-dev
    package libcli11-dev
    package zlib1g-dev
}

for_test() {
    for_run
    program git git
    program python3 python3
    program pkg-config pkg-config
    program clang-format-14 clang-format-14
    program chromium chromium
    program clang++-19 clang-19
    package libclang-rt-19-dev
    package libgtest-dev
    package libbenchmark-dev
}

case "${1:-}" in
run) for_run ;;
test) for_test ;;
*)
    echo "usage: tools/setup.sh run|test" >&2
    exit 2
    ;;
esac

install_missing() {
    local install=(apt-get install --yes --no-install-recommends "${missing[@]}")
    local by_hand="apt-get update && ${install[*]}"
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null || ! { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
            echo "setup: these Debian packages are missing: ${missing[*]}" >&2
            echo "setup: without root or sudo this cannot install them. Please run, as root:" >&2
            echo "    $by_hand" >&2
            exit 1
        fi
        as_root=(sudo)
    fi
    as_root+=(env DEBIAN_FRONTEND=noninteractive)

    echo "setup: installing the Debian packages ${missing[*]}"
    if ! { "${as_root[@]}" apt-get update && "${as_root[@]}" "${install[@]}"; } >/dev/null; then
        echo "setup: the installation failed. What it tried, to be run as root:" >&2
        echo "    $by_hand" >&2
        exit 1
    fi
}

if [ ${#missing[@]} -gt 0 ]; then
    install_missing
fi

version=$(node --version)
version=${version#v}
if [ "${version%%.*}" -lt 18 ]; then
    echo "setup: node is $version, but the replay viewer needs 18 or newer" >&2
    exit 1
fi
