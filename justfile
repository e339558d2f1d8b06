# What is done with this repository again and again. Nothing here is needed to build it or to render.

smalti := "cargo run --release --quiet --package smalti --"
room := "scenes/hexroom.toml"

# List the recipes
[private]
default:
    @just --list --unsorted

# Formatting, lints and documentation, as strict as CI
check:
    cargo fmt --all --check
    cargo clippy --workspace --all-targets -- -D warnings
    RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --quiet

# Every test, or those that ARGS name
test *ARGS:
    cargo test --workspace {{ARGS}}

# Render a scene; the picture lies here under the scene's name
render SCENE=room *FLAGS:
    {{smalti}} render {{SCENE}} {{FLAGS}}

# What a scene requires, and why
explain SCENE=room *FLAGS:
    {{smalti}} explain {{SCENE}} {{FLAGS}}

# How far an image is from a reference
compare IMAGE REFERENCE *FLAGS:
    {{smalti}} compare {{IMAGE}} {{REFERENCE}} {{FLAGS}}

# The report's Table 1 and its claims, measured, and its Figure 6, into out/report (about two minutes)
report *FLAGS:
    {{smalti}} study report {{room}} -o out/report {{FLAGS}}
    {{smalti}} photons scenes/hexroom-points.toml --photons 3000000 --exposure 4 -o out/report/figure6.png

# Take what the program says now as what the tests expect; look at the difference before it is committed
bless:
    SMALTI_BLESS=1 cargo test --package smalti-scene --test bad
    SMALTI_BLESS=1 cargo test --package smalti-tests --test golden
    git diff --stat

coverage_of := "cargo run --release --quiet --package smalti-tests --bin coverage -- --seeds 200"

# Does the error that renders state of themselves hold the truth as often as it claims? docs/promises.md (about an hour)
coverage *FLAGS:
    {{coverage_of}} --size 160 --spp 128 {{FLAGS}} scenes/hexroom.toml scenes/hexroom-caustic.toml
    {{coverage_of}} --size 200 --spp 64 {{FLAGS}} scenes/cornell.toml scenes/furnace.toml
    {{coverage_of}} --size 96 --spp 64 {{FLAGS}} scenes/blob.toml

# The golden scenes on another architecture, by qemu: needs rustup, qemu-user and gcc-aarch64-linux-gnu (about ten minutes)
aarch64:
    rustup target add aarch64-unknown-linux-gnu
    CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
    CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64 -L /usr/aarch64-linux-gnu" \
    cargo test --locked --target aarch64-unknown-linux-gnu --package smalti-tests --test golden

# How far the kernels are from f64: the table of docs/kernels.md
accuracy *FLAGS:
    cargo run --release --quiet --package smalti-tests --bin accuracy -- {{FLAGS}}

# A thousand million rays at edges of closed meshes, as many off surfaces: none may slip out or hit again (ten minutes)
rays *FLAGS:
    cargo run --release --quiet --package smalti-tests --bin rays -- {{FLAGS}}

# Make each known mistake and see that a test notices: the table of docs/mutants.md (about an hour)
mutants *NAMES:
    tests/mutants.sh {{NAMES}}

# Fuzz all that is read, each kind of input for so many seconds: just fuzz 720 (needs cargo-fuzz)
fuzz *ARGUMENTS:
    tests/fuzz.sh {{ARGUMENTS}}
