#!/usr/bin/env bash
# Puts each known mistake into the core, one at a time, and sees that some test fails: the proof that the tests have
# power. Prints a table of the mistakes and the first tests that noticed; exit code 1 if one went unnoticed.
#   tests/mutants.sh [NAME ...]
set -uo pipefail
cd "$(dirname "$0")/.."
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-target/mutants}

names=("$@")
if [ ${#names[@]} -eq 0 ]; then
    mapfile -t names < <(grep -rhoE 'mutant!\("[a-z0-9_]+"\)' crates/smalti-core/src | sed -E 's/.*"(.*)".*/\1/' | sort -u)
fi

survivors=0
for name in "${names[@]}"; do
    log=$CARGO_TARGET_DIR/$name.log
    mkdir -p "$CARGO_TARGET_DIR"
    # A mutant that hangs is noticed too.
    SMALTI_MUTANT=$name timeout 900 cargo test --package smalti-core --package smalti-tests --no-fail-fast >"$log" 2>&1
    code=$?
    killers=$(grep -E '^test .* \.\.\. FAILED' "$log" | sed -E 's/^test (.*) \.\.\. FAILED/\1/' | sort -u | head -3 | paste -sd, | sed 's/,/, /g')
    if [ $code -eq 124 ]; then killers="${killers:+$killers, }did not end"; fi
    if grep -qE '^error(\[|:) ' "$log" && [ -z "$killers" ] && ! grep -q 'test result' "$log"; then
        echo "error: $name does not compile, see $log" >&2
        exit 2
    fi
    if [ -z "$killers" ]; then
        survivors=$((survivors + 1))
        killers="SURVIVED"
    fi
    printf '| %s | %s |\n' "$name" "$killers"
done
[ "$survivors" -eq 0 ]
