#!/bin/sh
# Runs the tests of a shadowfit bundle on a graphics adapter of this machine, without Rust:
#
#   ./run.sh [--adapter NAME] [--limit SECONDS] [FILTER...]
#
# NAME is `software`, `any` or part of an adapter's name (default: $SHADOWFIT_ADAPTER, or `any`). FILTER is part of a
# test's path. A test program that exceeds the limit (default: 1200 seconds) is stopped and counts as failed, if the
# machine has the command `timeout`. The bundle omits golden pictures, which need one software driver, and tests of the
# real window, which need an X server. A test that needs a feature the adapter lacks, like most tests on OpenGL, is
# refused and not failed. Each program's output is in logs. Exit code: 0, 1 if a test fails, 2 after bad input.
set -u

refuse() {
    echo "error: $1" >&2
    exit 2
}

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd) || exit 2
workspace=$here/workspace
logs=$here/logs
adapter=${SHADOWFIT_ADAPTER:-any}
limit=1200

# Removes each word from the front of the list, and appends filters to its end.
words=$#
while [ "$words" -gt 0 ]; do
    word=$1
    shift
    words=$((words - 1))
    case $word in
    --adapter | --limit)
        [ "$words" -gt 0 ] || refuse "$word needs a value"
        if [ "$word" = --adapter ]; then adapter=$1; else limit=$1; fi
        shift
        words=$((words - 1))
        ;;
    --adapter=*) adapter=${word#*=} ;;
    --limit=*) limit=${word#*=} ;;
    --help | -h)
        sed -n '2,10s/^# \{0,1\}//p' "$0"
        exit 0
        ;;
    -*) refuse "unknown option $word; --help lists them" ;;
    *) set -- "$@" "$word" ;;
    esac
done
case $limit in
'' | *[!0-9]*) refuse "--limit needs a number of seconds, not '$limit'" ;;
esac
[ -s "$here/tests.txt" ] || refuse "$here/tests.txt, the list of the test programs, is missing or empty"

export SHADOWFIT_ADAPTER="$adapter"
# Unoptimised code needs larger stacks than a thread's default of 2 MiB.
export RUST_MIN_STACK=16777216
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-${TMPDIR:-/tmp}}"
# Makes Mesa's software driver compile shaders quickly and cache them.
export GALLIVM_PERF="${GALLIVM_PERF:-nopt}"
export MESA_SHADER_CACHE_DIR="${MESA_SHADER_CACHE_DIR:-$here/mesa}"

label=$("$workspace/target/debug/examples/adapters" --adapter "$adapter") || exit 2
echo "adapter: $label"
threads=$(nproc 2>/dev/null || echo 2)
threads=$((threads * 2))
# Other systems than Linux may lack the command or its option -k.
limited=
if timeout -k 1 1 true 2>/dev/null; then
    limited="timeout -k 10 $limit"
fi
mkdir -p "$logs" || exit 2
rm -f "$logs"/*.log "$logs/table" "$logs/early" "$logs/failed" "$logs/run"
: >"$logs/table"

# Replaces a background shell by a test program with the time limit: become PROGRAM PACKAGE [ARGUMENT...]
become() {
    program=$workspace/$1
    export CARGO_MANIFEST_DIR="$workspace/$2"
    shift 2
    # Unquoted, because the limit is a command with arguments.
    cd "$CARGO_MANIFEST_DIR" && exec $limited "$program" "$@" >"$logs/run" 2>&1 </dev/null
}

# Prints the numbers of result lines and of passed, failed, refused and ignored tests of the last run. A failed test
# counts as refused if its section of the output has a line that begins with LACKING. Other failed tests are added to a
# list.
judge() {
    awk -v list="$logs/failed" '
        /^test result: / {
            results++
            for (i = 2; i <= NF; i++) {
                if ($i == "passed;") passed += $(i - 1)
                if ($i == "failed;") failed += $(i - 1)
                if ($i == "ignored;") ignored += $(i - 1)
            }
            test = ""
        }
        /^test .* \.\.\. FAILED$/ { names[$2] }
        /^---- .* stdout ----$/ { test = $2; names[test] }
        /^LACKING: / && test != "" && !(test in lacking) { lacking[test]; refused++ }
        END {
            for (name in names) if (!(name in lacking)) print name >>list
            print results + 0, passed + 0, failed + 0, refused + 0, ignored + 0
        }' "$logs/run"
}

# Runs a test program and adds its results to its line in the table: tally NAME PROGRAM PACKAGE LOG [ARGUMENT...]
tally() {
    name=$1
    program=$2
    package=$3
    log=$4
    shift 4
    : >"$logs/run"
    # Runs in the background, so that this shell receives an interrupt at once.
    become "$program" "$package" "$@" &
    child=$!
    wait "$child"
    code=$?
    child=
    cat "$logs/run" >>"$log"
    set -- $(judge)
    run_failed=$(($3 > $4 ? $3 - $4 : 0))
    # The expected exit code for this result. Refused tests also fail.
    explained=0
    [ "$3" = 0 ] || explained=101
    if [ "$1" = 0 ] || [ "$code" != "$explained" ]; then
        run_failed=$((run_failed + 1))
        why="exit code $code"
        [ "$code" != 124 ] || [ -z "$limited" ] || why="no end after $limit seconds"
        echo "$name: $why" >>"$logs/early"
        echo "ENDED EARLY: $name: $why" >>"$log"
    fi
    passed=$((passed + $2))
    failed=$((failed + run_failed))
    refused=$((refused + $4))
    ignored=$((ignored + $5))
}

child=
trap '[ -z "$child" ] || kill "$child"; exit 130' INT TERM HUP

all_passed=0
all_failed=0
all_refused=0
tab=$(printf '\t')
while IFS=$tab read -r file folder target <&3; do
    log=$logs/$(echo "$target" | tr / -).log
    start=$(date +%s)
    passed=0
    failed=0
    refused=0
    ignored=0
    tally "$target" "$file" "$folder" "$log" "$@" --skip golden --skip window:: --skip own_process \
        "--test-threads=$threads"
    # These tests measure their process, so each runs in a separate one.
    alone=$(cd "$workspace/$folder" &&
        "$workspace/$file" --list --format terse "$@" --skip golden --skip window:: 2>/dev/null |
        sed -n 's/: test$//p' | grep own_process)
    for test in $alone; do
        tally "$target, $test" "$file" "$folder" "$log" --exact "$test"
    done
    verdict=ok
    [ "$failed" = 0 ] || verdict=FAILED
    if [ "$((passed + failed + refused))" != 0 ]; then
        seconds=$(($(date +%s) - start))
        printf '%-7s %6d %6d %7d %7d %5ds  %s\n' "$verdict" "$passed" "$failed" "$refused" "$ignored" "$seconds" \
            "$target" | tee -a "$logs/table"
    fi
    all_passed=$((all_passed + passed))
    all_failed=$((all_failed + failed))
    all_refused=$((all_refused + refused))
done 3<"$here/tests.txt"
rm -f "$logs/run"

[ "$((all_passed + all_failed + all_refused))" != 0 ] ||
    refuse "no test was run: each test is ignored, left out, or has none of the filters in its path: $*"
echo
echo "verdict passed failed refused ignored  time  program"
cat "$logs/table"
echo
skipped=$(grep -h '^SKIPPED' "$logs"/*.log | sort -u)
[ -z "$skipped" ] || printf '%s\n\n' "$skipped"
refusals=$(grep -h '^LACKING' "$logs"/*.log | sort | uniq -c)
[ -z "$refusals" ] || printf 'refused:\n%s\n\n' "$refusals"
[ ! -s "$logs/failed" ] || printf 'failed:\n%s\n\n' "$(sort -u "$logs/failed")"
[ ! -s "$logs/early" ] || printf 'ended early:\n%s\n\n' "$(cat "$logs/early")"
echo "$all_passed passed, $all_failed failed, $all_refused refused on $label." \
    "Left out: golden pictures (one software driver) and the window."
[ "$all_failed" = 0 ]
