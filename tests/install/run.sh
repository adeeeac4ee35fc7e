#!/usr/bin/env bash
# run.sh SOURCE BUILD COMPILER: installs a built Carom into a new prefix, then builds and runs the program of the
# README against it, once through find_package and once through pkg-config.
set -euo pipefail
source=$1
build=$2
compiler=$3
here=$source/tests/install
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/installed" >/dev/null
# A tree that has been moved must work too.
mv "$work/installed" "$work/prefix"
"$work/prefix/bin/carom" --version

mkdir "$work/user"
python3 "$source/tests/readme/extract_example.py" "$source/README.md" "$work/user/main.cpp"
cp "$here/user.cmake" "$work/user/CMakeLists.txt"

echo "find_package:"
cmake -S "$work/user" -B "$work/user/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$work/user/build" >/dev/null
"$work/user/build/user" | tee "$work/one"

echo "pkg-config:"
export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name carom.pc)")
# The flags are words to be split.
# shellcheck disable=SC2046
"$compiler" -std=c++20 "$work/user/main.cpp" -o "$work/user/other" $(pkg-config --cflags --libs carom)
"$work/user/other" | tee "$work/two"

[ -s "$work/one" ]
cmp "$work/one" "$work/two"
