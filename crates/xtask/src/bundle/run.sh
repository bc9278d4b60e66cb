#!/bin/sh
# Runs the tests of a bundle of shadowfit on a graphics adapter of this machine, without Rust:
#
#   ./run.sh [--adapter NAME] [FILTER...]
#
# NAME is `software`, `any` or a part of an adapter's name (default: $SHADOWFIT_ADAPTER, or `any`). A FILTER is a part of a
# test's path. The bundle leaves out golden pictures, which belong to one software driver, and tests of the real window,
# which need an X server. A test that needs more than the adapter has, as most do on OpenGL, is refused, which is no
# failure. The output of each program is in logs. Exit code: 0, 1 if a test fails, 2 after bad input.
set -u

here=$(cd "$(dirname "$0")" && pwd)
workspace=$here/workspace
logs=$here/logs
adapter=${SHADOWFIT_ADAPTER:-any}

case "${1:-}" in
--adapter)
    [ $# -ge 2 ] || { echo "error: --adapter needs a name" >&2; exit 2; }
    adapter=$2
    shift 2
    ;;
--help | -h)
    sed -n '2,9s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
-*)
    echo "error: unknown option $1; --help lists them" >&2
    exit 2
    ;;
esac

export SHADOWFIT_ADAPTER="$adapter"
# Unoptimised code needs larger stacks than the usual 2 MiB of a thread.
export RUST_MIN_STACK=16777216
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-${TMPDIR:-/tmp}}"
# Mesa's software driver: compile shaders quickly and keep them.
export GALLIVM_PERF="${GALLIVM_PERF:-nopt}"
export MESA_SHADER_CACHE_DIR="${MESA_SHADER_CACHE_DIR:-$here/mesa}"

label=$("$workspace/target/debug/examples/adapters" --adapter "$adapter") || exit 2
echo "adapter: $label"
threads=$(nproc 2>/dev/null || echo 2)
threads=$((threads * 2))
mkdir -p "$logs"
rm -f "$logs"/*.log
: >"$logs/table"

# Adds up a number of all `test result` lines of a log.
count() {
    sed -n "s/^test result: .* \([0-9][0-9]*\) $2.*/\1/p" "$1" | { sum=0; while read -r n; do sum=$((sum + n)); done; echo $sum; }
}

# Runs a test program in a shell of its own: run PROGRAM PACKAGE LOG [ARGUMENT...]
run() (
    program=$workspace/$1
    export CARGO_MANIFEST_DIR="$workspace/$2"
    log=$3
    shift 3
    cd "$CARGO_MANIFEST_DIR" && exec "$program" "$@" >>"$log" 2>&1 </dev/null
)

tab=$(printf '\t')
while IFS=$tab read -r program package name <&3; do
    log=$logs/$(echo "$name" | tr / -).log
    start=$(date +%s)
    run "$program" "$package" "$log" "$@" --skip golden --skip window:: --skip own_process "--test-threads=$threads"
    code=$?
    # These tests measure their process, so each has one of its own.
    alone=$(cd "$workspace/$package" && "$workspace/$program" --list --format terse "$@" 2>/dev/null |
        sed -n 's/: test$//p' | grep own_process)
    for test in $alone; do
        run "$program" "$package" "$log" --exact "$test" || code=1
    done
    passed=$(count "$log" passed)
    failed=$(count "$log" failed)
    # Tests that need more than the adapter has.
    refused=$(grep -c '^LACKING: ' "$log")
    [ "$failed" -le "$refused" ] && [ "$failed" != 0 ] && code=0
    failed=$((failed > refused ? failed - refused : 0))
    ignored=$(count "$log" ignored)
    # A program that ends without a result has crashed.
    [ "$code" = 0 ] || [ "$failed" != 0 ] || failed=1
    verdict=ok
    [ "$failed" = 0 ] || verdict=FAILED
    if [ "$((passed + failed + refused))" != 0 ]; then
        seconds=$(($(date +%s) - start))
        line=$(printf '%-7s %6d %6d %7d %7d %5ds  %s' "$verdict" "$passed" "$failed" "$refused" "$ignored" "$seconds" "$name")
        echo "$line" | tee -a "$logs/table"
    fi
    echo "$passed $failed" >>"$logs/sums.log"
done 3<"$here/tests.txt"

echo
echo "verdict passed failed refused ignored  time  program"
cat "$logs/table"
echo
skipped=$(grep -h '^SKIPPED' "$logs"/*.log | sort -u)
[ -z "$skipped" ] || printf '%s\n\n' "$skipped"
refusals=$(grep -h '^LACKING' "$logs"/*.log | sort | uniq -c)
[ -z "$refusals" ] || printf 'refused:\n%s\n\n' "$refusals"
failures=$(sed -n 's/^test \(.*\) \.\.\. FAILED$/\1/p' "$logs"/*.log | sort -u)
[ -z "$failures" ] || printf 'failed or refused:\n%s\n\n' "$failures"
total=$(awk '{ p += $1; f += $2 } END { print p + 0, f + 0 }' "$logs/sums.log")
echo "${total% *} passed, ${total#* } failed on $label. Left out: golden pictures (one software driver) and the window."
[ "${total#* }" = 0 ]
