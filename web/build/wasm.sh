#!/usr/bin/env bash
# Builds src/engine/infopart.wasm. Needs rustup's target (`rustup target add wasm32-unknown-unknown`), or WASM_TOOLCHAIN: a folder
# that build/debian-toolchain.sh has filled.
set -euo pipefail
cd "$(dirname "$0")/../wasm"
target=${CARGO_TARGET_DIR:-$PWD/target}
export CARGO_TARGET_DIR=$target
if [ -n "${WASM_TOOLCHAIN:-}" ]; then
    # shellcheck disable=SC1091
    source "$WASM_TOOLCHAIN/env"
    cargo build --release --target wasm32-unknown-unknown -Zbuild-std=std,panic_abort
else
    cargo build --release --target wasm32-unknown-unknown
fi
cp "$target/wasm32-unknown-unknown/release/infopart_web.wasm" ../src/engine/infopart.wasm
