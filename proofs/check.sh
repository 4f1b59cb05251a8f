#!/usr/bin/env bash
# Prints every claim of docs/theory/errors*.md and docs/theory/equations.md with how it is held, and fails if one is not, or if a change of a constant
# that is proved is not told (proofs/mutants.py).
#   proofs/check.sh            all, 2 minutes
#   proofs/check.sh --quick    without the runs over all inputs, whose claims then count as missed
# Installs Gappa (Debian) and z3 (Debian's, or that of PyPI) where they are missing, and says so.
set -euo pipefail
cd "$(dirname "$0")/.."
export RUSTUP_AUTO_INSTALL=0

command -v python3 >/dev/null || .ci/install.sh python3
command -v gappa >/dev/null || .ci/install.sh gappa || { echo "Gappa is missing: https://gappa.gitlabpages.inria.fr" >&2; exit 1; }
if ! python3 -c 'import z3' 2>/dev/null; then
  echo "installing z3-solver"
  python3 -m pip install -q z3-solver 2>/dev/null || .ci/install.sh python3-z3 || { echo "z3 for Python is missing" >&2; exit 1; }
  python3 -c 'import z3'
fi

# The kernels are those that are proved things of: pcr-core/src/recorded.rs.
cargo test -q --locked -p pcr-core --lib recorded::
python3 proofs/mutants.py
python3 proofs/check.py "$@"
