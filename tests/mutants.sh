#!/usr/bin/env bash
# Makes each known mistake, one at a time, and sees that some test fails: the proof that the tests have power. Prints a
# table of the mistakes and the tests that noticed first; exit code 1 if one went unnoticed.
#   tests/mutants.sh [NAME ...]
# One build can make them all; which of them it makes is told to the tests that run.
set -uo pipefail
cd "$(dirname "$0")/.."
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-target/mutants} SMALTI_MUTANTS=1

names=("$@")
if [ ${#names[@]} -eq 0 ]; then
    mapfile -t names < <(grep -rhoE 'mutant!\("[a-z0-9_]+"\)' crates/smalti-core/src | sed -E 's/.*"(.*)".*/\1/' | sort -u)
fi

# What tells most of a mistake's meaning comes first, and the pictures, which notice everything, last.
suites=("smalti-core --lib" "smalti-tests --test laws" "smalti-tests --test answers" "smalti-tests --test agreement"
    "smalti-tests --test bits" "smalti-tests --test extremes" "smalti-tests --test golden")

cargo test --quiet --package smalti-core --package smalti-tests --no-run || exit 2

# Runs the suites until one notices; prints the first tests that did.
killers() {
    local log=$CARGO_TARGET_DIR/$1.log suite noticed code
    : >"$log"
    for suite in "${suites[@]}"; do
        # A mistake that hangs is noticed too. The suite is two words or three.
        # shellcheck disable=SC2086
        SMALTI_MUTANT=$1 timeout 900 cargo test --quiet --package $suite >"$log" 2>&1
        code=$?
        noticed=$(grep -E '^    [a-z0-9_:]+$' "$log" | sed 's/^ *//' | sort -u | head -3 | paste -sd, | sed 's/,/, /g')
        if [ $code -eq 124 ]; then noticed="${noticed:+$noticed, }did not end"; fi
        if [ $code -ne 0 ]; then
            echo "${noticed:-${suite##* } failed as a whole}"
            return
        fi
    done
}

survivors=0
for name in "${names[@]}"; do
    by=$(killers "$name")
    if [ -z "$by" ]; then
        survivors=$((survivors + 1))
        by="SURVIVED"
    fi
    printf '| %s | %s |\n' "$name" "$by"
done
[ "$survivors" -eq 0 ]
