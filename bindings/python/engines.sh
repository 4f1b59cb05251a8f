#!/usr/bin/env bash
# Tests of what others compute with: the recipe for a cluster of Dask, and frames of GeoPandas. Their packages have 100 MB, and are
# not in continuous integration.
#   engines.sh PYTHON     PYTHON has the package: target/python/bin/python after check.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
python=${1:?usage: $0 PYTHON}
"$python" -m pip install -q --disable-pip-version-check dask distributed geopandas
"$python" bindings/python/tests/test_engines.py
