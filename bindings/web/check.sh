#!/usr/bin/env bash
# The module for WebAssembly and the playground: built, run in node and in a browser, compared with the tool bit for bit.
#   check.sh PCR       PCR is the tool; the page is then target/playground/index.html
set -euo pipefail
cd "$(dirname "$0")/../.."
tool=$(realpath "${1:?usage: $0 PCR}")
target=${CARGO_TARGET_DIR:-target}
command -v node >/dev/null || .ci/install.sh nodejs

firmware/cross.sh wasm32-unknown-unknown build --profile web --locked -p pcr-web
module=$target/wasm32-unknown-unknown/web/pcr_web.wasm
node -e 'const imports = WebAssembly.Module.imports(new WebAssembly.Module(require("fs").readFileSync(process.argv[1])));
  if (imports.length) { console.error("the module asks for", imports); process.exit(1); }' "$module"
diff <(node bindings/web/regions.mjs "$module") bindings/web/regions.out
bindings/web/build.py "$module" "$target/playground/index.html"
bindings/web/check.py "$tool" "$target/playground/index.html" "$target/playground"
