#!/usr/bin/env bash
# compare_builds.sh PROGRAM PROGRAM [STEPS]: runs every scene twice with the first program and once with the
# second. The traces must be the same bytes and the state hashes the same.
set -euo pipefail
first=$1
second=$2
steps=${3:-240}
scenes=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scenes" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

simulate() { # NAME PROGRAM SCENE: leaves NAME.csv and NAME.hash
    "$2" run "$3" --steps "$steps" --trace "$work/$1.csv" --json >"$work/$1.json"
    grep -oE '"hash": *"[0-9a-fA-Fx]+"' "$work/$1.json" >"$work/$1.hash"
}

count=0
different=0
while IFS= read -r -d '' scene; do
    count=$((count + 1))
    simulate first "$first" "$scene"
    simulate again "$first" "$scene"
    simulate second "$second" "$scene"
    for other in again second; do
        for kind in csv hash; do
            if ! cmp "$work/first.$kind" "$work/$other.$kind"; then
                different=$((different + 1))
                echo "DIFFERENT: $scene: $kind of first and $other"
            fi
        done
    done
    echo "$(basename "$scene"): $(wc -l <"$work/first.csv") rows, $(cat "$work/first.hash")"
done < <(find "$scenes" -name '*.json' -print0 | sort -z)

if [ "$count" -eq 0 ]; then
    echo "no scenes to compare" >&2
    exit 1
fi
[ "$different" -eq 0 ]
