#!/bin/bash
# A SLURM of one node on the loopback, for tests: one_node_slurm.sh up FOLDER | down FOLDER, as root on Debian
# (apt-get install slurmctld slurmd slurm-client munge). It has no accounting: ask it by squeue and not by sacct.
set -eu
folder=$2; conf=/etc/slurm/slurm.conf; host=$(hostname -s); mark="# made by softkin's tests in $folder"

up() {
  getent ahostsv4 "$host" | grep -q '^127\.' || { echo "$host must resolve to 127.0.0.1, see /etc/hosts" >&2; exit 1; }
  [ ! -e $conf ] || { echo "$conf is there already" >&2; exit 1; }
  mkdir -p "$folder"/{munge,state,spool,log}; chmod 755 "$folder" "$folder/munge"
  (umask 077; head -c 128 /dev/urandom > "$folder/munge/key")
  cat > $conf <<CONF
$mark
ClusterName=softkin
SlurmctldHost=$host(127.0.0.1)
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
AuthInfo=socket=$folder/munge/socket
SlurmUser=root
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/slurmd.log
MailProg=/bin/true
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc=$folder/log/jobs.txt
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,bf_interval=5
MinJobAge=86400
KillWait=5
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$(awk '/MemTotal/{print int($2*0.9/1024)}' /proc/meminfo)
PartitionName=main Nodes=$host Default=YES State=UP
CONF
  munged --socket="$folder/munge/socket" --key-file="$folder/munge/key" --pid-file="$folder/munge/munged.pid" \
    --log-file="$folder/munge/log" --seed-file="$folder/munge/seed"
  slurmctld -c; slurmd -c
  for _ in $(seq 600); do [ "$(sinfo -h -o %t 2> /dev/null)" = idle ] && return; sleep .1; done
  echo "no node is idle after a minute, see $folder/log" >&2; exit 1
}

down() {
  grep -qxF "$mark" $conf || { echo "$conf is not of $folder" >&2; exit 1; }
  scancel --user="$(id -un)" || :
  for pids in slurmd.pid slurmctld.pid munge/munged.pid; do
    [ -s "$folder/$pids" ] || continue
    pid=$(cat "$folder/$pids"); kill "$pid" || :
    for _ in $(seq 300); do [ -d "/proc/$pid" ] || break; sleep .1; done
  done
  rm -f $conf
}

"$1"
