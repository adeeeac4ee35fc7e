#!/usr/bin/env bash
# compare_builds.sh STEPS PROGRAM PROGRAM...: runs every scene twice with the first program and once with each of
# the others. The traces must be the same bytes and the state hashes the same.
set -euo pipefail
steps=$1
shift
programs=("$1" "$@")
scenes=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../scenes" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

simulate() { # NUMBER SCENE: runs programs[NUMBER], leaves NUMBER.trace and NUMBER.hash
    "${programs[$1]}" run "$2" --steps "$steps" --trace "$work/$1.trace" --json >"$work/$1.json"
    grep -oE '"hash": *"[0-9a-fA-Fx]+"' "$work/$1.json" >"$work/$1.hash"
}

count=0
different=0
while IFS= read -r -d '' scene; do
    count=$((count + 1))
    simulate 0 "$scene"
    for number in $(seq 1 $((${#programs[@]} - 1))); do
        simulate "$number" "$scene"
        for kind in trace hash; do
            if ! cmp "$work/0.$kind" "$work/$number.$kind"; then
                different=$((different + 1))
                echo "DIFFERENT: $scene: the $kind of ${programs[0]} and ${programs[$number]}"
            fi
        done
    done
    echo "$(basename "$scene"): $(wc -l <"$work/0.trace") rows, $(cat "$work/0.hash")"
done < <(find "$scenes" -name '*.json' -print0 | sort -z)

if [ "$count" -eq 0 ]; then
    echo "no scenes to compare" >&2
    exit 1
fi
echo "$count scenes, $different differences"
[ "$different" -eq 0 ]
