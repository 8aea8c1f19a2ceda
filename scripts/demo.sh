#!/usr/bin/env bash
# From a fresh checkout to the paper's Table I: installs, builds, meshes the Basic Finner, plunges it at Mach 2.5, takes its
# derivatives at the paper's five Mach numbers, and prints and draws them beside the paper's. Less than ten minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

ranks=${RANKS:-2}
case=cases/basic_finner
runs=runs/demo
# Open MPI refuses to run as root, and more ranks than cores, unless it is told to.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1

step() { printf '\n== %s (after %d s)\n' "$*" "$SECONDS"; }
alphadot() { mpirun -n "$ranks" build/alphadot "$@"; }

step "Packages"
./scripts/install.sh

step "Program"
./scripts/build.sh

step "Mach 2.5: mesh of the half model from $case/missile.toml, steady flow, then one and a half cycles of plunge at k = 0.01, on $ranks ranks"
alphadot run $case/plunge.toml --out $runs/plunge --overwrite

step "Five Mach numbers: derivatives for k -> 0, by linear solves about the steady flow"
for mach in 1.58 1.75 1.89 2.10 2.50; do
  echo "Mach $mach (after $SECONDS s)"
  alphadot derivatives $case/derivatives.toml --set freestream.mach=$mach --out $runs/mach_$mach --overwrite --quiet
done

step "Beside the paper"
/usr/bin/python3 scripts/table_one.py $runs
step "Done"
