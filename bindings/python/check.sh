#!/usr/bin/env bash
# The Python package, installed in an environment of its own, tested against the tool, and type-checked.
#   check.sh PCR PACKAGE     PCR is the tool, PACKAGE a wheel, or the module as cargo builds it: target/checked/lib_pcr.so
set -euo pipefail
cd "$(dirname "$0")/../.."
[ $# = 2 ] || { sed -n '3s/^# *//p' "$0" >&2; exit 2; }
tool=$(realpath "$1") package=$2
target=${CARGO_TARGET_DIR:-target}
environment=$target/python
python=${PYTHON:-python3}
if ! "$python" -m venv "$environment" >/dev/null 2>&1; then
  .ci/install.sh python3-venv
  "$python" -m venv "$environment"
fi
bin=$environment/bin
"$bin/pip" install -q --disable-pip-version-check numpy mypy matplotlib shapely abi3audit

# install PYTHON: the package, in the environment of this interpreter.
install() {
  local site
  "$1" -m pip uninstall -q --disable-pip-version-check --yes pcr-py >/dev/null 2>&1
  site=$("$1" -c 'import sysconfig; print(sysconfig.get_path("platlib"))')
  rm -rf "$site/pcr"
  case $package in
    *.whl) "$1" -m pip install -q --disable-pip-version-check --no-deps "$package" ;;
    *)
      cp -r bindings/python/python/pcr "$site/pcr"
      cp "$package" "$site/pcr/_pcr.abi3.so"
      ;;
  esac
}

install "$bin/python"
# No symbol but those of the stable interface of CPython 3.9.
"$bin/abi3audit" --strict --assume-minimum-abi3 3.9 "$("$bin/python" -I -c 'import pcr._pcr; print(pcr._pcr.__file__)')"
# Without NumPy in sight: nothing is needed.
"$bin/python" -I -c 'import sys; sys.modules["numpy"] = None; import pcr; assert len(pcr.Fleet([], name="none").regions()) == 0'
PCR=$tool "$bin/python" bindings/python/tests/test_pcr.py
"$bin/python" - <<'DOCTEST'
import doctest, sys, pcr
# With what modules of the package define for it: a module of its own is nobody's business.
runner = doctest.DocTestRunner()
for test in doctest.DocTestFinder().find(pcr, "pcr", module=False, globs=vars(pcr).copy()):
    runner.run(test)
failed, run = runner.summarize()
sys.exit(1 if failed or run < 20 else 0)
DOCTEST
# One module is for all of them: the oldest CPython and newer ones, where this machine has them.
others=(python3.9 python3.10 python3.12 python3.13)
if command -v pyenv >/dev/null; then others+=("$(pyenv root)"/versions/3.{9,1[0-9]}.*/bin/python); fi
for other in "${others[@]}"; do
  if "$other" -m venv --clear "$target/python-other" >/dev/null 2>&1; then
    install "$target/python-other/bin/python"
    "$target/python-other/bin/python" -I -c 'import sys, pcr; fleet = pcr.Fleet.read(sys.argv[1])
assert len(fleet.regions()) == 136 and len(fleet.plan().fleet.conflicts()) == 0
print("the same module in CPython", sys.version.split()[0])' tests/data/paper12.json
  fi
done
# The example of the package's README prints what that says.
"$bin/python" - bindings/python/README.md <<'README'
import contextlib, io, sys
text = open(sys.argv[1]).read()
program, said = (text.split(f"```{kind}\n")[1].split("```")[0] for kind in ("python", "text"))
out = io.StringIO()
with contextlib.redirect_stdout(out):
    exec(program, {})
sys.exit(0 if out.getvalue() == said else f"the README says\n{said}but it prints\n{out.getvalue()}")
README
# The notebooks say what they say in the file.
for notebook in bindings/python/notebooks/*.ipynb; do PCR=$tool "$bin/python" bindings/python/notebooks/run.py "$notebook"; done
"$bin/mypy" --config-file bindings/python/pyproject.toml -p pcr
"$bin/mypy" --config-file bindings/python/pyproject.toml bindings/python/tests/test_pcr.py
"$bin/stubtest" pcr._pcr --ignore-disjoint-bases
echo "the Python package: ok"
