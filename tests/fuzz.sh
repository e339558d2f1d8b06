#!/usr/bin/env bash
# Fuzzes everything that smalti reads, each kind of input for as many seconds; exit code 1 with the first finding, which is
# then in target/fuzz/KIND.
#   tests/fuzz.sh [SECONDS] [KIND ...]
# Needs cargo-fuzz (cargo install cargo-fuzz); any toolchain will do, as no sanitizer is asked for.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-60}
kinds=("${@:2}")
if [ ${#kinds[@]} -eq 0 ]; then kinds=(scene built mesh image photons); fi
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$PWD/target/fuzz-build}

cargo fuzz build --fuzz-dir tests/fuzz --sanitizer none ask
for kind in "${kinds[@]}"; do
    work=target/fuzz/$kind
    mkdir -p "$work/corpus"
    # What is new goes to the first folder; the committed corpus is read. One worker thread: it is the inputs that count.
    SMALTI_FUZZ=$kind RAYON_NUM_THREADS=1 cargo fuzz run --fuzz-dir tests/fuzz --sanitizer none ask \
        "$work/corpus" "tests/corpus/$kind" -- \
        -max_total_time="$seconds" -rss_limit_mb=2048 -malloc_limit_mb=1024 -timeout=20 -max_len=20000 \
        -artifact_prefix="$work/" -print_final_stats=1
done
