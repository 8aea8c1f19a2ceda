#!/usr/bin/env bash
# Measures the solver against its targets on the Basic Finner's coarse mesh: installs, builds in build-bench/, meshes, times kernels,
# whole steady solves, memory and two ranks over one, and writes one JSON file. Wants a machine with nothing else to do; a few
# minutes. Arguments go to scripts/bench.py, e.g. --out FILE.
set -euo pipefail
cd "$(dirname "$0")/.."

./scripts/install.sh
cmake --preset bench
cmake --build --preset bench --parallel "$(nproc)" --target alphadot alphadot_bench
mesh=cases/basic_finner/coarse.msh
[[ -e $mesh ]] || /usr/bin/python3 scripts/mesh.py cases/basic_finner/missile.toml --level coarse --output $mesh
/usr/bin/python3 scripts/bench.py "$@"
