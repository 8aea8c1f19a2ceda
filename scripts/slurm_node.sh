# Slurm on this machine alone, for tests; to be sourced by a script that runs as root. start_node FOLDER writes a configuration
# and a key for munge there, starts the daemons, and points the commands of Slurm to them; stop_node ends them.

slurm_pids=()

start_node() {
  local node=$1 host cores memory
  host=$(hostname -s) cores=$(nproc)
  memory=$(awk '/MemTotal/ {print int($2 / 1024 * 0.9)}' /proc/meminfo)
  mkdir -p "$node"/{state,spool}
  dd if=/dev/urandom of="$node/munge.key" bs=1024 count=1 status=none
  chmod 600 "$node/munge.key"
  # Its own key and socket: a munge that runs on this machine is left alone. munged wants a folder that only root can write to.
  munge_folder=$(mktemp -d /run/alphadot-munge.XXXX)
  chmod 755 "$munge_folder"
  munged --foreground --force --key-file="$node/munge.key" --socket="$munge_folder/socket" --pid-file="$munge_folder/pid" \
    --seed-file="$munge_folder/seed" --log-file="$node/munged.log" &> "$node/munged.out" &
  slurm_pids+=($!)

  cat > "$node/slurm.conf" <<END
ClusterName=alphadot
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$munge_folder/socket
StateSaveLocation=$node/state
SlurmdSpoolDir=$node/spool
SlurmctldPidFile=$node/slurmctld.pid
SlurmdPidFile=$node/slurmd.pid
SlurmctldLogFile=$node/slurmctld.log
SlurmdLogFile=$node/slurmd.log
SlurmctldPort=16817
SlurmdPort=16818
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SchedulerType=sched/backfill
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
MailProg=/bin/true
KillWait=10
MinJobAge=600
SchedulerParameters=sched_interval=5,bf_interval=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cores RealMemory=$memory State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
  export SLURM_CONF=$node/slurm.conf
  wait_until "munged" test -S "$munge_folder/socket"
  slurmctld -D -i &> "$node/slurmctld.out" &
  slurm_pids+=($!)
  slurmd -D -N "$host" &> "$node/slurmd.out" &
  slurm_pids+=($!)
  wait_until "Slurm" node_is_idle
}

node_is_idle() { sinfo --noheader --format=%T 2>/dev/null | grep -q idle; }

# wait_until NAME COMMAND...: until the command succeeds, half a minute at most.
wait_until() {
  local name=$1 try
  shift
  for try in {1..60}; do
    if "$@"; then return 0; fi
    sleep 0.5
  done
  echo "$name did not start; see the logs beside $SLURM_CONF" >&2
  return 1
}

stop_node() {
  scancel --user=root --quiet 2>/dev/null || true
  local try
  for try in {1..30}; do  # jobs that are stopped half-way take their time, and slurmd waits for them
    [[ -n $(squeue --noheader 2>/dev/null) ]] || break
    sleep 0.5
  done
  if ((${#slurm_pids[@]})); then
    kill "${slurm_pids[@]}" 2>/dev/null || true
    wait "${slurm_pids[@]}" 2>/dev/null || true
  fi
  rm -rf "${munge_folder:-}"
}
