#!/usr/bin/env bash
# A study on a SLURM of this machine alone, which the test starts in a folder of its own on the
# loopback and ends: registrations, eight shards of which one is killed and requeued, merge. The
# result is compared with an undivided run.
#
#     slurm_test.sh FATHOM SOURCES
#
# "skipped: WHY" where SLURM is not installed (scripts/setup.sh cluster installs it) or will not run.
set -euo pipefail
fathom=$1
sources=$2

for program in munged slurmctld slurmd sbatch srun scontrol squeue sacctmgr python3; do
  command -v "$program" > /dev/null || [[ -x /usr/sbin/$program ]] || {
    printf "skipped: %s is not installed; 'scripts/setup.sh cluster' installs it\n" "$program"
    exit 0
  }
done
PATH=$PATH:/usr/sbin

folder=$(mktemp -d /tmp/fathom-slurm-XXXXXX)
host=$(hostname -s)
export SLURM_CONF=$folder/slurm.conf

fail() {
  printf 'failed: %s\n' "$1"
  tail -n 20 "$folder"/*.log "$folder"/study/logs/*.log 2> /dev/null || true
  exit 1
}

daemons=()
end() {
  local status=$?
  scancel --user="$(id -un)" 2> /dev/null || true
  sleep 1
  # Steps first, then who would start them again.
  pkill -KILL -f "slurmstepd.*$folder" 2> /dev/null || true
  for ((i = ${#daemons[@]} - 1; i >= 0; --i)); do
    kill "${daemons[$i]}" 2> /dev/null || true
  done
  for pid in "${daemons[@]}"; do
    for ((i = 0; i < 100; ++i)); do
      kill -0 "$pid" 2> /dev/null || break
      sleep 0.1
    done
    kill -KILL "$pid" 2> /dev/null || true
  done
  rm -rf "$folder"
  return "$status"
}
trap end EXIT

# Two ports that nobody has just now.
read -r controller_port node_port < <(python3 -c '
import socket
held = [socket.socket() for _ in range(2)]
for one in held: one.bind(("127.0.0.1", 0))
print(*(one.getsockname()[1] for one in held))')

# Not from the system: a service of the machine is left alone.
mkdir -m 711 "$folder/munge"
dd if=/dev/urandom of="$folder/munge/key" bs=1024 count=1 status=none
chmod 400 "$folder/munge/key"
munged --foreground --force --socket="$folder/munge/socket" --key-file="$folder/munge/key" \
  --log-file="$folder/munge.log" --pid-file="$folder/munge/pid" --seed-file="$folder/munge/seed" \
  --num-threads=2 > /dev/null 2>&1 &
daemons+=($!)

user=$(id -un)
cat > "$SLURM_CONF" << CONF
ClusterName=fathom_test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$controller_port
SlurmdPort=$node_port
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
SlurmUser=$user
SlurmdUser=$user
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SchedulerParameters=sched_interval=1,batch_sched_delay=0
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN
PartitionName=test Nodes=$host Default=YES State=UP
CONF
mkdir "$folder/state" "$folder/spool"

slurmctld -D -f "$SLURM_CONF" > /dev/null 2>&1 &
daemons+=($!)
slurmd -D -f "$SLURM_CONF" > /dev/null 2>&1 &
daemons+=($!)
for ((i = 0; ; ++i)); do
  [[ $(sinfo --noheader --format=%T 2> /dev/null) != idle ]] || break
  for pid in "${daemons[@]}"; do
    kill -0 "$pid" 2> /dev/null && [[ $i -lt 300 ]] || {
      printf 'skipped: SLURM does not run here: %s\n' \
        "$(cat "$folder"/*.log 2> /dev/null | grep -iE 'error|fatal' | tail -n 1)"
      exit 0
    }
  done
  sleep 0.2
done

cat > "$folder/study.yaml" << 'STUDY'
dataset:
  type: simulated
  world: {metres_per_pixel: 0.01}
  mission: {type: sweep, legs: 2, leg_length_m: 3, leg_spacing_m: 1}
  camera: {width: 200, height: 150, fx: 150, fy: 150}
front_end:
  keyframes: {separation_frames: 3}
  ransac: {max_error_m: 0.05}
estimators: [{type: trajectory_iekf}, {type: ekf}, {type: ceres_pose_graph}]
sweep:
  - {key: dataset.odometry.sigma_theta_rad, name: heading noise, values: [0.01, 0.03]}
surveys: 2
trials: 400
STUDY
cd "$folder"
export TMPDIR=$folder/scratch
mkdir "$TMPDIR"

last=$("$sources/scripts/cluster/submit.sh" study.yaml --shards 8 --out study --fathom "$fathom" \
  --arguments "--no-mosaic")
printf 'submitted; the merge is job %s\n' "$last"

# The third shard is killed as soon as it has something to lose, and must be seen to run again.
killed=no
for ((i = 0; i < 3000; ++i)); do
  if [[ $killed == no ]]; then
    pid=$(pgrep -f "^$fathom compare .*--shard 3/8 .*--scratch" | head -n 1 || true)
    if [[ -n $pid ]] && compgen -G "$TMPDIR/fathom-*/results.sqlite" > /dev/null; then
      sleep 0.3
      kill -KILL "$pid" 2> /dev/null && killed=yes && printf 'killed shard 3/8\n'
    fi
  fi
  state=$(scontrol show job "$last" 2> /dev/null | sed -n 's/.*JobState=\([A-Z_]*\).*/\1/p')
  case $state in
    COMPLETED) break ;;
    FAILED | CANCELLED | TIMEOUT | NODE_FAIL) fail "the merge ended as $state" ;;
  esac
  # SLURM lets a requeued job wait for two minutes; a test need not.
  for held in $(squeue --noheader --states=PENDING --format='%i %r' | sed -n 's/ BeginTime$//p'); do
    scontrol update JobId="$held" StartTime=now 2> /dev/null || true
  done
  sleep 0.2
done
[[ $state == COMPLETED ]] || fail "the merge is $state after ten minutes"
[[ $killed == yes ]] || fail "no task could be killed: they were too quick"
grep -q 'Killed\|killed' study/logs/shards-3.log || fail "shard 3/8 was not killed"

"$fathom" compare study.yaml --out whole --no-mosaic --quiet --no-cache
python3 "$sources/tests/cluster/same_results.py" whole study || fail "the merged study differs"
[[ -f study/report.html ]] || fail "the merged study has no page"
[[ -z $(ls -A "$TMPDIR") ]] || fail "the node's disk is not empty: $(ls "$TMPDIR")"
printf 'passed\n'
