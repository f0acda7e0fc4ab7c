#!/usr/bin/env bash
# A Rust that builds for WebAssembly, from Debian's packages, for machines where rustup cannot fetch its target: unpacked into a folder
# (900 MB) and not installed, so rustup's toolchain stays as it is. Then: WASM_TOOLCHAIN=FOLDER npm run build
set -euo pipefail
folder=${1:?usage: debian-toolchain.sh FOLDER}
mkdir -p "$folder/packages"
folder=$(cd "$folder" && pwd)
needs() { apt-cache depends --important "$1" | sed -n "s/ *Depends: \($2\)$/\1/p" | tail -1; }
linker=$(apt-cache search --names-only '^lld-[0-9]+$' | sort -V | tail -1 | cut -d' ' -f1)
(
    cd "$folder/packages"
    apt-get download -qq rustc-web rust-web-src libstd-rust-web-dev "$(needs libstd-rust-web-dev 'libstd-rust-web-.*')" \
        "$linker" "$(needs "$linker" 'libllvm[0-9]*')"
    for package in *.deb; do
        dpkg -x "$package" "$folder"
        rm "$package"
    done
)
source=$(find "$folder/usr/src" -maxdepth 1 -name 'rustc-*' | tail -1)
mkdir -p "$folder/usr/lib/rustlib/src"
ln -sfn "$source" "$folder/usr/lib/rustlib/src/rust"
mkdir -p "$folder/bin"
# The linker finds its own libraries wherever the folder is.
cat >"$folder/bin/wasm-ld" <<LINKER
#!/bin/sh
LD_LIBRARY_PATH=$folder/usr/lib/x86_64-linux-gnu:$folder/usr/lib/${linker/lld/llvm}/lib exec $folder/usr/bin/wasm-ld-${linker#lld-} "\$@"
LINKER
chmod +x "$folder/bin/wasm-ld"
cat >"$folder/env" <<ENV
export LD_LIBRARY_PATH=$folder/usr/lib/x86_64-linux-gnu
export RUSTC=$folder/usr/bin/rustc RUSTC_BOOTSTRAP=1
export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$folder/bin/wasm-ld
ENV
echo "WASM_TOOLCHAIN=$folder"
