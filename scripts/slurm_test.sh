#!/usr/bin/env bash
# Slurm for real, on this machine: starts Debian's slurm-wlm on one node, submits a small sweep of the Basic Finner through
# sweep.py slurm, lets a job reach its wall-clock limit, and checks that it went back into the queue, went on from its checkpoint,
# and finished with the numbers of an uninterrupted run. As root, in a container or on a machine without a Slurm of its own; needs
# the built program; about ten minutes. The log stays in runs/slurm_test/slurm_test.log.
#
#   scripts/slurm_test.sh [PROGRAM]        installs slurm-wlm and munge if they are missing
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD

stop() {
  echo "slurm_test.sh: $*" >&2
  exit 1
}

program=$(realpath "${1:-${ALPHADOT:-build/alphadot}}")
[[ -x $program ]] || stop "there is no program $program; run scripts/build.sh first"
((EUID == 0)) || stop "must be run as root: it starts the daemons of Slurm"
if pgrep -x slurmctld >/dev/null || pgrep -x slurmd >/dev/null; then stop "there is a Slurm on this machine already"; fi
if ! { command -v slurmctld && command -v slurmd && command -v munged; } >/dev/null; then
  DEBIAN_FRONTEND=noninteractive apt-get install --quiet --yes --no-install-recommends slurm-wlm munge
fi

folder=$root/runs/slurm_test
rm -rf "$folder"
mkdir -p "$folder"
exec > >(tee "$folder/slurm_test.log") 2>&1
source scripts/slurm_node.sh
trap stop_node EXIT
# Both jobs are on one node, where each mpirun would bind its ranks to the first core.
export OMPI_MCA_hwloc_base_binding_policy=none
step() { printf '\n== %s (after %d s)\n' "$*" "$SECONDS"; }

step "Slurm on one node"
start_node "$folder/node"
sinfo

step "A sweep whose plunge is longer than the limit of its job, and the same without a limit"
/usr/bin/python3 scripts/mesh.py cases/basic_finner/missile.toml --level coarse --output "$folder/coarse.msh"
cp cases/basic_finner/{derivatives,plunge}.toml "$folder"
# So many steps that the plunge takes several minutes. Slurm may send its signal up to a minute earlier than it is told to.
sweep() {
  cat <<END
title = "Sweep under Slurm"
case = "derivatives.toml"
folder = "$1"
mesh = "coarse.msh"
alpha = 1.5
ranks = 1

[[runs]]
mach = 2.5

[[runs]]
case = "plunge.toml"
method = "plunge"
mach = 2.5
set."unsteady.steps_per_cycle" = ${STEPS:-240}
END
}
sweep limited > "$folder/limited.toml"
sweep unlimited > "$folder/unlimited.toml"
verb() { /usr/bin/python3 scripts/sweep.py "$@"; }
verb slurm "$folder/limited.toml" --program "$program" --time 2 --margin 20 --submit
verb slurm "$folder/unlimited.toml" --program "$program" --time 60 --submit

step "Until the queue is empty"
while [[ -n $(squeue --noheader) ]]; do
  squeue --format='%.12i %.10j %.10T %.8M %.9l %r' --noheader | sed "s/^/  after ${SECONDS} s: /"
  ((SECONDS < ${LIMIT:-1800})) || stop "the queue is not empty after $SECONDS s"
  sleep 15
done

step "What the jobs say"
tail -n +1 "$folder"/limited/slurm/*.log
step "Status"
verb status "$folder/limited.toml"
verb status "$folder/unlimited.toml"

step "Checks"
grep -q 'back into the queue' "$folder"/limited/slurm/1.log || stop "the plunge never reached its limit: set STEPS higher"
echo "the plunge went back into the queue $(grep -c 'back into the queue' "$folder"/limited/slurm/1.log) times"
[[ -s $folder/limited/report.html ]] || stop "the report job wrote no report"
echo "the report is there"
/usr/bin/python3 - "$folder"/{limited,unlimited}/plunge_*/result.json <<'END'
import json, sys
limited, unlimited = (json.load(open(file)) for file in sys.argv[1:])
assert limited["status"] == "completed", limited["status"]
for name, entry in unlimited["derivatives"].items():
    difference = limited["derivatives"][name]["value"] - entry["value"]
    assert abs(difference) <= 1e-9 * abs(entry["value"]), f"{name} differs by {difference}"
print("derivatives are those of the uninterrupted run")
END
step "Passed"
